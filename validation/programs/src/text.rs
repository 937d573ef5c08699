//! Text that programs write, made fit for one line of a report.

/// The most characters of a program's own words in a reason.
const MAX_CHARACTERS: usize = 200;

/// A text on one line, without characters that steer a terminal, cut where it is long.
pub(crate) fn plain(text: &str) -> String {
    let word = |word: &str| word.chars().filter(|it| !it.is_control()).collect::<String>();
    // A part of a long text is enough: its words need not all be looked at.
    let start: String = text.chars().take(8 * MAX_CHARACTERS).collect();
    let words: Vec<String> = start.split_whitespace().map(word).collect();
    let line = words.join(" ");
    if line.chars().count() <= MAX_CHARACTERS {
        return line;
    }
    let cut: String = line.chars().take(MAX_CHARACTERS).collect();
    format!("{cut}...")
}

/// The last line of what a program wrote to its standard error that is not empty.
pub(crate) fn last_line(bytes: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(bytes);
    let lines = text.lines().rev().map(plain);
    lines.into_iter().find(|line| !line.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_programs_stay_on_one_short_line() {
        assert_eq!(plain(" a\r\n\tb\u{1b}[31m \u{7}c"), "a b[31m c");
        let long = plain(&"x".repeat(1_000_000));
        assert_eq!(long.len(), MAX_CHARACTERS + 3);
        assert_eq!(last_line(b"one\ntwo \xff\n\n \n").as_deref(), Some("two \u{fffd}"));
        assert_eq!(last_line(b"\n \n"), None);
    }
}

//! The examples of a page: run, and held against what the page shows.
//!
//! Every example is run, in the page's order and in one folder; a block of TOML or CSV whose first
//! line is the comment `# NAME` is written there. In a block ```` ```console ```` all commands end
//! with exit code 0, in ```` ```console exit=1 ```` with 1. A line `...` stands for any number of
//! lines; splicing keeps as many lines before and after it as there are.

use super::{percuss, text};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const GAP: &str = "...";

/// A page of the documentation.
pub fn page(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name)
}

pub fn read(page: &Path) -> String {
    std::fs::read_to_string(page).expect("the page is there")
}

/// Whether pages are written anew instead of being held against what is printed.
pub fn is_splicing() -> bool {
    std::env::var_os("PERCUSS_SPLICE").is_some()
}

/// Whether digits are those of the pages: the last ones are those of one platform's sine.
pub const fn is_the_pages_platform() -> bool {
    cfg!(all(target_arch = "x86_64", target_os = "linux"))
}

/// Runs the examples of a page in a folder: they print what the page shows. With `PERCUSS_SPLICE=1`
/// what they print is written to the page; `test` is the name of the test that does so.
pub fn hold(page: &Path, folder: &Path, test: &str) {
    let page_text = read(page);
    let parts = page_text.split("```").enumerate().map(|(i, part)| {
        let (language, block) = part.split_once('\n').unwrap_or((part, ""));
        let exit = language.strip_prefix("console").map(|it| it.trim().strip_prefix("exit="));
        match (i % 2 == 1, exit, language) {
            (true, Some(exit), _) => {
                let code = exit.map_or(0, |it| it.parse().expect("an exit code"));
                format!("{language}\n{}", spliced(block, folder, code))
            }
            (true, None, "toml" | "csv") => {
                write_file(folder, block, language == "toml");
                part.to_owned()
            }
            _ => part.to_owned(),
        }
    });
    let whole = parts.collect::<Vec<_>>().join("```");
    if is_splicing() {
        std::fs::write(page, &whole).expect("written");
    } else if is_the_pages_platform() {
        assert!(page_text == whole, "PERCUSS_SPLICE=1 cargo test --test harness {test}\n{whole}");
    }
}

/// Holds the pictures that a page shows from `docs/SHOWN/` against those that its commands made in
/// a folder; their names. With `PERCUSS_SPLICE=1` they are written anew.
pub fn hold_pictures(page: &Path, shown: &str, made_in: &Path) -> BTreeSet<String> {
    let text = read(page);
    let opening = format!("]({shown}/");
    let names = text.split(&opening).skip(1).filter_map(|it| it.split(')').next());
    let names: BTreeSet<String> = names.map(str::to_owned).collect();
    for name in &names {
        let made = std::fs::read(made_in.join(name)).expect("a command makes it");
        let kept = page.with_file_name(shown).join(name);
        if is_splicing() {
            std::fs::create_dir_all(kept.parent().expect("a folder")).expect("made");
            std::fs::write(kept, made).expect("written");
        } else if is_the_pages_platform() {
            assert!(std::fs::read(kept).ok() == Some(made), "{name} is not as it is made");
        }
    }
    names
}

/// Runs the commands of pages, each in an empty folder: they print what the pages show, and make
/// the pictures in `docs/SHOWN/`, which has no others.
pub fn hold_studies(pages: &[&str], shown: &str, test: &str) {
    let mut pictures = BTreeSet::new();
    for name in pages {
        let folder = tempfile::tempdir().expect("a folder");
        hold(&page(name), folder.path(), test);
        pictures.extend(hold_pictures(&page(name), shown, folder.path()));
    }
    let kept = std::fs::read_dir(page(shown)).expect("the pictures");
    let kept = kept.filter_map(|it| it.ok()?.file_name().into_string().ok());
    assert_eq!(kept.collect::<BTreeSet<_>>(), pictures);
}

/// The commands of a text's transcripts.
pub fn commands(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.strip_prefix("$ ")).map(str::to_owned).collect()
}

/// The words of a command as a shell has them; quotation marks are single ones.
pub fn words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (i, part) in command.split('\'').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

/// What a command prints in a folder: messages, then data. `> FILE` keeps the data.
fn printed(command: &str, folder: &Path, code: i32) -> String {
    let words = words(command);
    let (words, file) = match words.iter().position(|it| it == ">") {
        Some(end) => (&words[..end], words.get(end + 1)),
        None => (&words[..], None),
    };
    assert_eq!(words[0], "percuss", "{command}");
    let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
    let output = percuss(&arguments).current_dir(folder).output().expect("it runs");
    let (data, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(code), "{command}: {said}");
    match file {
        Some(file) => {
            std::fs::write(folder.join(file), data).expect("written");
            said
        }
        None => said + &data,
    }
}

/// What is printed with the gap that the shown text has.
fn with_gap(printed: &str, shown: &str) -> String {
    let shown: Vec<&str> = shown.lines().collect();
    let Some(gap) = shown.iter().position(|line| *line == GAP) else { return printed.to_owned() };
    let lines: Vec<&str> = printed.lines().collect();
    let after = shown.len() - gap - 1;
    assert!(lines.len() >= gap + after, "{printed} is too short for its gap");
    let tail = &lines[lines.len() - after..];
    let kept = [&lines[..gap], &[GAP], tail].concat();
    kept.join("\n") + "\n"
}

/// A transcript with today's output.
fn spliced(transcript: &str, folder: &Path, code: i32) -> String {
    let mut whole = String::new();
    let mut lines = transcript.lines().peekable();
    while let Some(line) = lines.next() {
        let command = line.strip_prefix("$ ").unwrap_or_else(|| panic!("{line} has no command"));
        let mut shown = String::new();
        while let Some(line) = lines.next_if(|it| !it.starts_with("$ ")) {
            shown += &format!("{line}\n");
        }
        whole += &format!("$ {command}\n{}", with_gap(&printed(command, folder, code), &shown));
    }
    whole
}

/// A block whose first line is the comment `# NAME`, as a file; CSV has no comments.
fn write_file(folder: &Path, block: &str, with_name: bool) {
    let (line, rest) = block.split_once('\n').expect("a line");
    let name = line.strip_prefix("# ").expect("a name");
    let block = if with_name { block } else { rest };
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
    std::fs::write(path, block).expect("written");
}

//! The transcripts of docs/SCORE_YOUR_INTEGRATOR.md, done as they say.
//!
//! `PERCUSS_SPLICE=1 cargo test --release --test harness score_your_integrator:: -- --ignored`
//! writes what `score` prints into the page.

use crate::support::{percuss, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/SCORE_YOUR_INTEGRATOR.md")
}

fn read() -> String {
    fs::read_to_string(page()).expect("the page is there")
}

/// The fenced blocks of the page in a language, as they stand there.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fenced = page.split("```").skip(1).step_by(2);
    let own = fenced.filter_map(|it| it.split_once('\n')).filter(|it| it.0 == language);
    own.map(|it| it.1).collect()
}

/// Writes a program of the page, whose first line names it, into a folder.
fn write(folder: &Path, program: &str) {
    let name =
        program.split_once(": ").and_then(|(line, _)| line.split(' ').nth(1)).expect("a name");
    fs::write(folder.join(name), program).expect("written");
}

/// The words of a command; quotation marks are single ones.
fn words(command: &str) -> Vec<String> {
    let parts = command.split('\'').enumerate();
    let word = |(i, part): (usize, &str)| -> Vec<String> {
        if i % 2 == 1 {
            vec![part.to_owned()]
        } else {
            part.split_whitespace().map(str::to_owned).collect()
        }
    };
    parts.flat_map(word).collect()
}

/// Runs a command of the page in a folder.
fn run(folder: &Path, command: &str) -> Output {
    let words = words(command);
    let output = if words[0] == "percuss" {
        let arguments: Vec<&str> = words[1..].iter().map(String::as_str).collect();
        percuss(&arguments).current_dir(folder).output()
    } else {
        // A virtual environment of the tester's own.
        let python = std::env::var("PERCUSS_PYTHON").unwrap_or("python3".to_owned());
        let program = if words[0] == "python3" { &python } else { &words[0] };
        Command::new(program).args(&words[1..]).current_dir(folder).output()
    };
    output.unwrap_or_else(|error| panic!("{command}: {error}"))
}

/// Runs a command of the page, and says what it prints as far as the page shows it: of `score` the
/// rows, and nothing of the others.
fn done(folder: &Path, command: &str) -> String {
    let output = run(folder, command);
    let (printed, said) = (text(&output.stdout), text(&output.stderr));
    let is_score = command.starts_with("percuss score ");
    assert!(output.status.success() || is_score, "{command}: {said}");
    assert_ne!(output.status.code(), Some(2), "{command}: {said}");
    let rows = printed.split("\n\n").next().unwrap_or_default();
    if is_score { format!("{rows}\n") } else { String::new() }
}

/// The page's transcripts from the one that exports to the end, done again.
fn spliced(page: &str, folder: &Path) -> String {
    let mut parts: Vec<String> = page.split("```").map(str::to_owned).collect();
    for part in parts.iter_mut().skip(1).step_by(2) {
        let Some((language, block)) = part.split_once('\n') else { continue };
        match language {
            "python" | "cpp" | "r" => write(folder, block),
            "console" => {
                let commands = block.lines().filter_map(|line| line.strip_prefix("$ "));
                let done = commands.map(|it| format!("$ {it}\n{}", done(folder, it)));
                *part = format!("console\n{}", done.collect::<String>());
            }
            _ => {}
        }
    }
    parts.join("```")
}

/// A text in which figures that hang on a library's or a processor's rounding are left out, and the
/// blanks that make room for them.
fn without_figures(text: &str) -> String {
    let line = |line: &str| {
        let cells = line.split_whitespace();
        let cells: Vec<_> =
            cells
                .map(|it| {
                    if it.contains("e-") && line.contains("1e-6 ") && it != "1e-6" {
                        "#"
                    } else {
                        it
                    }
                })
                .collect();
        cells.join(" ") + "\n"
    };
    text.lines().map(line).collect()
}

#[test]
#[ignore = "needs Python with SciPy, a compiler of C++, and R with deSolve"]
fn every_transcript_prints_what_it_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let old = read();
    let new = spliced(&old, folder.path());
    if std::env::var_os("PERCUSS_SPLICE").is_some() {
        fs::write(page(), new).expect("written");
    } else {
        assert_eq!(without_figures(&old), without_figures(&new));
    }
}

/// Cases on which a solver may never end, and one that is turned back in time.
const HARD_CASES: &str = "'^(ball-(forty-impacts|moving-in|backward)|rigid-rests-on-stop|\
                    spheres-.*|relay-chatter-fine|cradle-one)$'";

/// What is no case: its horizon is no number, and it has no rows.
const BROKEN_CASE: &str = "mode,horizon,omega,phi,backward,x\nfree,nonsense,1,0,0,0\n";

/// Each program ends on hard cases, says which case it cannot answer, and answers the others.
#[test]
#[ignore = "needs Python with SciPy, a compiler of C++, and R with deSolve"]
fn every_program_ends_and_goes_on_after_a_case_that_fails() {
    let (page, folder) = (read(), tempfile::tempdir().expect("a folder"));
    let folder = folder.path();
    ["python", "cpp", "r"].iter().for_each(|it| write(folder, blocks(&page, it)[0]));
    done(folder, &format!("percuss export --out asked -c {HARD_CASES}"));
    fs::write(folder.join("asked/a-broken.start.csv"), BROKEN_CASE).expect("written");
    let consoles = blocks(&page, "console");
    let commands = consoles.iter().flat_map(|it| it.lines()).filter_map(|it| it.strip_prefix("$ "));
    for command in commands.filter(|it| !it.starts_with("percuss ")) {
        let said = text(&run(folder, command).stderr);
        if let [.., asked, answers, _] = &words(command)[..]
            && asked == "asked"
        {
            assert!(said.contains("a-broken: "), "{command}: {said}");
            hold_hard_answers(folder, answers);
        }
    }
}

/// Answers to the hard cases and to no other; all can be read.
fn hold_hard_answers(folder: &Path, answers: &str) {
    let file = |case: &str| folder.join(answers).join(format!("{case}.events.csv"));
    assert!(!file("a-broken").exists(), "{answers}");
    let backward = fs::read_to_string(file("ball-backward")).expect("it is answered");
    assert!(backward.lines().last().is_some_and(|it| it.contains(",leaves-domain,")), "{backward}");
    let score =
        format!("percuss score --name x --tolerance 1e-6 --answers {answers} -c {HARD_CASES}");
    let output = run(folder, &score);
    let counts = text(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
    let are_all_read = counts.ends_with(" 0 error");
    assert!(are_all_read, "{answers}: {counts}: {}", text(&output.stderr));
}

/// What needs no other language: the page's export has what its programs read, and its command of
/// `score` judges answers of its cases.
#[test]
fn what_is_asked_is_there() {
    let page = read();
    let folder = tempfile::tempdir().expect("a folder");
    let consoles = blocks(&page, "console");
    let ask = consoles.first().and_then(|it| it.trim().strip_prefix("$ ")).expect("a command");
    done(folder.path(), ask);
    for ending in ["start.csv", "rows.csv", "sample-times.csv", "txt", "json"] {
        assert!(folder.path().join(format!("asked/small-b.{ending}")).exists(), "{ending}");
    }
    let languages = ["python", "cpp", "r"].map(|it| blocks(&page, it).len());
    assert_eq!(languages, [1; 3]);
    for program in ["python", "cpp", "r"].map(|it| blocks(&page, it)[0]) {
        let files = ["start.csv", "rows.csv", "sample-times.csv", "events", "samples"];
        let endings = ["backward", "leaves-domain", "no-progress"];
        for word in files.iter().chain(&endings) {
            assert!(program.contains(word), "{word} is not in {program}");
        }
    }
    let scores = consoles
        .iter()
        .flat_map(|it| it.lines())
        .filter_map(|it| it.strip_prefix("$ percuss score"));
    assert_eq!(scores.count(), 3);
}

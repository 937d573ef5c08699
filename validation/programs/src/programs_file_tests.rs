use super::*;

fn refused(text: &str) -> String {
    match parse("p.toml", text, Path::new("folder")) {
        Ok(programs) => format!("accepted: {programs:?}"),
        Err(error) => error.0,
    }
}

#[test]
fn programs_are_read_in_order() {
    let text = "[[program]]\nname = \"a\"\ncommand = [\"x\", \"-y\"]\ntimeout_s = 2.5\n\
                [[program]]\nname = \"b-1.0\"\ncommand = [\"./z\"]\n";
    let programs = parse("p.toml", text, Path::new("folder")).unwrap_or_default();
    let [a, b] = programs.as_slice() else { unreachable!("{programs:?}") };
    assert_eq!((a.name.as_str(), a.timeout), ("a", Duration::from_millis(2500)));
    assert_eq!((b.name.as_str(), b.timeout), ("b-1.0", Duration::from_secs(60)));
    assert_eq!((a.command.join(" "), a.folder.as_path()), ("x -y".to_owned(), Path::new("folder")));
}

#[test]
fn every_mistake_is_named_in_one_line() {
    let one = |rest: &str| format!("[[program]]\n{rest}");
    let name = "name = \"a\"\n";
    let whole = "[[program]]\nname = \"a\"\ncommand = [\"x\"]\n";
    let mistakes = [
        (String::new(), "p.toml: names no program; accepted is a [[program]] or more"),
        ("[[programs]]\n".to_owned(), "p.toml:1: unknown field `programs`"),
        ("[[program\n".to_owned(), "p.toml:1: "),
        (one("command = [\"x\"]\n"), "p.toml:1: name is missing; accepted is a name of 1 to 40"),
        (one(name), "p.toml:1: command is missing; accepted is a list: a program, its arguments"),
        (one("name = \"A b\"\ncommand = [\"x\"]\n"), "p.toml:2: name \"A b\" is not accepted: a n"),
        (one("name = 3\n"), "p.toml:2: name = 3 is not accepted: a string"),
        (one(&format!("{name}command = []\n")), "p.toml:3: command is not accepted: a list that"),
        (one(&format!("{name}command = [\"\"]\n")), "p.toml:3: command is not accepted: a list"),
        (one(&format!("{name}command = [\"a\\u0000\"]\n")), "p.toml:3: command is not accepted"),
        (
            one(&format!("{name}command = \"x\"\n")),
            "p.toml:3: command = \"x\" is not accepted: a l",
        ),
        (format!("{whole}timeout_s = 0\n"), "p.toml:4: timeout_s = 0 is not accepted: 0.001 to"),
        (format!("{whole}timeout_s = nan\n"), "p.toml:4: timeout_s = NaN is not accepted: 0.001"),
        (
            format!("{whole}timeout_s = \"1\"\n"),
            "p.toml:4: timeout_s = \"1\" is not accepted: a nu",
        ),
        (format!("{whole}timeout = 1\n"), "p.toml:4: unknown field `timeout`"),
        (format!("{whole}{whole}"), "p.toml:5: name \"a\" is not accepted: another program has it"),
    ];
    for (text, expected) in mistakes {
        let error = refused(&text);
        assert!(error.starts_with(expected) && !error.contains('\n'), "{text}\n{error}");
    }
    let absent = read(Path::new("absent.toml"));
    let absent = absent.err().map(|error| error.0).unwrap_or_default();
    assert!(absent.starts_with("absent.toml: cannot be read"), "{absent}");
}

/// The programs of this folder are read, and what is known of them names set-ups of theirs.
#[test]
fn the_programs_here_and_their_shortcomings_are_accepted() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("programs.toml");
    let programs = read(&path).unwrap_or_default();
    let known = shortcomings(&path).unwrap_or_default();
    assert!(programs.len() >= 12 && known.len() >= 100, "{} {}", programs.len(), known.len());
    for it in known {
        let engine = it.engine.to_string();
        let of_a_program = |name: &str| engine.starts_with(&format!("{name}-"));
        assert!(programs.iter().any(|it| of_a_program(&it.name)), "{engine}");
    }
}

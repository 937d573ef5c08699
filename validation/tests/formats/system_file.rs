//! The files of systems, held to the schema that editors check them by.

use super::{assert_valid, json};
use crate::support;
use serde_json::Value;
use std::path::Path;

/// The system's file as the JSON that an editor's check sees.
fn of_toml(text: &str) -> Value {
    serde_json::to_value(text.parse::<toml::Table>().expect("TOML")).expect("JSON")
}

#[test]
fn every_systems_file() {
    for (_, text) in percuss_validation::systems::SYSTEMS {
        assert_valid("system.schema.json", &of_toml(text));
    }
    let page = std::fs::read_to_string(support::transcripts::page("SYSTEM_FORMAT.md"));
    let page = page.expect("the page is there");
    let example = page.split("```toml\n").nth(1).and_then(|it| it.split("```").next());
    assert_valid("system.schema.json", &of_toml(example.expect("an example")));
}

/// The phase of a forcing may be left out: it is 0.
#[test]
fn a_forcing_without_its_phase() {
    let named = percuss_validation::systems::named("plastic-ball-on-table").expect("a system");
    let with = percuss::affine::System::parse("with", named).expect("accepted");
    assert!(named.contains(", phi = 0.0 }"));
    let shorter = named.replacen(", phi = 0.0 }", " }", 1);
    assert_valid("system.schema.json", &of_toml(&shorter));
    let without = percuss::affine::System::parse("without", &shorter).expect("accepted");
    assert_eq!(format!("{with:?}"), format!("{without:?}"));
}

/// What the program refuses and a schema can see, the schema refuses.
#[test]
fn mistakes_in_a_systems_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/system.schema.json");
    let schema = json(&std::fs::read_to_string(path).expect("read"));
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let named = percuss_validation::systems::named("plastic-ball-on-table").expect("a system");
    assert!(validator.is_valid(&of_toml(named)));
    for (from, to) in [
        ("schema = 1", "schema = 2"),
        ("name = \"plastic-ball", "name = \"Plastic-ball"),
        ("states = [\"x\", \"v\"]", "states = []"),
        ("states = [\"x\", \"v\"]", "states = [\"x\", \"sin\"]"),
        ("forcing = { omega = 1.0,", "forcing = { omega = -1.0,"),
        ("omega = 1.0, phi = 0.0", "phi = 0.0"),
        ("A = 1.5", "A = \"3/2\""),
        ("A = 1.5", "2A = 1.5"),
        ("A*omega^2*cos - g\"", "A*omega^2*cos - 9.81\""),
        ("v' = -g\"", "v = -g\""),
        ("v' = -g\"", "v' = -9.81\""),
        ("name = \"impact\"", "name = \"end\""),
        ("name = \"impact\"", "name = \"first impact\""),
        ("guard = \"A*cos > x\"", "guard = \"A*cos >= x\""),
        ("guard = \"A*cos > x\"", "guard = \"A*cos - x\""),
        ("guard = \"A*cos > x\"", "gard = \"A*cos > x\""),
        ("guard = \"A*cos > x\"", ""),
        ("reset = [\"x = A*cos\"", "reset = [\"x' = A*cos\""),
        ("{ mode = \"stuck\" }", "{ modes = \"stuck\" }"),
        ("mode = \"stuck\"\nt = 2.0", "t = 2.0"),
    ] {
        assert!(named.contains(from), "{from} is not in the file");
        let changed = named.replacen(from, to, 1);
        assert!(!validator.is_valid(&of_toml(&changed)), "{from} -> {to} is accepted");
        let refusal = percuss::affine::System::parse("changed", &changed);
        assert!(refusal.is_err(), "{from} -> {to} is accepted by the program");
    }
}

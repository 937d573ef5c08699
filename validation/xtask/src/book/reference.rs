//! Pages that are generated: the help of every verb, and the keys of every JSON file.

use crate::process::Folder;
use anyhow::{Context, Result};
use serde_json::Value;
use std::fmt::Write;

/// The page of the verbs, as the summary names it.
pub const VERBS: &str = "docs/reference/VERBS.md";

/// The page of the keys, as the summary names it.
pub const KEYS: &str = "docs/reference/KEYS.md";

/// The folder of the schemas.
const SCHEMAS: &str = "validation/schemas";

/// The help of the program and of each of its verbs, as they print it.
pub fn verbs(root: &Folder) -> Result<String> {
    let mut page =
        "# Every verb's help\n\nThis page is what `percuss VERB --help` prints.\n".to_owned();
    add_verb(root, &[], &mut page)?;
    Ok(page)
}

fn add_verb(root: &Folder, verb: &[&str], page: &mut String) -> Result<()> {
    let program = ["run", "--release", "--locked", "--quiet", "--"];
    let help = root.output("cargo", &[&program[..], verb, &["--help"]].concat())?;
    write!(page, "\n## percuss {}\n\n```text\n{help}\n```\n", verb.join(" "))?;
    for below in commands(&help) {
        add_verb(root, &[verb, &[below]].concat(), page)?;
    }
    Ok(())
}

/// The commands that a help lists.
fn commands(help: &str) -> Vec<&str> {
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed = lines.take_while(|line| !line.is_empty());
    let names = listed.filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    names.filter(|name| *name != "help").collect()
}

/// The keys of every schema.
pub fn keys(root: &Folder) -> Result<String> {
    let mut page =
        "# Every key\n\nThis page lists the keys of the JSON that percuss writes and reads, \
                    by the schemas that a test holds what is written to.\n"
            .to_owned();
    let files = std::fs::read_dir(root.path(SCHEMAS)).context(SCHEMAS)?;
    let mut names = Vec::new();
    for file in files {
        names.push(file?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    for name in names.iter().filter(|name| name.ends_with(".schema.json")) {
        let path = format!("{SCHEMAS}/{name}");
        let schema: Value = serde_json::from_str(&root.read(&path)?).context(path.clone())?;
        page += &section(name.trim_end_matches(".schema.json"), &path, &schema);
    }
    Ok(page)
}

/// The section of one schema: a table of its keys.
fn section(name: &str, path: &str, schema: &Value) -> String {
    let title = schema["title"].as_str().unwrap_or(name);
    let mut rows = Vec::new();
    add_keys(schema, schema, "", &mut rows);
    let rows: String = rows.iter().map(|row| format!("| {} |\n", row.join(" | "))).collect();
    let head = "| key | type | meaning |\n|---|---|---|";
    format!("\n## {name}\n\n{title}: [the schema](../../{path})\n\n{head}\n{rows}")
}

/// Adds a row for each key below a part of a schema; `[]` stands for the items of an array.
fn add_keys(schema: &Value, part: &Value, path: &str, rows: &mut Vec<[String; 3]>) {
    let part = resolve(schema, part);
    if let Some(items) = part.get("items") {
        add_keys(schema, items, &format!("{path}[]"), rows);
    }
    for choice in ["oneOf", "anyOf", "allOf"].iter().filter_map(|it| part[*it].as_array()) {
        choice.iter().for_each(|it| add_keys(schema, it, path, rows));
    }
    for (key, value) in part["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let meaning = value["description"].as_str();
        let value = resolve(schema, value);
        let meaning = meaning.or(value["description"].as_str()).unwrap_or_default();
        let row = [format!("`{path}`"), kind(value), meaning.replace('|', "\\|")];
        if !rows.contains(&row) {
            rows.push(row);
        }
        add_keys(schema, value, &path, rows);
    }
}

/// A part of a schema, or what it refers to.
fn resolve<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let pointer = part["$ref"].as_str().and_then(|it| it.strip_prefix('#'));
    pointer.and_then(|it| schema.pointer(it)).unwrap_or(part)
}

/// The type of a value in words.
fn kind(value: &Value) -> String {
    if let Some(constant) = value.get("const") {
        return format!("`{constant}`");
    }
    if let Some(names) = value["enum"].as_array() {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        return names.join(", ");
    }
    match &value["type"] {
        Value::String(kind) => kind.clone(),
        Value::Array(kinds) => {
            let kinds: Vec<&str> = kinds.iter().filter_map(Value::as_str).collect();
            kinds.join(" or ")
        }
        _ => String::new(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    #[test]
    fn the_keys_of_every_schema_are_listed() {
        let keys = keys(&Folder::of_the_repository().unwrap()).unwrap();
        for row in [
            "| `percuss` | string | version of the program |",
            "| `rows[].dtime` | string or null | the derivative of the row's time; null where",
        ] {
            assert!(keys.contains(row), "{row}");
        }
    }

    #[test]
    fn the_commands_of_a_help_are_found() {
        let help =
            "About\n\nCommands:\n  one  This\n  two  That\n  help  Print\n\nOptions:\n  -h\n";
        assert_eq!(commands(help), ["one", "two"]);
        assert!(commands("Usage: percuss one\n").is_empty());
    }
}

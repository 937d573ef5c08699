//! `claims.json`, and the table for people.

use crate::reproduce::Claim;
use anyhow::Result;
use comfy_table::Table;
use comfy_table::presets::NOTHING;
use serde::Serialize;
use std::io::Write;

#[derive(Serialize)]
struct ClaimsFile<'a> {
    schema: u32,
    percuss: &'static str,
    claims: &'a [Claim],
}

pub(super) fn write(claims: &[Claim], out: &mut dyn Write) -> Result<()> {
    let file = ClaimsFile { schema: 1, percuss: env!("CARGO_PKG_VERSION"), claims };
    serde_json::to_writer_pretty(&mut *out, &file)?;
    Ok(out.write_all(b"\n")?)
}

pub(super) fn table(claims: &[Claim]) -> String {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(["claim", "verdict", "what we find"]);
    for claim in claims {
        table.add_row([claim.id.as_str(), claim.verdict.word(), claim.computed.as_str()]);
    }
    let lines: Vec<_> = table.lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n") + "\n"
}

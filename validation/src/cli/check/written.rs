//! The texts of a system's file, as they are written. The file has been read and accepted before.

use anyhow::Result;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The texts of a file, in its order.
#[derive(Deserialize)]
pub(super) struct Written {
    #[serde(default, rename = "let")]
    pub(super) lets: BTreeMap<String, String>,
    #[serde(default)]
    pub(super) mode: Vec<WrittenMode>,
}

#[derive(Deserialize)]
pub(super) struct WrittenMode {
    equations: Vec<String>,
    #[serde(default)]
    pub(super) until: Vec<WrittenUntil>,
    #[serde(default)]
    pub(super) watch: Vec<WrittenWatch>,
}

#[derive(Deserialize)]
pub(super) struct WrittenUntil {
    pub(super) guard: String,
    #[serde(default)]
    reset: Vec<String>,
    next: Option<WrittenNext>,
}

/// The successors: a mode alone, or a list.
#[derive(Deserialize)]
#[serde(untagged)]
enum WrittenNext {
    Mode(#[expect(dead_code, reason = "it has no condition")] String),
    Modes(Vec<WrittenSuccessor>),
}

#[derive(Deserialize)]
struct WrittenSuccessor {
    when: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct WrittenWatch {
    pub(super) guard: String,
}

impl Written {
    pub(super) fn read(text: &str) -> Result<Self> {
        Ok(toml::from_str(text)?)
    }
}

impl WrittenMode {
    /// The right side of a state's equation.
    pub(super) fn rate(&self, state: &str) -> Option<&str> {
        right_side(&self.equations, &format!("{state}'"))
    }
}

impl WrittenUntil {
    /// The right side of a state's reset, where it has one.
    pub(super) fn reset(&self, state: &str) -> Option<&str> {
        right_side(&self.reset, state)
    }

    /// The condition of a successor by its number.
    pub(super) fn when(&self, n: usize) -> Option<&str> {
        match self.next.as_ref()? {
            WrittenNext::Mode(_) => None,
            WrittenNext::Modes(list) => list.get(n)?.when.as_deref(),
        }
    }
}

/// The right side of the line whose left side this is, but for spaces.
fn right_side<'a>(lines: &'a [String], left: &str) -> Option<&'a str> {
    let sides = lines.iter().filter_map(|it| it.split_once('='));
    let plain = |side: &str| side.split_whitespace().collect::<String>();
    sides.filter(|(own, _)| plain(own) == left).map(|(_, right)| right.trim()).next()
}

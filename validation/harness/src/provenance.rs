//! The build of this program and the machine that runs it.

use serde::{Deserialize, Serialize};

/// The build information at the beginning of every report and of every file of a bench.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Build {
    /// The format's number.
    pub schema: u32,
    /// The program's version.
    pub percuss: String,
    /// The commit it was built from, where that is known.
    pub commit: Option<String>,
    /// The compiler.
    pub rustc: String,
    /// The processor that runs the program.
    pub cpu: String,
    /// The processor for which the program was compiled.
    #[serde(skip)]
    pub target_cpu: String,
}

impl Build {
    /// A program that was built from this commit (empty where it is not known), by this compiler
    /// and for this processor, here.
    #[must_use]
    pub fn new(commit: &str, rustc: &str, target_cpu: &str) -> Self {
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION").to_owned(),
            commit: Some(commit.to_owned()).filter(|it| !it.is_empty()),
            rustc: rustc.to_owned(),
            cpu: cpu(),
            target_cpu: target_cpu.to_owned(),
        }
    }
}

/// The processor's name where the system tells it, else its architecture.
fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

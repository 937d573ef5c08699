//! Which program this is, and where it runs.

use serde::{Deserialize, Serialize};

/// What every report and every file of a bench begins with.
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
    /// The processor that runs it.
    pub cpu: String,
}

impl Build {
    /// This program, here.
    #[must_use]
    pub fn this() -> Self {
        let commit = env!("PERCUSS_COMMIT");
        Self {
            schema: 1,
            percuss: env!("CARGO_PKG_VERSION").to_owned(),
            commit: (!commit.is_empty()).then(|| commit.to_owned()),
            rustc: env!("PERCUSS_RUSTC").to_owned(),
            cpu: cpu(),
        }
    }
}

/// The processor it was compiled for.
pub const TARGET_CPU: &str = env!("PERCUSS_TARGET_CPU");

/// The processor's name where the system tells it, else its architecture.
fn cpu() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

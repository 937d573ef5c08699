//! Which program this is, and where it runs.

use serde::Serialize;

/// What every report and every file of a bench begins with.
#[derive(Clone, Debug, Serialize)]
pub struct Build {
    /// The format's number.
    pub schema: u32,
    /// The program's version.
    pub percuss: &'static str,
    /// The commit it was built from, where that is known.
    pub commit: Option<&'static str>,
    /// The compiler.
    pub rustc: &'static str,
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
            percuss: env!("CARGO_PKG_VERSION"),
            commit: (!commit.is_empty()).then_some(commit),
            rustc: env!("PERCUSS_RUSTC"),
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

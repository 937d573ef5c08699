//! Which program this is, and where it runs.

use serde::Serialize;

/// What every file of a bench begins with.
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
            cpu: crate::report::cpu(),
        }
    }
}

/// The processor it was compiled for.
pub const TARGET_CPU: &str = env!("PERCUSS_TARGET_CPU");

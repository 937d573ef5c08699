//! The build of this program. Its commit is known here alone, so that a commit compiles nothing
//! else again.

pub use percuss_harness::provenance::Build;

/// The build of this program on this machine.
#[must_use]
pub fn this() -> Build {
    Build::new(env!("PERCUSS_COMMIT"), env!("PERCUSS_RUSTC"), env!("PERCUSS_TARGET_CPU"))
}

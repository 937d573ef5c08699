//! Which program this is. Its commit is known here alone, so that a commit compiles nothing else
//! again.

pub use percuss_harness::provenance::Build;

/// This program, here.
#[must_use]
pub fn this() -> Build {
    Build::of(env!("PERCUSS_COMMIT"), env!("PERCUSS_RUSTC"), env!("PERCUSS_TARGET_CPU"))
}

//! Programs that misbehave in every way that docs/PROTOCOL.md lists. Each costs one row, with a
//! reason that names what happened; the rows before and after it are right, no process is left, and
//! the memory stays small.
//!
//! This program runs itself as the programs that misbehave, so that no other language is needed.

#![cfg_attr(not(target_os = "linux"), allow(dead_code, unused_imports))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a panic is a failure")]

#[cfg(unix)]
mod act;
#[cfg(unix)]
mod alter;
#[cfg(target_os = "linux")]
mod host;
#[cfg(unix)]
mod kinds;
#[cfg(target_os = "linux")]
mod left;
#[cfg(target_os = "linux")]
mod rows;

#[cfg(target_os = "linux")]
fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    match arguments.get(1).map(String::as_str) {
        Some("misbehave") => act::misbehave(&arguments[2], &arguments[3]),
        Some("host") => host::host(&arguments[2], &arguments[3]),
        _ => rows::test(),
    }
}

/// Which processes are left is known on Linux alone.
#[cfg(not(target_os = "linux"))]
fn main() {}

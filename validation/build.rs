//! Tells the program which compiler and which commit it was built from, for its reports.

use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    // Asked of git, because in a worktree they stand elsewhere.
    for name in ["HEAD", "logs/HEAD"] {
        let head = said("git", &["rev-parse", "--git-path", name]);
        if std::path::Path::new(&head).exists() {
            println!("cargo:rerun-if-changed={head}");
        }
    }
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    println!("cargo:rustc-env=PERCUSS_RUSTC={}", said(&rustc, &["--version"]));
    println!("cargo:rustc-env=PERCUSS_COMMIT={}", said("git", &["rev-parse", "HEAD"]));
    println!("cargo:rustc-env=PERCUSS_TARGET_CPU={}", target_cpu());
}

/// The processor that is compiled for: `-C target-cpu` where it is given, else any of its kind.
fn target_cpu() -> String {
    let flags = std::env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default();
    // Of several the last counts.
    let given = flags.rsplit('\x1f').find_map(|it| it.split_once("target-cpu="));
    let any = || std::env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    given.map_or_else(any, |(_, name)| name.to_owned())
}

/// What a command prints, or nothing.
fn said(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output();
    let text = output.ok().filter(|output| output.status.success()).map(|output| output.stdout);
    String::from_utf8_lossy(&text.unwrap_or_default()).trim().to_owned()
}

//! The `percuss` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    percuss_validation::cli::run(std::env::args_os())
}

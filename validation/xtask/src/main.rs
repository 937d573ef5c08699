//! What maintainers of percuss do by one command: `cargo xtask`.

mod book;
mod changelog;
mod edit;
mod interface;
mod process;
mod release;
mod versions;

use anyhow::Result;
use clap::{Parser, Subcommand};
use process::Folder;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "What maintainers of percuss do by one command")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    Release(release::Arguments),
    Interface(interface::Arguments),
    Book(book::Arguments),
}

fn main() -> Result<()> {
    // Cargo names the folder when it runs the program, so it is not compiled into it.
    let root = Folder::of_the_repository()?;
    match Arguments::parse().task {
        Task::Release(arguments) => release::run(&root, &arguments),
        Task::Interface(arguments) => interface::run(&root, &arguments),
        Task::Book(arguments) => book::run(&root, &arguments),
    }
}

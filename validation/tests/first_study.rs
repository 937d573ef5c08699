//! The commands of the two first studies, run in an empty folder: they print what the pages show,
//! make the pictures that they show, and the figures that the text takes from them are there.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness first_study::` writes output and pictures anew.

use crate::support::transcripts;

/// The decimal numbers between backticks in the prose of a page.
fn figures(page: &str) -> Vec<&str> {
    let prose = page.split("```").step_by(2);
    let quoted = prose.flat_map(|part| part.split('`').skip(1).step_by(2));
    quoted.filter(|it| it.contains('.') && it.parse::<f64>().is_ok()).collect()
}

#[test]
fn the_pages_commands_print_and_draw_what_is_shown() {
    let pages = ["FIRST_STUDY_OSCILLATOR.md", "FIRST_STUDY_SYSTEM.md"];
    transcripts::hold_studies(&pages, "first-study", "first_study::");
}

#[test]
fn figures_of_the_text_are_those_of_the_transcripts() {
    let page = transcripts::read(&transcripts::page("FIRST_STUDY_OSCILLATOR.md"));
    let figures = figures(&page);
    assert!(!figures.is_empty());
    for figure in figures {
        let printed = page.split("```").skip(1).step_by(2).any(|block| block.contains(figure));
        assert!(printed, "no command prints {figure}");
    }
    assert_eq!(page.split("```console\n").count() - 1, 5, "five commands");
}

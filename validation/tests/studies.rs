//! The commands of the studies of a rig and of a converter print what the pages show, and make the
//! pictures that they show.
//!
//! `PERCUSS_SPLICE=1 cargo test --test harness studies::` writes output and pictures anew.

use crate::support::transcripts;

#[test]
fn the_pages_commands_print_and_draw_what_is_shown() {
    let pages = ["STUDY_RIG.md", "STUDY_CONVERTER.md"];
    transcripts::hold_studies(&pages, "studies", "studies::");
}

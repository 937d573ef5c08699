//! The paper reproduced: every table and figure computed, every claim settled.
//!
//! An [`Item`] is one piece of work: it settles some claims and leaves pictures with their data.
//! What the paper says stands in `paper.toml` and is only ever compared with; nothing is tuned to
//! agree.

// Modules here name those of the packages below as if they were their own.
use percuss_engines::{case, engine, integrators, number};
use percuss_harness::score;
use percuss_pictures as picture;
use percuss_pictures::arrays;

mod attractors;
mod bifurcations;
mod branches;
mod brute;
mod claim;
mod continued;
mod curve;
mod figure10;
mod figure2;
mod figure5;
mod figure6;
mod figure7;
mod figures8_9;
mod fractal;
mod integrated;
mod item_work;
pub mod paper;
mod progression_rate;
mod table1;

pub use claim::{Claim, ClaimEvidence, ClaimVerdict};
pub use item_work::{Findings, ItemWork, Parts, Size};

use crate::engine::Failure;

/// An item of the reproduction: a figure, a table or a claim.
pub struct Item {
    /// The item's name.
    pub id: &'static str,
    /// The claims that the item settles.
    pub claims: &'static [&'static str],
    /// The number of steps, of about a second each, in which it tells of its progress.
    pub parts: u32,
    /// Names of what it keeps of its work before it is finished.
    pub kept: &'static [&'static str],
    run: fn(&ItemWork<'_>) -> Result<Findings, Failure>,
}

impl Item {
    /// Computes the item's pictures, data and claims.
    ///
    /// # Errors
    /// What could not be computed, and why.
    pub fn run(&self, work: &ItemWork<'_>) -> Result<Findings, Failure> {
        (self.run)(work)
    }

    /// Whether the item, or a claim that it settles, has the given name.
    #[must_use]
    pub fn answers_to(&self, id: &str) -> bool {
        self.id == id || self.claims.contains(&id)
    }
}

/// All items, in the paper's order.
#[must_use]
pub const fn items() -> &'static [Item] {
    &[
        Item { id: "figure-2", claims: &["fig2"], parts: 1, kept: &[], run: figure2::run },
        Item {
            id: "table-1",
            claims: &["table1", "table1-period", "table1-closed", "fig3", "fig4"],
            parts: 1,
            kept: &[],
            run: table1::run,
        },
        Item { id: "figure-5", claims: &["fig5"], parts: 1, kept: &[], run: figure5::run },
        Item {
            id: "figure-6",
            claims: &["fig6a", "fig6b"],
            parts: 3,
            kept: &[],
            run: figure6::run,
        },
        figure7::ITEM,
        Item {
            id: "figures-8-9",
            claims: &["fig8", "fig9"],
            parts: 2,
            kept: &[],
            run: figures8_9::run,
        },
        Item {
            id: "figure-10",
            claims: &["fig10a", "fig10b", "false-12"],
            parts: 3,
            kept: &[],
            run: figure10::run,
        },
        Item {
            id: "bifurcations",
            claims: bifurcations::CLAIMS,
            parts: 7,
            kept: &[],
            run: bifurcations::run,
        },
        Item { id: "branches", claims: &[], parts: 6, kept: &[], run: branches::run },
        Item { id: "progression", claims: &[], parts: 2, kept: &[], run: progression_rate::run },
        Item { id: "boundaries", claims: &["fractal"], parts: 6, kept: &[], run: fractal::run },
    ]
}

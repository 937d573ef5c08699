//! The paper reproduced: every table and figure computed, every claim settled.
//!
//! An [`Item`] is one piece of work: it settles some claims and leaves pictures with their data. What
//! the paper says stands in `paper.toml` and is only ever compared with; nothing is tuned to agree.

mod claim;
mod curve;
mod figure2;
mod figure5;
mod figure6;
pub mod paper;
mod table1;
mod work;

pub use claim::{Claim, Evidence, Verdict};
pub use work::{Findings, Size, Work};

use crate::engine::Failure;

/// One piece of the reproduction.
pub struct Item {
    /// Its name.
    pub id: &'static str,
    /// The claims that it settles.
    pub claims: &'static [&'static str],
    /// In how many steps of about a second it tells of its progress.
    pub parts: u32,
    run: fn(&Work<'_>) -> Result<Findings, Failure>,
}

impl Item {
    /// Computes it.
    ///
    /// # Errors
    /// What could not be computed, and why.
    pub fn run(&self, work: &Work<'_>) -> Result<Findings, Failure> {
        (self.run)(work)
    }

    /// Whether it is called so, or settles a claim that is.
    #[must_use]
    pub fn answers_to(&self, id: &str) -> bool {
        self.id == id || self.claims.contains(&id)
    }
}

/// All items, in the paper's order.
#[must_use]
pub const fn items() -> &'static [Item] {
    &[
        Item { id: "figure-2", claims: &["fig2"], parts: 1, run: figure2::run },
        Item {
            id: "table-1",
            claims: &["table1", "table1-period", "table1-closed", "fig3", "fig4"],
            parts: 1,
            run: table1::run,
        },
        Item { id: "figure-5", claims: &["fig5"], parts: 1, run: figure5::run },
        Item { id: "figure-6", claims: &["fig6a", "fig6b"], parts: 3, run: figure6::run },
    ]
}

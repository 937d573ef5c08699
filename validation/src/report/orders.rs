//! The order at which each engine converges, beside the one it claims.

use super::Row;
use crate::engine::claimed_order;
use crate::score::Spread;

/// An engine's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The engine.
    pub engine: &'static str,
    /// What its authors state.
    pub claimed: u32,
    /// The middle value over the cases.
    pub found: f64,
    /// How many cases have a ladder long enough.
    pub cases: usize,
}

impl Order {
    /// Whether it falls short of what is claimed, by more than a ladder with restarts at every switch
    /// blurs it.
    #[must_use]
    pub fn falls_short(&self) -> bool {
        self.cases >= ENOUGH && self.found < f64::from(self.claimed) - BLUR
    }
}

/// Starting steps, and steps that end at switches, cost about this much of a fitted order.
const BLUR: f64 = 1.5;
/// Ladders on fewer cases than this say nothing of a method.
const ENOUGH: usize = 5;

/// The orders of all engines that claim one and have ladders.
#[must_use]
pub fn orders(rows: &[Row]) -> Vec<Order> {
    let mut engines: Vec<&'static str> = Vec::new();
    for row in rows {
        if !engines.contains(&row.engine) {
            engines.push(row.engine);
        }
    }
    engines.into_iter().filter_map(|engine| of(engine, rows)).collect()
}

fn of(engine: &'static str, rows: &[Row]) -> Option<Order> {
    let claimed = claimed_order(engine)?;
    let mut own: Vec<_> = rows
        .iter()
        .filter(|row| row.engine == engine)
        .filter_map(|row| Some((row.case.as_str(), row.order?)))
        .collect();
    own.dedup_by_key(|it| it.0);
    let cases = own.len();
    let found = Spread::of(own.into_iter().map(|it| it.1).collect()).median;
    (cases > 0).then_some(Order { engine, claimed, found, cases })
}

//! The order at which each engine converges, beside the one it claims.

use super::{EngineEntry, ReportRow};
use crate::score::Spread;

/// An engine's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The engine.
    pub engine: &'static str,
    /// The order that the method's authors state.
    pub claimed: u32,
    /// The median over the cases.
    pub found: f64,
    /// The number of cases with enough settings.
    pub cases: usize,
}

impl Order {
    /// Whether it falls short of what is claimed by more than a right method does by chance.
    #[must_use]
    pub fn falls_short(&self) -> bool {
        self.cases >= MIN_CASES && self.found < f64::from(self.claimed) - MAX_ORDER_DEFICIT
    }
}

/// How far the median of a right method may lie below its order.
///
/// Measured on the settings of `full` over 14 cases, of which 13 or 14 have enough for each method.
/// Medians of adaptive methods are 0 to 4 above the order claimed; of 20,000 draws of ten cases
/// with repetition one in a thousand is up to 0.47 below it (Verner 7(6)). The classical method
/// with fixed steps is 0.28 below. A method that claims one order too much is 0.9 below (ESDIRK
/// 3(4) taken for order 4) and has to be named.
const MAX_ORDER_DEFICIT: f64 = 0.6;
/// The least number of cases with settings enough: with five the same draws reach 2.7 below the
/// order.
const MIN_CASES: usize = 10;

/// The orders of all engines that claim one and have settings enough.
#[must_use]
pub fn orders(engines: &[EngineEntry], rows: &[ReportRow]) -> Vec<Order> {
    engines.iter().filter_map(|engine| order(engine, rows)).collect()
}

fn order(entry: &EngineEntry, rows: &[ReportRow]) -> Option<Order> {
    let (engine, claimed) = (entry.name, entry.order?);
    let mut own: Vec<_> = rows
        .iter()
        .filter(|row| row.engine == engine)
        .filter_map(|row| Some((row.case.as_str(), row.order?)))
        .collect();
    own.dedup_by_key(|it| it.0);
    let cases = own.len();
    let found = Spread::new(own.into_iter().map(|it| it.1).collect()).median;
    (cases > 0).then_some(Order { engine, claimed, found, cases })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn falls_short(claimed: u32, found: f64, cases: usize) -> bool {
        Order { engine: "a method", claimed, found, cases }.falls_short()
    }

    #[test]
    fn a_right_method_does_not_fall_short() {
        // Measured: TR-BDF2, ESDIRK 3(4), the classical method, Verner 6(5), Dormand-Prince 8(5,3).
        for (claimed, found) in [(2, 2.0), (3, 3.1), (4, 3.72), (6, 6.2), (8, 12.0)] {
            assert!(!falls_short(claimed, found, 13), "{claimed} {found}");
        }
    }

    #[test]
    fn a_method_that_is_one_order_short_is_named() {
        // Measured: ESDIRK 3(4) by the 4 of its name, built-in events, the first-order dop853.
        for (claimed, found) in [(4, 3.12), (6, 2.0), (8, 1.0)] {
            assert!(falls_short(claimed, found, 13), "{claimed} {found}");
        }
    }

    #[test]
    fn too_few_ladders_say_nothing() {
        assert!(!falls_short(8, 1.0, MIN_CASES - 1) && falls_short(8, 1.0, MIN_CASES));
    }
}

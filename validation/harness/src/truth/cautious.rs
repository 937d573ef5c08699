//! The f64 search for a first crossing, asked for more than its own rounding room.
//!
//! The truth takes from f64 the order of events: that no crossing lies before the one that it then
//! refines. In f64 that is proved for the phase as it was rounded, with room for the rounding of
//! the guard. Here every certificate must leave a multiple of that room, so that it holds for the
//! phase in 106 bits too; where one does not, the search counts it, and the run is undecided.

use super::forms::TruthMotion;
use percuss::insides::crossing::search::first_crossing;
use percuss::insides::crossing::{
    Corridor, Counters, Crossing, Guarded, Proof, SearchHint, ThresholdEnds,
};
use percuss::insides::flow::steps::Steps;
use percuss::insides::flow::{Flow, Point};
use percuss::insides::series::Series;

/// Rounding an entry to f64 moves the guard by a unit or two of its largest term; its own rounding
/// is within the four that the search sets aside. Sixteen times those four leaves a factor of ten.
const ROUNDING_FACTOR: f64 = 16.0;

struct Cautious<'a, G>(&'a G);

impl<G: Guarded> Cautious<'_, G> {
    fn cautious(mut point: Point<f64>) -> Point<f64> {
        point.guard.largest_term *= ROUNDING_FACTOR;
        point
    }
}

impl<G: Guarded> Flow<f64> for Cautious<'_, G> {
    fn at(&self, elapsed: f64) -> Point<f64> {
        Self::cautious(self.0.at(elapsed))
    }
}

impl<G: Guarded> Guarded for Cautious<'_, G> {
    fn corridor(&self) -> Corridor {
        self.0.corridor()
    }

    fn entry(&self) -> Point<f64> {
        Self::cautious(self.0.entry())
    }

    fn imposed(&self) -> ThresholdEnds {
        self.0.imposed()
    }

    fn hint(&self, steps: &Steps, left: &Point<f64>, limit: f64) -> SearchHint {
        self.0.hint(steps, left, limit)
    }

    fn certify(
        &self,
        steps: &Steps,
        left: &Point<f64>,
        right: &Point<f64>,
        ends: ThresholdEnds,
    ) -> Proof {
        self.0.certify(steps, left, right, ends)
    }

    fn divide(&self, left: &Point<f64>, right: &Point<f64>) -> f64 {
        self.0.divide(left, right)
    }

    fn underflow(&self) -> f64 {
        self.0.underflow()
    }

    fn short_reach(&self) -> f64 {
        self.0.short_reach()
    }

    fn series<const N: usize>(&self, at: &Point<f64>) -> Series<f64, N> {
        self.0.series(at)
    }

    fn continued<const N: usize>(
        &self,
        at: &Point<f64>,
        step: f64,
        series: &Series<f64, N>,
        (value, slope): (f64, f64),
    ) -> Point<f64> {
        self.0.continued(at, step, series, (value, slope))
    }

    fn fastest_rate(&self) -> f64 {
        self.0.fastest_rate()
    }
}

/// How the phase ends before `limit`, and whether every certificate left the room asked for.
pub(super) fn crossing(motion: &TruthMotion<f64>, steps: &Steps, limit: f64) -> (Crossing, bool) {
    let mut counters = Counters::default();
    let crossing = match motion {
        TruthMotion::NoContact(it) => first_crossing(&Cautious(it), steps, limit, &mut counters),
        TruthMotion::Contact(it) => first_crossing(&Cautious(it), steps, limit, &mut counters),
        TruthMotion::Progression(it) => first_crossing(&Cautious(it), steps, limit, &mut counters),
    };
    (crossing, counters.undecidable == 0)
}

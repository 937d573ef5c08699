//! Means over a run in batches of equal length: their standard errors, and whether the run changes
//! on the way.
//!
//! # From how many periods on the errors hold
//!
//! The scatter of batch means gives the error of their mean if batches are longer than the motion
//! remembers. In chaos a batch of one forcing period is not, and errors from 32 of them were 1.4
//! times too small. So a batch has at least [`MIN_BATCH_PERIODS`] periods wherever the run has that
//! many times [`MIN_BATCHES`], and the error has Student's factor for the few batches that are
//! left. Over a thousand runs each of four chaotic motions the exponent then scatters by at most
//! 1.15 times its error from 32 periods on; a shorter run has an error that is of the right order
//! only.
//!
//! # A run that changes
//!
//! Batch means that scatter about one value come in any order. The largest sum of squares between
//! the batches before a place and those after it is compared with that of [`REORDERINGS`] random
//! orders of the same batches: a run changes where none of them reaches it. So a run that does not
//! change is taken for one that does in one of 200, whatever the distribution; in chaos,
//! whose batches remember a little, in up to 3 of 100 at 256 periods and in 1 of 100 at a thousand.

use crate::numeric::two_word::TwoWord;

/// The largest number of batches of a run.
pub const MAX_BATCHES: u64 = 32;
/// Least number of forcing periods of a batch, where a run has enough of them.
pub const MIN_BATCH_PERIODS: u64 = 8;
/// Least number of batches, where a run has as many forcing periods.
pub const MIN_BATCHES: u64 = 4;
/// Least number of batches that can show a change: the orders of fewer are too few.
pub const MIN_BATCHES_FOR_CHANGE: usize = 16;
/// Random orders that a run's own order is compared with.
pub const REORDERINGS: u32 = 199;
/// The largest change of the mean, beside 1 + |mean|, of a motion that has settled.
const CHANGE_TOLERANCE: f64 = 1e-6;

/// Whether the means over the batches of a run scatter about one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stationarity {
    /// The run has too few batches to tell, or is not known to its end.
    Unknown,
    /// No change is seen.
    Stationary,
    /// The means before and after so many forcing periods of the run differ.
    ChangesAfter(u64),
}

/// A run of some forcing periods in batches of equal length, as far as whole periods allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batches {
    periods: u64,
    count: u64,
}

impl Batches {
    /// The batches of a run of `periods` forcing periods, at least one.
    #[must_use]
    pub fn new(periods: u64) -> Self {
        let periods = periods.max(1);
        let count = (periods / MIN_BATCH_PERIODS).clamp(MIN_BATCHES, MAX_BATCHES).min(periods);
        Self { periods, count }
    }

    /// How many batches there are.
    #[must_use]
    pub const fn count(self) -> u64 {
        self.count
    }

    /// The period, counted from the run's beginning, at which batch number `k` (from 1) ends.
    #[must_use]
    pub fn end(self, k: u64) -> u64 {
        (u128::from(k) * u128::from(self.periods) / u128::from(self.count)) as u64
    }

    /// The means per forcing period of what has grown by these sums at the beginning and at the end
    /// of each batch.
    pub(crate) fn means<S>(self, sums: &[S], grown: impl Fn(&S, &S) -> f64) -> Vec<f64> {
        let mean = |(pair, k): (&[S], u64)| {
            let length = self.end(k) - self.end(k - 1);
            grown(&pair[0], &pair[1]) / length as f64
        };
        sums.windows(2).zip(1..).map(mean).collect()
    }

    /// The mean drift per forcing period and its standard error, from the drift at the run's
    /// beginning and after each of its periods.
    pub(super) fn drift(self, strobes: &[TwoWord]) -> [f64; 2] {
        let ends: Vec<TwoWord> =
            (0..=self.count).filter_map(|k| strobes.get(self.end(k) as usize).copied()).collect();
        match ends.as_slice() {
            [first, .., last] if ends.len() as u64 > self.count => {
                let mean = last.minus(*first).value() / self.periods as f64;
                [mean, standard_error(&self.means(&ends, |a, b| b.minus(*a).value()))]
            }
            _ => [f64::NAN; 2],
        }
    }

    /// Whether some quantities, given by their batch means, scatter about one value each; the
    /// latest change where they do not.
    pub(crate) fn stationarity(self, quantities: &[Vec<f64>]) -> Stationarity {
        if (self.count as usize) < MIN_BATCHES_FOR_CHANGE {
            return Stationarity::Unknown;
        }
        let latest = quantities.iter().filter_map(|means| change(means)).max();
        latest.map_or(Stationarity::Stationary, |batches| {
            Stationarity::ChangesAfter(self.end(batches as u64))
        })
    }
}

/// The standard error of the mean of batch means, with Student's factor: that many on either side
/// hold the true mean in 68.3 of 100 runs. NaN for a single batch.
pub(crate) fn standard_error(means: &[f64]) -> f64 {
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let scatter: f64 = means.iter().map(|it| (it - mean).powi(2)).sum();
    student_factor(count - 1.0) * (scatter / (count * (count - 1.0))).sqrt()
}

/// The quantile of Student's distribution at which the normal distribution has 1: its expansion in
/// the reciprocal degrees of freedom, 1.3 % low for one degree and 0.02 % for three.
fn student_factor(freedom: f64) -> f64 {
    let share = 1.0 / freedom;
    1.0 + share * (0.5 + share * (0.25 + share * 0.0625))
}

/// The number of batches before the change of their mean, where there is one.
fn change(means: &[f64]) -> Option<usize> {
    let (batches, between) = largest_split(means)?;
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    if between.sqrt() <= CHANGE_TOLERANCE * (1.0 + mean.abs()) {
        return None;
    }
    let mut order = means.to_vec();
    let mut chance = Chance(0);
    let reached = (0..REORDERINGS).any(|_| {
        chance.shuffle(&mut order);
        // The same parts in another order are as far apart, but for roundings.
        largest_split(&order).is_some_and(|(_, other)| other >= (1.0 - 1e-9) * between)
    });
    (!reached).then_some(batches)
}

/// The split of a series between whose parts the sum of squares is largest: the length of the
/// first part, and that sum.
fn largest_split(means: &[f64]) -> Option<(usize, f64)> {
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let mut sum = 0.0;
    let between = |(k, value): (usize, &f64)| {
        sum += value - mean;
        let before = (k + 1) as f64;
        (k + 1, sum * sum * count / (before * (count - before)))
    };
    let splits = means.iter().take(means.len().saturating_sub(1)).enumerate().map(between);
    splits.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Random numbers that are the same in every run: SplitMix64.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    fn shuffle(&mut self, values: &mut [f64]) {
        for last in (1..values.len()).rev() {
            let place = self.next() % (last as u64 + 1);
            values.swap(last, place as usize);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Chance {
        /// A normal deviate of unit variance: the sum of twelve uniform ones.
        fn normal(&mut self) -> f64 {
            let uniform = |bits: u64| (bits >> 11) as f64 * 0.5_f64.powi(53);
            (0..12).map(|_| uniform(self.next())).sum::<f64>() - 6.0
        }

        fn normals(&mut self, count: usize) -> Vec<f64> {
            (0..count).map(|_| self.normal()).collect()
        }
    }

    #[test]
    fn batches_are_whole_periods_and_none_is_left_out() {
        for periods in [1, 2, 3, 7, 33, 100, 255, 256, 1000, 1_000_000_000] {
            let batches = Batches::new(periods);
            let ends: Vec<u64> = (0..=batches.count()).map(|k| batches.end(k)).collect();
            assert_eq!((ends[0], ends[ends.len() - 1]), (0, periods));
            assert!(ends.windows(2).all(|pair| pair[0] < pair[1]), "{periods}: {ends:?}");
        }
        let counts = [1, 3, 33, 100, 256, 1000].map(|periods| Batches::new(periods).count());
        assert_eq!(counts, [1, 3, 4, 12, 32, 32]);
    }

    /// The quantiles for one to 31 degrees of freedom, by tables.
    #[test]
    fn students_factor_is_the_quantile() {
        for (freedom, quantile) in [(1.0, 1.8373), (2.0, 1.3213), (3.0, 1.1969), (31.0, 1.0164)] {
            let apart = (student_factor(freedom) / quantile - 1.0).abs();
            assert!(apart < 0.014 / (freedom * freedom), "{freedom}: {apart}");
        }
    }

    /// The interval of one standard error holds the mean as often as it should, however few the
    /// batches are: of 4000 draws 68.3 %, within four standard errors of that share.
    #[test]
    fn errors_of_few_batches_hold_as_often_as_those_of_many() {
        let mut chance = Chance(1);
        for count in [3, 4, 12, 32] {
            let holds = (0..4000).filter(|_| {
                let draws = chance.normals(count);
                let mean = draws.iter().sum::<f64>() / count as f64;
                mean.abs() <= standard_error(&draws)
            });
            let share = holds.count() as f64 / 4000.0;
            assert!((share - 0.683).abs() <= 4.0 * 0.0074, "{count}: {share}");
        }
    }

    /// How often the batches of 1000 runs with a step of this many scatters at this share of the
    /// run are told.
    fn detections(chance: &mut Chance, step: f64, share: f64) -> f64 {
        let count = MAX_BATCHES as usize;
        let detected = (0..1000).filter(|_| {
            let mut draws = chance.normals(count);
            let from = (share * count as f64) as usize;
            draws[from..].iter_mut().for_each(|it| *it += step);
            change(&draws).is_some()
        });
        detected.count() as f64 / 1000.0
    }

    /// The power that docs/COMMAND_LINE.md states: a step of 2.5 scatters of the batches at half of
    /// the run is told in 19 of 20 runs, and one of 3.5 at an eighth of it in nine of ten; where
    /// there is none, one run of 200 is told (0.5 %, with four of its standard errors 1.4 %).
    #[test]
    fn a_change_is_told_with_the_stated_power() {
        let mut chance = Chance(2);
        let [none, half, eighth] = [(0.0, 0.5), (2.5, 0.5), (3.5, 0.125)]
            .map(|(step, at)| detections(&mut chance, step, at));
        println!("none {none}, half {half}, eighth {eighth}");
        assert!(none <= 0.014 && half >= 0.95 && eighth >= 0.9, "{none} {half} {eighth}");
    }

    #[test]
    fn the_change_is_where_it_was_made() {
        let step = |k: usize| if k < 11 { 1.0 } else { 0.0 } + 1e-3 * (k % 3) as f64;
        let means: Vec<f64> = (0..32).map(step).collect();
        assert_eq!(change(&means), Some(11));
        let batches = Batches::new(3200);
        assert_eq!(batches.stationarity(&[means]), Stationarity::ChangesAfter(1100));
        assert_eq!(Batches::new(100).stationarity(&[]), Stationarity::Unknown);
    }

    /// A motion on its orbit has batch means that differ by roundings, in any order.
    #[test]
    fn roundings_are_no_change() {
        let means: Vec<f64> = (0..32).map(|k| 0.25 + 1e-15 * f64::from(k)).collect();
        assert_eq!(change(&means), None);
        assert_eq!(change(&[0.0; 32]), None);
    }
}

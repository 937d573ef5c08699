//! Limits measured on runs of the exact solver, without an extrapolated tail.
//!
//! `cargo maintain calibrate` makes `attractors.toml` again. With m and s the mean
//! and standard deviation over the runs against the reference, a limit is |m| + z s of the
//! difference itself for exponent and drift, which are means over many periods and so nearly
//! normal, and exp(m + z s) of the logarithms of the other distances, which are positive. m and s
//! only make the distances comparable; the level is in z, the same for all distances of a case: the
//! largest that any distance of any run takes. One more run, exchangeable with the N that were
//! made, exceeds a largest value of N with a probability of 1/(N + 1), whatever the tails look
//! like. That is the level of the whole family of distances of a row, and N = [`NULL_RUNS`] runs
//! measure no lower one.

use super::distance::{Distances, STATISTICS, distances};
use super::limits::{Calibrated, ComparisonPlan};
use super::runs::{RunKind, exact_section, reference};
use super::section::RunSection;
use crate::case::OscillatorCase;
use crate::engine::Failure;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Runs from which the limits of a case are taken.
pub const NULL_RUNS: u32 = 20_000;

/// The least scale of a distance that is a length. Where reference runs agree exactly, as where
/// nothing drifts, an integrator need not: a length below a tenth of the error up to which runs are
/// scored does not count.
const MIN_LENGTH_SCALE: f64 = 1e-4;
/// The least scale of a distance that is a share of a run, in periods, for the same reason.
const MIN_SHARE_PERIODS: f64 = 5.0;

/// Limits, and how they were found.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The limits.
    pub calibrated: Calibrated,
    /// The largest standardized distance of any run.
    pub z: f64,
    /// The name of the farthest distance.
    pub farthest: &'static str,
}

/// Measures the limits of a case on so many runs.
///
/// # Errors
/// The solver's reason where it refuses a run.
pub fn calibrate(
    (name, case): (&str, &OscillatorCase),
    plan: ComparisonPlan,
    runs: u32,
) -> Result<Calibration, Failure> {
    let reference = reference(case, &plan)?;
    let null = |number| {
        let run = exact_section(case, *case.parameters(), &plan, RunKind::Calibration, number)?;
        Ok(Null::new(&run, &reference))
    };
    let nulls: Result<Vec<Null>, Failure> = (0..runs).into_par_iter().map(null).collect();
    let nulls = nulls?;
    let scales = STATISTICS.map(|name| DistanceScale::new(name, &plan, &nulls));
    let all = nulls
        .iter()
        .flat_map(|null| scales.iter().map(|it| (it.deviations_above_mean(null), it.name)));
    let farthest = all.fold((0.0, ""), |most, it| if it.0 > most.0 { it } else { most });
    let limits = scales.iter().map(|scale| (scale.name.to_owned(), scale.limit(farthest.0)));
    let calibrated = Calibrated { case: name.to_owned(), plan, limits: limits.collect() };
    Ok(Calibration { calibrated, z: farthest.0, farthest: farthest.1 })
}

/// The distances of one run from the reference.
struct Null {
    distances: Distances,
    /// The two differences that have a sign, with it.
    signed: BTreeMap<&'static str, f64>,
}

impl Null {
    fn new(section: &RunSection, reference: &RunSection) -> Self {
        let signed = BTreeMap::from([
            ("lyapunov", section.lyapunov - reference.lyapunov),
            ("drift", section.drift - reference.drift),
        ]);
        Self { distances: distances(section, reference), signed }
    }

    /// The value whose mean and deviation make a scale.
    fn value(&self, name: &str) -> f64 {
        self.signed.get(name).copied().unwrap_or_else(|| self.distances[name].ln())
    }
}

/// The scale that makes a distance comparable with the others.
struct DistanceScale {
    name: &'static str,
    is_signed: bool,
    mean: f64,
    deviation: f64,
    floor: f64,
}

impl DistanceScale {
    fn new(name: &'static str, plan: &ComparisonPlan, nulls: &[Null]) -> Self {
        let is_signed = nulls.iter().any(|null| null.signed.contains_key(name));
        let is_share = name.starts_with("ks") || name.ends_with("share") || name == "phase_words";
        let floor =
            if is_share { MIN_SHARE_PERIODS / f64::from(plan.periods) } else { MIN_LENGTH_SCALE };
        let (mean, deviation) = moments(nulls.iter().map(|null| null.value(name)));
        Self { name, is_signed, mean, deviation, floor }
    }

    /// The number of standard deviations by which a run is above the mean; zero below the floor.
    fn deviations_above_mean(&self, null: &Null) -> f64 {
        if null.distances[self.name] <= self.floor {
            return 0.0;
        }
        let value = null.value(self.name);
        if self.is_signed {
            (value.abs() - self.mean.abs()) / self.deviation
        } else {
            (value - self.mean) / self.deviation
        }
    }

    fn limit(&self, z: f64) -> f64 {
        let limit = if self.is_signed {
            self.mean.abs() + z * self.deviation
        } else {
            (self.mean + z * self.deviation).exp()
        };
        // The logarithm of an exact zero has no mean: then the floor is the limit.
        limit.max(self.floor)
    }
}

fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let variance = values.map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAN: ComparisonPlan =
        ComparisonPlan { transient: 0, periods: 1_000_000, reference_periods: 1 };

    fn nulls(name: &'static str, values: &[f64], signed: bool) -> Vec<Null> {
        let null = |value: &f64| Null {
            distances: Distances::from([(name, value.abs())]),
            signed: if signed { BTreeMap::from([(name, *value)]) } else { BTreeMap::new() },
        };
        values.iter().map(null).collect()
    }

    #[test]
    fn drift_and_exponent_differ_with_their_signs() {
        let section = |drift: f64, lyapunov: f64| RunSection {
            points: vec![[0.0; 3]; 3],
            phase_sequences: BTreeMap::new(),
            drift,
            lyapunov,
            map_errors: vec![0.0; 3],
            sorted: std::array::from_fn(|_| vec![0.0, 1.0]),
        };
        let null = Null::new(&section(0.25, 0.5), &section(0.75, 0.125));
        assert_eq!((null.value("drift"), null.value("lyapunov")), (-0.5, 0.375));
    }

    /// The logarithms 1, 2 and 3 have the mean 2 and the deviation 1; the differences 0.1, 0.2 and
    /// 0.3 have 0.2 and 0.1.
    #[test]
    fn a_run_so_many_deviations_off_has_the_limit_of_so_many() {
        let logarithms = [1.0_f64, 2.0, 3.0].map(f64::exp);
        let scale =
            DistanceScale::new("wasserstein_p", &PLAN, &nulls("wasserstein_p", &logarithms, false));
        for z in [-1.5, 0.5, 4.0_f64] {
            let value = (2.0 + z).exp();
            let null = &nulls("wasserstein_p", &[value], false)[0];
            approx::assert_relative_eq!(scale.deviations_above_mean(null), z, max_relative = 1e-12);
            approx::assert_relative_eq!(scale.limit(z), value, max_relative = 1e-12);
        }
        for sign in [1.0, -1.0] {
            let differences = [0.1, 0.2, 0.3].map(|value| sign * value);
            let scale = DistanceScale::new("drift", &PLAN, &nulls("drift", &differences, true));
            for z in [0.5, 3.0] {
                let value = 0.2 + 0.1 * z;
                let null = &nulls("drift", &[sign * value], true)[0];
                approx::assert_relative_eq!(
                    scale.deviations_above_mean(null),
                    z,
                    max_relative = 1e-12
                );
                approx::assert_relative_eq!(scale.limit(z), value, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn the_floor_forgives_what_is_below_it() {
        let values = [1e-3_f64, 2e-3, 3e-3];
        let coarse = ComparisonPlan { periods: 100, ..PLAN };
        let scale = DistanceScale::new("ks_p", &coarse, &nulls("ks_p", &values, false));
        assert_eq!(scale.floor, MIN_SHARE_PERIODS / 100.0);
        assert_eq!(scale.deviations_above_mean(&nulls("ks_p", &[scale.floor], false)[0]), 0.0);
        assert_eq!(scale.limit(0.0), scale.floor);
    }
}

//! A truth of any run, in the shape of the tables.

use super::replay::{Beginning, Replay, Undecided};
use super::{DoubleDouble, Row, Truth};
use percuss::{Entry, Instant, Parameters};

/// The most switches that a replayed run may have.
const SWITCHES: usize = 1_000_000;

impl Truth {
    /// The run from `entry` to `horizon`, and its state at `samples` instants, `k / per_period`
    /// forcing periods after the start.
    ///
    /// # Errors
    /// [`Undecided`] where 106 bits do not tell what comes next.
    pub fn replayed(
        parameters: &Parameters,
        entry: &Entry,
        horizon: Instant,
        (samples, per_period): (usize, u32),
    ) -> Result<Self, Undecided> {
        let omega = parameters.omega;
        let begin = entry.instant;
        let row = |phase, instant: &Instant, values: [DoubleDouble; 4]| Row {
            phase,
            elapsed: instant.since(&begin, omega),
            state: values.map(Into::into),
        };
        let opening = |it: &Beginning| row(Some(it.phase()), &it.instant, it.values());
        let mut rows: Vec<Row> = Vec::new();
        let mut sampled = Vec::with_capacity(samples);
        for passage in Replay::new(parameters, entry, horizon) {
            let passage = passage?;
            rows.push(opening(&passage.begin));
            while sampled.len() < samples {
                let instant = begin.after_periods(sampled.len() as u64, u64::from(per_period));
                if passage.ends_by(&instant) {
                    break;
                }
                sampled.push(row(Some(passage.begin.phase()), &instant, passage.at(&instant)));
            }
            if passage.next.is_none() {
                let end = row(None, &horizon, passage.at(&horizon));
                let start = rows.remove(0);
                return Ok(Self { start, switches: rows, end, samples: sampled });
            }
            if rows.len() > SWITCHES {
                break;
            }
        }
        Err(Undecided { what: "the end of so many switches", elapsed: 0.0 })
    }
}

//! A walk along the ends of steps, for methods whose states inside a step are dear.

use crate::engine::cubic::Point;
use crate::engine::field::Equations;
use crate::engine::joining::{Ended, Moment};
use crate::engine::location::Search;
use crate::engine::meter::Failure;
use crate::engine::sampler::Sampler;

/// Looks at the guards at each step's end, and inside a step only where they show a crossing or a
/// peak. `inside` gives the state at a time between two ends.
pub(super) fn walk<E: Equations>(
    search: &Search<'_, E>,
    from: &Moment,
    points: impl IntoIterator<Item = Point>,
    sampler: &mut Sampler,
    mut inside: impl FnMut(&Point, &Point, f64) -> Result<[f64; 4], Failure>,
) -> Result<Ended, Failure> {
    let mut left = (from.t, from.state);
    let mut left_look = search.look(left.0, &left.1);
    for right in points {
        let look = search.look(right.0, &right.1);
        let mut state_at = |t: f64| match t {
            t if t >= right.0 => Ok(right.1),
            t => inside(&left, &right, t),
        };
        let found = search.between(&left_look, &look, &mut state_at)?;
        sampler.take(found.map_or(right.0, |it| it.t), &mut state_at)?;
        if let Some(it) = found {
            return Ok(Ended::Switch { t: it.t, guard: it.guard, state: state_at(it.t)? });
        }
        (left, left_look) = (right, look);
    }
    Ok(Ended::Inside { t: left.0, state: left.1 })
}

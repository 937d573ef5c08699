//! The derivatives of events by names, as a run in one arithmetic has them.

use super::request::Request;
use crate::affine::gradient::derivative as engine;
use crate::affine::gradient::derivative::{NoGradient, Side};
use crate::affine::gradient::walk::Walk;
use crate::affine::model::error::SystemError;
use crate::affine::model::tangent::Tangent;
use crate::affine::run::Run;
use crate::affine::solver::Solver;
use crate::affine::solver::event::Event;
use crate::numeric::number::{Bound, Number};
use std::sync::Arc;

/// The derivatives of an event's time and state by a name.
///
/// They are total derivatives: that of the state is the state just after the event, as it stands at
/// the event's time, which moves with the name too.
///
/// ```
/// use percuss::{System, gallery};
///
/// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
/// let solver = ball.solver::<f64>()?;
/// let impact = solver.run().gradients(["g"])?.events(1)?.next().expect("an impact");
/// // From the height 1 with g = 1: the time is the root of 2/g, and the speed e times that of 2 g.
/// let by_gravity = impact.gradient("g").expect("it was asked for").expect("it has one");
/// let root = 2_f64.sqrt();
/// assert!((by_gravity.time() + root / 2.0).abs() < 1e-15);
/// assert!((by_gravity.state()[1] - root / 4.0).abs() < 1e-15);
/// # Ok::<(), percuss::SystemError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gradient<V> {
    time: V,
    state: Vec<V>,
}

impl<V> Gradient<V> {
    /// The derivative of the event's time.
    #[must_use]
    pub fn time(&self) -> &V {
        &self.time
    }

    /// The derivatives of the states, in the order of [`System::states`](crate::System::states).
    #[must_use]
    pub fn state(&self) -> &[V] {
        &self.state
    }
}

/// The derivatives of an event by a name.
#[derive(Clone, Debug)]
pub(super) struct ByName<V> {
    pub name: String,
    /// Those of both sides of the name's value, or the reason why there are none.
    pub both: Found<V>,
    /// Those below and above it, where they differ.
    pub sides: Option<Box<[Found<V>; 2]>>,
}

/// Derivatives, or the reason why there are none.
type Found<V> = Result<Gradient<V>, NoGradient>;

/// The derivatives of an event in one arithmetic.
type Derivatives<T> = Result<engine::Gradient<T>, NoGradient>;

/// The derivatives along a run by a name.
struct OneName<'a, T: Number> {
    name: String,
    walk: Walk<'a, T>,
    /// The walks below and above the name's value, once the first of them has ended.
    sides: Vec<Walk<'a, T>>,
    start: Derivatives<T>,
    /// The derivatives of the last event: of both sides, then below and above.
    last: Vec<Derivatives<T>>,
    /// The largest size of each derivative so far.
    sizes: Vec<T::Bound>,
}

/// The derivatives along a run by each name that was asked for.
pub(super) struct Walks<'a, T: Number>(Vec<OneName<'a, T>>);

impl<'a, T: Number> Walks<'a, T> {
    pub fn begin(
        solver: &'a Solver<T>,
        request: &Request,
        start: &Event<T>,
    ) -> Result<Self, SystemError> {
        let cells = 1 + solver.system().states.len();
        let one = |tangent: &Arc<Tangent>| {
            let name = tangent.name.to_string();
            let walk = Walk::new(solver, tangent, &request.start, start);
            let item = || format!("a derivative of {} by {name}", solver.system().name);
            let walk = walk.ok_or_else(|| SystemError::Undecidable { item: item() })?;
            let start = Ok(walk.start());
            let (last, sizes) = (vec![start.clone()], vec![T::Bound::ZERO; cells]);
            Ok(OneName { name, walk, sides: Vec::new(), start, last, sizes })
        };
        Ok(Self(request.tangents.iter().map(one).collect::<Result<_, _>>()?))
    }

    /// Passes the event that a run has just returned.
    pub fn step(&mut self, event: &Event<T>, run: &Run<'_, T>) {
        self.0.iter_mut().for_each(|it| it.step(event, run));
    }

    /// The derivatives of the start, as numbers of another kind.
    pub fn of_start<V>(&self, number: impl Fn(&(T, T::Bound)) -> V) -> Vec<ByName<V>> {
        let one = |it: &OneName<'_, T>| it.by_name(std::slice::from_ref(&it.start), &number);
        self.0.iter().map(one).collect()
    }

    /// The derivatives of the last event, as numbers of another kind.
    pub fn of_last<V>(&self, number: impl Fn(&(T, T::Bound)) -> V) -> Vec<ByName<V>> {
        self.0.iter().map(|it| it.by_name(&it.last, &number)).collect()
    }

    /// Adds the sizes of the last event's derivatives, and says whether more bits may give it some,
    /// or the digits that are wanted.
    pub fn need_more_bits(&mut self, digits: usize) -> bool {
        let mut need = false;
        for it in &mut self.0 {
            need |= it.needs_more_bits(digits);
        }
        need
    }
}

impl<T: Number> OneName<'_, T> {
    fn step(&mut self, event: &Event<T>, run: &Run<'_, T>) {
        if self.sides.is_empty() && self.walk.is_one_sided() {
            self.sides = [Side::Below, Side::Above].map(|side| self.walk.on_side(side)).into();
        }
        self.last.clear();
        self.last.push(self.walk.step(event, run));
        self.last.extend(self.sides.iter_mut().map(|it| it.step(event, run)));
    }

    fn needs_more_bits(&mut self, digits: usize) -> bool {
        let mut needs = false;
        for it in &self.last {
            needs |= match it {
                Ok(gradient) => have_too_few_digits(gradient, &mut self.sizes, digits),
                Err(reason) => *reason == NoGradient::Undecided,
            };
        }
        needs
    }

    fn by_name<V>(
        &self,
        all: &[Derivatives<T>],
        number: &impl Fn(&(T, T::Bound)) -> V,
    ) -> ByName<V> {
        let gradient = |it: &Derivatives<T>| {
            it.as_ref().map_err(|error| *error).map(|it| Gradient {
                time: number(&it.time),
                state: it.state.iter().map(number).collect(),
            })
        };
        let sides = match all {
            [_, below, above] => Some(Box::new([gradient(below), gradient(above)])),
            _ => None,
        };
        let both = all.first().map_or(Err(NoGradient::Unknown), gradient);
        ByName { name: self.name.clone(), both, sides }
    }
}

/// Whether a derivative has fewer digits than are wanted. One that may be zero has enough of them
/// if it is known that well beside the largest that it has had, or else beside the largest of all
/// by the name: more bits would not make it another one than zero.
fn have_too_few_digits<T: Number>(
    gradient: &engine::Gradient<T>,
    sizes: &mut [T::Bound],
    digits: usize,
) -> bool {
    let share = T::Bound::from_f64(0.5 * 10_f64.powi(-(digits as i32)));
    let cells = || std::iter::once(&gradient.time).chain(&gradient.state);
    for ((value, error), size) in cells().zip(&mut *sizes) {
        let value = value.bound().abs();
        // A value that may be zero is rounding alone.
        *size = if value > *error { size.max(value) } else { *size };
    }
    let largest = sizes.iter().copied().fold(T::Bound::ZERO, Bound::max);
    let largest = if largest > T::Bound::ZERO { largest } else { T::Bound::from_f64(1.0) };
    cells().zip(&*sizes).any(|((value, error), size)| {
        let value = value.bound().abs();
        let of_zero = if *size > T::Bound::ZERO { *size } else { largest };
        let beside = if value > *error { value } else { of_zero };
        *error > beside * share
    })
}

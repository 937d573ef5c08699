//! The derivatives of a run's events, one event after the other.

use super::ball::{Ball, Jet, applied, dot};
use super::exponential::exponential;
use super::first_order::{FirstOrder, with_derivative};
use crate::affine::arithmetic::clock::Time;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{Mode, Row, StartPoint, System};
use crate::affine::model::tangent::Tangent;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Ending, Event, What};
use crate::affine::zeros::space::ZeroSpace;
use crate::numeric::number::{Bound, Number};
use std::fmt;

/// The derivatives of an event: each is within an error of its value, in a run that follows its
/// errors.
#[derive(Clone, Debug)]
pub struct Gradient<T: Number> {
    /// The derivative of the event's time, with its error.
    pub time: (T, T::Bound),
    /// The derivatives of the states just after the event, at its moving time, with their errors.
    pub state: Vec<(T, T::Bound)>,
}

/// The reason why an event, and each that follows, has no derivative, or none that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoGradient {
    /// A guard, or a condition of a successor, is zero without being so to first order: the
    /// derivatives on the two sides differ.
    OneSided,
    /// The bits do not tell a value from zero that has to differ from it: the rate of a guard that
    /// fires, or the value of another.
    Undecided,
    /// The run ended, or its numbers are too large.
    Unknown,
}

impl fmt::Display for NoGradient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::OneSided => "a zero there does not hold to first order",
            Self::Undecided => "a graze, a tie or too few digits",
            Self::Unknown => "the motion is not known",
        })
    }
}

/// A mode's coefficients with their derivatives.
struct ModeJets<T: Number> {
    matrix: Vec<Vec<Jet<T>>>,
    guards: Vec<Vec<Jet<T>>>,
    resets: Vec<Vec<Vec<Jet<T>>>>,
}

/// The derivatives along a run.
pub struct Walk<'a, T: Number> {
    solver: &'a Solver<T>,
    tangent: &'a Tangent,
    modes: Vec<ModeJets<T>>,
    zeros: FirstOrder,
    /// The mode, time and state of the last event, with derivatives.
    mode: usize,
    time: Time<T>,
    time_error: T::Bound,
    time_rate: Ball<T>,
    state: Vec<Jet<T>>,
    /// The guards of `until` that fire at the entry, as bits.
    fires: u64,
    refused: Option<NoGradient>,
}

impl<'a, T: Number> Walk<'a, T> {
    /// The derivatives of a run of a solver from its system's own start, which is this event; none
    /// for a system without one, or one that runs back in time.
    #[must_use]
    pub fn new(solver: &'a Solver<T>, tangent: &'a Tangent, start: &Event<T>) -> Option<Self> {
        let system = solver.system();
        let (point, rates) = (system.start.as_ref()?, tangent.start.as_ref()?);
        if solver.is_backward() || point.mode != start.mode {
            return None;
        }
        let turn = turn(system, tangent, point, rates);
        let rows = start_rows(system, point);
        let slopes = start_slopes(&rows, rates, &turn);
        let is_at_zero = system.is_at_zero_angle(point);
        let [z, s] = [&rows, &slopes].map(|it| independent(it, is_at_zero));
        let zeros =
            FirstOrder::at_start(&system.modes, &tangent.modes, start.mode, [&s[..], &z[..]])?;
        let modes = system.modes.iter().zip(&tangent.modes).map(ModeJets::of).collect();
        let mut own = Self {
            solver,
            tangent,
            modes,
            zeros,
            mode: start.mode,
            time: start.time,
            time_error: T::Bound::ZERO,
            time_rate: Ball::of(&rates.time),
            state: Vec::new(),
            fires: 0,
            refused: None,
        };
        let values = own.values(start);
        let angle = own.angle(start);
        let slope = |row: &[Rational; 3]| {
            let terms = row.iter().zip(&angle).map(|(a, b)| Ball::of(a).times(*b));
            terms.fold(Ball::zero(), Ball::plus)
        };
        own.state = values
            .iter()
            .zip(&slopes)
            .map(|(value, row)| Jet { value: *value, rate: slope(row) })
            .collect();
        own.refused = own.check_entry().err();
        Some(own)
    }

    /// The derivatives of the start.
    #[must_use]
    pub fn start(&self) -> Gradient<T> {
        self.gradient(self.time_rate)
    }

    /// The derivatives of the next event of the run.
    ///
    /// # Errors
    /// An event that has none, and each after it.
    pub fn step(&mut self, event: &Event<T>) -> Result<Gradient<T>, NoGradient> {
        let gradient = match self.refused {
            Some(refused) => Err(refused),
            None => self.follow(event),
        };
        self.refused = gradient.as_ref().err().copied();
        gradient
    }

    fn follow(&mut self, event: &Event<T>) -> Result<Gradient<T>, NoGradient> {
        match event.what {
            What::Until(mode, until) => self.until(event, mode, until)?,
            What::Watch(mode, watch) => {
                let guard = self.solver.system().modes[mode].until.len() + watch;
                self.cross(event, guard)?;
                self.replace_values(event);
            }
            What::End(Ending::Horizon) => self.given_time(event)?,
            _ => return Err(NoGradient::Unknown),
        }
        Ok(self.gradient(self.time_rate))
    }

    fn gradient(&self, time_rate: Ball<T>) -> Gradient<T> {
        let pair = |it: Ball<T>| (it.middle, it.radius);
        let states = self.solver.system().states.len();
        let state = self.state[..states].iter().map(|it| pair(it.rate)).collect();
        Gradient { time: pair(time_rate), state }
    }

    /// Ends the mode by an `until`.
    fn until(&mut self, event: &Event<T>, mode: usize, until: usize) -> Result<(), NoGradient> {
        let at_entry = self.fires >> until & 1 == 1;
        let zeros = if at_entry {
            self.zeros.with_guard(self.guard(mode, until), true).ok_or(NoGradient::Unknown)?
        } else {
            self.cross(event, until)?
        };
        self.state = applied(&self.modes[mode].resets[until], &self.state);
        self.zeros.enter(&zeros, [mode, until], event.mode);
        self.mode = event.mode;
        self.replace_values(event);
        self.check_successor(mode, until)?;
        self.check_entry()
    }

    /// Moves to the instant at which a guard crosses.
    fn cross(&mut self, event: &Event<T>, guard: usize) -> Result<ZeroSpace, NoGradient> {
        self.move_to(event)?;
        let rate = applied(&self.modes[self.mode].matrix, &self.state);
        let own = &self.modes[self.mode].guards[guard];
        let shift = dot(own, &self.state).rate.negative();
        let later = shift.over(dot(own, &rate).value).ok_or(NoGradient::Undecided)?;
        self.shift(&rate, later);
        self.time_rate = self.time_rate.plus(later);
        let zeros = self.zeros.with_guard(self.guard(self.mode, guard), false);
        let zeros = zeros.ok_or(NoGradient::Unknown)?;
        self.check_others(guard, &zeros)?;
        Ok(zeros)
    }

    /// Moves to the horizon, which does not move with the name.
    fn given_time(&mut self, event: &Event<T>) -> Result<(), NoGradient> {
        let elapsed = self.elapsed(event);
        let at_start = elapsed.middle == T::zero() && elapsed.radius <= T::Bound::LAST_WORD;
        if elapsed.sign().is_none() && !at_start {
            return Err(NoGradient::Undecided);
        }
        self.move_to(event)?;
        let rate = applied(&self.modes[self.mode].matrix, &self.state);
        self.shift(&rate, self.time_rate.negative());
        self.time_rate = Ball::zero();
        Ok(())
    }

    /// Adds to the derivatives what the motion makes in a time that moves with the name.
    fn shift(&mut self, rate: &[Jet<T>], later: Ball<T>) {
        for (entry, rate) in self.state.iter_mut().zip(rate) {
            entry.rate = entry.rate.plus(rate.value.times(later));
        }
    }

    fn elapsed(&self, event: &Event<T>) -> Ball<T> {
        let Time { high, low } = event.time.since(&self.time);
        let error = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        Ball::exact(high).plus(Ball::within(low, self.time_error + error))
    }

    /// Moves values and derivatives by the time to an event, as if that were fixed.
    fn move_to(&mut self, event: &Event<T>) -> Result<(), NoGradient> {
        let elapsed = self.elapsed(event);
        let matrix = &self.modes[self.mode].matrix;
        let flow = exponential(matrix, elapsed).ok_or(NoGradient::Unknown)?;
        self.state = applied(&flow, &self.state);
        self.time = event.time;
        self.time_error = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        Ok(())
    }

    /// Takes the values of an event, whose errors are smaller than those of one segment's motion.
    fn replace_values(&mut self, event: &Event<T>) {
        let values = self.values(event);
        for (entry, value) in self.state.iter_mut().zip(values) {
            entry.value = value;
        }
    }

    /// The entries of z at an event.
    fn values(&self, event: &Event<T>) -> Vec<Ball<T>> {
        let error = |n: usize| event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.state[n]);
        let states = event.state.iter().enumerate();
        let mut all: Vec<_> = states.map(|(n, it)| Ball::within(*it, error(n))).collect();
        let [cos, sin, one] = self.angle(event);
        if self.solver.system().forcing.is_some() {
            all.extend([cos, sin]);
        }
        all.push(one);
        all
    }

    /// Cosine and sine of the forcing angle at an event, and 1.
    fn angle(&self, event: &Event<T>) -> [Ball<T>; 3] {
        let one = Ball::exact(T::one());
        let Some(forcing) = &self.solver.system().forcing else {
            return [one, Ball::zero(), one];
        };
        let (sin, cos) = self.solver.sin_cos(&event.time);
        let moved = event.errors.as_ref().map_or(T::Bound::ZERO, |it| it.time);
        let states = self.solver.system().states.len();
        let phase = self.solver.phase_roundings(&event.time)[states];
        // Sine and cosine themselves are good to a few units.
        let error = Ball::<T>::of(&forcing.omega).size() * moved + phase + T::unit() * 8.0;
        [Ball::within(cos, error), Ball::within(sin, error), one]
    }

    /// A guard of a mode with its derivative.
    fn guard(&self, mode: usize, guard: usize) -> [&Row; 2] {
        [&self.solver.system().modes[mode], &self.tangent.modes[mode]].map(|it| guard_of(it, guard))
    }

    /// Refuses an instant at which another guard may be zero, unless it is so to first order.
    fn check_others(&self, fired: usize, zeros: &ZeroSpace) -> Result<(), NoGradient> {
        for (n, guard) in self.modes[self.mode].guards.iter().enumerate() {
            if n == fired || dot(guard, &self.state).value.sign().is_some() {
                continue;
            }
            let [row, rate] = self.guard(self.mode, n);
            let row = with_derivative(row, rate).ok_or(NoGradient::Unknown)?;
            if !zeros.contains(&row) {
                return Err(NoGradient::Undecided);
            }
        }
        Ok(())
    }

    /// Refuses an entry at which a guard is zero and not so to first order, and finds those of
    /// `until` that fire there.
    fn check_entry(&mut self) -> Result<(), NoGradient> {
        self.fires = 0;
        for n in 0..self.modes[self.mode].guards.len() {
            let sign = self.sign_at_entry(self.guard(self.mode, n))?;
            let is_until = n < self.solver.system().modes[self.mode].until.len();
            if sign == Some(true) && is_until {
                self.fires |= 1 << n;
            }
        }
        Ok(())
    }

    /// Refuses a choice of a successor that is not the same to first order.
    fn check_successor(&self, mode: usize, until: usize) -> Result<(), NoGradient> {
        let [own, rates] = [&self.solver.system().modes[mode], &self.tangent.modes[mode]]
            .map(|it| &it.until[until].next);
        for (own, rate) in own.iter().zip(rates) {
            let (Some(row), Some(rate)) = (&own.when, &rate.when) else { return Ok(()) };
            // The condition is decided in the mode that it would begin.
            let is_chosen = self.sign_in(own.mode, [row, rate])? == Some(true);
            if is_chosen {
                return Ok(());
            }
        }
        Ok(())
    }

    fn sign_at_entry(&self, row: [&Row; 2]) -> Result<Option<bool>, NoGradient> {
        self.sign_in(self.mode, row)
    }

    /// The sign of the first derivative of a row that is not zero to first order; none inside if
    /// all are.
    fn sign_in(&self, mode: usize, [row, rate]: [&Row; 2]) -> Result<Option<bool>, NoGradient> {
        let both = with_derivative(row, rate).ok_or(NoGradient::Unknown)?;
        let Some(order) = self.zeros.multiplicity(&both, mode) else { return Ok(None) };
        let matrix = &self.solver.system().modes[mode].matrix;
        let derivative = (0..order).fold(row.clone(), |row, _| times(&row, matrix));
        if self.zeros.is_zero_at_entry(&derivative) {
            return Err(NoGradient::OneSided);
        }
        let row: Vec<Jet<T>> = derivative.iter().map(|it| Jet::fixed(Ball::of(it))).collect();
        dot(&row, &self.state).value.sign().map(Some).ok_or(NoGradient::Undecided)
    }
}

impl<T: Number> ModeJets<T> {
    fn of((mode, rates): (&Mode, &Mode)) -> Self {
        let row = |(row, rate): (&Row, &Row)| -> Vec<Jet<T>> {
            row.iter().zip(rate).map(|(a, b)| Jet::of(a, b)).collect()
        };
        let rows = |a: &[Row], b: &[Row]| a.iter().zip(b).map(row).collect::<Vec<_>>();
        let guards = (0..mode.until.len() + mode.watch.len())
            .map(|n| row((guard_of(mode, n), guard_of(rates, n))));
        let resets = mode.until.iter().zip(&rates.until).map(|(a, b)| rows(&a.reset, &b.reset));
        Self {
            matrix: rows(&mode.matrix, &rates.matrix),
            guards: guards.collect(),
            resets: resets.collect(),
        }
    }
}

fn guard_of(mode: &Mode, guard: usize) -> &Row {
    match guard.checked_sub(mode.until.len()) {
        Some(watch) => &mode.watch[watch].guard,
        None => &mode.until[guard].guard,
    }
}

fn times(row: &Row, matrix: &[Row]) -> Row {
    let entry = |k: usize| {
        let terms = row.iter().zip(matrix).map(|(factor, own)| factor * &own[k]);
        terms.fold(Rational::ZERO, |sum, term| sum + term)
    };
    (0..row.len()).map(entry).collect()
}

/// The derivative of the forcing angle at the start.
fn turn(system: &System, tangent: &Tangent, point: &StartPoint, rates: &StartPoint) -> Rational {
    match (&system.forcing, &tangent.forcing) {
        (Some(own), Some(rate)) => &rate.omega * &point.time + &own.omega * &rates.time + &rate.phi,
        _ => Rational::ZERO,
    }
}

/// The entries of z at a start, as factors of cos theta, sin theta and 1.
fn start_rows(system: &System, point: &StartPoint) -> Vec<[Rational; 3]> {
    let unit = |n: usize| [0, 1, 2].map(|k| if k == n { Rational::ONE } else { Rational::ZERO });
    let mut rows = point.state.clone();
    if system.forcing.is_some() {
        rows.extend([unit(0), unit(1)]);
    }
    rows.push(unit(2));
    rows
}

/// The derivatives of the entries of z at a start, in the same way: cos theta has that of -sin
/// theta, times the angle's.
fn start_slopes(rows: &[[Rational; 3]], rates: &StartPoint, turn: &Rational) -> Vec<[Rational; 3]> {
    let turned = |[cos, sin, _]: &[Rational; 3]| [sin * turn, -(cos * turn), Rational::ZERO];
    let mut slopes: Vec<_> = rows.iter().map(turned).collect();
    for (slope, rate) in slopes.iter_mut().zip(&rates.state) {
        slope.iter_mut().zip(rate).for_each(|(sum, term)| *sum += term);
    }
    slopes
}

/// The factors of numbers that are linearly independent: at theta = 0 the cosine is 1 and the sine
/// 0.
fn independent(rows: &[[Rational; 3]], is_at_zero: bool) -> Vec<Vec<Rational>> {
    let row = |[cos, sin, one]: &[Rational; 3]| match is_at_zero {
        true => vec![cos + one],
        false => vec![cos.clone(), sin.clone(), one.clone()],
    };
    rows.iter().map(row).collect()
}

//! Runs whose digits are proved: in 106 bits with enclosed errors, and in twice as many bits where
//! these do not decide or have too few digits.

use super::answer::{Answer, Running, sealed};
use super::cause::Cause;
use super::event::{Event, Kind};
use super::gradient::ByName;
use super::proved::Proved;
use super::request::Request;
use super::sizes::Sizes;
use super::steps::{Step, Steps};
use crate::affine::model::error::SystemError;
use crate::affine::model::system::System;
use crate::affine::solver::Solver;
use crate::affine::solver::event as engine;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::number::{Bound, Number};
use crate::numeric::wide::{Bits212, Bits424, Bits848, Bits1696, Bits3392};
use std::sync::OnceLock;

/// The bits of the arithmetics, one after the other.
pub const PRECISION_BITS: [u32; 6] = [106, 212, 424, 848, 1696, 3392];

/// The most bits of an arithmetic.
pub(super) const MAX_BITS: u32 = PRECISION_BITS[5];

/// A system with a solver in each arithmetic, which is prepared when a run needs it.
pub struct ProvedSolver {
    system: System,
    backward: bool,
    bits106: OnceLock<Solver<DoubleDouble>>,
    bits212: OnceLock<Solver<Bits212>>,
    bits424: OnceLock<Solver<Bits424>>,
    bits848: OnceLock<Solver<Bits848>>,
    bits1696: OnceLock<Solver<Bits1696>>,
    bits3392: OnceLock<Solver<Bits3392>>,
}

impl ProvedSolver {
    /// The run in the arithmetic of this number.
    fn begin<'a>(
        &'a self,
        level: usize,
        request: &Request,
    ) -> Result<Box<dyn Level<'a> + Send + 'a>, SystemError> {
        match level {
            0 => self.begin_in(&self.bits106, request),
            1 => self.begin_in(&self.bits212, request),
            2 => self.begin_in(&self.bits424, request),
            3 => self.begin_in(&self.bits848, request),
            4 => self.begin_in(&self.bits1696, request),
            _ => self.begin_in(&self.bits3392, request),
        }
    }

    fn begin_in<'a, T: Number>(
        &'a self,
        solver: &'a OnceLock<Solver<T>>,
        request: &Request,
    ) -> Result<Box<dyn Level<'a> + Send + 'a>, SystemError> {
        let solver = match solver.get() {
            Some(solver) => solver,
            None => {
                let made = Solver::prepare(&self.system, self.backward)?;
                solver.get_or_init(|| made)
            }
        };
        let steps = Steps::begin(solver, request, true)?;
        let sizes = Sizes::new(&steps.run.start());
        Ok(Box::new(InArithmetic { system: &self.system, steps, step: None, sizes }))
    }
}

impl sealed::Sealed for Proved {}

impl Answer for Proved {
    type Value = Self;
    type Prepared = ProvedSolver;

    fn prepare(system: &System, backward: bool) -> Result<ProvedSolver, SystemError> {
        let first = OnceLock::from(Solver::prepare(system, backward)?);
        Ok(ProvedSolver {
            system: system.clone(),
            backward,
            bits106: first,
            bits212: OnceLock::new(),
            bits424: OnceLock::new(),
            bits848: OnceLock::new(),
            bits1696: OnceLock::new(),
            bits3392: OnceLock::new(),
        })
    }

    fn system(prepared: &ProvedSolver) -> &System {
        &prepared.system
    }

    fn is_backward(prepared: &ProvedSolver) -> bool {
        prepared.backward
    }

    fn begin<'a>(
        prepared: &'a ProvedSolver,
        request: &Request,
    ) -> Result<Box<dyn Running<'a, Self> + Send + 'a>, SystemError> {
        Ok(Box::new(Escalating::begin(prepared, request)?))
    }
}

/// A run in one arithmetic with enclosed errors.
trait Level<'a> {
    fn start(&self) -> Event<'a, Proved>;

    /// Whether the start has fewer digits than are wanted.
    fn start_needs_more_bits(&mut self, digits: usize) -> bool;

    /// Goes to the next step, and says whether it is a sample; none if there is no step.
    fn advance(&mut self) -> Option<bool>;

    /// Whether more bits may decide the step, or give the digits that are wanted: asked once.
    fn needs_more_bits(&mut self, digits: usize) -> bool;

    /// Whether the step is an ending that is not decided.
    fn is_undecided(&self) -> bool;

    /// Whether the step is such an ending because the search took too much work.
    fn is_exhausted(&self) -> bool;

    /// The step, as an event.
    fn event(&self) -> Option<Event<'a, Proved>>;

    fn cause(&self) -> Option<Cause>;
}

struct InArithmetic<'a, T: Number> {
    system: &'a System,
    steps: Steps<'a, T>,
    step: Option<Step<T>>,
    sizes: Sizes<T::Bound>,
}

impl<'a, T: Number> InArithmetic<'a, T> {
    fn proved(
        &self,
        event: &engine::Event<T>,
        kind: Kind,
        gradients: Vec<ByName<Proved>>,
    ) -> Event<'a, Proved> {
        let errors = event.errors.as_ref();
        let error = |it: Option<&T::Bound>| it.copied().unwrap_or(T::Bound::INFINITY);
        let time = Proved::new(event.time.value(), error(errors.map(|it| &it.time)));
        let state = event.state.iter().enumerate();
        let state = state
            .map(|(n, value)| Proved::new(*value, error(errors.and_then(|it| it.state.get(n)))));
        Event {
            system: self.system,
            kind,
            mode: event.mode,
            time,
            state: state.collect(),
            accumulation: accumulation(event),
            gradients,
        }
    }
}

impl<'a, T: Number> Level<'a> for InArithmetic<'a, T> {
    fn start(&self) -> Event<'a, Proved> {
        let gradients = self.steps.walks.of_start(|it| Proved::new(it.0, it.1));
        self.proved(&self.steps.run.start(), Kind::Start, gradients)
    }

    fn start_needs_more_bits(&mut self, digits: usize) -> bool {
        let of_gradients = self.steps.walks.need_more_bits(digits);
        self.sizes.have_too_few_digits(&self.steps.run.start(), digits) || of_gradients
    }

    fn advance(&mut self) -> Option<bool> {
        self.step = self.steps.next();
        self.step.as_ref().map(|it| it.is_sample)
    }

    fn needs_more_bits(&mut self, digits: usize) -> bool {
        let Some(Step { event, is_sample }) = &self.step else { return false };
        match event.what {
            engine::What::End(engine::Ending::Undecided) => true,
            // The events of a run with samples are not printed.
            _ if self.steps.has_samples() && !is_sample => false,
            _ => {
                let of_gradients = self.steps.walks.need_more_bits(digits);
                self.sizes.have_too_few_digits(event, digits) || of_gradients
            }
        }
    }

    fn is_undecided(&self) -> bool {
        let undecided = engine::What::End(engine::Ending::Undecided);
        self.step.as_ref().is_some_and(|it| it.event.what == undecided)
    }

    fn is_exhausted(&self) -> bool {
        self.steps.run.is_exhausted()
    }

    fn event(&self) -> Option<Event<'a, Proved>> {
        let step = self.step.as_ref()?;
        let gradients = self.steps.walks.of_last(|it| Proved::new(it.0, it.1));
        Some(self.proved(&step.event, step.kind(), gradients))
    }

    fn cause(&self) -> Option<Cause> {
        Cause::new(&self.steps.run, self.system)
    }
}

/// The earliest and the latest time at which impacts accumulate, of an ending by an accumulation.
fn accumulation<T: Number>(last: &engine::Event<T>) -> Option<Box<[Proved; 2]>> {
    let engine::What::End(engine::Ending::Accumulation(from, to)) = last.what else { return None };
    let time = last.time.value();
    let error = last.errors.as_ref().map_or(0.0, |it| it.time.to_f64());
    let middle = time + (from + to) * T::exact(0.5);
    // The rounding of these operations is below the last term.
    let width = 0.5 * (to - from).to_f64() + error + 1e-29 * time.to_f64().abs();
    let end = |width: f64| Proved::new(middle + T::exact(width), T::Bound::ZERO);
    Some(Box::new([end(-width), end(width)]))
}

/// A run in one arithmetic after the other.
struct Escalating<'a> {
    solver: &'a ProvedSolver,
    request: Request,
    level: usize,
    run: Box<dyn Level<'a> + Send + 'a>,
    given: Count,
    /// The steps that fewer bits have given out, and that are not given out again.
    repeated: Count,
    left: LeftOpen<'a>,
    /// Whether a search has taken too much work. In more bits one may take less, because pieces are
    /// short where rounding is large; after a second one no more are tried.
    is_exhausted: bool,
}

/// The knowledge of a run that fewer bits left undecided: more bits may know less of its motion,
/// and run out of work before they meet the guard that fewer of them left open.
#[derive(Default)]
struct LeftOpen<'a> {
    /// The latest ending that a run in fewer bits came to, after this number of events and samples.
    ending: Option<(u64, Event<'a, Proved>)>,
    /// The last cause that names a guard.
    cause: Option<Cause>,
}

/// A number of events and samples. They are counted apart, because rounding may change the order of
/// an event and a sample at the same time.
#[derive(Clone, Copy, Default)]
struct Count {
    events: u64,
    samples: u64,
}

impl Count {
    fn counter(&mut self, is_sample: bool) -> &mut u64 {
        if is_sample { &mut self.samples } else { &mut self.events }
    }

    fn sum(&self) -> u64 {
        self.events + self.samples
    }

    /// Takes a step off, and says whether it was among those that are counted.
    fn take(&mut self, is_sample: bool) -> bool {
        let count = self.counter(is_sample);
        let is_there = *count > 0;
        *count = count.saturating_sub(1);
        is_there
    }
}

impl<'a> Escalating<'a> {
    fn begin(solver: &'a ProvedSolver, request: &Request) -> Result<Self, SystemError> {
        let run = solver.begin(0, request)?;
        let (given, repeated) = (Count::default(), Count::default());
        let request = request.clone();
        let left = LeftOpen::default();
        let is_exhausted = false;
        let mut own = Self { solver, request, level: 0, run, given, repeated, left, is_exhausted };
        let has_samples = own.request.samples.is_some();
        while own.may_go_on() && !has_samples && own.run.start_needs_more_bits(own.request.digits) {
            own.raise();
        }
        Ok(own)
    }

    fn may_go_on(&self) -> bool {
        PRECISION_BITS.get(self.level + 1).is_some_and(|bits| *bits <= self.request.most_bits)
    }

    /// Keeps the ending at which these bits are left undecided, if it is later than that of fewer.
    fn leave_open(&mut self) {
        let Some(event) = self.run.event() else { return };
        // Steps that are still to be repeated were not passed in these bits.
        let passed = self.given.sum() - self.repeated.sum();
        let is_later = |(others, other): &(u64, Event<'_, Proved>)| {
            let elapsed = other.time().midpoint() - event.time().midpoint();
            let elapsed = if self.solver.backward { -elapsed } else { elapsed };
            (*others, elapsed) > (passed, 0.0)
        };
        if !self.left.ending.as_ref().is_some_and(is_later) {
            self.left.ending = Some((passed, event));
        }
        let cause = self.run.cause().filter(Cause::names_a_guard);
        self.left.cause = cause.or(self.left.cause.take());
    }

    /// Begins again in twice as many bits.
    fn raise(&mut self) {
        // A system and a start that one arithmetic accepts are accepted by each.
        if let Ok(run) = self.solver.begin(self.level + 1, &self.request) {
            (self.run, self.repeated) = (run, self.given);
        }
        self.level += 1;
    }
}

impl<'a> Running<'a, Proved> for Escalating<'a> {
    fn start(&self) -> Event<'a, Proved> {
        self.run.start()
    }

    fn next(&mut self) -> Option<Event<'a, Proved>> {
        while let Some(is_sample) = self.run.advance() {
            // It is asked of steps that are repeated, too, which have the sizes of the states.
            let mut needs_more = self.may_go_on() && self.run.needs_more_bits(self.request.digits);
            if self.run.is_exhausted() {
                needs_more &= !std::mem::replace(&mut self.is_exhausted, true);
            }
            let is_undecided = self.run.is_undecided();
            if is_undecided {
                self.leave_open();
            } else if self.repeated.take(is_sample) {
                continue;
            }
            if needs_more {
                self.raise();
                continue;
            }
            if is_undecided {
                return self.left.ending.take().map(|(_, event)| event);
            }
            *self.given.counter(is_sample) += 1;
            return self.run.event();
        }
        None
    }

    fn undecidable(&self) -> u64 {
        // A run that follows its errors ends where rounding leaves a choice open.
        0
    }

    fn cause(&self) -> Option<Cause> {
        let own = self.run.cause()?;
        Some(own.or_named(self.left.cause.as_ref()))
    }

    fn bits(&self) -> u32 {
        PRECISION_BITS[self.level]
    }
}

//! Modes that programs build, with the events that end them and those that are watched.

use super::Expression;
use crate::affine::model::scalar::{Assignment, Condition};
use crate::affine::model::system::Direction;

/// A mode of a system that is built.
#[derive(Clone, Debug)]
#[must_use = "a mode is added by `SystemBuilder::mode`"]
pub struct ModeBuilder {
    pub(super) name: String,
    pub(super) equations: Vec<Assignment>,
    pub(super) until: Vec<UntilBuilder>,
    pub(super) watch: Vec<(String, Condition, Direction)>,
}

impl ModeBuilder {
    /// A mode of this name, which is lower-case words joined by hyphens.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let mode = ModeBuilder::new("Free fall").equation("x' = 1");
    /// let error = System::builder("fall").states(["x"]).mode(mode).build().unwrap_err();
    /// let said = error.to_string();
    /// assert!(said.starts_with("mode \"Free fall\": \"Free fall\" is not accepted"), "{said}");
    /// ```
    pub fn new(name: impl Into<String>) -> Self {
        let (equations, until, watch) = (Vec::new(), Vec::new(), Vec::new());
        Self { name: name.into(), equations, until, watch }
    }

    /// Adds the equation of a state, such as `x' = v`. Each state has one.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let mode = ModeBuilder::new("fall").equation("x' = v");
    /// let error = System::builder("fall").states(["x", "v"]).mode(mode).build().unwrap_err();
    /// assert_eq!(error.to_string(), "mode \"fall\": an equation `v' = ...` is missing");
    /// ```
    pub fn equation(mut self, text: impl Into<String>) -> Self {
        self.equations.push(Assignment::Text(text.into()));
        self
    }

    /// Adds the equation of a state by its right side alone, which may be a row of numbers.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let mode = ModeBuilder::new("fall").rate("x", [0, 1, 0]).rate("v", [0.0, 0.0, -9.81]);
    /// let system = System::builder("fall").states(["x", "v"]).mode(mode).build()?;
    /// assert_eq!(system.modes[0].matrix[1][2].to_f64(), -9.81);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn rate(mut self, state: impl Into<String>, right: impl Into<Expression>) -> Self {
        self.equations.push(Assignment::To { state: state.into(), value: right.into().0 });
        self
    }

    /// Adds an event that ends the mode. Of two that fire at one instant the one that was
    /// added first is the event.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let mode = ModeBuilder::new("rise").equation("x' = 1");
    /// let mode = mode.until(UntilBuilder::new("full", "x > 3").reset("x = 0"));
    /// let system = System::builder("bucket").states(["x"]).mode(mode).build()?;
    /// assert_eq!(system.modes[0].until[0].name, "full");
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn until(mut self, event: UntilBuilder) -> Self {
        self.until.push(event);
        self
    }

    /// Adds an event that is counted and changes nothing: where the condition, or the row of the
    /// guard, becomes true (rising), becomes false (falling), or both.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{Direction, ModeBuilder};
    /// let mode = ModeBuilder::new("fall").equation("x' = -1");
    /// let mode = mode.watch("half", "x < 1/2", Direction::Rising);
    /// let mode = mode.watch("ground", [-1, 0], Direction::Both);
    /// let system = System::builder("fall").states(["x"]).mode(mode).build()?;
    /// assert_eq!(system.modes[0].watch.len(), 2);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn watch(
        mut self,
        name: impl Into<String>,
        guard: impl Into<Expression>,
        direction: Direction,
    ) -> Self {
        self.watch.push((name.into(), Condition(guard.into().0), direction));
        self
    }
}

/// An event that ends a mode of a system that is built.
#[derive(Clone, Debug)]
#[must_use = "an event is added by `ModeBuilder::until`"]
pub struct UntilBuilder {
    pub(super) name: String,
    pub(super) guard: Condition,
    pub(super) reset: Vec<Assignment>,
    pub(super) next: Vec<(Option<Condition>, String)>,
    pub(super) limit: Option<LimitBuilder>,
}

/// The passage from the limit at which an event of a system that is built accumulates.
///
/// ```
/// use percuss::System;
/// use percuss::system::{LimitBuilder, ModeBuilder, UntilBuilder};
///
/// let rest = LimitBuilder::new().reset("x = 0").reset("v = 0").next("rest");
/// let impact = UntilBuilder::new("impact", "x < 0").reset("v = -v/2").accumulates_to(rest);
/// let flight = ModeBuilder::new("flight").equation("x' = v").equation("v' = -1").until(impact);
/// let rest = ModeBuilder::new("rest").equation("x' = 0").equation("v' = 0");
/// let ball = System::builder("ball").states(["x", "v"]).mode(flight).mode(rest);
/// let ball = ball.start("flight", [("x", 0), ("v", 1)]).build()?;
/// let solver = ball.solver::<f64>()?;
/// let mut events = solver.run().until(5.0)?;
/// let limit = events.find(|it| it.name() == "accumulation").expect("the limit");
/// // Flights of 2, 1, 1/2 and so on.
/// assert!((limit.time() - 4.0).abs() < 1e-15 && limit.mode() == "rest");
/// assert_eq!(events.next().map(|it| it.name()), Some("end"));
/// # Ok::<(), percuss::SystemError>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use = "a limit is added by `UntilBuilder::accumulates_to`"]
pub struct LimitBuilder {
    pub(super) reset: Vec<Assignment>,
    pub(super) next: Vec<(Option<Condition>, String)>,
}

impl LimitBuilder {
    /// A limit without a reset and without a successor, of which it needs one.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an assignment to what happens at the limit. All right sides are taken before it, and
    /// states that are not assigned stay.
    pub fn reset(mut self, text: impl Into<String>) -> Self {
        self.reset.push(Assignment::Text(text.into()));
        self
    }

    /// Adds the mode that follows where no condition of [`next_when`](Self::next_when) holds.
    pub fn next(mut self, mode: impl Into<String>) -> Self {
        self.next.push((None, mode.into()));
        self
    }

    /// Adds a mode that follows where a condition holds just after the reset; the first whose
    /// condition holds does.
    pub fn next_when(mut self, condition: impl Into<Expression>, mode: impl Into<String>) -> Self {
        self.next.push((Some(Condition(condition.into().0)), mode.into()));
        self
    }
}

impl UntilBuilder {
    /// An event of this name that fires where a condition becomes true, or a row positive.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let mode = ModeBuilder::new("fall").equation("x' = -1");
    /// let mode = mode.until(UntilBuilder::new("ground", [-1, 0, 0]));
    /// let error = System::builder("fall").states(["x"]).mode(mode).build().unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "mode \"fall\", until \"ground\", guard: a row of 3 entries is not accepted: 2 are, \
    ///      of the states, and 1"
    /// );
    /// ```
    pub fn new(name: impl Into<String>, guard: impl Into<Expression>) -> Self {
        let (guard, reset, next) = (Condition(guard.into().0), Vec::new(), Vec::new());
        Self { name: name.into(), guard, reset, next, limit: None }
    }

    /// Adds an assignment, such as `v = -v/2`, to what happens at the event. All right sides are
    /// taken before it, and states that are not assigned stay.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let swap = UntilBuilder::new("swap", "x > 1").reset("x = y").reset("y = x");
    /// let mode = ModeBuilder::new("on").equation("x' = 1").equation("y' = 0").until(swap);
    /// let system = System::builder("swap").states(["x", "y"]).mode(mode).build()?;
    /// assert!(system.modes[0].until[0].reset[0][1].is_one());
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn reset(mut self, text: impl Into<String>) -> Self {
        self.reset.push(Assignment::Text(text.into()));
        self
    }

    /// Adds an assignment by its right side alone, which may be a row of numbers.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let halve = UntilBuilder::new("halve", "x > 1").assign("x", [0.5, 0.0]);
    /// let mode = ModeBuilder::new("on").equation("x' = 1").until(halve);
    /// let system = System::builder("halve").states(["x"]).mode(mode).build()?;
    /// assert_eq!(system.modes[0].until[0].reset[0][0].to_f64(), 0.5);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn assign(mut self, state: impl Into<String>, right: impl Into<Expression>) -> Self {
        self.reset.push(Assignment::To { state: state.into(), value: right.into().0 });
        self
    }

    /// Adds the mode that follows where no condition of [`next_when`](Self::next_when) holds, after
    /// which no other can be added. An event without a successor goes on in its own mode.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let mode = ModeBuilder::new("on").equation("x' = 1");
    /// let mode = mode.until(UntilBuilder::new("full", "x > 1").next("off"));
    /// let error = System::builder("tank").states(["x"]).mode(mode).build().unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "mode \"on\", until \"full\", successor 1: there is no mode \"off\": accepted is one \
    ///      of on"
    /// );
    /// ```
    pub fn next(mut self, mode: impl Into<String>) -> Self {
        self.next.push((None, mode.into()));
        self
    }

    /// Adds a mode that follows where a condition holds just after the reset; the first whose
    /// condition holds does. The last successor has none: [`next`](Self::next).
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let hit = UntilBuilder::new("hit", "x < 0").next_when("v > 1", "up").next("rest");
    /// let up = ModeBuilder::new("up").equation("x' = v").equation("v' = -1").until(hit);
    /// let rest = ModeBuilder::new("rest").equation("x' = 0").equation("v' = 0");
    /// let system = System::builder("hop").states(["x", "v"]).mode(up).mode(rest).build()?;
    /// assert_eq!(system.modes[0].until[0].next.len(), 2);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn next_when(mut self, condition: impl Into<Expression>, mode: impl Into<String>) -> Self {
        self.next.push((Some(Condition(condition.into().0)), mode.into()));
        self
    }

    /// Says what follows where the event accumulates: a run goes on there, and does not end.
    pub fn accumulates_to(mut self, limit: LimitBuilder) -> Self {
        self.limit = Some(limit);
        self
    }
}

//! Systems that programs build: by the rules of files, with errors that name items, not lines.

mod mode;
mod tables;

use super::error::SystemError;
use super::rational::Rational;
use super::scalar::{Condition, Scalar};
use super::system::System;
pub use mode::{LimitBuilder, ModeBuilder, UntilBuilder};

/// An expression of a system that is built: text, a number, or a row of coefficients.
///
/// - Text is read as in a file: `"-g"`, `"A*cos - x"`; a guard or another condition is
///   `"left > right"` or `"left < right"`. A guard names a state, cos or sin.
/// - A number is taken exactly: integers, `f64` and [`Rational`]. It is no condition.
/// - A row has a factor for each state, then those of cos theta and sin theta if the system is
///   forced, then that of 1. As a guard it is positive where the condition holds. Its entries are
///   numbers, or expressions of parameters.
///
/// ```
/// use percuss::Rational;
/// use percuss::system::Expression;
///
/// let third = Rational::ONE / Rational::from(3);
/// let of_each_kind: [Expression; 4] =
///     ["A*cos - x".into(), 0.5.into(), third.into(), [0, 1, -1].into()];
/// # assert_eq!(of_each_kind.len(), 4);
/// ```
#[derive(Clone, Debug)]
pub struct Expression(pub(super) Scalar);

impl From<&str> for Expression {
    fn from(text: &str) -> Self {
        Self(Scalar::Text(text.to_owned()))
    }
}

impl From<String> for Expression {
    fn from(text: String) -> Self {
        Self(Scalar::Text(text))
    }
}

impl From<f64> for Expression {
    fn from(number: f64) -> Self {
        Self(Scalar::Decimal(number))
    }
}

impl From<i32> for Expression {
    fn from(number: i32) -> Self {
        Self(Scalar::Integer(number.into()))
    }
}

impl From<i64> for Expression {
    fn from(number: i64) -> Self {
        Self(Scalar::Integer(number))
    }
}

impl From<Rational> for Expression {
    fn from(number: Rational) -> Self {
        Self(Scalar::Exact(number))
    }
}

impl<E: Into<Self>> From<Vec<E>> for Expression {
    fn from(row: Vec<E>) -> Self {
        Self(Scalar::Row(row.into_iter().map(|it| it.into().0).collect()))
    }
}

impl<E: Into<Self>, const N: usize> From<[E; N]> for Expression {
    fn from(row: [E; N]) -> Self {
        Self(Scalar::Row(row.into_iter().map(|it| it.into().0).collect()))
    }
}

/// A system that is being built: [`System::builder`] begins it, [`SystemBuilder::build`] checks it.
///
/// The parts may be given in any order. Of what a system has once, a later call replaces an earlier
/// one; parameters, definitions and modes are added, and one that is there twice is an error.
#[derive(Clone, Debug)]
#[must_use = "a system is built by `build`"]
pub struct SystemBuilder {
    name: String,
    why: String,
    source: String,
    trouble: Vec<String>,
    states: Vec<String>,
    drift: Option<Vec<String>>,
    scales: Option<Vec<Expression>>,
    time_scale: Option<Expression>,
    forcing: Option<[Expression; 2]>,
    parameters: Vec<(String, Expression)>,
    definitions: Vec<(String, String)>,
    modes: Vec<ModeBuilder>,
    start: Option<(String, Vec<(String, Expression)>)>,
    start_time: Option<Expression>,
    start_when: Vec<(Condition, String)>,
}

impl System {
    /// Begins a system of this name, which is lower-case words joined by hyphens.
    ///
    /// ```
    /// use percuss::System;
    /// use percuss::system::{Direction, ModeBuilder, UntilBuilder};
    ///
    /// let system = System::builder("bouncing-ball")
    ///     .states(["x", "v"])
    ///     .parameter("g", 9.81)
    ///     .mode(
    ///         ModeBuilder::new("flight")
    ///             .equation("x' = v")
    ///             .equation("v' = -g")
    ///             .until(UntilBuilder::new("impact", "x < 0").reset("v = -v/2"))
    ///             .watch("top", "v < 0", Direction::Rising),
    ///     )
    ///     .start("flight", [("x", 1.0), ("v", 0.0)])
    ///     .build()?;
    /// let solver = system.solver::<f64>()?;
    /// let first = solver.run().until(1.0)?.next();
    /// let fall = (2.0_f64 / 9.81).sqrt();
    /// assert!(first.is_some_and(|impact| (impact.time() - fall).abs() < 1e-15));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// An error names the item:
    ///
    /// ```
    /// use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    ///
    /// let error = System::builder("bouncing-ball")
    ///     .states(["x", "v"])
    ///     .mode(
    ///         ModeBuilder::new("flight")
    ///             .equation("x' = v")
    ///             .equation("v' = -10")
    ///             .until(UntilBuilder::new("impact", "x < 0").reset("v = -e*v")),
    ///     )
    ///     .build()
    ///     .unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "mode \"flight\", until \"impact\", reset `v = -e*v`: e is not known: accepted are x, v"
    /// );
    /// ```
    pub fn builder(name: impl Into<String>) -> SystemBuilder {
        SystemBuilder {
            name: name.into(),
            why: String::new(),
            source: String::new(),
            trouble: Vec::new(),
            states: Vec::new(),
            drift: None,
            scales: None,
            time_scale: None,
            forcing: None,
            parameters: Vec::new(),
            definitions: Vec::new(),
            modes: Vec::new(),
            start: None,
            start_time: None,
            start_when: Vec::new(),
        }
    }
}

impl SystemBuilder {
    /// The names of the states, in the order of the system's rows.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let rest = ModeBuilder::new("rest").equation("x' = 0");
    /// let system = System::builder("rest").states(["x"]).mode(rest).build()?;
    /// assert_eq!(system.states, ["x"]);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn states(mut self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.states = names.into_iter().map(Into::into).collect();
        self
    }

    /// The states that are [drifts](System::drifts): without this call they are found.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let going = ModeBuilder::new("going").equation("gone' = x").equation("x' = 1 - x");
    /// let system = System::builder("walk").states(["gone", "x"]).mode(going);
    /// let error = system.clone().drift(["x"]).build().unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "drift: x is no drift: mode \"going\", equation `gone' = x` depends on it"
    /// );
    /// assert_eq!(system.drift(["gone"]).build()?.drifts(), [0]);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn drift(mut self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.drift = Some(names.into_iter().map(Into::into).collect());
        self
    }

    /// A forcing of the phase theta = omega t + phi, whose cosine and sine expressions may use.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let system = System::builder("driven")
    ///     .states(["x"])
    ///     .forcing(1.25, 0)
    ///     .mode(ModeBuilder::new("on").equation("x' = cos - x"))
    ///     .build()?;
    /// assert_eq!(system.forcing.map(|it| it.omega.to_string()), Some("5/4".to_owned()));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn forcing(mut self, omega: impl Into<Expression>, phi: impl Into<Expression>) -> Self {
        self.forcing = Some([omega.into(), phi.into()]);
        self
    }

    /// A parameter: a finite number, which expressions use by its name.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let system = System::builder("decay")
    ///     .states(["x"])
    ///     .parameter("rate", 0.5)
    ///     .mode(ModeBuilder::new("on").equation("x' = -rate*x"))
    ///     .build()?;
    /// assert_eq!(system.parameters["rate"], 0.5);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn parameter(mut self, name: impl Into<String>, value: impl Into<Expression>) -> Self {
        self.parameters.push((name.into(), value.into()));
        self
    }

    /// A definition, which a file has in `[let]`: a name for an expression.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let system = System::builder("spring")
    ///     .states(["x", "v"])
    ///     .definition("force", "-4*x - v/10")
    ///     .mode(ModeBuilder::new("on").equation("x' = v").equation("v' = force"))
    ///     .build()?;
    /// assert_eq!(system.modes[0].matrix[1][0].to_f64(), -4.0);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn definition(mut self, name: impl Into<String>, text: impl Into<String>) -> Self {
        self.definitions.push((name.into(), text.into()));
        self
    }

    /// Adds a mode.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::{ModeBuilder, UntilBuilder};
    /// let on = UntilBuilder::new("warm", "x > 21").next("off");
    /// let off = UntilBuilder::new("cold", "x < 19").next("on");
    /// let system = System::builder("thermostat")
    ///     .states(["x"])
    ///     .mode(ModeBuilder::new("on").equation("x' = 30 - x").until(on))
    ///     .mode(ModeBuilder::new("off").equation("x' = 10 - x").until(off))
    ///     .build()?;
    /// assert_eq!(system.mode("off"), Some(1));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn mode(mut self, mode: ModeBuilder) -> Self {
        self.modes.push(mode);
        self
    }

    /// The start: its mode, and every state, by numbers or by expressions of parameters, and of cos
    /// and sin at the start.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let system = System::builder("decay")
    ///     .states(["x"])
    ///     .mode(ModeBuilder::new("on").equation("x' = -x"))
    ///     .start("on", [("x", 2)])
    ///     .build()?;
    /// assert_eq!(system.start()?.state[0][2].to_f64(), 2.0);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn start(
        mut self,
        mode: impl Into<String>,
        states: impl IntoIterator<Item = (impl Into<String>, impl Into<Expression>)>,
    ) -> Self {
        let states = states.into_iter().map(|(name, value)| (name.into(), value.into()));
        self.start = Some((mode.into(), states.collect()));
        self
    }

    /// Adds a mode in which the start lies where this condition holds there and none added before
    /// does. Where none holds, the start lies in the mode of [`start`](Self::start).
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let system = System::builder("thermostat")
    ///     .states(["x"])
    ///     .mode(ModeBuilder::new("heat").equation("x' = 25 - x"))
    ///     .mode(ModeBuilder::new("cool").equation("x' = 15 - x"))
    ///     .start_when("x > 20", "cool")
    ///     .start("heat", [("x", 21)])
    ///     .build()?;
    /// assert_eq!(system.start()?.mode, 1);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn start_when(mut self, condition: impl Into<Expression>, mode: impl Into<String>) -> Self {
        self.start_when.push((Condition(condition.into().0), mode.into()));
        self
    }

    /// The time at the start, 0 by default.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let system = System::builder("decay")
    ///     .states(["x"])
    ///     .mode(ModeBuilder::new("on").equation("x' = -x"))
    ///     .start("on", [("x", 1)])
    ///     .start_time(0.5)
    ///     .build()?;
    /// assert_eq!(system.start()?.time.to_f64(), 0.5);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn start_time(mut self, time: impl Into<Expression>) -> Self {
        self.start_time = Some(time.into());
        self
    }

    /// A positive size of each state, by which it is divided before any norm: 1 by default.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let on = ModeBuilder::new("on").equation("x' = -x");
    /// let system = System::builder("decay").states(["x"]).scales([100]).mode(on).build()?;
    /// assert_eq!(system.scales, [100.0]);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn scales(mut self, scales: impl IntoIterator<Item = impl Into<Expression>>) -> Self {
        self.scales = Some(scales.into_iter().map(Into::into).collect());
        self
    }

    /// The positive unit by which times are divided before any comparison: 1/omega by default where
    /// the system is forced, else 1.
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let on = ModeBuilder::new("on").equation("x' = -1000*x");
    /// let system = System::builder("decay").states(["x"]).time_scale(1e-3).mode(on).build()?;
    /// assert_eq!(system.time_scale, 1e-3);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn time_scale(mut self, scale: impl Into<Expression>) -> Self {
        self.time_scale = Some(scale.into());
        self
    }

    /// What the system is for, where it is from, and the kinds of trouble that it makes, of those
    /// in [`TROUBLE`](crate::system::TROUBLE).
    ///
    /// ```
    /// # use percuss::System;
    /// use percuss::system::ModeBuilder;
    /// let on = ModeBuilder::new("on").equation("x' = -x");
    /// let system = System::builder("decay").states(["x"]).mode(on);
    /// let system = system.about("The simplest motion.", "folklore", ["stiffness"]).build()?;
    /// assert_eq!((system.why.as_str(), system.trouble.len()), ("The simplest motion.", 1));
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn about(
        mut self,
        why: impl Into<String>,
        source: impl Into<String>,
        trouble: impl IntoIterator<Item = impl Into<String>>,
    ) -> Self {
        (self.why, self.source) = (why.into(), source.into());
        self.trouble = trouble.into_iter().map(Into::into).collect();
        self
    }

    /// The system that was built.
    ///
    /// # Errors
    /// Whatever the reader of files would refuse, with the item that it is about.
    ///
    /// ```
    /// # use percuss::System;
    /// let error = System::builder("nothing").states(["x"]).build().unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "system \"nothing\": 0 modes are not accepted: 1 to 64 are"
    /// );
    /// ```
    pub fn build(self) -> Result<System, SystemError> {
        tables::file(self)?.system()
    }
}

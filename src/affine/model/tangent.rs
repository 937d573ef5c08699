//! The derivatives of a system's coefficients by one name: a parameter, or a state at the start.

use super::error::SystemError;
use super::file::SystemFile;
use super::rational::Rational;
use super::scalar::Scalar;
use super::system::{Forcing, Mode, StartPoint, Successor, System};
use std::fmt;

/// A name by which a run may be differentiated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Name {
    /// A parameter of the system.
    Parameter(String),
    /// A state at the start, which is written `start.STATE`.
    Start(String),
}

impl Name {
    /// Reads a parameter's name, or `start.STATE`.
    ///
    /// ```
    /// use percuss::system::Name;
    ///
    /// assert_eq!(Name::read("start.v"), Name::Start("v".to_owned()));
    /// assert_eq!(Name::read("g").to_string(), "g");
    /// ```
    #[must_use]
    pub fn read(text: &str) -> Self {
        match text.strip_prefix("start.") {
            Some(state) => Self::Start(state.to_owned()),
            None => Self::Parameter(text.to_owned()),
        }
    }

    /// 1 for the parameter by which is differentiated, 0 for any other.
    pub(super) fn is_parameter(by: Option<&Self>, name: &str) -> Rational {
        unit(matches!(by, Some(Self::Parameter(own)) if own == name))
    }

    /// The index of the state of the start that the name is, if it is one.
    fn start_index(&self, states: &[String]) -> Option<usize> {
        match self {
            Self::Start(name) => states.iter().position(|it| it == name),
            Self::Parameter(_) => None,
        }
    }

    /// 1 for the state by whose start is differentiated, 0 for any other.
    pub(super) fn is_start(by: Option<&Self>, name: &str) -> Rational {
        unit(matches!(by, Some(Self::Start(own)) if own == name))
    }
}

fn unit(is_one: bool) -> Rational {
    if is_one { Rational::ONE } else { Rational::ZERO }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(name) => f.write_str(name),
            Self::Start(state) => write!(f, "start.{state}"),
        }
    }
}

/// The derivatives of a system's coefficients by a name, each in the place of the coefficient.
///
/// A state of the start is a sum of cos theta, sin theta and 1 with factors; its derivative here is
/// that of the factors.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Tangent {
    /// The name by which is differentiated.
    pub name: Name,
    /// The modes, with derivatives for coefficients: names and successors are those of the system.
    pub modes: Vec<Mode>,
    /// The derivatives of frequency and phase, of a forced system.
    pub forcing: Option<Forcing>,
    /// The derivatives of the time and the states of the start, if the file has one.
    pub start: Option<StartPoint>,
    /// The modes in which the start may lie, with derivatives for their conditions.
    pub(in crate::affine) start_modes: Vec<Successor>,
    /// The system for another value of the name, where it accepts one.
    pub(in crate::affine) nearby: Option<Box<System>>,
}

impl SystemFile {
    /// The derivatives of all coefficients by a name, exactly, in the place of the coefficients.
    ///
    /// ```
    /// use percuss::Rational;
    /// use percuss::system::{Name, SystemFile};
    ///
    /// let file = SystemFile::read("spring.system.toml", r#"
    ///     schema = 1
    ///     name = "spring"
    ///     states = ["x", "v"]
    ///     [parameters]
    ///     k = 3
    ///     m = 2
    ///     [[mode]]
    ///     name = "free"
    ///     equations = ["x' = v", "v' = -k/m*x"]
    /// "#)?;
    /// let by_mass = file.tangent(&Name::read("m"))?;
    /// // -k/m has the derivative k/m^2.
    /// assert_eq!(by_mass.modes[0].matrix[1][0], Rational::from(3) / Rational::from(4));
    /// assert!(by_mass.modes[0].matrix[0][1].is_zero());
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A name that is neither a parameter nor a state, whatever does not make sense in the file,
    /// and an expression that is affine for this value of the parameter only, such as `(k - 1)*x*v`
    /// for k = 1.
    pub fn tangent(&self, by: &Name) -> Result<Tangent, SystemError> {
        self.check_name(by)?;
        let System { modes, forcing, start, start_modes, .. } = self.derivatives(by)?;
        let (name, nearby) = (by.clone(), self.nearby_system(by));
        Ok(Tangent { name, modes, forcing, start, start_modes, nearby })
    }

    /// The system for another value of a name. What is zero for both values by the model is so for
    /// all but a few; how far apart they are does not matter.
    fn nearby_system(&self, by: &Name) -> Option<Box<System>> {
        let moved = |sign: i32| {
            let mut file = self.clone();
            if let Name::Parameter(name) = by {
                let parameter = file.parameters.get_mut(name)?;
                parameter.value = Scalar::Exact(perturbed_value(&parameter.value.number()?, sign));
            }
            let mut system = file.system().ok()?;
            if let Some(mut start) = system.start.take() {
                move_start(&mut start, &system.states, by, sign);
                system.follow_start(&mut start, by.start_index(&system.states).as_slice());
                system.start = Some(start);
            }
            Some(Box::new(system))
        };
        moved(1).or_else(|| moved(-1))
    }

    /// Refuses a name that is neither a parameter nor a state at the start.
    fn check_name(&self, name: &Name) -> Result<(), SystemError> {
        let states: Vec<&str> =
            self.tables.states.get_ref().iter().map(|it| it.get_ref().as_str()).collect();
        let is_known = match name {
            Name::Parameter(own) => self.parameters.contains_key(own),
            Name::Start(own) => states.contains(&own.as_str()),
        };
        if is_known {
            return Ok(());
        }
        let starts = states.iter().map(|it| format!("start.{it}"));
        let known: Vec<String> = self.parameters.keys().cloned().chain(starts).collect();
        let what = format!("{name} is not known: accepted are {}", known.join(", "));
        Err(SystemError::Name { item: "a derivative by".to_owned(), what })
    }
}

impl System {
    /// The derivatives of all coefficients by a name, with those of a start: by its expressions
    /// where it is the system's own and not changed, and else of a state alone that is the name.
    pub(in crate::affine) fn tangent(
        &self,
        by: &Name,
        start: &StartPoint,
        is_own: bool,
    ) -> Result<Tangent, SystemError> {
        let refused = |what: &str| SystemError::Name {
            item: format!("a derivative by {by}"),
            what: format!("{what}: accepted is a system as it was read or built"),
        };
        let file = self.file.0.as_ref().ok_or_else(|| refused("the system has no expressions"))?;
        let read = file.system()?;
        if read.modes != self.modes || read.forcing != self.forcing {
            return Err(refused("the system was changed, and its expressions were not"));
        }
        let mut tangent = file.tangent(by)?;
        if !is_own || read.start.as_ref() != Some(start) {
            let rate =
                |state: &String| [Rational::ZERO, Rational::ZERO, Name::is_start(Some(by), state)];
            let state = self.states.iter().map(rate).collect();
            tangent.start = Some(StartPoint { mode: start.mode, time: Rational::ZERO, state });
            tangent.start_modes.clear();
            if let Some(nearby) = &mut tangent.nearby {
                let mut moved = start.clone();
                move_start(&mut moved, &self.states, by, 1);
                nearby.start = Some(moved);
            }
        }
        Ok(tangent)
    }
}

/// The value, changed by a small fraction of itself; a value of zero becomes this small fraction.
fn perturbed_value(value: &Rational, sign: i32) -> Rational {
    /// A large prime, because no model's own value is expected to have it as a denominator.
    const DENOMINATOR: i32 = 1_048_583;
    let size = if value.is_zero() { Rational::ONE } else { value.abs() };
    value + size * Rational::from(sign) / Rational::from(DENOMINATOR)
}

/// Moves the state of a start that is the name.
fn move_start(start: &mut StartPoint, states: &[String], by: &Name, sign: i32) {
    let Some(entry) = by.start_index(states) else { return };
    if let Some([.., one]) = start.state.get_mut(entry) {
        *one = perturbed_value(one, sign);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;
    use crate::affine::model::system::Row;

    const DRIVEN: &str = r#"
        schema = 1
        name = "driven"
        states = ["x", "v"]
        forcing = { omega = "2*w", phi = "w^2" }
        [parameters]
        w = 3
        e = 0.5
        [let]
        thrust = "w^3*cos - e*v"
        [[mode]]
        name = "free"
        equations = ["x' = v", "v' = thrust - x/(w - e)"]
        until = [{ name = "hit", guard = "x > w*sin", reset = ["v = -e^2*v + w"] }]
        [start]
        mode = "free"
        t = "w/3"
        x = "w*cos + e"
        v = "1/w"
    "#;

    fn file(set: &[(&str, f64)]) -> SystemFile {
        let mut file = SystemFile::read("driven.system.toml", DRIVEN).unwrap();
        set.iter().for_each(|(name, value)| file.set(name, *value, "test").unwrap());
        file
    }

    /// All coefficients in one list.
    fn coefficients(modes: &[Mode], forcing: &Forcing, start: &StartPoint) -> Row {
        let mut all = vec![forcing.omega.clone(), forcing.phi.clone(), start.time.clone()];
        all.extend(start.state.iter().flatten().cloned());
        for mode in modes {
            all.extend(mode.matrix.iter().flatten().cloned());
            for until in &mode.until {
                all.extend(until.guard.iter().chain(until.reset.iter().flatten()).cloned());
            }
        }
        all
    }

    fn of_system(set: &[(&str, f64)]) -> Row {
        let system = file(set).system().unwrap();
        coefficients(&system.modes, &system.forcing.unwrap(), &system.start.unwrap())
    }

    fn of_tangent(name: &str) -> Row {
        let tangent = file(&[]).tangent(&Name::read(name)).unwrap();
        coefficients(&tangent.modes, &tangent.forcing.unwrap(), &tangent.start.unwrap())
    }

    /// Exact differences over 2^-20 are off by their second order: no second or third derivative of
    /// a coefficient here is above 64 in size.
    #[test]
    fn derivatives_are_those_of_the_coefficients() {
        let step = 0.5_f64.powi(20);
        for (name, value) in [("w", 3.0), ("e", 0.5)] {
            let [above, below] = [step, -step].map(|it| of_system(&[(name, value + it)]));
            let tangent = of_tangent(name);
            assert_eq!((tangent.len(), above.len()), (below.len(), tangent.len()));
            assert!(tangent.iter().any(|it| !it.is_zero()), "{name}");
            for ((above, below), rate) in above.iter().zip(&below).zip(&tangent) {
                let difference = (above - below).to_f64() / (2.0 * step);
                let error = (difference - rate.to_f64()).abs();
                assert!(error <= 64.0 * step * step, "{name}: {difference} {rate}");
            }
        }
    }

    #[test]
    fn a_state_of_the_start_has_the_derivative_one_there_alone() {
        let ones = of_tangent("start.x").iter().filter(|it| it.is_one()).count();
        assert_eq!(ones, 1);
        assert!(of_tangent("start.x").iter().all(|it| it.is_zero() || it.is_one()));
        let start = file(&[]).tangent(&Name::read("start.x")).unwrap().start.unwrap();
        assert!(start.state[0][2].is_one());
    }

    #[test]
    fn other_names_and_products_that_vanish_at_one_value_are_refused() {
        let error = file(&[]).tangent(&Name::read("start.y")).unwrap_err().to_string();
        assert!(
            error.contains("start.y is not known: accepted are e, w, start.x, start.v"),
            "{error}"
        );
        let text = DRIVEN.replace("v' = thrust", "v' = (w - 3)*x*v");
        let file = SystemFile::read("driven.system.toml", &text).unwrap();
        assert!(file.system().is_ok() && file.tangent(&Name::read("e")).is_ok());
        let error = file.tangent(&Name::read("w")).unwrap_err().to_string();
        assert!(error.contains("a product with a state"), "{error}");
    }
}

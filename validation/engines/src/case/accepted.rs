//! The accepted values of each flag and key, for error messages.

use percuss::{InputError, Model, Parameter, Parameters, Start};

/// What is accepted of a flag or of a key of that name, where it is more than a type.
#[must_use]
pub fn accepted(name: &str) -> Option<&'static str> {
    match name {
        "cycle" => Some("an integer, -2^53 to 2^53"),
        "periods" => Some("an integer, 0 to 1000000000"),
        "until" => Some("a number, at or after the start, at most 1000000000 periods later"),
        "samples" => Some("an integer, 1 to 100000"),
        "valid_within" => Some("an integer, 1 to 1000"),
        "phase" => Some("\"no-contact\", \"contact\" or \"progression\""),
        "margin" => Some("a finite number"),
        "limit" | "at_least" | "at_most" => Some("a number"),
        "engine" | "case" => Some("a string, a regular expression of whole names"),
        name => name.parse().map_or_else(|_| of_start(name), of_parameter),
    }
}

/// The range of a parameter, as its own check states it.
fn of_parameter(parameter: Parameter) -> Option<&'static str> {
    range(parameter.set(Parameters::default(), f64::NAN).check())
}

/// The accepted range of one number of a start.
fn of_start(name: &str) -> Option<&'static str> {
    let mut start = Start::default();
    match name {
        "tau" => start.tau = f64::NAN,
        "p" => start.p = f64::NAN,
        "y" => start.y = f64::NAN,
        "q" => start.q = Some(f64::NAN),
        "v" => start.v = f64::NAN,
        _ => return None,
    }
    let model = Model::new(Parameters::default()).ok()?;
    range(model.start(&start).map(drop))
}

fn range(checked: Result<(), InputError>) -> Option<&'static str> {
    match checked {
        Err(InputError::OutOfRange { accepted, .. }) => Some(accepted),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_a_problem_has_its_range() {
        for name in ["a", "b", "xi", "omega", "g", "phi", "tau", "p", "y", "q", "v", "cycle"] {
            assert!(
                accepted(name).is_some_and(|range| range.contains(" to ") || range.contains("<=")),
                "{name}"
            );
        }
        assert_eq!(accepted("xi"), Some("1e-8 <= xi <= 1e4"));
        assert_eq!(accepted("why"), None);
    }
}

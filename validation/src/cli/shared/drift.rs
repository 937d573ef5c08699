//! The means of a system's drifts by their names.

use percuss::System;
use std::collections::BTreeMap;

/// A number of each drift of a system by its name; NaN, which is null in JSON, where there is none.
pub(in crate::cli) fn by_name<'a>(system: &'a System, numbers: &[f64]) -> BTreeMap<&'a str, f64> {
    let numbers = numbers.iter().copied().chain(std::iter::repeat(f64::NAN));
    let names = system.drifts().into_iter().map(|it| system.states[it].as_str());
    names.zip(numbers).collect()
}

//! The start of a file: its mode, its time, and its states, of which some may hang on others.

use super::names::Names;
use crate::affine::model::dual::Dual;
use crate::affine::model::error::SystemError;
use crate::affine::model::file::{GivenParameter, StartTable};
use crate::affine::model::form::Form;
use crate::affine::model::naming::unknown_mode;
use crate::affine::model::scalar::Scalar;
use crate::affine::model::system::{StartPoint, StartRow};
use std::collections::BTreeMap;

/// A state's factors of cos theta, sin theta and 1.
type Entry = [Dual; 3];

/// The start, and the rows of the states that hang on others; where derivatives are read, theirs.
pub(super) fn read(
    names: &mut Names,
    table: &StartTable,
    places: &BTreeMap<String, usize>,
) -> Result<(StartPoint, Vec<StartRow>), SystemError> {
    let mode = mode(table, places)?;
    let time = match table.entries.get("t") {
        Some(GivenParameter { value, place }) => names.constant_at("t", value, place)?,
        _ => Dual::ZERO,
    };
    let time = names.value_or_rate(time);
    let states = names.states.clone();
    let mut forms = Vec::with_capacity(states.len());
    for name in &states {
        let Some(GivenParameter { value, place }) = table.entries.get(name) else {
            let what = format!("the start has no state {name}");
            return Err(SystemError::at(&table.place, &what));
        };
        let form = names.affine(value);
        forms.push(form.map_err(|what| SystemError::at(place, &format!("{name}: {what}")))?);
    }
    let surplus = |key: &&String| !(["mode", "t"].contains(&key.as_str()) || states.contains(key));
    if let Some(key) = table.entries.keys().find(surplus) {
        let place = &table.entries[key].place;
        let accepted = [names.file.source.keys_of_a_start(), &states.join(", ")].concat();
        return Err(SystemError::at(place, &format!("{key} is no state: accepted are {accepted}")));
    }
    let (entries, order) = resolve(names, &forms).map_err(|n| {
        let place = &table.entries[&states[n]].place;
        let what = "a start that hangs on itself, by way of other states or not, is not accepted";
        SystemError::at(place, &format!("{}: {what}", states[n]))
    })?;
    let row = |n: usize| StartRow {
        state: n,
        row: forms[n].0.iter().map(|it| it.value.clone()).collect(),
    };
    let state =
        entries.into_iter().map(|it| it.map(|number| names.value_or_rate(number))).collect();
    Ok((StartPoint { mode, time, state }, order.into_iter().map(row).collect()))
}

/// The mode of a start, the first of all where its conditions choose one.
fn mode(table: &StartTable, places: &BTreeMap<String, usize>) -> Result<usize, SystemError> {
    let known: Vec<_> = places.keys().map(String::as_str).collect();
    match table.entries.get("mode") {
        Some(GivenParameter { value: Scalar::Text(name), place }) => places
            .get(name)
            .copied()
            .ok_or_else(|| SystemError::at(place, &unknown_mode(name, known.iter().copied()))),
        Some(GivenParameter { place, .. }) => {
            let what = format!("mode is no number: accepted is one of {}", known.join(", "));
            Err(SystemError::at(place, &what))
        }
        None if !table.modes.is_empty() => Ok(0),
        None => {
            let what = format!("the start has no mode: accepted is one of {}", known.join(", "));
            Err(SystemError::at(&table.place, &what))
        }
    }
}

/// The entries of the states, and those that hang on others in an order in which each has its
/// others before it; the first state of a circle where there is one.
fn resolve(names: &Names, forms: &[Form]) -> Result<(Vec<Entry>, Vec<usize>), usize> {
    let mut known: Vec<Option<Entry>> = vec![None; forms.len()];
    let mut order = Vec::new();
    while let Some(open) = known.iter().position(Option::is_none) {
        let entry = |n: usize| entry(names, n, &forms[n], &known).map(|it| (n, it));
        let is_open = |n: &usize| known[*n].is_none();
        let (n, found) = (open..forms.len()).filter(is_open).find_map(entry).ok_or(open)?;
        known[n] = Some(found);
        if forms[n].has_states() {
            order.push(n);
        }
    }
    Ok((known.into_iter().flatten().collect(), order))
}

/// The entry of a state, once all that it hangs on are known.
fn entry(names: &Names, n: usize, form: &Form, known: &[Option<Entry>]) -> Option<Entry> {
    let (others, own) = form.0.split_at(known.len());
    let [cos, sin, one] = own else { return None };
    let mut entry = [cos, sin, one].map(Clone::clone);
    for (factor, other) in others.iter().zip(known).filter(|(factor, _)| !factor.is_zero()) {
        for (sum, number) in entry.iter_mut().zip(other.as_ref()?) {
            *sum = &*sum + &(factor * number);
        }
    }
    entry[2].rate += names.start_rate(&names.states[n]);
    Some(entry)
}

//! From a builder to the tables that a file has, whose spans are the indices of items.

use super::mode::{LimitBuilder, ModeBuilder, UntilBuilder};
use super::{Expression, SystemBuilder};
use crate::affine::model::error::SystemError;
use crate::affine::model::file::{
    ForcingTable, GivenParameter, LimitEntry, LimitTable, ModeTable, NextEntry, NextTable,
    StartChoice, StartTable, SystemFile, Tables, UntilTable, WatchTable,
};
use crate::affine::model::scalar::{Assignment, Condition, Scalar};
use crate::affine::model::source::Source;
use crate::affine::model::system::Direction;
use std::collections::{BTreeMap, BTreeSet};
use toml::Spanned;

/// The file that a builder stands for.
pub(super) fn file(builder: SystemBuilder) -> Result<SystemFile, SystemError> {
    let mut items = Items::default();
    let start = start(builder.start, builder.start_time, builder.start_when)?;
    let parameters = placed("parameters", builder.parameters)?;
    let mut lets = BTreeMap::new();
    for (name, text) in builder.definitions {
        let text = items.at("definitions", text);
        insert(&mut lets, "definitions", name, text)?;
    }
    let system = format!("system {:?}", builder.name);
    let of_system = |items: &mut Items, it: Expression| items.at(&system, it.0);
    let states = builder.states.into_iter().map(|it| items.at("states", it)).collect();
    let drift = builder.drift.map(|it| it.into_iter().map(|it| items.at("drift", it)).collect());
    let trouble = builder.trouble.into_iter().map(|it| items.at(&system, it)).collect();
    let scales = builder.scales.map(|scales| {
        let scales = scales.into_iter().map(|it| of_system(&mut items, it)).collect();
        items.at(&system, scales)
    });
    let time_scale = builder.time_scale.map(|it| of_system(&mut items, it));
    let forcing = builder.forcing.map(|[omega, phi]| ForcingTable {
        omega: of_system(&mut items, omega),
        phi: Some(of_system(&mut items, phi)),
    });
    let tables = Tables {
        schema: items.at(&system, 1),
        states: items.at(&system, states),
        name: items.at(&system, builder.name),
        why: builder.why,
        drift,
        trouble,
        source: builder.source,
        scales,
        time_scale,
        forcing,
        parameters: BTreeMap::new(),
        lets,
        mode: builder.modes.into_iter().map(|it| items.mode(it)).collect(),
        start: None,
    };
    let source = Source::Items(items.0);
    Ok(SystemFile { source, tables, parameters, start, replaced: BTreeSet::new() })
}

fn start(
    states: Option<(String, Vec<(String, Expression)>)>,
    time: Option<Expression>,
    when: Vec<(Condition, String)>,
) -> Result<Option<StartTable>, SystemError> {
    let place = "start".to_owned();
    let Some((mode, states)) = states else {
        if !when.is_empty() {
            let what = "a mode of the start by a condition is not accepted without a start";
            return Err(SystemError::at(&place, what));
        }
        let what = "a time of the start is not accepted without a start";
        return time.map_or(Ok(None), |_| Err(SystemError::at(&place, what)));
    };
    // A state of these names is refused where states are named, too.
    for (name, _) in &states {
        let what = match name.as_str() {
            "t" => "t is no state: the time of the start is given by `start_time`",
            "mode" => "mode is no state: the mode of the start is given before the states",
            _ => continue,
        };
        return Err(SystemError::at(&place, what));
    }
    let time = time.map(|it| ("t".to_owned(), it));
    let mut entries = placed(&place, time.into_iter().chain(states))?;
    if when.is_empty() {
        let value = Scalar::Text(mode);
        entries.insert("mode".to_owned(), GivenParameter { value, place: place.clone() });
        return Ok(Some(StartTable { place, entries, modes: Vec::new() }));
    }
    let choice = |(n, (when, mode)): (usize, (Option<Condition>, String))| {
        let place = format!("start, mode {n}");
        StartChoice { when: when.map(|it| (it, place.clone())), mode: (mode, place) }
    };
    let last = std::iter::once((None, mode));
    let choices = when.into_iter().map(|(when, mode)| (Some(when), mode)).chain(last);
    Ok(Some(StartTable { place, entries, modes: (1..).zip(choices).map(choice).collect() }))
}

/// Values by their names, all from one place.
fn placed(
    place: &str,
    values: impl IntoIterator<Item = (String, Expression)>,
) -> Result<BTreeMap<String, GivenParameter>, SystemError> {
    let mut entries = BTreeMap::new();
    for (name, Expression(value)) in values {
        insert(&mut entries, place, name, GivenParameter { value, place: place.to_owned() })?;
    }
    Ok(entries)
}

/// Refuses a name that is there already: a table would keep the later value without a word.
fn insert<T>(
    entries: &mut BTreeMap<String, T>,
    place: &str,
    name: String,
    value: T,
) -> Result<(), SystemError> {
    if entries.contains_key(&name) {
        return Err(SystemError::at(place, &format!("{name} is given twice")));
    }
    entries.insert(name, value);
    Ok(())
}

/// The names of the items that have been met.
#[derive(Default)]
struct Items(Vec<String>);

impl Items {
    /// A value of an item.
    fn at<T>(&mut self, item: &str, value: T) -> Spanned<T> {
        let index = self.0.len();
        self.0.push(item.to_owned());
        Spanned::new(index..index, value)
    }

    fn mode(&mut self, mode: ModeBuilder) -> ModeTable {
        let item = format!("mode {:?}", mode.name);
        let assigned = |it| self.assignment(&item, ["equation", "rate"], it);
        let equations = mode.equations.into_iter().map(assigned).collect();
        ModeTable {
            equations: self.at(&item, equations),
            until: mode.until.into_iter().map(|it| self.until(&item, it)).collect(),
            watch: mode.watch.into_iter().map(|it| self.watch(&item, it)).collect(),
            name: self.at(&item, mode.name),
        }
    }

    /// An assignment of an item, which is called differently where only its right side is given.
    fn assignment(
        &mut self,
        item: &str,
        [whole, right]: [&str; 2],
        assignment: Assignment,
    ) -> Spanned<Assignment> {
        let item = match &assignment {
            Assignment::Text(text) => format!("{item}, {whole} `{text}`"),
            Assignment::To { state, .. } => format!("{item}, {right} of {state:?}"),
        };
        self.at(&item, assignment)
    }

    fn until(&mut self, mode: &str, until: UntilBuilder) -> UntilTable {
        let item = format!("{mode}, until {:?}", until.name);
        let assigned = |it| self.assignment(&item, ["reset", "assignment"], it);
        let reset = until.reset.into_iter().map(assigned).collect();
        let next = self.successors(&item, until.next);
        let limit = until.limit.map(|it| self.limit(&format!("{item}, accumulates_to"), it));
        UntilTable {
            guard: self.at(&format!("{item}, guard"), until.guard),
            reset,
            next: (!next.is_empty()).then(|| self.at(&item, NextEntry::Modes(next))),
            accumulates_to: limit,
            name: self.at(&item, until.name),
        }
    }

    /// The modes that may follow, with their conditions.
    fn successors(&mut self, item: &str, next: Vec<(Option<Condition>, String)>) -> Vec<NextTable> {
        let one = |(n, (when, mode)): (usize, (Option<Condition>, String))| {
            let item = format!("{item}, successor {n}");
            NextTable { when: when.map(|it| self.at(&item, it)), mode: self.at(&item, mode) }
        };
        (1..).zip(next).map(one).collect()
    }

    fn limit(&mut self, item: &str, limit: LimitBuilder) -> Spanned<LimitEntry> {
        let assigned = |it| self.assignment(item, ["reset", "assignment"], it);
        let reset = limit.reset.into_iter().map(assigned).collect();
        let next = NextEntry::Modes(self.successors(item, limit.next));
        let table = LimitTable { reset, next: self.at(item, next) };
        self.at(item, LimitEntry::Table(table))
    }

    fn watch(&mut self, mode: &str, watch: (String, Condition, Direction)) -> WatchTable {
        let (name, guard, direction) = watch;
        let item = format!("{mode}, watch {name:?}");
        WatchTable {
            guard: self.at(&format!("{item}, guard"), guard),
            direction: Some(self.at(&item, direction.as_str().to_owned())),
            name: self.at(&item, name),
        }
    }
}

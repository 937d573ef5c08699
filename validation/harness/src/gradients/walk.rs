//! Derivatives along the exact run's events, by the right rule or a wrong one.

use super::linear::Linear;
use super::mechanism::{Rule, Term};
use super::path::{Flow, Stop, Stretch};
use nalgebra::DVector;

/// Derivatives of time and states, a list for each row of a table.
pub(super) type Rows = Vec<Vec<f64>>;

/// A run with all that its derivatives by a name need.
#[derive(Clone, Copy)]
pub(super) struct Along<'a> {
    pub linear: &'a Linear,
    pub rates: &'a Linear,
    pub path: &'a [Stretch],
    pub flows: &'a [Flow],
    /// The number of states.
    pub states: usize,
}

/// The derivatives of time and states at the start and at each event, by a rule.
pub(super) fn walk(along: &Along<'_>, rule: Rule) -> Rows {
    let mut slope = along.rates.start.clone();
    let mut time = 0.0;
    let mut rows = vec![cells(along, 0.0, &slope)];
    for (stretch, flow) in along.path.iter().zip(along.flows) {
        let there = &flow.exponential * &slope + &flow.derivative * &stretch.begin;
        if stretch.stop == Stop::End {
            rows.push(cells(along, 0.0, &there));
            break;
        }
        let event = EventTerms::new(along, stretch);
        if !stretch.at_entry {
            time = event.time(&there, rule);
        }
        let moved = event.moved(&there, time, rule);
        slope = &moved - term(rule.after, &event.after, &event.before) * time;
        // No rule moves the forcing.
        let forcing = along.states..slope.len();
        forcing.for_each(|entry| slope[entry] = there[entry]);
        let row = if rule.row_moves { &moved } else { &slope };
        rows.push(cells(along, time, row));
    }
    rows
}

fn cells(along: &Along<'_>, time: f64, slope: &DVector<f64>) -> Vec<f64> {
    std::iter::once(time).chain(slope.iter().take(along.states).copied()).collect()
}

/// A field on one side, as a rule uses it.
fn term(rule: Term, own: &DVector<f64>, other: &DVector<f64>) -> DVector<f64> {
    match rule {
        Term::Own => own.clone(),
        Term::Other => other.clone(),
        Term::None => own * 0.0,
        Term::Negated => -own,
    }
}

/// The fields on both sides of an event.
pub(super) struct EventTerms<'a> {
    pub(super) along: &'a Along<'a>,
    stretch: &'a Stretch,
    pub(super) before: DVector<f64>,
    pub(super) after: DVector<f64>,
}

impl<'a> EventTerms<'a> {
    pub(super) fn new(along: &'a Along<'a>, stretch: &'a Stretch) -> Self {
        let field = |mode: usize, z| &along.linear.modes[mode].matrix * z;
        Self {
            along,
            stretch,
            before: field(stretch.mode, &stretch.before),
            after: field(stretch.next, &stretch.after),
        }
    }

    /// The derivative of the event's time.
    pub(super) fn time(&self, there: &DVector<f64>, rule: Rule) -> f64 {
        let (Stop::Until(guard) | Stop::Watch(guard)) = self.stretch.stop else { return 0.0 };
        let [own, rate] = [self.along.linear, self.along.rates]
            .map(|it| &it.modes[self.stretch.mode].guards[guard]);
        let mut shift = own.dot(&there.transpose());
        if rule.guard_moves {
            shift += rate.dot(&self.stretch.before.transpose());
        }
        match rule.time {
            Term::Own => -shift / own.dot(&self.before.transpose()),
            Term::Negated => shift / own.dot(&self.before.transpose()),
            Term::Other => -shift / own.dot(&self.after.transpose()),
            Term::None => 0.0,
        }
    }

    /// The derivative of the state after the event, at its moving time.
    pub(super) fn moved(&self, there: &DVector<f64>, time: f64, rule: Rule) -> DVector<f64> {
        let Stop::Until(until) = self.stretch.stop else {
            return there + term(rule.before, &self.before, &self.before) * time;
        };
        let [own, rate] = [self.along.linear, self.along.rates]
            .map(|it| &it.modes[self.stretch.mode].resets[until]);
        let moved = there + term(rule.before, &self.before, &self.after) * time;
        let mut after = if rule.reset_applies { own * moved } else { moved };
        if rule.reset_moves && rule.reset_applies {
            after += rate * &self.stretch.before;
        }
        after
    }
}

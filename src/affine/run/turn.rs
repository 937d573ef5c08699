//! Turns between impacts: an impact may lead into another mode, such as one of friction that acts
//! the other way, which ends where the gap's rate is zero and leads back without a change.
//!
//! A run remembers its last impact and what has followed it. By the next impact from the same node,
//! into the same one, the cycle is closed, and may accumulate.

use super::Run;
use crate::affine::zeros::graph::Firing;
use crate::affine::zeros::impact::Impacts;
use crate::numeric::number::Number;

/// An `until` that has led from the mode that an impact began back to that of the impact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// The node before it, and the one after it.
    pub node: usize,
    pub to: usize,
    pub firing: Firing,
    pub successor: usize,
    /// The `until` of the impact.
    impact: usize,
    /// The discards of the graph after which the nodes have their numbers.
    discards: u64,
}

/// The place of an `until` in a cycle of impacts and turns.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlaceInCycle {
    /// The turn before an impact with which the cycle closes.
    pub closing: Option<Turn>,
    /// Whether it is a turn.
    pub is_turn: bool,
    /// The `until` of the impact before a turn in the same instant, which has left its guard and
    /// the rate of that at zero.
    pub rested: Option<usize>,
}

/// The last `until` of a run, where a cycle of impacts and turns may go on from it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LastOfCycle {
    impact: Option<LastImpact>,
    turn: Option<Turn>,
}

/// An impact that has led into another mode.
#[derive(Clone, Copy, Debug)]
struct LastImpact {
    mode: usize,
    until: usize,
    /// The node that follows.
    to: usize,
    /// Whether it has left its guard's rate at zero.
    rests: bool,
    discards: u64,
}

impl<T: Number> Run<'_, T> {
    /// Remembers an `until` that has led from a node to the present one; `impacts` and `rests` are
    /// those of its arrival.
    pub(super) fn place_in_cycle(
        &mut self,
        (from, mode): (usize, usize),
        firing: Firing,
        successor: usize,
        (impacts, rests): (Option<Impacts>, bool),
    ) -> PlaceInCycle {
        let LastOfCycle { impact, turn } = std::mem::take(&mut self.last_of_cycle);
        let (to, discards, until) = (self.node, self.graph.discards, firing.until);
        let next = self.graph.node(to).mode;
        let leads_back = |it: &LastImpact| {
            let unchanged = self.solver.modes[mode].changes_nothing.get(until) == Some(&true);
            unchanged && (it.to, it.mode, it.discards) == (from, next, discards)
        };
        if let Some(impact) = impact.filter(leads_back) {
            let LastImpact { until: impact, rests, .. } = impact;
            let turn = Turn { node: from, to, firing, successor, impact, discards };
            self.last_of_cycle.turn = Some(turn);
            let rested = (rests && firing.at_entry).then_some(impact);
            return PlaceInCycle { closing: None, is_turn: true, rested };
        }
        if next == mode || !(impacts.is_some() || rests) {
            return PlaceInCycle::default();
        }
        self.last_of_cycle.impact = Some(LastImpact { mode, until, to, rests, discards });
        let closes = |it: &Turn, idle: u64| {
            let are_alike = |nodes: [usize; 2]| self.graph.are_alike(nodes, idle);
            (it.impact, it.discards) == (until, discards)
                && are_alike([it.to, from])
                && are_alike([it.node, to])
        };
        let closing = impacts.and_then(|own| turn.filter(|it| closes(it, own.idle)));
        PlaceInCycle { closing, ..PlaceInCycle::default() }
    }
}

//! The graph of a system's structural zeros: its nodes are modes with the zeros that hold at their
//! entry, and its edges are events.
//!
//! The structural zeros at the entry of a segment depend on the events that led there, not on
//! numbers. A run therefore follows a path in a small graph, each node of which is computed once.

use super::impact::{Impacts, rests};
use super::mode_residues::ModeResidues;
use super::residue::{Residues, row_times};
use super::space::ZeroSpace;
use crate::affine::model::system::System;
use std::collections::HashMap;
use std::sync::Arc;

/// The number of nodes at which all are discarded: a system that counts its own events has a new
/// node at each of them.
const MAX_NODES: usize = 4096;

/// An event: the `until` that ends the mode, the zeros there, and whether it is at the instant at
/// which the mode was entered. The limit at which an `until` accumulates is numbered after all
/// `until`: all zeros of the mode's entry hold there, with the guard and its rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Firing {
    pub until: usize,
    pub zero: ZeroGuards,
    pub at_entry: bool,
}

/// The guards that are zero at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ZeroGuards {
    /// The guards, as bits.
    pub guards: u64,
    /// One of them that is zero at a rational point of the circle, and the number of that point.
    pub point: Option<(usize, usize)>,
}

/// A node of the graph: a mode with the space of structural zeros at its entry.
#[derive(Clone, Debug)]
pub struct Node {
    pub mode: usize,
    zeros: ZeroSpace,
    /// The structural zeros that last along the segment.
    lasting: ZeroSpace,
    /// For each guard: the order of its first derivative that is not a structural zero at entry;
    /// none if it stays zero.
    pub multiplicities: Arc<[Option<usize>]>,
    /// The arrivals that were asked for: there are few, and each event searches the list.
    arrivals: Vec<(Firing, Arrival)>,
    /// For instants that were asked for, the guards and the entries of z that are zero there.
    instants: Vec<(ZeroGuards, bool, [u64; 2])>,
    /// What [`ZeroGraph::cycle`] has found, where the node's mode has the turn.
    cycles: Vec<(Cycle, Option<[u64; 2]>)>,
    /// What [`ZeroGraph::returning_guard`] has found, for an `until` and the node that follows it.
    returning: Vec<(usize, usize, Option<usize>)>,
}

/// Impacts and turns that follow one another: each by the node before it and its `until`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    pub impact: (usize, usize),
    pub turn: (usize, usize),
}

/// The consequences of an event for the structural zeros.
#[derive(Clone, Debug)]
pub struct Arrival {
    /// For each successor: the order of its condition's first derivative that is not a structural
    /// zero; none if there is none, or no condition.
    pub orders: Arc<[Option<usize>]>,
    /// The changes by the event and by those that follow it, if it is an impact.
    pub impacts: Option<Impacts>,
    /// Whether the event leaves its guard and the rate of that at zero.
    pub rests: bool,
    /// The entries of z that are zero before the event's reset, as bits.
    pub zero_before: u64,
    /// The entries of z that are zero after the event, as bits.
    pub zero_entries: u64,
    after: ZeroSpace,
    nodes: Vec<Option<usize>>,
}

/// The graph of a system's structural zeros, as far as runs have explored it.
#[derive(Clone, Debug, Default)]
pub struct ZeroGraph {
    modes: Vec<ModeResidues>,
    nodes: Vec<Node>,
    known: HashMap<(usize, ZeroSpace), usize>,
    /// The number of times that all nodes were discarded.
    pub discards: u64,
}

impl ZeroGraph {
    /// The graph of a system, without a node; none if a coefficient has no residue.
    pub fn new(system: &System) -> Option<Self> {
        let states = system.states.len();
        let modes = system.modes.iter().map(|it| ModeResidues::new(it, states));
        let modes = modes.collect::<Option<_>>()?;
        Some(Self { modes, ..Self::default() })
    }

    #[inline]
    pub fn node(&self, node: usize) -> &Node {
        &self.nodes[node]
    }

    /// The node of a start: `known` if that is still the start's node.
    pub fn at_start(&mut self, mode: usize, zeros: &ZeroSpace, known: Option<usize>) -> usize {
        let same = |node: &usize| {
            self.nodes.get(*node).is_some_and(|it| it.mode == mode && it.zeros == *zeros)
        };
        known.filter(same).unwrap_or_else(|| {
            self.make_room();
            self.intern(mode, zeros.clone())
        })
    }

    /// A space of zeros in a mode, with these guards of it as zeros too.
    pub fn with_guards(&self, mode: usize, zeros: &ZeroSpace, guards: u64) -> ZeroSpace {
        with_rows(zeros, &self.modes[mode], ZeroGuards { guards, point: None })
    }

    /// What is zero at an instant of a node's segment, or at its entry, where these guards are.
    pub fn zeros_with(&self, node: usize, zero: ZeroGuards, at_entry: bool) -> ZeroSpace {
        let node = &self.nodes[node];
        with_rows(node.zeros_at(at_entry), &self.modes[node.mode], zero)
    }

    /// The guards that are zero at an event because the given ones are, which are included.
    #[inline]
    pub fn tied_guards(&mut self, node: usize, zero: ZeroGuards, at_entry: bool) -> u64 {
        self.zeros_there(node, zero, at_entry)[0]
    }

    /// The entries of z that are zero at an event because the given guards are, as bits.
    #[inline]
    pub fn zero_entries(&mut self, node: usize, zero: ZeroGuards, at_entry: bool) -> u64 {
        self.zeros_there(node, zero, at_entry)[1]
    }

    fn zeros_there(&mut self, node: usize, zero: ZeroGuards, at_entry: bool) -> [u64; 2] {
        let node = &mut self.nodes[node];
        let known = node.instants.iter().find(|it| (it.0, it.1) == (zero, at_entry));
        if let Some((.., zeros)) = known {
            return *zeros;
        }
        let mode = &self.modes[node.mode];
        let space = with_rows(node.zeros_at(at_entry), mode, zero);
        let also = |n: &usize| space.contains(&mode.guards[*n]);
        let tied = (0..mode.guards.len()).filter(also).fold(zero.guards, |mask, n| mask | 1 << n);
        let zeros = [tied, space.zero_entries(mode.matrix.len())];
        node.instants.push((zero, at_entry, zeros));
        zeros
    }

    /// The consequences of an event at a node, computed once.
    #[inline]
    pub fn arrival(&mut self, node: usize, firing: Firing) -> &mut Arrival {
        let Self { modes, nodes, .. } = self;
        let node = &mut nodes[node];
        let known = node.arrivals.iter().position(|(it, _)| *it == firing);
        let at = known.unwrap_or_else(|| {
            node.arrivals.push((firing, arrival_of(modes, node, firing)));
            node.arrivals.len() - 1
        });
        &mut node.arrivals[at].1
    }

    /// The guards that impacts and turns keep inside, as bits: those of the impact's mode, and
    /// those of the turn's. None if the turn is none of the impact.
    ///
    /// With the guard h of the impact, the reset of a turn changes nothing, its guard is a multiple
    /// of h' in its mode, where h' begins as in the impact's, and h' is zero in the impact's mode,
    /// in whose node it has arrived. Guards that are multiples of h', or in the turn's mode of h,
    /// keep the sign that they have at first.
    pub fn kept_inside(&mut self, cycle: Cycle) -> Option<[u64; 2]> {
        let between = cycle.turn.0;
        if let Some((_, found)) = self.nodes[between].cycles.iter().find(|it| it.0 == cycle) {
            return *found;
        }
        let nodes = [cycle.impact.0, between].map(|node| &self.nodes[node]);
        let found = kept_inside(&self.modes, nodes, [cycle.impact.1, cycle.turn.1]);
        self.nodes[between].cycles.push((cycle, found));
        found
    }

    /// A guard of an `until` of the node that follows an event whose reset changes nothing: one
    /// that was zero at the entry of the node before it, and whose rate is zero after the event.
    #[inline]
    pub fn returning_guard(&mut self, node: usize, until: usize, next: usize) -> Option<usize> {
        let asked = |it: &&(usize, usize, Option<usize>)| (it.0, it.1) == (until, next);
        if let Some((.., found)) = self.nodes[node].returning.iter().find(asked) {
            return *found;
        }
        let (from, to) = (&self.nodes[node], &self.nodes[next]);
        let own = &self.modes[to.mode];
        let comes_back = |n: &usize| {
            let guard = &own.guards[*n];
            from.zeros.contains(guard)
                && !to.zeros.contains(guard)
                && to.zeros.contains(&row_times(guard, &own.matrix))
        };
        let unchanged = self.modes[from.mode].changes_nothing.get(until) == Some(&true);
        let found = (0..own.until()).find(comes_back).filter(|_| unchanged);
        self.nodes[node].returning.push((until, next, found));
        found
    }

    /// Whether nothing depends on states, given as bits, but they themselves in the mode of a node.
    #[inline]
    pub fn are_idle(&self, node: usize, states: u64) -> bool {
        states & !self.modes[self.nodes[node].mode].idle == 0
    }

    /// Whether two nodes are of one mode with the same zeros, but for those of some states, given
    /// as bits.
    #[inline]
    pub fn are_alike(&self, [one, other]: [usize; 2], but: u64) -> bool {
        let same = |one: &Node, other: &Node| {
            one.mode == other.mode && one.zeros.without(but) == other.zeros.without(but)
        };
        one == other || but != 0 && same(&self.nodes[one], &self.nodes[other])
    }

    /// The node that follows an event by the successor of this index.
    #[inline]
    pub fn enter(&mut self, node: usize, firing: Firing, successor: usize) -> usize {
        let mode = self.modes[self.nodes[node].mode].next[firing.until][successor].1;
        let arrival = self.arrival(node, firing);
        if let Some(known) = arrival.nodes[successor] {
            return known;
        }
        let after = arrival.after.clone();
        if self.make_room() {
            return self.intern(mode, after);
        }
        let next = self.intern(mode, after);
        self.arrival(node, firing).nodes[successor] = Some(next);
        next
    }

    /// Forgets all nodes where there are too many, and says whether it does.
    fn make_room(&mut self) -> bool {
        let is_full = self.nodes.len() >= MAX_NODES;
        if is_full {
            self.nodes.clear();
            self.known.clear();
            self.discards += 1;
        }
        is_full
    }

    fn intern(&mut self, mode: usize, zeros: ZeroSpace) -> usize {
        if let Some(known) = self.known.get(&(mode, zeros.clone())) {
            return *known;
        }
        let ModeResidues { matrix, guards, .. } = &self.modes[mode];
        let multiplicity = |guard: &Residues| zeros.multiplicity(guard, matrix);
        let node = Node {
            mode,
            lasting: zeros.invariant(matrix),
            multiplicities: guards.iter().map(multiplicity).collect(),
            zeros: zeros.clone(),
            arrivals: Vec::new(),
            instants: Vec::new(),
            cycles: Vec::new(),
            returning: Vec::new(),
        };
        self.nodes.push(node);
        self.known.insert((mode, zeros), self.nodes.len() - 1);
        self.nodes.len() - 1
    }
}

impl Node {
    /// The structural zeros at entry.
    pub fn zeros(&self) -> &ZeroSpace {
        &self.zeros
    }

    /// The structural zeros just before an event: at the instant of entry those of the entry.
    fn zeros_at(&self, entry: bool) -> &ZeroSpace {
        if entry { &self.zeros } else { &self.lasting }
    }
}

fn arrival_of(modes: &[ModeResidues], node: &Node, firing: Firing) -> Arrival {
    let own = &modes[node.mode];
    let mut zeros = with_rows(node.zeros_at(firing.at_entry), own, firing.zero);
    let limit = firing.until.checked_sub(own.until());
    if let Some(guard) = limit.map(|until| &own.guards[until]) {
        zeros.insert(&row_times(guard, &own.matrix));
    }
    let after = zeros.after(&own.resets[firing.until]);
    let next = &own.next[firing.until];
    let order = |(when, mode): &(Option<Residues>, usize)| {
        when.as_ref().and_then(|row| after.multiplicity(row, &modes[*mode].matrix))
    };
    let is_limit = limit.is_some();
    let zeros_around = [&zeros, &after];
    let impacts = if is_limit { None } else { Impacts::of(modes, own, firing.until, zeros_around) };
    Arrival {
        orders: next.iter().map(order).collect(),
        impacts,
        rests: !is_limit && rests(own, firing.until, &after),
        zero_before: zeros.zero_entries(own.matrix.len()),
        zero_entries: after.zero_entries(own.matrix.len()),
        nodes: vec![None; next.len()],
        after,
    }
}

fn with_rows(zeros: &ZeroSpace, mode: &ModeResidues, zero: ZeroGuards) -> ZeroSpace {
    let mut zeros = zeros.clone();
    for (_, guard) in mode.guards.iter().enumerate().filter(|(n, _)| zero.guards >> n & 1 == 1) {
        zeros.insert(guard);
    }
    if let Some((guard, point)) = zero.point {
        mode.points[guard][point].iter().for_each(|row| zeros.insert(row));
    }
    zeros
}

fn kept_inside(
    modes: &[ModeResidues],
    [before, between]: [&Node; 2],
    [impact, turn]: [usize; 2],
) -> Option<[u64; 2]> {
    let (own, other) = (&modes[before.mode], &modes[between.mode]);
    let guard = &own.guards[impact];
    let [rate, other_rate] = [own, other].map(|mode| row_times(guard, &mode.matrix));
    let apart: Residues = rate.iter().zip(&other_rate).map(|(a, b)| a.minus(*b)).collect();
    let kept = |node: &Node, mode: &ModeResidues, rows: &[&Residues]| {
        let is_kept = |row: &Residues| rows.iter().any(|it| node.lasting.ratio(row, it).is_some());
        let all = mode.guards.iter().enumerate().filter(|(_, row)| is_kept(row));
        all.fold(0, |mask, (n, _)| mask | 1 << n)
    };
    let is_turn = other.changes_nothing[turn]
        && between.zeros.contains(&apart)
        && before.zeros.contains(&rate)
        && between.lasting.ratio(&other.guards[turn], &other_rate).is_some();
    is_turn.then(|| [kept(before, own, &[&rate]), kept(between, other, &[&other_rate, guard])])
}

//! Events of an instant that are only counted and that other records of the instant come before.

use super::continuation::{Exact, Named};
use super::pending::Pending;
use super::walk::{Said, Walk};
use crate::engine::Event;
use crate::score::worst;

impl Walk<'_> {
    /// Waits for an exact event, unless the record before did.
    pub(super) fn await_event(&mut self, exact: &Exact) {
        let name = self.judge.name(self.place.mode, exact.named.event);
        if self.pending.iter().any(|it| it.name == name) {
            return;
        }
        let (stretch, guard) = (self.place.stretch(exact.elapsed), exact.named.event);
        let deadline = exact.elapsed + self.units.allowed_time(&stretch, guard);
        let k = self.units.allowance.state * self.units.tolerance();
        let sizes = self.units.sizes_after(&exact.state, &stretch, guard);
        let allowed = sizes.into_iter().map(|size| k * size).collect();
        self.pending.push(Pending { name, exact: exact.clone(), deadline, allowed });
    }

    /// Takes the awaited event that a record tells.
    pub(super) fn take_pending(&mut self, named: Named) -> Option<Pending> {
        let name = self.judge.name(self.place.mode, named.event);
        let place = self.pending.iter().position(|it| it.name == name)?;
        Some(self.pending.swap_remove(place))
    }

    /// Judges the record of an awaited event. It may have the state of its own crossing, from which
    /// the records since have gone on: then the run stays where they left it.
    pub(super) fn judge_awaited(&mut self, event: &Event, named: Named, pending: &Pending) -> Said {
        let off = event.state.iter().zip(&pending.exact.state).zip(&pending.allowed);
        let defect = worst(off.map(|((own, exact), allowed)| (own - exact).abs() / allowed));
        let is_of_the_crossing = defect <= 1.0 && named.next == self.place.mode;
        let (said, defects) = self.own_event_of(event, named);
        if matches!(said, Said::Wrong(..)) && is_of_the_crossing {
            self.stays = true;
            return Said::Right;
        }
        self.found.defects.append(defects);
        said
    }

    /// Counts the events as missed that had to come by now.
    pub(super) fn expire(&mut self, n: usize, event: &Event, now: f64) {
        let (over, open) = std::mem::take(&mut self.pending)
            .into_iter()
            .partition(|it: &Pending| it.deadline < now);
        self.pending = open;
        for pending in over {
            self.count_missed(n, Some(event), pending.exact);
        }
    }
}

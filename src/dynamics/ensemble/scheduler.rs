//! The scheduler of an ensemble: phases of one kind are solved together, one motion in each lane.
//!
//! So many motions are under way that some kind always fills a vector, until there are no more to
//! begin. Which motions share a vector depends on the order in which their phases end; their
//! results do not.

use super::cursor::Cursor;
use super::slot::Slot;
use super::{Done, Member, Tally, Watcher};
use crate::lanes::{Batch, LaneTask, MAX_LANES, Permit};
use crate::model::Model;

/// The motions of one thread.
pub struct LaneScheduler<'a, W> {
    permit: Permit,
    slots: Vec<Option<Slot<'a, W>>>,
    free: Vec<usize>,
    /// Slots by the task that they wait for.
    waiting: [Vec<usize>; LaneTask::ALL.len()],
    batch: Box<Batch>,
    /// The model whose constants each lane of the batch has.
    shaped: Vec<Option<&'a Model>>,
    done: Vec<(usize, W)>,
    tally: Tally,
}

impl<'a, W: Watcher> LaneScheduler<'a, W> {
    pub fn new(permit: Permit) -> Self {
        // With one less than a vector waiting for each task and one motion more, some vector is
        // full.
        let slots = LaneTask::ALL.len() * permit.width();
        Self {
            permit,
            slots: (0..slots).map(|_| None).collect(),
            free: (0..slots).collect(),
            waiting: Default::default(),
            batch: Box::default(),
            shaped: vec![None; permit.width()],
            done: Vec::new(),
            tally: Tally::default(),
        }
    }

    /// Follows motions as long as there is a next one; returns their numbers and watchers.
    pub fn follow(
        mut self,
        next: &mut dyn FnMut() -> Option<usize>,
        begin: &impl Fn(usize) -> Member<'a, W>,
    ) -> Done<W> {
        let mut more = true;
        loop {
            while more && let Some(place) = self.free.pop() {
                match next() {
                    Some(number) => self.enter(place, number, Cursor::new(begin(number))),
                    None => {
                        more = false;
                        self.free.push(place);
                    }
                }
            }
            let fullest =
                LaneTask::ALL.into_iter().max_by_key(|it| self.waiting[*it as usize].len());
            match fullest {
                Some(task) if !self.waiting[task as usize].is_empty() => self.work(task),
                _ => return Done { watchers: self.done, tally: self.tally },
            }
        }
    }

    fn enter(&mut self, place: usize, number: usize, cursor: Cursor<'a, W>) {
        let mut slot = Slot::new(number, cursor);
        let task = slot.next_task();
        self.slots[place] = Some(slot);
        self.queue(place, task);
    }

    fn queue(&mut self, place: usize, task: Option<LaneTask>) {
        match task {
            Some(task) => self.waiting[task as usize].push(place),
            None => {
                if let Some((number, watcher, tally)) = self.slots[place].take().map(Slot::leave) {
                    self.done.push((number, watcher));
                    self.tally.add(tally);
                }
                self.free.push(place);
            }
        }
    }

    /// Solves one batch of a task. Lanes without a motion repeat what they had.
    fn work(&mut self, task: LaneTask) {
        let waiting = &mut self.waiting[task as usize];
        let rest = waiting.len().saturating_sub(self.permit.width());
        let taken = waiting.len() - rest;
        let mut places = [0; MAX_LANES];
        places[..taken].copy_from_slice(&waiting[rest..]);
        waiting.truncate(rest);
        let places = &places[..taken];
        for (lane, place) in places.iter().enumerate() {
            let Some(slot) = &self.slots[*place] else { continue };
            let model = slot.model();
            if !self.shaped[lane].is_some_and(|it| std::ptr::eq(it, model)) {
                slot.shape(lane, &mut self.batch.shape);
                self.shaped[lane] = Some(model);
            }
            slot.begin(task, lane, &mut self.batch.begin);
        }
        self.permit.work(task, &mut self.batch);
        for (lane, place) in places.iter().enumerate() {
            let Some(slot) = &mut self.slots[*place] else { continue };
            let task = slot.advance(task, lane, &self.batch.end);
            self.queue(*place, task);
        }
    }
}

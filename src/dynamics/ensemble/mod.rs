//! Many motions, each looked at once a forcing period until its watcher has seen enough: starts by
//! the thousand, or one start at many parameters.
//!
//! Motions share nothing, so that every result is the same for any number of threads (feature
//! `parallel`). With the feature `lanes` several are solved at once in the vectors of the processor
#![cfg_attr(feature = "lanes", doc = "([`crate::lanes`]).")]
#![cfg_attr(not(feature = "lanes"), doc = "(`percuss::lanes`).")]

mod cursor;
#[cfg(feature = "lanes")]
mod scheduler;
#[cfg(feature = "lanes")]
mod slot;

#[cfg(feature = "lanes")]
use crate::lanes::Instructions;
use crate::model::Model;
use crate::model::entry::Entry;
use crate::model::instant::Instant;
use crate::run::exit::Endless;
use cursor::Cursor;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An observer of the strobes of one motion.
pub trait Watcher {
    /// The next strobe, and why the phase that it lies in has no end, where that is proved. A
    /// motion has no end of its own: it is followed until this breaks, or into an undecidable
    /// phase.
    fn see(&mut self, strobe: &Entry, endless: Option<Endless>) -> ControlFlow<()>;

    /// A phase begins, by a switch; what was due before it has been seen.
    fn enter(&mut self, _phase: &Entry) {}
}

/// One motion of an ensemble.
#[derive(Clone, Debug)]
pub struct Member<'a, W> {
    /// The model that is followed.
    pub model: &'a Model,
    /// The entry at which the motion begins.
    pub entry: Entry,
    /// The motion's first strobe, not before its entry; the others follow at whole forcing periods.
    pub first: Instant,
    /// The instant after which no event need be found; it is not before the last strobe that the
    /// watcher reads.
    pub horizon: Option<Instant>,
    /// The watcher of its strobes.
    pub watcher: W,
}

/// How many phases of an ensemble were solved in lanes and how many one by one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// The phases that were solved in lanes.
    pub in_lanes: u64,
    /// The phases that were solved one by one: those that no lane has proved, those of models whose
    /// closed form lanes do not have, and starts away from the slider.
    pub alone: u64,
}

/// Follows motions number 0 to `count`, by the widest instructions that there are; the watchers
/// come back in order.
pub fn follow<'a, W: Watcher + Send>(
    count: usize,
    begin: impl Fn(usize) -> Member<'a, W> + Sync,
) -> Vec<W> {
    #[cfg(feature = "lanes")]
    return follow_by(Instructions::widest(), count, begin).0;
    #[cfg(not(feature = "lanes"))]
    on_all_threads(count, |next| follow_one_by_one(next, &begin)).0
}

/// Follows the motions as [`follow`] does, by these instructions, and counts how their phases were
/// solved.
#[cfg(feature = "lanes")]
pub fn follow_by<'a, W: Watcher + Send>(
    instructions: Instructions,
    count: usize,
    begin: impl Fn(usize) -> Member<'a, W> + Sync,
) -> (Vec<W>, Tally) {
    on_all_threads(count, |next| match instructions.permit() {
        Some(permit) => scheduler::LaneScheduler::new(permit).follow(next, &begin),
        None => follow_one_by_one(next, &begin),
    })
}

/// Follows one motion by the scalar solver.
pub fn follow_alone<W: Watcher>(motion: Member<'_, W>) -> W {
    Cursor::new(motion).watched_alone().0
}

/// The results of one thread.
struct Done<W> {
    /// Motions by their numbers.
    watchers: Vec<(usize, W)>,
    tally: Tally,
}

fn follow_one_by_one<'a, W: Watcher>(
    next: &mut dyn FnMut() -> Option<usize>,
    begin: &impl Fn(usize) -> Member<'a, W>,
) -> Done<W> {
    let mut done = Done { watchers: Vec::new(), tally: Tally::default() };
    while let Some(number) = next() {
        let (watcher, phases) = Cursor::new(begin(number)).watched_alone();
        done.watchers.push((number, watcher));
        done.tally.alone += phases;
    }
    done
}

/// Lets every thread take the next motion as it gets ready for it.
fn on_all_threads<W: Send>(
    count: usize,
    work: impl Fn(&mut dyn FnMut() -> Option<usize>) -> Done<W> + Sync,
) -> (Vec<W>, Tally) {
    let taken = AtomicUsize::new(0);
    let thread = |_| {
        work(&mut || {
            let number = taken.fetch_add(1, Ordering::Relaxed);
            (number < count).then_some(number)
        })
    };
    #[cfg(feature = "parallel")]
    let done: Vec<Done<W>> = {
        use rayon::prelude::*;
        let threads = rayon::current_num_threads().min(count);
        (0..threads).into_par_iter().with_max_len(1).map(thread).collect()
    };
    #[cfg(not(feature = "parallel"))]
    let done = [thread(0)];
    let mut tally = Tally::default();
    let mut all = Vec::with_capacity(count);
    for one in done {
        tally.add(one.tally);
        all.extend(one.watchers);
    }
    all.sort_unstable_by_key(|(number, _)| *number);
    (all.into_iter().map(|(_, watcher)| watcher).collect(), tally)
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.in_lanes += other.in_lanes;
        self.alone += other.alone;
    }
}

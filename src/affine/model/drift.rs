//! States that only add up what the others do, such as a distance that is gone: a motion from
//! anywhere along them is the same motion.

use super::system::{Mode, System};

impl System {
    /// The indices of the states on which nothing depends, not even they themselves: no rate, no
    /// guard, no condition and no reset but the one that keeps them or adds to them.
    ///
    /// ```
    /// use percuss::System;
    ///
    /// let system = System::from_toml(r#"
    ///     schema = 1
    ///     name = "walk"
    ///     states = ["gone", "x"]
    ///     [[mode]]
    ///     name = "going"
    ///     equations = ["gone' = x", "x' = 1 - x"]
    /// "#)?;
    /// assert_eq!(system.drifts(), [0]);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn drifts(&self) -> Vec<usize> {
        let drifts = |n: &usize| self.modes.iter().all(|it| it.ignores(*n));
        (0..self.states.len()).filter(drifts).collect()
    }
}

impl Mode {
    /// Whether the mode's motion, guards and events are the same wherever this state is.
    fn ignores(&self, n: usize) -> bool {
        let watched = self.watch.iter().map(|it| &it.guard);
        let guards = self.until.iter().map(|it| &it.guard).chain(watched);
        let conditions =
            self.until.iter().flat_map(|it| &it.next).filter_map(|it| it.when.as_ref());
        let mut rows = self.matrix.iter().chain(guards).chain(conditions);
        let resets = self.until.iter().flat_map(|it| it.reset.iter().enumerate());
        let mut resets =
            resets.map(|(k, row)| if k == n { row[n].is_one() } else { row[n].is_zero() });
        rows.all(|row| row[n].is_zero()) && resets.all(|keeps| keeps)
    }
}

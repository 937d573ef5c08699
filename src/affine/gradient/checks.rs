//! What a walk refuses: zeros that do not hold to first order, and what its bits leave open.

use super::ball::{Ball, Jet, dot};
use super::derivative::{NoGradient, Side};
use super::first_order::{InstantZeros, VariedRow};
use super::walk::Walk;
use crate::affine::model::system::{Mode, Row, Successor, row_times};
use crate::numeric::number::Number;

/// How a row begins at the entry of a mode.
enum Begin {
    /// It is zero to first order, and stays so.
    Zero,
    /// The sign that it has on both sides of the name's value.
    At { is_positive: bool },
    /// The sign that it has beside the name's value, on the side that is followed, and the one that
    /// it takes after the entry for the value itself, by its derivative of this order.
    Beside { was: bool, is_positive: bool, order: usize },
}

impl<T: Number> Walk<'_, T> {
    /// Refuses an instant at which another guard may be zero, unless it is so to first order.
    pub(super) fn check_others(
        &self,
        fired: usize,
        zeros: &InstantZeros,
    ) -> Result<(), NoGradient> {
        self.check_guards(Some(fired), |row| zeros.contain(row))
    }

    /// Refuses an instant between two events at which a guard may be zero, unless it is so to first
    /// order along the segment.
    pub(super) fn check_along(&self) -> Result<(), NoGradient> {
        self.check_guards(None, |row| self.zeros.lasts(row))
    }

    fn check_guards(
        &self,
        fired: Option<usize>,
        is_zero: impl Fn(&VariedRow<'_>) -> Result<bool, NoGradient>,
    ) -> Result<(), NoGradient> {
        for (n, guard) in self.modes[self.mode].guards.iter().enumerate() {
            if fired == Some(n) || dot(guard, &self.state).value.sign().is_some() {
                continue;
            }
            if !is_zero(&self.guard(self.mode, n))? {
                return Err(NoGradient::Undecided);
            }
        }
        Ok(())
    }

    /// Refuses an entry at which a guard is zero and not so to first order, and finds those of
    /// `until` that fire there.
    pub(super) fn check_entry(&mut self) -> Result<(), NoGradient> {
        self.fires = 0;
        let until = self.solver.system().modes[self.mode].until.len();
        let mut crosses = 0;
        for n in 0..self.modes[self.mode].guards.len() {
            match self.begin_in(self.mode, &self.guard(self.mode, n))? {
                Begin::At { is_positive: true, .. } if n < until => self.fires |= 1 << n,
                Begin::Beside { was: true, is_positive: false, order: 1 } if n < until => {
                    // It fired at once, and beside the name's value it crosses shortly after.
                    crosses += 1;
                }
                Begin::Beside { was, is_positive, .. } => {
                    let stays = was == is_positive && !(n < until && was);
                    if !stays {
                        return Err(NoGradient::OtherEvents);
                    }
                }
                _ => {}
            }
        }
        // Of several that fire at once the order beside the value is another question.
        let is_one = crosses == 0 || crosses == 1 && self.fires == 0;
        if is_one { Ok(()) } else { Err(NoGradient::OtherEvents) }
    }

    /// Refuses a choice of a successor that is not the same to first order.
    pub(super) fn check_successor(&self, mode: usize, until: usize) -> Result<(), NoGradient> {
        fn next(modes: &[Mode], [mode, until]: [usize; 2]) -> &[Successor] {
            &modes[mode].until[until].next
        }
        let event = [mode, until];
        let nearby = self.tangent.nearby.as_ref().map(|it| next(&it.modes, event));
        let own = next(&self.solver.system().modes, event);
        self.check_choice([own, next(&self.tangent.modes, event)], nearby)
    }

    /// Refuses a mode of the start that its conditions do not choose to first order.
    pub(super) fn check_start_mode(&self) -> Result<(), NoGradient> {
        let nearby = self.tangent.nearby.as_ref().map(|it| &it.start_modes[..]);
        let own = &self.solver.system().start_modes;
        self.check_choice([own, &self.tangent.start_modes], nearby)
    }

    fn check_choice(
        &self,
        [own, rates]: [&[Successor]; 2],
        nearby: Option<&[Successor]>,
    ) -> Result<(), NoGradient> {
        for (n, (own, rate)) in own.iter().zip(rates).enumerate() {
            let (Some(row), Some(rate)) = (&own.when, &rate.when) else { return Ok(()) };
            let nearby = nearby.and_then(|it| it.get(n)?.when.as_ref());
            // The condition is decided in the mode that it would begin.
            let is_chosen = match self.begin_in(own.mode, &VariedRow { row, rate, nearby })? {
                Begin::Beside { was, is_positive, .. } if was != is_positive => {
                    return Err(NoGradient::OtherEvents);
                }
                Begin::At { is_positive } | Begin::Beside { is_positive, .. } => is_positive,
                Begin::Zero => false,
            };
            if is_chosen {
                return Ok(());
            }
        }
        Ok(())
    }

    /// How a row begins at the entry of a mode, by the first of its derivatives that is not zero to
    /// first order.
    fn begin_in(&self, mode: usize, varied: &VariedRow<'_>) -> Result<Begin, NoGradient> {
        let Some(order) = self.zeros.multiplicity(varied, mode)? else { return Ok(Begin::Zero) };
        let VariedRow { row, rate, .. } = *varied;
        let matrix = &self.solver.system().modes[mode].matrix;
        let mut derivative = (0..order).fold(row.clone(), |row, _| row_times(&row, matrix));
        if !self.zeros.is_zero_at_entry(&derivative) {
            let is_positive = self.is_positive(&derivative)?;
            return Ok(Begin::At { is_positive });
        }
        let side = self.side.filter(|_| order == 0).ok_or(NoGradient::OneSided)?;
        let moved: Vec<Jet<T>> = row.iter().zip(rate).map(|(a, b)| Jet::new(a, b)).collect();
        let moves_up = dot(&moved, &self.state).rate.sign().ok_or(NoGradient::Undecided)?;
        let is_positive = moves_up == (side == Side::Above);
        for order in 1..=matrix.len() {
            derivative = row_times(&derivative, matrix);
            if !self.zeros.is_zero_at_entry(&derivative) {
                let was = self.is_positive(&derivative)?;
                return Ok(Begin::Beside { was, is_positive, order });
            }
        }
        Err(NoGradient::OtherEvents)
    }

    fn is_positive(&self, row: &Row) -> Result<bool, NoGradient> {
        let row: Vec<Jet<T>> = row.iter().map(|it| Jet::fixed(Ball::new(it))).collect();
        dot(&row, &self.state).value.sign().ok_or(NoGradient::Undecided)
    }
}

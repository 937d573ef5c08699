//! Start states as users give them, and the phase in which they begin.

use crate::crossing::allowances::FOUR_ULPS;
use crate::error::InputError;
use crate::flow::constants::Constants;
use crate::model::Model;
use crate::model::entry::{Entry, ModeEntry};
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::parameters::within;
use crate::phase::Phase;
use crate::state::State;

/// A start: `cycle` forcing periods after `tau`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Start {
    /// Time, -1e15 to 1e15.
    pub tau: f64,
    /// Forcing periods after `tau`, up to 2^53 in size.
    pub cycle: i64,
    /// Displacement of the mass, -1e9 to 1e9.
    pub p: f64,
    /// The velocity of the mass, -1e9 to 1e9.
    pub y: f64,
    /// Displacement of the slider's top, -1e9 to 1e9; where not given, the slider touches a mass at
    /// p >= g and is at rest otherwise.
    pub q: Option<f64>,
    /// Drift, -1e9 to 1e9.
    pub v: f64,
    /// The phase, for states copied from rounded tables.
    pub phase: Option<Phase>,
}

/// The largest distance by which a stated phase may move what was given.
const MAX_PROJECTION: f64 = 1e-4;

impl Model {
    /// Checks a start and decides its phase.
    ///
    /// # Errors
    /// [`InputError`] names what is out of range, a mass beyond the slider's top, or a stated phase
    /// further than 1e-4 from the state.
    pub fn start(&self, start: &Start) -> Result<Entry, InputError> {
        check(start)?;
        let instant = Instant::at(self.parameters().omega, start.tau, start.cycle);
        let g = self.parameters().g;
        let q = start.q.unwrap_or(if start.p >= g { start.p - g } else { 0.0 });
        let state = State { p: start.p, y: start.y, q };
        let (state, mode) = match start.phase {
            None => self.decide_phase(state, &instant)?,
            Some(phase) => self.project(state, phase, &instant)?,
        };
        Ok(Entry { instant, state, drift: TwoWord::new(start.v), mode })
    }

    /// The entry in `state` at `instant` with no drift; its phase is decided as for a [`Start`]
    /// that states none.
    ///
    /// # Errors
    /// [`InputError`] names what is out of range, or a mass beyond the slider's top.
    pub fn entry(&self, instant: Instant, state: State) -> Result<Entry, InputError> {
        check_size(&state)?;
        let (state, mode) = self.decide_phase(state, &instant)?;
        Ok(Entry { instant, state, drift: TwoWord::ZERO, mode })
    }

    fn decide_phase(
        &self,
        state: State,
        instant: &Instant,
    ) -> Result<(State, ModeEntry), InputError> {
        let g = self.parameters().g;
        let scale = state.p.abs().max(state.q.abs()).max(g);
        let limit = state.q + g;
        if (state.p - limit).abs() <= FOUR_ULPS * scale {
            return Ok(ModeEntry::on_surface(
                self.constants(),
                state,
                None,
                self.harmonic_force(instant),
            ));
        }
        if state.p > limit {
            return Err(InputError::Penetrates { p: state.p, limit });
        }
        Ok((state, ModeEntry::Apart))
    }

    /// Projects a rounded state onto where its phase can begin.
    fn project(
        &self,
        given: State,
        phase: Phase,
        instant: &Instant,
    ) -> Result<(State, ModeEntry), InputError> {
        let State { y, q, .. } = given;
        let Constants { two_xi, rate, g, .. } = *self.constants();
        let force = two_xi * y + q;
        let at = |y: f64, q: f64| State { p: q + g, y, q };
        let on = |threshold: f64, state: State| {
            let force = self.harmonic_force(instant);
            (state, ModeEntry::on_threshold(self.constants(), &state, threshold, force))
        };
        let (state, mode) = match phase {
            Phase::NoContact => {
                let near =
                    (given.p - (q + g)).abs() <= MAX_PROJECTION && force.abs() <= MAX_PROJECTION;
                if !near {
                    return self.no_contact_entry(given, instant);
                }
                on(0.0, at(y, -(two_xi * y)))
            }
            Phase::Contact => {
                let settled = force.clamp(0.0, 1.0);
                let state = at(if settled == force { y } else { (settled - q) / two_xi }, q);
                if settled == 0.0 || settled == 1.0 {
                    on(settled, state)
                } else {
                    (state, ModeEntry::Contact { offset: settled, reference: 0.0 })
                }
            }
            Phase::Progression if force <= 1.0 => on(1.0, at((1.0 - q) * rate, q)),
            Phase::Progression => {
                let state = at(y, q);
                (state, ModeEntry::slipping(self.constants(), &state))
            }
        };
        check_near(phase, "p", given.p, state.p)?;
        check_near(phase, "q", given.q, state.q)?;
        check_near(phase, "y", given.y, state.y)?;
        Ok((state, mode))
    }

    /// A start stated to be without contact and not at a separation must be so.
    fn no_contact_entry(
        &self,
        state: State,
        instant: &Instant,
    ) -> Result<(State, ModeEntry), InputError> {
        let (settled, mode) = self.decide_phase(state, instant)?;
        match mode {
            ModeEntry::Apart | ModeEntry::Separation { .. } => Ok((settled, mode)),
            // In contact: the force would have to fall to zero.
            _ => Err(InputError::FarFromPhase {
                phase: Phase::NoContact,
                name: "q",
                from: state.q,
                to: -(self.constants().two_xi * state.y),
            }),
        }
    }
}

fn check_near(phase: Phase, name: &'static str, from: f64, to: f64) -> Result<(), InputError> {
    // Written so that a NaN is refused.
    if (from - to).abs() <= MAX_PROJECTION {
        Ok(())
    } else {
        Err(InputError::FarFromPhase { phase, name, from, to })
    }
}

/// The sizes of a state's entries that are accepted, as errors say them.
const ACCEPTED_SIZES: &str = "-1e9 to 1e9";

fn check(start: &Start) -> Result<(), InputError> {
    within("tau", start.tau, -1e15, 1e15, "-1e15 <= tau <= 1e15")?;
    let limit = 1_i64 << 53;
    if !(-limit..=limit).contains(&start.cycle) {
        let value = start.cycle as f64;
        return Err(InputError::OutOfRange {
            name: "cycle",
            value,
            accepted: "-2^53 <= cycle <= 2^53",
        });
    }
    let q = start.q.unwrap_or(0.0);
    check_size(&State { p: start.p, y: start.y, q })?;
    within("v", start.v, -1e9, 1e9, ACCEPTED_SIZES)
}

fn check_size(state: &State) -> Result<(), InputError> {
    within("p", state.p, -1e9, 1e9, ACCEPTED_SIZES)?;
    within("y", state.y, -1e9, 1e9, ACCEPTED_SIZES)?;
    within("q", state.q, -1e9, 1e9, ACCEPTED_SIZES)
}

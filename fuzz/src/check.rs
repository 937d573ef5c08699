//! What every run must satisfy, whatever the input.

use crate::Case;
use percuss::{Exit, Leg, Model, Parameters, Phase, State};

/// Phases followed in one run.
const LEGS: usize = 20;

/// Longest run in units of 1/omega0, the time of the free oscillation.
const LONGEST: f64 = 200.0;

/// Rounding allowed in what is compared, in units of eps times the terms that went into it: the
/// closed forms claim 10 eps for a phase of at most one forcing period, and a switch adds as much.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// What the search itself grants to products that underflow.
const UNDERFLOW: f64 = 1e-285;

/// Evaluations a phase may take, whatever its length: a crossing bracketed by bisection from the
/// length of the phase down to one unit in the last place takes 60 at most (1100 where the left end
/// is zero), a near graze divided down to that size the same on both sides of each of two thresholds.
const FIXED: f64 = 1500.0;

/// Evaluations a phase may take for each forcing period it covers and each unit of natural time:
/// a certificate of degree eight reaches about a radian of the fastest harmonic, two where it is far
/// from the threshold, and halving finds such pieces with at most as many evaluations again; 64 a
/// period leave a factor of five.
const PER_PERIOD: f64 = 64.0;

/// Runs a case; an error says what is wrong.
///
/// # Errors
/// The first check that failed. A refused input is no error.
pub fn check(case: &Case) -> Result<(), String> {
    let model = Model::new(case.parameters).map_err(|error| format!("not in range: {error}"))?;
    let Ok(entry) = model.start(&case.start) else { return Ok(()) };
    // A phase without events costs up to a few evaluations a forcing period and, in contact, a
    // period of the free oscillation: 64 of the one, 200/2 pi of the other are honest work.
    let period = model.period();
    let periods = case.periods.min(LONGEST / period);
    let (whole, rest) = (periods.floor(), (periods.fract() * 1e6).floor());
    let horizon = entry.instant.after_periods(whole as u64 * 1_000_000 + rest as u64, 1_000_000);
    let mut trajectory = model.trajectory(entry).until(horizon);
    let mut history = History::new(&case.parameters);
    let mut spent = 0;
    for number in 0..LEGS {
        let Some(leg) = trajectory.next() else { break };
        let total = trajectory.counters().evaluations;
        history
            .leg(&model, &leg, total - spent, periods)
            .map_err(|fault| format!("leg {number} ({}): {fault}", leg.phase()))?;
        spent = total;
    }
    Ok(())
}

/// What earlier phases leave to be compared with.
struct History {
    parameters: Parameters,
    /// Phases of no length in a row.
    stuck: usize,
    /// q has been in [0, 1].
    settled: bool,
    /// Rounding room of q: of 2 xi y and q where the one was computed from the other.
    q_room: f64,
    /// The largest terms of y's closed forms so far.
    speed: f64,
}

macro_rules! ensure {
    ($holds:expr, $($text:tt)*) => {
        if !$holds {
            return Err(format!($($text)*));
        }
    };
}

impl History {
    fn new(parameters: &Parameters) -> Self {
        Self { parameters: *parameters, stuck: 0, settled: false, q_room: 0.0, speed: 0.0 }
    }

    fn leg(
        &mut self,
        model: &Model,
        leg: &Leg,
        evaluations: u64,
        periods: f64,
    ) -> Result<(), String> {
        let duration = leg.duration();
        ensure!(duration >= 0.0, "duration {duration:e}");
        let entry = leg.entry();
        ensure!(possible(&entry.state) && entry.v().is_finite(), "entry {entry:?}");
        let angle = entry.instant.angle();
        ensure!((0.0..=std::f64::consts::TAU).contains(&angle), "angle {angle:e}");

        let honest = FIXED + PER_PERIOD * (periods + periods * model.period());
        ensure!((evaluations as f64) < honest, "{evaluations} evaluations, {honest} are honest");

        self.stuck = if duration > 0.0 { 0 } else { self.stuck + 1 };
        ensure!(self.stuck < 3, "phases without length follow each other");

        // An endless phase is looked at as far as the run would have gone.
        let seen = duration.min(periods * model.period());
        for eighth in 0..=8 {
            self.sample(leg, seen * (f64::from(eighth) / 8.0))
                .map_err(|fault| format!("{fault}, {eighth}/8 of {seen:e}, from {entry:?}"))?;
        }
        if let Exit::Switch(next) = leg.exit() {
            ensure!(possible(&next.state) && next.v().is_finite(), "exit {next:?}");
            let legal = match (leg.phase(), next.phase()) {
                (before, after) if before == after => false,
                (Phase::Progression, after) => after == Phase::Contact,
                _ => true,
            };
            ensure!(legal, "after {duration:e} follows {}, {next:?}", next.phase());
            let room = self.drift_room(leg, duration);
            let fall = entry.v() - next.v();
            ensure!(fall <= room, "v falls by {fall:e} in {duration:e}, room {room:e}");
            ensure!(leg.phase() == Phase::Progression || fall == 0.0, "v moves by {fall:e}");
        }
        Ok(())
    }

    fn sample(&mut self, leg: &Leg, elapsed: f64) -> Result<(), String> {
        let Parameters { a, b, xi, omega, g, .. } = self.parameters;
        let two_xi = 2.0 * xi;
        let sample = leg.at(elapsed);
        let State { p, y, q } = sample.state;
        ensure!(possible(&sample.state) && sample.v.is_finite(), "sample {sample:?}");
        let from = leg.entry().state;
        // The terms of the closed forms: what was there, and what the force adds.
        let time = elapsed.min(1.0 / omega + 1.0 / omega / omega);
        let pushed = elapsed * (b.abs() * elapsed + a * time);
        let place =
            from.p.abs() + p.abs() + from.q.abs() + q.abs() + g + from.y.abs() * elapsed + pushed;
        // What y was rounded to in an earlier phase it keeps.
        self.speed = self.speed.max(self.speed_terms(leg, elapsed, y));
        let over = p - (q + g);
        // At the switch f is known to the rounding of its terms, up to 1; h' = f/(2 xi) passes it on as
        // long as q has not died out.
        let passed_on = (elapsed / two_xi).min(1.0);
        let room = ROUNDING * (place + passed_on) + UNDERFLOW;
        ensure!(over <= room, "p - (q + g) = {over:e}, room {room:e}, {sample:?}");
        if leg.phase() != Phase::NoContact {
            ensure!(over.abs() <= room, "p - (q + g) = {over:e} on the surface, room {room:e}");
            let force = two_xi * y + q;
            let speed = self.speed;
            let room = ROUNDING * (1.0 + place + two_xi * speed);
            let inside = match leg.phase() {
                Phase::Contact => force >= -room && force <= 1.0 + room,
                _ => force >= 1.0 - room,
            };
            ensure!(inside, "f = {force:e}, room {room:e}, {sample:?}");
        }
        // q returns to [0, 1] by itself; its rounding is that of its closed form's terms, and of
        // 2 xi y where it is imposed at the end of this phase or was at that of an earlier one.
        let in_place = (0.0..=1.0).contains(&q);
        let terms = 1.0 + place + two_xi * self.speed;
        self.q_room = self.q_room.max(ROUNDING * terms);
        if self.settled {
            let far = (-q).max(q - 1.0);
            ensure!(far <= self.q_room, "q = {q:e} left [0, 1] again, room {:e}", self.q_room);
        }
        self.settled |= in_place;
        let fall = leg.entry().v() - sample.v;
        let room = self.drift_room(leg, elapsed);
        ensure!(fall <= room, "v fell by {fall:e} in {elapsed:e}, room {room:e}");
        Ok(())
    }

    /// The terms of y's closed form: in contact what is forced dies out within 1/(2 xi).
    fn speed_terms(&self, leg: &Leg, elapsed: f64, y: f64) -> f64 {
        let Parameters { a, b, xi, omega, .. } = self.parameters;
        let forced = match leg.phase() {
            Phase::Contact => elapsed.min(1.0).min(0.5 / xi) * (a + b.abs() + 1.0),
            _ => elapsed.min(1.0 / omega) * a + elapsed * (b.abs() + 1.0),
        };
        y.abs() + leg.entry().state.y.abs() + forced
    }

    /// Rounding of v, and of the distance slipped.
    fn drift_room(&self, leg: &Leg, elapsed: f64) -> f64 {
        let Parameters { a, b, xi, omega, .. } = self.parameters;
        let entry = leg.entry();
        let slipped = if leg.phase() == Phase::Progression {
            let lag = (1.0 - entry.state.q).abs() * (elapsed / (2.0 * xi)).min(1.0);
            let push = elapsed * ((b - 1.0).abs() * elapsed + a * elapsed.min(1.0 / omega));
            entry.state.y.abs() * elapsed + lag + push
        } else {
            0.0
        };
        ROUNDING * (entry.v().abs() + slipped) + UNDERFLOW
    }
}

fn possible(state: &State) -> bool {
    state.p.is_finite() && state.y.is_finite() && state.q.is_finite()
}

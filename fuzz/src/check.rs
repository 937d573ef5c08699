//! The properties that every run must have, whatever the input.

use crate::one_sided::{Effort, OneSidedEnd, one_sided_end};
use crate::{Case, Family};
use percuss::affine::DoubleDouble;
use percuss::insides::crossing::limit::{
    EVALUATIONS_PER_RADIAN, GRANTED_EVALUATIONS, LAST_ROOT_EVALUATIONS, MAX_EVALUATIONS,
};
use percuss::{Exit, Model, Parameters, Phase, Segment, State};

/// Phases followed in one run.
const SEGMENTS: usize = 20;

/// Longest run in units of 1/omega0, the time of the free oscillation.
const MAX_RUN_TIME: f64 = 200.0;

/// Rounding allowed in what is compared, in units of eps times the terms that went into it: the
/// closed forms claim 10 eps for a phase of at most one forcing period, and an event adds as much.
const ROUNDING_TOLERANCE: f64 = 32.0 * f64::EPSILON;

/// The largest loss of a state by products that underflow: the smallest normal number times
/// a/omega^2 <= 1e21.
const UNDERFLOW_TOLERANCE: f64 = 1e-285;

/// Phases of a case that are decided again in 106 bits, where any are.
const MAX_JUDGED_PHASES: usize = 6;

/// Evaluations of the judge for one phase.
const JUDGE_EVALUATIONS: usize = 2000;

/// The number of cases drawn from everything of which one is judged.
const CASES_PER_JUDGED: u64 = 16;

/// The largest error of an event, in units of what rounding of the guard moves it by: the search
/// allows itself as much again, and the guards of the two arithmetics differ by some roundings of
/// the parameters' products.
const MAX_EVENT_WIDTHS: f64 = 8.0;

/// The counts of what the runs met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Phases passed.
    pub phases: u64,
    /// Phases asked of 106 bits,
    pub judged: u64,
    /// and those of them that 106 bits decide.
    pub decided: u64,
    /// Phases that 106 bits decide otherwise, but whose touch f64 has counted as undecidable.
    pub touches: u64,
    /// Phases that end as undecidable.
    pub undecidable: u64,
    /// Phases looked at without a horizon as well.
    pub endless: u64,
    /// The most evaluations that a phase has taken.
    pub most_evaluations: u64,
}

macro_rules! ensure {
    ($holds:expr, $($text:tt)*) => {
        if !$holds {
            return Err(format!($($text)*));
        }
    };
}

/// Runs a case; an error says what is wrong.
///
/// # Errors
/// The first check that failed. A refused input is no error.
pub fn check(case: &Case) -> Result<(), String> {
    check_counted(case, &mut Tally::default())
}

/// Checks a case and returns what was met on the way.
///
/// # Errors
/// The first check that failed.
pub fn check_counted(case: &Case, tally: &mut Tally) -> Result<(), String> {
    let model = Model::new(case.parameters).map_err(|error| format!("not in range: {error}"))?;
    let Ok(entry) = model.start(&case.start) else { return Ok(()) };
    // A phase without events costs up to a few evaluations a forcing period and, in contact, a
    // period of the free oscillation: 64 of the one, 200/2 pi of the other are honest work.
    let period = model.period();
    let periods = case.periods.min(MAX_RUN_TIME / period);
    let (whole, rest) = (periods.floor(), (periods.fract() * 1e6).floor());
    let horizon = entry.instant.after_periods(whole as u64 * 1_000_000 + rest as u64, 1_000_000);
    let mut trajectory = model.trajectory(entry).until(horizon);
    let mut history = History::new(&case.parameters);
    let mut before = trajectory.counters();
    let sampled = case.parameters.a.to_bits() ^ case.start.p.to_bits() ^ case.start.y.to_bits();
    let judged = case.family != Family::Any || sampled % CASES_PER_JUDGED == 0;
    for number in 0..SEGMENTS {
        let Some(segment) = trajectory.next() else { break };
        let counters = trajectory.counters();
        let evaluations = counters.evaluations - before.evaluations;
        let named = |fault| format!("segment {number} ({}): {fault}", segment.phase());
        tally.phases += 1;
        tally.most_evaluations = tally.most_evaluations.max(evaluations);
        history.segment(&model, &segment, evaluations, periods).map_err(named)?;
        let touched = counters.undecidable > before.undecidable;
        if number == 0 {
            tally.endless += 1;
            without_horizon(&model, &segment, segment.elapsed_at(&horizon), touched)
                .map_err(named)?;
        }
        let undecidable = *segment.exit() == Exit::Undecidable;
        tally.undecidable += u64::from(undecidable);
        if undecidable || judged && number < MAX_JUDGED_PHASES {
            let left = segment.elapsed_at(&horizon);
            judge(&model, &segment, left, touched, tally).map_err(named)?;
        }
        before = counters;
    }
    Ok(())
}

/// Holds a phase to itself without a horizon, `left` after it begins: the same end, unless a touch
/// was counted, and no more work than the limit of a search.
fn without_horizon(
    model: &Model,
    segment: &Segment,
    left: f64,
    touched: bool,
) -> Result<(), String> {
    /// The largest distance of two ends next to the horizon.
    const HORIZON_TOLERANCE: f64 = 1e-3;
    /// A contact that is taken up in stages is granted the limit by its first search, by its stages
    /// and by the last of these.
    const SEARCHES: u64 = 3;
    let mut run = model.trajectory(*segment.entry());
    let Some(whole) = run.next() else { return Err("no phase without a horizon".to_owned()) };
    let counters = run.counters();
    let limit = SEARCHES * (MAX_EVALUATIONS + GRANTED_EVALUATIONS + LAST_ROOT_EVALUATIONS);
    let evaluations = counters.evaluations;
    ensure!(evaluations <= limit, "{evaluations} evaluations without a horizon");
    let (cut, free) = (segment.duration(), whole.duration());
    let alike = match (segment.exit(), whole.exit()) {
        (Exit::Undecidable, _) | (_, Exit::Undecidable) => true,
        (Exit::Switch(one), Exit::Switch(other)) => {
            // Rounding moves an event in time by as much as it likes where nothing moves.
            one.phase() == other.phase() && same_place(model, segment, [&one.state, &other.state])
        }
        (Exit::Endless(one), Exit::Endless(other)) => one == other,
        (Exit::Horizon, _) => free >= left * (1.0 - HORIZON_TOLERANCE),
        _ => false,
    };
    let touched = touched || counters.undecidable > 0;
    let ends = [segment.exit(), whole.exit()];
    ensure!(alike || touched, "ends after {cut:e}, without a horizon {free:e}: {ends:?}");
    Ok(())
}

/// Compares the end of a phase with the decision of 106 bits.
fn judge(
    model: &Model,
    segment: &Segment,
    left: f64,
    touched: bool,
    tally: &mut Tally,
) -> Result<(), String> {
    let lasts = segment.duration();
    let horizon = match segment.exit() {
        Exit::Switch(_) => lasts + 1e-3 * lasts + 1e-9,
        _ => left,
    };
    let effort = Effort { horizon, evaluations: JUDGE_EVALUATIONS, unit: DoubleDouble::UNIT };
    let found = one_sided_end::<DoubleDouble>(model, segment, &effort);
    tally.judged += 1;
    let alike = match (segment.exit(), found) {
        (_, OneSidedEnd::Undecided) => return Ok(()),
        (Exit::Switch(next), OneSidedEnd::Crossing { elapsed, rises, width }) => {
            let side =
                segment.phase() != Phase::Contact || rises == (next.phase() == Phase::Progression);
            side && (elapsed - lasts).abs() <= MAX_EVENT_WIDTHS * width
        }
        (Exit::Switch(_) | Exit::Undecidable, _) => false,
        (_, OneSidedEnd::Clear) => true,
        // The horizon may fall into what rounding moves the event by.
        (_, OneSidedEnd::Crossing { elapsed, width, .. }) => {
            elapsed > left - MAX_EVENT_WIDTHS * width
        }
    };
    tally.decided += 1;
    if !alike && touched {
        tally.touches += 1;
        return Ok(());
    }
    let exit = segment.exit();
    ensure!(alike, "in 106 bits {found:?}, in f64 {lasts:e}, {exit:?}, {:?}", segment.entry());
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

impl History {
    fn new(parameters: &Parameters) -> Self {
        Self { parameters: *parameters, stuck: 0, settled: false, q_room: 0.0, speed: 0.0 }
    }

    fn segment(
        &mut self,
        model: &Model,
        segment: &Segment,
        evaluations: u64,
        periods: f64,
    ) -> Result<(), String> {
        let duration = segment.duration();
        ensure!(duration >= 0.0, "duration {duration:e}");
        let entry = segment.entry();
        ensure!(is_possible(&entry.state) && entry.v().is_finite(), "entry {entry:?}");
        let angle = entry.instant.angle();
        ensure!((0.0..=std::f64::consts::TAU).contains(&angle), "angle {angle:e}");

        // The limit of the search, up to where the phase ends or is cut; an event next to the
        // horizon is looked for twice.
        let omega = model.parameters().omega;
        let clear = duration.min(periods * model.period()) + 0.2 / omega;
        let granted = (GRANTED_EVALUATIONS as f64 + EVALUATIONS_PER_RADIAN * (1.0 + omega) * clear)
            .min(MAX_EVALUATIONS as f64);
        let limit = 2.0 * (granted + LAST_ROOT_EVALUATIONS as f64);
        ensure!((evaluations as f64) <= limit, "{evaluations} evaluations, the limit is {limit}");

        self.stuck = if duration > 0.0 { 0 } else { self.stuck + 1 };
        ensure!(self.stuck < 3, "phases without length follow each other");

        // An endless phase is looked at as far as the run would have gone.
        let seen = duration.min(periods * model.period());
        for eighth in 0..=8 {
            self.sample(segment, seen * (f64::from(eighth) / 8.0))
                .map_err(|fault| format!("{fault}, {eighth}/8 of {seen:e}, from {entry:?}"))?;
        }
        if let Exit::Switch(next) = segment.exit() {
            ensure!(is_possible(&next.state) && next.v().is_finite(), "exit {next:?}");
            let legal = match (segment.phase(), next.phase()) {
                (before, after) if before == after => false,
                (Phase::Progression, after) => after == Phase::Contact,
                _ => true,
            };
            ensure!(legal, "after {duration:e} follows {}, {next:?}", next.phase());
            let room = self.drift_room(segment, duration);
            let fall = entry.v() - next.v();
            ensure!(fall <= room, "v falls by {fall:e} in {duration:e}, room {room:e}");
            ensure!(segment.phase() == Phase::Progression || fall == 0.0, "v moves by {fall:e}");
        }
        Ok(())
    }

    fn sample(&mut self, segment: &Segment, elapsed: f64) -> Result<(), String> {
        let Parameters { a, b, xi, omega, g, .. } = self.parameters;
        let two_xi = 2.0 * xi;
        let sample = segment.at(elapsed);
        let State { p, y, q } = sample.state;
        ensure!(is_possible(&sample.state) && sample.v.is_finite(), "sample {sample:?}");
        let from = segment.entry().state;
        // The terms of the closed forms: what was there, and what the force adds.
        let time = elapsed.min(1.0 / omega + 1.0 / omega / omega);
        let pushed = elapsed * (b.abs() * elapsed + a * time);
        let place =
            from.p.abs() + p.abs() + from.q.abs() + q.abs() + g + from.y.abs() * elapsed + pushed;
        // What y was rounded to in an earlier phase it keeps.
        self.speed = self.speed.max(self.speed_terms(segment, elapsed, y));
        let over = p - (q + g);
        // At the event f is known to the rounding of its terms, up to 1; h' = f/(2 xi) passes it
        // on as long as q has not died out.
        let passed_on = (elapsed / two_xi).min(1.0);
        let room = ROUNDING_TOLERANCE * (place + passed_on) + UNDERFLOW_TOLERANCE;
        ensure!(over <= room, "p - (q + g) = {over:e}, room {room:e}, {sample:?}");
        if segment.phase() != Phase::NoContact {
            ensure!(over.abs() <= room, "p - (q + g) = {over:e} on the surface, room {room:e}");
            let force = two_xi * y + q;
            let speed = self.speed;
            let room = ROUNDING_TOLERANCE * (1.0 + place + two_xi * speed);
            let inside = match segment.phase() {
                Phase::Contact => force >= -room && force <= 1.0 + room,
                _ => force >= 1.0 - room,
            };
            ensure!(inside, "f = {force:e}, room {room:e}, {sample:?}");
        }
        // q returns to [0, 1] by itself; its rounding is that of its closed form's terms, and of
        // 2 xi y where it is imposed at the end of this phase or was at that of an earlier one.
        let in_place = (0.0..=1.0).contains(&q);
        let terms = 1.0 + place + two_xi * self.speed;
        self.q_room = self.q_room.max(ROUNDING_TOLERANCE * terms);
        if self.settled {
            let far = (-q).max(q - 1.0);
            ensure!(far <= self.q_room, "q = {q:e} left [0, 1] again, room {:e}", self.q_room);
        }
        self.settled |= in_place;
        let fall = segment.entry().v() - sample.v;
        let room = self.drift_room(segment, elapsed);
        ensure!(fall <= room, "v fell by {fall:e} in {elapsed:e}, room {room:e}");
        Ok(())
    }

    /// The terms of y's closed form: in contact what is forced dies out within 1/(2 xi).
    fn speed_terms(&self, segment: &Segment, elapsed: f64, y: f64) -> f64 {
        let Parameters { a, b, xi, omega, .. } = self.parameters;
        let forced = match segment.phase() {
            Phase::Contact => elapsed.min(1.0).min(0.5 / xi) * (a + b.abs() + 1.0),
            _ => elapsed.min(1.0 / omega) * a + elapsed * (b.abs() + 1.0),
        };
        y.abs() + segment.entry().state.y.abs() + forced
    }

    /// Rounding of v, and of the distance slipped.
    fn drift_room(&self, segment: &Segment, elapsed: f64) -> f64 {
        let Parameters { a, b, xi, omega, .. } = self.parameters;
        let entry = segment.entry();
        let slipped = if segment.phase() == Phase::Progression {
            let lag = (1.0 - entry.state.q).abs() * (elapsed / (2.0 * xi)).min(1.0);
            let push = elapsed * ((b - 1.0).abs() * elapsed + a * elapsed.min(1.0 / omega));
            entry.state.y.abs() * elapsed + lag + push
        } else {
            0.0
        };
        ROUNDING_TOLERANCE * (entry.v().abs() + slipped) + UNDERFLOW_TOLERANCE
    }
}

/// Whether two ends of a phase are the same state within the rounding of its terms.
fn same_place(model: &Model, segment: &Segment, [one, other]: [&State; 2]) -> bool {
    const STATE_TOLERANCE: f64 = 1e-9;
    let Parameters { a, b, .. } = *model.parameters();
    let size = |state: &State| state.p.abs() + state.y.abs() + state.q.abs();
    let scale = 1.0 + a + b.abs() + size(&segment.entry().state) + size(one);
    let near = |x: f64, y: f64| (x - y).abs() <= STATE_TOLERANCE * scale;
    near(one.p, other.p) && near(one.y, other.y) && near(one.q, other.q)
}

fn is_possible(state: &State) -> bool {
    state.p.is_finite() && state.y.is_finite() && state.q.is_finite()
}

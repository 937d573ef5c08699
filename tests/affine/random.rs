//! Random systems of prescribed spectra, and what runs of them have to satisfy: f64 against 106
//! bits within the errors that f64 encloses, and crests that a guard just reaches or just misses.
//!
//! The package in `fuzz/` compiles this file too.

use percuss::affine::DoubleDouble;
use percuss::affine::{
    Direction, Ending, Event, Rational, Solver, System, SystemFile, Watch, What,
};
use percuss::number::Number;
use std::fmt::Write;

/// The time that runs take at most, and the number of events that are compared.
const HORIZON: f64 = 20.0;
const EVENTS: usize = 60;

/// The counts of what a check has compared.
#[derive(Clone, Copy, Debug, Default)]
pub struct Met {
    /// Events that were compared.
    pub events: u64,
    /// Runs of which f64 leaves something open.
    pub undecided: u64,
    /// Crests at which a guard just fires, and just does not.
    pub crests: u64,
}

/// Numbers drawn from a seed.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 16
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// An eighth of an integer, at most `most` eighths in size.
    fn eighths(&mut self, most: usize) -> f64 {
        (self.below(2 * most + 1) as f64 - most as f64) / 8.0
    }
}

/// A matrix of blocks: decays up to 1e6 beside 1, oscillations, defective double and triple
/// eigenvalues, defective pairs, and pairs of eigenvalues that nearly coincide.
fn spectrum(draw: &mut Draw, size: usize) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; size]; size];
    let mut at = 0;
    while at < size {
        let (left, rate) = (size - at, -draw.one_of(&[0.0, 0.125, 0.5, 1.0, 2.0]));
        let used = match draw.below(7) {
            0 if left >= 3 => jordan(&mut matrix, at, 3, rate),
            1 if left >= 2 => jordan(&mut matrix, at, 2, rate),
            2 if left >= 2 => {
                let used = jordan(&mut matrix, at, 2, rate);
                matrix[at][at] += draw.one_of(&[1e-3, 1e-6, 1e-9, 1e-12]);
                used
            }
            3 if left >= 4 => {
                let frequency = draw.one_of(&[0.5, 1.0, 3.0]);
                pair(&mut matrix, at, rate, frequency);
                pair(&mut matrix, at + 2, rate, frequency);
                (matrix[at][at + 2], matrix[at + 1][at + 3]) = (1.0, 1.0);
                4
            }
            4 | 5 if left >= 2 => {
                let frequency = draw.one_of(&[0.5, 1.0, 3.0, 40.0]);
                pair(&mut matrix, at, draw.one_of(&[0.0, -0.125, -1.0, 0.0625]), frequency)
            }
            _ => {
                matrix[at][at] = draw.one_of(&[rate, rate, 0.0625, -37.0, -1024.0, -1e6]);
                1
            }
        };
        at += used;
    }
    matrix
}

fn jordan(matrix: &mut [Vec<f64>], at: usize, size: usize, rate: f64) -> usize {
    for n in at..at + size {
        matrix[n][n] = rate;
        if n + 1 < at + size {
            matrix[n][n + 1] = 1.0;
        }
    }
    size
}

fn pair(matrix: &mut [Vec<f64>], at: usize, rate: f64, frequency: f64) -> usize {
    (matrix[at][at], matrix[at + 1][at + 1]) = (rate, rate);
    (matrix[at][at + 1], matrix[at + 1][at]) = (frequency, -frequency);
    2
}

/// A matrix of the same eigenvalues, whose co-ordinates are mixed by sums and differences.
fn mix(draw: &mut Draw, mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let size = matrix.len();
    for _ in 0..draw.below(2 * size) {
        let (i, j, sign) = (draw.below(size), draw.below(size), draw.one_of(&[-1.0, 1.0]));
        if i == j {
            continue;
        }
        let added = matrix[j].clone();
        for (entry, other) in matrix[i].iter_mut().zip(added) {
            *entry += sign * other;
        }
        for row in &mut matrix {
            row[j] -= sign * row[i];
        }
    }
    matrix
}

/// A sum of parameters times states; the parameters are written down.
fn combination(
    draw: &mut Draw,
    parameters: &mut String,
    name: &str,
    start: &[f64],
) -> (String, f64) {
    let (mut text, mut value) = ("0".to_owned(), 0.0);
    for (n, state) in start.iter().enumerate() {
        let factor = if draw.below(3) == 0 { 0.0 } else { draw.eighths(8) };
        // A guard names a state, and the factor may be 0.
        if factor != 0.0 || n == 0 {
            let _ = write!(text, " + {name}{n}*x{n}");
            let _ = writeln!(parameters, "{name}{n} = {factor:?}");
            value += factor * state;
        }
    }
    (text, value)
}

/// The text of a system.
pub fn system(seed: u64) -> String {
    let mut draw = Draw(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    for _ in 0..8 {
        draw.next();
    }
    let (size, count, forced) = (1 + draw.below(8), 1 + draw.below(2), draw.below(2) == 0);
    let start: Vec<f64> = (0..size).map(|_| draw.eighths(16)).collect();
    let (mut parameters, mut modes) = (String::new(), String::new());
    for mode in 0..count {
        let plain = spectrum(&mut draw, size);
        let matrix = mix(&mut draw, plain);
        let mut equations = Vec::new();
        for (n, row) in matrix.iter().enumerate() {
            let mut text = format!("x{n}' = {}/8", draw.below(9) as i64 - 4);
            if forced && draw.below(2) == 0 {
                let _ = write!(text, " + {}*cos/4", draw.below(5));
            }
            for (k, factor) in row.iter().enumerate().filter(|(_, it)| **it != 0.0) {
                let _ = write!(text, " + a{mode}{n}{k}*x{k}");
                let _ = writeln!(parameters, "a{mode}{n}{k} = {factor:?}");
            }
            equations.push(format!("{text:?}"));
        }
        let _ =
            writeln!(modes, "[[mode]]\nname = \"m{mode}\"\nequations = [{}]", equations.join(", "));
        for event in 0..1 + draw.below(2) {
            let name = format!("u{mode}{event}w");
            let (guard, value) = combination(&mut draw, &mut parameters, &name, &start);
            let level = value + draw.one_of(&[0.125, 0.5, 1.0, 3.0]);
            let _ = writeln!(parameters, "l{mode}{event} = {level:?}");
            let (state, other) = (draw.below(size), draw.below(size));
            let reset = match draw.below(3) {
                0 => format!("[\"x{state} = -x{state}/2\"]"),
                1 => format!("[\"x{state} = x{state}/2 - x{other}/4\", \"x{other} = 1/8\"]"),
                _ => "[]".to_owned(),
            };
            let reset = if state == other { "[]".to_owned() } else { reset };
            let (first, last) = (draw.below(count), draw.below(count));
            let _ = writeln!(
                modes,
                "[[mode.until]]\nname = \"e{event}\"\nguard = \"{guard} > l{mode}{event}\"\n\
                 reset = {reset}\nnext = [{{ when = \"x{other} > 0\", mode = \"m{first}\" }}, \
                 {{ mode = \"m{last}\" }}]"
            );
        }
        for event in 0..draw.below(3) {
            let name = format!("s{mode}{event}w");
            let (guard, _) = combination(&mut draw, &mut parameters, &name, &start);
            let direction = draw.one_of(&["rising", "falling", "both"]);
            let level = draw.below(9) as i64 - 4;
            let _ = writeln!(
                modes,
                "[[mode.watch]]\nname = \"w{event}\"\nguard = \"{guard} > {level}/8\"\n\
                 direction = \"{direction}\""
            );
        }
    }
    let states: Vec<_> = (0..size).map(|n| format!("\"x{n}\"")).collect();
    let forcing = if forced { "forcing = { omega = 1.25, phi = 0.5 }\n" } else { "" };
    let begin: Vec<_> = start.iter().enumerate().map(|(n, it)| format!("x{n} = {it:?}")).collect();
    format!(
        "schema = 1\nname = \"random\"\nstates = [{}]\n{forcing}[parameters]\n{parameters}{modes}\
         [start]\nmode = \"m0\"\n{}\n",
        states.join(", "),
        begin.join("\n")
    )
}

/// The kind and the indices of an event, in any arithmetic.
fn kind<T: Number>(event: &Event<T>) -> (u8, usize, usize) {
    match &event.what {
        What::Start => (0, 0, 0),
        What::Until(mode, index) => (1, *mode, *index),
        What::Watch(mode, index) => (2, *mode, *index),
        What::Limit(mode, index) => (4, *mode, *index),
        What::End(ending) => (
            3,
            0,
            match ending {
                Ending::Horizon => 0,
                Ending::Accumulation(..) => 1,
                Ending::LeavesDomain => 2,
                Ending::NoProgress => 3,
                Ending::BeyondGuard => 4,
                Ending::Undecided => 5,
            },
        ),
    }
}

const UNDECIDED_RUNS: (u8, usize, usize) = (3, 0, 5);

/// Checks the system of a seed.
///
/// # Errors
/// What does not hold.
pub fn check(seed: u64, met: &mut Met) -> Result<(), String> {
    let text = system(seed);
    let named = |error: percuss::affine::SystemError| format!("{error}\n{text}");
    let system = SystemFile::read("random.system.toml", &text).map_err(named)?.system();
    let system = system.map_err(named)?;
    agreement(&system, met).map_err(|what| format!("{what}\n{text}"))?;
    crest(&system, met).map_err(|what| format!("{what}\n{text}"))
}

/// Events in f64 are those of 106 bits, each within its enclosed errors.
fn agreement(system: &System, met: &mut Met) -> Result<(), String> {
    let prepared = (Solver::<f64>::new(system), Solver::<DoubleDouble>::new(system));
    let (Ok(narrow), Ok(wide)) = prepared else { return Err("not taken apart".to_owned()) };
    let start = system.start.as_ref().ok_or("no start")?;
    let begun = (narrow.run_enclosed(start, HORIZON), narrow.run(start, HORIZON));
    let (Ok(mut enclosed), Ok(mut plain)) = begun else { return Err("no run".to_owned()) };
    let mut wide = wide.run(start, DoubleDouble::exact(HORIZON)).map_err(|_| "no run")?;
    for n in 0..EVENTS {
        let (Some(bounded), Some(event)) = (enclosed.next(), plain.next()) else { return Ok(()) };
        let Some(truth) = wide.next() else { return Err(format!("event {n} is not there")) };
        if kind(&bounded) == UNDECIDED_RUNS || wide.work().undecidable > 0 {
            met.undecided += 1;
            return Ok(());
        }
        let kinds = [kind(&bounded), kind(&event), kind(&truth)];
        // A run that does not follow its errors allows for more rounding, so it may leave open what
        // one that does decides; it may not take another event.
        if kinds[1] == UNDECIDED_RUNS {
            met.undecided += 1;
            return Ok(());
        }
        if kinds[0] != kinds[2] || kinds[1] != kinds[2] || bounded.mode != truth.mode {
            return Err(format!("event {n}: {kinds:?} enclosed, in f64, in 106 bits"));
        }
        met.events += 1;
        let errors = bounded.errors.as_ref().ok_or("no errors")?;
        let off = |own: f64, truth: DoubleDouble| (truth - DoubleDouble::exact(own)).to_f64().abs();
        // A run that does not follow its errors takes pieces of other lengths, and rounds
        // otherwise. A state of 1e-188 or less may be what 640 bits leave of a zero, 2e-193 beside
        // other states and factors, and moves by a matrix that does not know it: its last step to
        // an event is off by its rate.
        // A state that is zero by the model is exactly so in a run that follows its errors, which
        // then say nothing of a plain run; and the truth is off by its own rounding.
        let largest = truth.state.iter().map(|it| it.to_f64().abs()).fold(1.0, f64::max);
        let lost = 1e-28 * largest;
        for (own, room, nothing) in [(&bounded, 1.0, lost), (&event, 2.0, 1e-188)] {
            let time = off(own.time.high, truth.time.value() - DoubleDouble::exact(own.time.low));
            let most = room * errors.time;
            if time.is_nan() || time > most {
                return Err(format!(
                    "event {n}: the time is off by {time:e}, enclosed is {most:e}"
                ));
            }
            let is_plain = room > 1.0;
            let told = |(_, most): &(usize, &f64)| !is_plain || **most > 0.0;
            for (k, most) in errors.state.iter().enumerate().filter(told) {
                let (state, most) = (off(own.state[k], truth.state[k]), room * most + nothing);
                if state.is_nan() || state > most {
                    return Err(format!(
                        "event {n}: x{k} is off by {state:e}, enclosed is {most:e}"
                    ));
                }
            }
        }
        if kinds[0].0 == 3 {
            return Ok(());
        }
    }
    Ok(())
}

/// A guard whose level is moved to just below its crest fires before it, and one whose level is
/// just above it does not fire.
fn crest(system: &System, met: &mut Met) -> Result<(), String> {
    let mut looked_at = system.clone();
    let mode = &mut looked_at.modes[system.start.as_ref().ok_or("no start")?.mode];
    let until = mode.until.swap_remove(0);
    (mode.until, mode.watch) = (Vec::new(), Vec::new());
    let slope: Vec<Rational> = (0..until.guard.len())
        .map(|k| {
            until
                .guard
                .iter()
                .zip(&mode.matrix)
                .fold(Rational::ZERO, |sum, (a, row)| sum + a * &row[k])
        })
        .collect();
    let name = "top".to_owned();
    mode.watch.push(Watch { name, guard: slope, direction: Direction::Falling });
    let solver = Solver::<DoubleDouble>::new(&looked_at).map_err(|error| error.to_string())?;
    let start = looked_at.start.as_ref().ok_or("no start")?;
    let mut run = solver.run(start, DoubleDouble::exact(HORIZON)).map_err(|_| "no run")?;
    // The level is in the last entry of the row, whose factor is 1.
    let states = looked_at.states.len();
    let value = |event: &Event<DoubleDouble>| {
        let terms = until.guard.iter().zip(&event.state).take(states);
        terms.map(|(a, x)| a.to_f64() * x.to_f64()).sum::<f64>()
    };
    let size = |event: &Event<DoubleDouble>| {
        let terms = until.guard.iter().zip(&event.state).take(states);
        terms.map(|(a, x)| (a.to_f64() * x.to_f64()).abs()).sum::<f64>()
    };
    let begin = run.start();
    let all: Vec<_> = run.by_ref().take(200).collect();
    let Some((last, tops)) = all.split_last() else { return Ok(()) };
    if run.work().undecidable > 0 || kind(last) != (3, 0, 0) {
        return Ok(());
    }
    let Some(top) = tops.iter().max_by(|a, b| value(a).total_cmp(&value(b))) else { return Ok(()) };
    // Crests that are nearly equal, and motions whose sizes hide the margin, say nothing.
    let largest = all.iter().chain([&begin]).map(size).fold(1.0, f64::max);
    let states = top.state.iter().chain(&begin.state).map(|it| it.to_f64().abs());
    let margin = 1e-9 * (largest + states.fold(1.0, f64::max));
    let lower = |event: &Event<DoubleDouble>| value(event) < value(top) - 4.0 * margin;
    if !lower(&begin) || !lower(last) {
        return Ok(());
    }
    for (fires, shift) in [(true, -margin), (false, margin)] {
        let mut planted = looked_at.clone();
        let mut guard = until.guard.clone();
        let level = Rational::try_from(value(top) + shift).map_err(|_| "not finite")?;
        let last = guard.len() - 1;
        guard[last] = -level;
        let mode = &mut planted.modes[start.mode];
        mode.until = vec![percuss::affine::Until { guard, ..until.clone() }];
        mode.watch.clear();
        let solver = Solver::<f64>::new(&planted).map_err(|error| error.to_string())?;
        let mut run = solver.run(start, HORIZON).map_err(|_| "no run")?;
        let first = run.next().ok_or("no event")?;
        // Rounding moves guards of large factors by more than the margin, which the run counts.
        if run.work().undecidable > 0 {
            met.undecided += 1;
            return Ok(());
        }
        let (time, crest) = (first.time.value(), top.time.value().to_f64());
        let right = match kind(&first).0 {
            1 => fires && time <= crest * (1.0 + 1e-6),
            _ => !fires && kind(&first) == (3, 0, 0),
        };
        if !right {
            let kind = kind(&first);
            return Err(format!("crest at {crest}, level moved by {shift:e}: {kind:?} at {time}"));
        }
    }
    met.crests += 1;
    Ok(())
}

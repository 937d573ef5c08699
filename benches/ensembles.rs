//! The cost of an event in an ensemble: by each instruction set that the processor has, on one core
//! and in one interleaved run, beside the scalar solver; and two threads beside two processes.
//!
//! `cargo bench -p percuss-validation --bench ensembles`. Of every round the quotients are taken,
//! of the rounds their median: what else the machine does then weighs on both sides. For
//! exploration, no test.

#![allow(clippy::expect_used, reason = "a panic is a failed bench")]

use percuss::dynamics::ensemble::{Member, Watcher, follow_by};
use percuss::dynamics::section::section;
use percuss::lanes::Instructions;
use percuss::{Endless, Entry, Model, Parameters, Start};
use percuss_validation::bench::rounds::RoundTimes;
use percuss_validation::score::Spread;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;
use std::ops::ControlFlow;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// omega, xi: chaos with progression, period two, the attractors of Fig. 7; near resonance,
/// critically damped, over-damped.
const REGIMES: [(f64, f64); 7] =
    [(1.4, 0.01), (0.1, 0.01), (1.6, 0.1), (1.4, 0.1), (1.2, 0.01), (1.4, 1.0), (1.4, 5.0)];
const STARTS: usize = 256;
const PERIODS: u32 = 100;
const ROUNDS: usize = 9;
/// The time for which two threads and two processes work in each round.
const WORK_TIME: Duration = Duration::from_millis(500);
const PROCESS_FLAG: &str = "--process";

/// Counts the events of a run.
struct EventCounter {
    left: u32,
    switches: u64,
}

impl Watcher for EventCounter {
    fn see(&mut self, strobe: &Entry, _: Option<Endless>) -> ControlFlow<()> {
        black_box(strobe);
        self.left -= 1;
        if self.left > 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    fn enter(&mut self, _: &Entry) {
        self.switches += 1;
    }
}

/// Starts on an attractor.
struct Ensemble {
    model: Model,
    starts: Vec<Entry>,
}

impl Ensemble {
    fn new(omega: f64, xi: f64) -> Self {
        let model = Model::new(Parameters { omega, xi, ..Parameters::default() });
        let model = model.expect("in range");
        let rest = model.start(&Start::default()).expect("rest is a start");
        let starts = section(&model, rest, 0.0, 100, STARTS as u64).collect();
        Self { model, starts }
    }

    /// Every start twice.
    fn twice(&self) -> Self {
        Self { model: self.model, starts: self.starts.repeat(2) }
    }

    /// Follows all starts and returns the number of events.
    fn run(&self, by: Instructions) -> u64 {
        let (counts, _) = follow_by(by, self.starts.len(), |number| {
            let entry = self.starts[number];
            let watcher = EventCounter { left: PERIODS, switches: 0 };
            let first = entry.instant.after_periods(1, 1);
            Member { model: &self.model, entry, first, horizon: None, watcher }
        });
        counts.iter().map(|count| count.switches).sum()
    }

    /// Nanoseconds per event.
    fn cost(&self, by: Instructions) -> f64 {
        let clock = Instant::now();
        let switches = self.run(by);
        clock.elapsed().as_secs_f64() * 1e9 / switches as f64
    }

    /// Events per second during a spell.
    fn throughput(&self) -> f64 {
        let clock = Instant::now();
        let mut switches = 0;
        while clock.elapsed() < WORK_TIME {
            switches += self.run(Instructions::widest());
        }
        switches as f64 / clock.elapsed().as_secs_f64()
    }
}

fn threads(count: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(count).build().expect("a pool of threads")
}

/// Instruction sets beside the scalar solver, one thread.
fn one_core(ensemble: &Ensemble) {
    let sets = Instructions::available();
    let rounds: Vec<Vec<f64>> =
        (0..ROUNDS).map(|_| sets.iter().map(|set| ensemble.cost(*set)).collect()).collect();
    let costs = |k: usize| RoundTimes(rounds.iter().map(|round| round[k]).collect());
    for (k, set) in sets.iter().enumerate() {
        let (cost, gain) = (costs(k).median(), costs(0).ratio_to(&costs(k)));
        println!(
            "  {:8} {cost:6.1} ns per event, {gain:.2} times the scalar throughput",
            set.as_str()
        );
    }
}

fn process() -> Child {
    let program = std::env::current_exe().expect("this program");
    let mut command = Command::new(program);
    command.arg(PROCESS_FLAG).stdout(Stdio::piped());
    command.spawn().expect("a process")
}

fn output(process: Child) -> f64 {
    let output = process.wait_with_output().expect("it ends");
    String::from_utf8_lossy(&output.stdout).trim().parse().expect("a number")
}

/// Two threads beside two processes, each of which follows `ensemble`: threads with the starts of
/// one of them, and with the starts of both. At the end of a run the last motions do not fill the
/// vectors, and with half as many a thread that is twice as large a part of the run; so only the
/// latter is the same work.
fn two_cores(ensemble: &Ensemble) {
    let two = threads(2);
    let both = ensemble.twice();
    let quotients = |_| {
        let pair = [process(), process()];
        let apart: f64 = pair.into_iter().map(output).sum();
        [ensemble, &both].map(|it| two.install(|| it.throughput()) / apart)
    };
    let rounds: Vec<[f64; 2]> = (0..ROUNDS).map(quotients).collect();
    let [half, same] =
        [0, 1].map(|k| Spread::new(rounds.iter().map(|round| round[k]).collect()).median);
    println!("two threads: {same:.2} of what two processes reach ({half:.2} with half the starts)");
}

fn main() {
    let (omega, xi) = REGIMES[0];
    if std::env::args().any(|argument| argument == PROCESS_FLAG) {
        println!("{}", threads(1).install(|| Ensemble::new(omega, xi).throughput()));
        return;
    }
    for (omega, xi) in REGIMES {
        println!("omega {omega}, xi {xi}");
        threads(1).install(|| one_core(&Ensemble::new(omega, xi)));
    }
    two_cores(&Ensemble::new(omega, xi));
}

//! Instruction counts, each held to its record (`record.csv`).

use gungraun::prelude::*;
use gungraun::{Callgrind, EventKind};
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Entry, Model, Parameters, Phase, Segment, Start};
use percuss_instructions::{Grain, limit};
use std::hint::black_box;

/// omega, xi: chaos with progression, slow forcing, Fig. 7's damping, over-damped, critical.
const CHAOS: (f64, f64) = (1.4, 0.01);

fn model((omega, xi): (f64, f64)) -> Model {
    Model::new(Parameters { omega, xi, ..Parameters::default() }).expect("in range")
}

fn at_rest(model: Model) -> (Model, Entry) {
    let entry = model.start(&Start::default()).expect("rest is a start");
    (model, entry)
}

fn segment(phase: Phase) -> Segment {
    let (model, entry) = at_rest(model(CHAOS));
    model
        .trajectory(entry)
        .skip(20)
        .find(|segment| segment.phase() == phase)
        .expect("all phases occur")
}

/// The entry at which a phase begins, with its model.
fn beginning(phase: Phase) -> (Model, Entry) {
    (model(CHAOS), *segment(phase).entry())
}

fn held(bench: &str, grain: Grain) -> LibraryBenchmarkConfig {
    let mut config = LibraryBenchmarkConfig::default();
    let mut tool = Callgrind::default();
    tool.hard_limits([(EventKind::Ir, limit(bench, grain))]);
    config.tool(tool);
    config
}

#[library_benchmark]
#[bench::no_contact(args = (segment(Phase::NoContact)), config = held("closed_form/no_contact", Grain::Micro))]
#[bench::contact(args = (segment(Phase::Contact)), config = held("closed_form/contact", Grain::Micro))]
#[bench::progression(args = (segment(Phase::Progression)), config = held("closed_form/progression", Grain::Micro))]
fn closed_form(segment: Segment) -> f64 {
    black_box(&segment).at(black_box(0.5 * segment.duration())).state.q
}

#[library_benchmark]
#[bench::no_contact(args = (beginning(Phase::NoContact)), config = held("switch/no_contact", Grain::Micro))]
#[bench::contact(args = (beginning(Phase::Contact)), config = held("switch/contact", Grain::Micro))]
#[bench::progression(args = (beginning(Phase::Progression)), config = held("switch/progression", Grain::Micro))]
fn switch((model, entry): (Model, Entry)) -> f64 {
    black_box(&model)
        .trajectory(black_box(entry))
        .next()
        .map_or(f64::NAN, |segment| segment.duration())
}

#[library_benchmark]
#[bench::model(config = held("model/model", Grain::Micro))]
fn made() -> Model {
    model(black_box(CHAOS))
}

#[library_benchmark]
#[bench::chaos(args = (at_rest(model(CHAOS))), config = held("trajectory/chaos", Grain::EndToEnd))]
#[bench::slow(args = (at_rest(model((0.1, 0.01)))), config = held("trajectory/slow", Grain::EndToEnd))]
#[bench::damped(args = (at_rest(model((1.6, 0.1)))), config = held("trajectory/damped", Grain::EndToEnd))]
#[bench::critical(args = (at_rest(model((1.4, 1.0)))), config = held("trajectory/critical", Grain::EndToEnd))]
#[bench::over_damped(args = (at_rest(model((1.4, 5.0)))), config = held("trajectory/over_damped", Grain::EndToEnd))]
fn trajectory((model, entry): (Model, Entry)) -> f64 {
    const SWITCHES: usize = 3000;
    black_box(&model).trajectory(entry).take(SWITCHES).map(|segment| segment.duration()).sum()
}

fn strobe_map() -> (StrobeMap, Entry) {
    let (model, entry) = at_rest(model((1.4, 0.1)));
    let map = StrobeMap::new(model, entry.instant);
    let first = map.strobes(entry, 100).last().expect("it goes on");
    (map, first)
}

#[library_benchmark]
#[bench::states(args = (strobe_map()), config = held("strobes/states", Grain::EndToEnd))]
fn strobes((map, entry): (StrobeMap, Entry)) -> f64 {
    black_box(&map).strobes(entry, 500).map(|strobe| strobe.state.y).sum()
}

#[library_benchmark]
#[bench::derivative(args = (strobe_map()), config = held("passage/derivative", Grain::Micro))]
fn passage((map, entry): (StrobeMap, Entry)) -> f64 {
    black_box(&map).passage(black_box(&entry), 1).jacobian()[0][0]
}

library_benchmark_group!(
    name = benches,
    benchmarks = [closed_form, switch, made, trajectory, strobes, passage]
);

main!(library_benchmark_groups = benches);

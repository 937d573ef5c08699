//! The tests of the harness and of the command, in one program: it is linked once, and its tests
//! share all threads.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is a failed test"
)]

mod action;
mod attractor;
mod bad_input;
mod bench;
mod bifurcation_curves;
mod browser;
mod case_files;
mod check_and_new;
mod command_line;
mod contributing;
mod counted_work;
mod dynamics_verbs;
mod event_rows;
mod events;
mod every_flag;
mod export;
mod findings;
mod first_study;
mod forged;
mod formats;
mod gradient;
mod growth;
mod horizon;
mod independent_orbits;
#[cfg(unix)]
mod interrupted;
mod junit;
mod motions_told;
mod orbits;
mod own_cases;
mod past_accumulations;
mod pictures;
mod power;
mod project;
mod proposals;
mod readme;
mod records;
mod replay;
mod report;
mod reproduce;
mod restart;
mod restart_systems;
mod rig;
mod rounding_promise;
mod score;
mod score_gradients;
mod score_your_integrator;
mod scoreboard;
mod simulate;
mod simulate_system;
mod spoiled;
mod strobe_derivative;
mod studies;
mod sweep;
mod system_cases;
mod system_diagrams;
mod system_drifts;
mod system_grazes;
mod system_sections;
mod systems;
mod systems_page;
mod terminal;
mod validate;

mod exact;
#[allow(dead_code, reason = "its main is another program's")]
#[path = "../examples/maintain/main.rs"]
mod maintain;
mod support;

//! The engines themselves, a file or a folder each: the exact solver, the integrators of each
//! library, and engines that are wrong on purpose. `registry.rs` names all that are scored.

mod differential_equations;
mod diffsol;
mod exact;
mod ode_solvers;
mod pins;
mod registry;
mod wrong;

pub use exact::{end_of_exact_run, run_in_lanes};
pub use registry::{add, all, exact, select};
pub use wrong::{
    CONTROL, COOLDOWN_TIME, CORRECT_ENGINE, Closed, FAULTY_CONTROL, FAULTY_ON_SYSTEMS_CONTROL, Way,
    WrongEngine, faulty, wrong,
};

#[cfg(test)]
mod tests;

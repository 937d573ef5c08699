//! The reader of piecewise-affine systems on any text: a system that can be made ready to run, or a
//! one-line error, never a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;
use percuss::affine::{Solver, System};

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    match System::parse("fuzz.system.toml", &text) {
        Ok(system) => drop(Solver::<f64>::new(&system)),
        Err(error) => {
            let error = error.to_string();
            assert!(error.starts_with("fuzz.system.toml"), "the file is not named: {error}");
            assert_eq!(error.lines().count(), 1, "not one line: {error}");
        }
    }
});

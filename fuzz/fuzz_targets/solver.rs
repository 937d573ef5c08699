//! The solver on any accepted input: no panic, no hang, legal phases, a state that stays possible.

#![no_main]

use libfuzzer_sys::fuzz_target;
use percuss_fuzz::{Case, check};

fuzz_target!(|bytes: &[u8]| {
    let case = Case::decode(bytes);
    if let Err(fault) = check(&case) {
        panic!("{fault}\n{case:#?}");
    }
});

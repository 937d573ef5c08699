//! The readers of cases and problems on any text: an answer or a one-line error, never a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;
use percuss_engines::case::{parse_case, parse_problem};

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    for error in [
        parse_case("fuzz.toml", &text, None).err().map(|error| error.to_string()),
        parse_problem("fuzz.toml", &text).err().map(|error| error.to_string()),
    ]
    .into_iter()
    .flatten()
    {
        assert!(error.starts_with("fuzz.toml"), "the file is not named: {error}");
        assert_eq!(error.lines().count(), 1, "not one line: {error}");
    }
});

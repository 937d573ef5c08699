//! The piecewise-affine systems inside the program.

/// A system's file: its name, and its text.
pub type SystemText = (&'static str, &'static str);

macro_rules! systems {
    ($($name:literal),+ $(,)?) => {
        /// All systems, by name.
        pub const SYSTEMS: &[SystemText] = &[
            $(($name, include_str!(concat!("../../systems/", $name, ".system.toml"))),)+
        ];
    };
}

systems![
    "bouncing-ball",
    "buck-converter",
    "buck-converter-latched",
    "dry-friction-oscillator",
    "newton-cradle",
    "percussive-oscillator",
    "plastic-ball-on-table",
    "relay-feedback",
    "rigid-impact-oscillator",
    "spheres-in-a-row",
    "two-masses-on-a-belt",
    "two-state-switching",
    "watched-ball",
    "watched-impact-oscillator",
];

/// The text of the system file of the given name.
#[must_use]
pub fn named(name: &str) -> Option<&'static str> {
    SYSTEMS.iter().find(|(own, _)| *own == name).map(|(_, text)| *text)
}

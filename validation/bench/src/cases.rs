//! The cases that are timed where none are named, and those of other systems in
//! docs/PERFORMANCE.md.

/// Every regime whose dearest engine takes a second at most: what is left out (`resonance`,
/// `slow-forcing`) keeps explicit integrators busy for minutes, and `-c` asks for it.
pub const DEFAULT_CASES: [&str; 12] = [
    // chaos with progression, lightly damped chaos, and motion of period two and five
    "chaos-from-rest",
    "fig7a-chaos",
    "table1-from-rest",
    "fig7e-period-5",
    // the damping ratio on either side of one
    "critical-xi-1",
    "over-damped-xi-20",
    // an impact that drives the slider at once, and forcing far from the contact's own frequency
    "impact-into-progression",
    "fast-forcing",
    // falling damping ratios
    "stiff-xi-0-3",
    "stiff-xi-0-003",
    "stiff-xi-0-001",
    // a start after 1e8 periods
    "cycle-1e8",
];

/// Every system, and every kind of motion that integrators are slow or fast at: what
/// docs/PERFORMANCE.md has.
pub const SYSTEMS: [&str; 17] = [
    // parabolas and straight lines
    "ball-cut-short",
    "height-crossed-twice",
    "cradle-inelastic",
    "spheres-one-after-another",
    "plastic-sticks-and-flies",
    // oscillations with blows, friction and stops
    "rigid-dense-output",
    "watched-every-direction",
    "friction-two-stops",
    "belt-two-masses",
    "percussive-chaos",
    // a limit cycle of a defective matrix, and its chatter
    "relay-1e-4",
    "relay-chatter",
    // circuits with a clock
    "buck-periodic",
    "latched-chaos",
    // stiffness
    "percussive-stiff",
    "c5-published",
    "c5-fast",
];

//! Which cases are raced where none are named.

/// Every regime whose dearest engine takes a second at most: what is left out (`resonance`,
/// `slow-forcing`) keeps explicit integrators busy for minutes, and `-c` asks for it.
pub const USUAL: [&str; 12] = [
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
    // the stiffness ladder
    "stiff-xi-0-3",
    "stiff-xi-0-003",
    "stiff-xi-0-001",
    // a start after 1e8 periods
    "cycle-1e8",
];

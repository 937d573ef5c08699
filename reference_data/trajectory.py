"""The joined motion: phase after phase from the start to the horizon, every switch proved."""

from typing import Iterator, NamedTuple

from flint import arb

from case import Case, certain, enter, start_motion
from crossing import first_crossing
from motion import CONTACT, NO_CONTACT, PROGRESSION, Motion, on_surface, trial_force

FIRST_STEP = arb(1) / 8


class Segment(NamedTuple):
    """One phase. `begins` and `lasts` are times; the last segment lasts until the horizon."""

    motion: Motion
    begins: arb
    lasts: arb


def segments_of(case: Case) -> Iterator[Segment]:
    motion, begins, span = start_motion(case), arb(0), case.span()
    while True:
        remaining = span - begins
        crossing = first_crossing(motion.guards, remaining, FIRST_STEP / (1 + motion.m.omega))
        if crossing is None:
            yield Segment(motion, begins, remaining)
            return
        guard, lasts = crossing
        yield Segment(motion, begins, lasts)
        motion = next_motion(motion, guard, lasts)
        begins = begins + lasts


def next_motion(motion: Motion, guard, lasts: arb) -> Motion:
    """What begins where `guard` ends `motion`. The value the guard fixes is imposed, not computed."""
    m, angle = motion.m, motion.angle + motion.m.omega * lasts
    state = motion.state(lasts)
    if guard.leads_to == "impact":
        state = on_surface(m, state)
        return after_impact(m, angle, state)
    force = 0 if guard.leads_to == NO_CONTACT else 1
    return enter(m, angle, on_surface(m, state, force), guard.leads_to, force)


def after_impact(m, angle, state) -> Motion:
    """The slider top is weightless, so the trial force jumps: below 1 it holds, above 1 it gives way at once."""
    force = trial_force(m, state)
    slides = certain(force > 1, force < 1)
    certain(force > 0, False)
    return enter(m, angle, state, PROGRESSION if slides else CONTACT, None)

"""The events of a system file up to a time, proved, without growth and without tables.

This is the run of `system_run.py` for systems that are no cases: nothing is refused that a program
may be asked, and what is proved before a precision gives up is kept.
"""

from flint import arb_mat, ctx, fmpq

from affine_expression import number
from crossing import Undecided
from system_case import SystemCase
from system_file import Event, System
from system_run import MOST_IN_AN_INSTANT, BeyondGuard, Ended, HybridState, Row, Run


class EventRun(Run):
    """All rows up to the horizon, at the present precision."""

    def __init__(self, system: System, until: float):
        case = SystemCase(system.name, system, {}, number(until), until, 1, False)
        super().__init__(case)

    def add(self, event: str, state: HybridState, _growth=None) -> None:
        self.rows.append(Row(event, state.mode, self.elapsed, state.z, []))

    def enter_at_start(self) -> None:
        self.fire(self.state, self.entering(self.state))

    def entering(self, state: HybridState) -> list:
        """The events that fire at once on entry; a guard that is positive already ends the run."""
        try:
            return self.firing(state)
        except BeyondGuard:
            raise Ended("beyond-guard") from None

    def advance_sensitivities(self, elapsed) -> None:
        self.elapsed = elapsed

    def present_growth(self) -> list:
        return []

    def counted(self, event: Event, state: HybridState) -> None:
        self.add(event.name, state)

    def leave(self, state: HybridState, events: list) -> None:
        """Ends a segment by the first of `events`; what else fires in the same instant follows."""
        self.state = state
        count = self.fire(state, events)
        if count == 1 and self.state.mode == state.mode:
            self.end_if_accumulating(events[0], state)

    def fire(self, state: HybridState, events: list) -> int:
        """Fires the first of `events`, then the first that its reset makes fire at once, ..."""
        count = 0
        while events:
            if count == MOST_IN_AN_INSTANT:
                raise Ended("no-progress")
            self.state = self.fired(events[0], self.state)
            self.add(events[0].name, self.state)
            count, events = count + 1, self.entering(self.state)
        return count


def attempted(system: System, until: float, bits: int) -> tuple:
    """(run, None), or (the run as far as it came, why it came no further), in so many bits."""
    ctx.prec = bits
    run = EventRun(system, until)
    try:
        run.run()
    except Undecided as reason:
        return run, str(reason)
    return run, None


def clock(system: System, row: Row):
    """The time of a row as the file's clock tells it."""
    return system.start["t"] + row.elapsed.ball


def states(system: System, z: arb_mat) -> list:
    return [z[i, 0] for i in range(len(system.states))]


def start_time(system: System) -> fmpq:
    return system.start["t"]

"""The events of a system file up to a time, proved, without growth and without tables.

This is the run of `system_run.py` for systems that are no cases: nothing is refused that a program
may be asked, and what is proved before a precision gives up is kept. Errors go from event to event
as columns (`spread.py`), so that a run of some hundred events needs few bits.

Where an event has `accumulates_to`, impacts go on without rows until the time left is a share of
the bits below the unit of time, or as long as the depth of a flight is clear of errors. The limit
then follows from bounds of the rates and of the jumps up to it (`accumulation.py`).
"""

from types import SimpleNamespace

from flint import arb, arb_mat, ctx, fmpq_mat

from accumulation import Impact, changes_nothing, has_limit
from affine_expression import number
from crossing import Undecided, refine
from spread import Spread
from system_case import SystemCase
from system_crossing import Crossing, Time, crossings
from system_file import Event, System
from system_run import (
    FIRST_STEP,
    MOST_IN_AN_INSTANT,
    BeyondGuard,
    Ended,
    HybridState,
    Row,
    Run,
)


LIMIT_SHARE = 4  # of the bits a fourth: the depth of a flight then has half of them left
VAGUE = arb(2) ** -20  # error of a state, in depths of a flight, with which the limit is taken


class EventRun(Run):
    """All rows up to the horizon, at the present precision."""

    def __init__(self, system: System, until: float):
        case = SystemCase(system.name, system, {}, number(until), until, 1, False)
        super().__init__(case)
        self.spread, self.silent = Spread.of(self.state.z, arb(0)), False

    def add(self, event: str, state: HybridState, _growth=None) -> None:
        if self.silent and event not in ("accumulation", "end"):
            return
        self.rows.append(Row(event, state.mode, self.elapsed, state.z, []))

    def enter_at_start(self) -> None:
        self.fire(self.entering(self.state))

    def entering(self, state: HybridState) -> list:
        """The events that fire at once on entry; a guard that is positive already ends the run."""
        try:
            return self.firing(state)
        except BeyondGuard:
            raise Ended("beyond-guard") from None

    def pass_segment(self) -> bool:
        """One segment from `state` to the event that ends it; False at the horizon."""
        state, begins = self.state, self.elapsed
        space, left = state.space.carried(self.matrices[state.mode]), self.left()
        step = FIRST_STEP / (self.flow(state.mode).rates + 1 / arb(self.system.time_scale))
        for crossing in crossings(self.guards(state), space, left.plus(Time.of(self.margin)), step):
            self.check_margin(crossing.time, left)
            rows = [guard.event.guard for guard in crossing.watches + crossing.untils]
            here, spread = self.arrived(state, begins, crossing, space.with_rows(rows))
            for guard in crossing.watches:
                self.add(guard.event.name, here)
            if crossing.untils:
                self.state, self.spread = here, spread
                self.leave_by([guard.event for guard in crossing.untils])
                return True
        self.end(left, space)
        return False

    def arrived(self, state: HybridState, begins: Time, crossing: Crossing, space) -> tuple:
        """The state at a crossing, and the same with its errors as columns."""
        if state.exact is not None:
            here = self.advanced(state, crossing.time, space)
            self.elapsed = begins.plus(crossing.time)
            return here, Spread.of(here.z, self.elapsed.ball)
        row = (crossing.watches + crossing.untils)[0].event.guard
        spread = self.at_event(row, state, crossing.time.ball)
        self.elapsed = Time(spread.elapsed(), None)
        return HybridState(state.mode, spread.hull(), None, space), spread

    def at_event(self, row: fmpq_mat, state: HybridState, time: arb) -> Spread:
        """The present spread at the zero of a guard, which for all its states lies in `time`."""
        flow, matrix = self.flow(state.mode), arb_mat(self.matrices[state.mode])
        centre, began = self.parted()
        curve = SimpleNamespace(value=flow.curve(row, centre))
        instant = refine(curve, time.lower(), time.upper())
        exponential = flow.matrix_at(time)
        velocity = matrix * (exponential * state.z)
        rate = (arb_mat(row) * velocity)[0, 0]
        if not (rate > 0 or rate < 0):
            raise Undecided("rate at an event")
        earlier = arb_mat(row) * exponential * (-1 / rate)
        derivative = extended(exponential + velocity * earlier, earlier)
        image = with_time(flow.matrix_at(instant) * centre, began + instant)
        return self.spread.mapped(derivative, image)

    def parted(self) -> tuple:
        """The centre's state and its elapsed time."""
        entries = self.spread.centre.entries()
        return arb_mat([[entry] for entry in entries[:-1]]), entries[-1]

    def end(self, left: Time, space) -> None:
        """The row of the horizon."""
        state = self.state
        if self.elapsed.exact is None:
            flow, (centre, began) = self.flow(state.mode), self.parted()
            exponential = flow.matrix_at(left.ball)
            velocity = arb_mat(self.matrices[state.mode]) * (exponential * state.z)
            derivative = extended(exponential, arb_mat(1, self.system.size), velocity * -1, arb(0))
            image = flow.matrix_at(self.span.ball - began) * centre
            spread = self.spread.mapped(derivative, with_time(image, self.span.ball))
            self.state = HybridState(state.mode, spread.hull(), None, space)
        else:
            self.state = self.advanced(state, left, space)
        self.elapsed = self.span
        self.add("end", self.state)

    def leave_by(self, events: list) -> None:
        """Ends a segment by the first of `events`; what else fires in the same instant follows."""
        before = self.state
        impact = self.possible_impact(events[0], before, self.fire(events))
        if impact is None:
            return
        if impact.event.limit is None:
            self.end_if_accumulating(impact)
        else:
            self.approach(impact)

    def approach(self, impact: Impact) -> None:
        """Goes on without rows from an impact next to the limit, or to the limit."""
        event, remaining = impact.event, self.accumulating(impact)
        if remaining is None:
            if self.silent:
                raise Undecided("an accumulation")
            return
        if not has_limit(impact):
            raise Ended("accumulation")
        self.silent = True
        near = arb(2) ** -(ctx.prec // LIMIT_SHARE) * arb(self.system.time_scale)
        speed = (arb_mat(event.guard * impact.back.matrix) * self.state.z)[0, 0]
        vaguest = max(entry.rad() for entry in self.state.z.entries())
        is_vague = not vaguest < abs(speed) * remaining.most * VAGUE
        left = self.left().ball
        if not (remaining.most <= near or is_vague) or left < remaining.least:
            return
        if not left > remaining.most:
            raise Undecided("a horizon at an accumulation")
        self.elapsed = Time(self.elapsed.ball + remaining.least.union(remaining.most), None)
        # The limit is in the mode of the impact, with what is zero where that is entered.
        self.state = HybridState(impact.on.mode.name, remaining.state, None, impact.on.space)
        self.pass_limit(event)

    def pass_limit(self, event: Event, count: int = 0) -> None:
        """Resets the state at a limit, where what is zero after an impact and its rate are zero,
        as one event more of the instant.
        """
        state = self.state
        rate = event.guard * self.matrices[state.mode]
        state.space = state.space.with_rows([event.guard, rate])
        for i in range(self.system.size):
            unit = fmpq_mat([[int(i == j) for j in range(self.system.size)]])
            if state.space.holds(unit):
                state.z[i, 0] = 0
        self.spread = Spread.of(state.z, self.elapsed.ball)
        self.silent = False
        self.fire([event.limit], count)

    def fire(self, events: list, count: int = 0) -> int:
        """Fires the first of `events`, then the first that its reset makes fire at once, ...

        The result is the number of events in the instant, of which `count` came before.
        """
        rested = None
        while events:
            if count == MOST_IN_AN_INSTANT:
                raise Ended("no-progress")
            event, mode = events[0], self.state.mode
            self.reset(event)
            self.add(event.name, self.state)
            count, events = count + 1, self.entering(self.state)
            turns = changes_nothing(event)
            if rested is None or not (turns and self.state.mode == rested[1]):
                rested = (event, mode) if self.rests(event, mode) else None
            if events and rested is not None:
                if events[0] is rested[0] and self.state.mode == rested[1]:
                    self.pass_limit(events[0], count)
                    return count + 1
        return count

    def rests(self, event: Event, mode: str) -> bool:
        """May the limit be at this instant: are the guard and its rate in a mode zero after it?"""
        rows = [event.guard, event.guard * self.matrices[mode]]
        return event.limit is not None and all(self.state.space.holds(row) for row in rows)

    def reset(self, event: Event) -> None:
        self.state = self.fired(event, self.state)
        if self.state.exact is not None:
            self.spread = Spread.of(self.state.z, self.elapsed.ball)
            return
        reset, (centre, began) = arb_mat(event.reset), self.parted()
        derivative = extended(reset, arb_mat(1, self.system.size))
        self.spread = self.spread.mapped(derivative, with_time(reset * centre, began))
        self.state.z = self.spread.hull()


def extended(states: arb_mat, time: arb_mat, by_time: arb_mat | None = None, last=1) -> arb_mat:
    """The derivative of a state and its time, given that of both by the state, and by the time."""
    by_time = arb_mat(states.nrows(), 1) if by_time is None else by_time
    rows = [[*row, by_time[i, 0]] for i, row in enumerate(states.tolist())]
    return arb_mat([*rows, [*time.entries(), last]])


def with_time(z: arb_mat, time: arb) -> arb_mat:
    return arb_mat([[entry] for entry in [*z.entries(), time]])


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

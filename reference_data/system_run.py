"""The joined run of a case: segment after segment, every event and every sign proved."""

from dataclasses import dataclass, replace
from typing import NamedTuple

from flint import arb, arb_mat, fmpq, fmpq_mat

import modal
from accumulation import Impact, Leg, Remaining, accumulation, changes_nothing
from affine_expression import Refused
from crossing import Undecided
from harmonic import Harmonic, of_forcing, since_entry, structural_value
from structural import Space, left_kernel, multiplicity
from system_case import SystemCase
from system_crossing import Guard, Time, crossings, evaluated, exact_polynomial, nilpotent
from system_file import Event
from system_growth import Growth, distinct

MOST_IN_AN_INSTANT = 64
MOST_ORDERED = 3  # guards that fire together, all of whose orders are followed
MOST_VISITS = 4000  # of orders at one instant; beyond, the order of the file alone is followed
FIRST_STEP = arb(1) / 8
MARGIN = fmpq(1, 10**6)  # of the time scale: from any event to the horizon or a tabulated instant


@dataclass
class HybridState:
    """A state in a mode: the ball, the rational state where it is known, what is zero in it."""

    mode: str
    z: arb_mat
    exact: fmpq_mat | None
    space: Space


class Row(NamedTuple):
    """The event at one instant, and the state and mode after it."""

    event: str
    mode: str
    elapsed: Time
    z: arb_mat
    growth: list


class Segment(NamedTuple):
    """A segment, or its rest after a watched event, with the derivatives at its start."""

    state: HybridState
    begins: Time
    sensitivities: list


class Turn(NamedTuple):
    """An event that has led from the mode after an impact back to that before it."""

    event: Event
    impact: Event
    back: Leg
    on: Leg


class Cycle:
    """The last two events of a run, where an impact leads into another mode, and a turn back."""

    def __init__(self):
        self.impact, self.turn = None, None

    def passed(self, event: Event, before: HybridState, after: HybridState, legs) -> Turn | None:
        """Remembers an event that was alone in its instant: the turn before it, if it closes a cycle.

        `legs` makes the leg of a mode from its space at entry.
        """
        impact, turn = self.impact, self.turn
        self.impact, self.turn = None, None
        if impact is not None and (impact[1], impact[2].mode) == (after.mode, before.mode):
            if changes_nothing(event):
                self.turn = Turn(event, impact[0], legs(impact[2]), legs(after))
                return None
        if after.mode == before.mode:
            return None
        self.impact = (event, before.mode, after)
        if turn is None or turn.impact is not event or turn.back.mode.name != after.mode:
            return None
        return turn


class BeyondGuard(Exception):
    """A mode is entered where one of its guards is positive already."""


class Ended(Exception):
    """The run is over before its horizon; the word, if any, is for a last row still to write."""


class Run:
    """All rows of a case, at the present precision."""

    def __init__(self, case: SystemCase):
        self.case, self.system = case, case.system
        self.growth = Growth(self.system)
        self.margin = MARGIN * self.system.time_scale
        self.flows, self.matrices, self.polynomial = {}, {}, {}
        for name, mode in self.system.modes.items():
            self.matrices[name] = -mode.matrix if case.backward else mode.matrix
            self.polynomial[name] = nilpotent(mode.matrix)
        self.rows, self.segments, self.order_matters = [], [], []
        self.sensitivities = [self.growth.identity]
        self.elapsed, self.span = Time.of(fmpq(0)), Time.of(case.span())
        self.remaining: Remaining | None = None
        self.cycle = Cycle()
        self.state = self.start()

    def start(self) -> HybridState:
        """The start's balls, and as structural zeros the left kernel of its coefficients."""
        system, rows = self.system, self.system.start["state"]
        theta, size = system.omega * system.start["t"] + system.phi, system.size
        appended = range(len(rows), size)
        kept = [[row[j] for j in appended] for row in rows]
        kept += [[fmpq(int(i == j)) for j in appended] for i in appended]
        coefficients = fmpq_mat(kept)
        if system.forced and theta == 0:
            coefficients = coefficients * fmpq_mat([[1], [0], [1]])
        sine, cosine = arb(theta).sin_cos()
        basis = [cosine, sine, 1] if coefficients.ncols() == 3 else [1]
        z = arb_mat(coefficients) * arb_mat([[b] for b in basis])
        exact = coefficients if coefficients.ncols() == 1 else None
        at = HybridState(None, z, exact, Space(left_kernel(coefficients)))
        for row, mode in system.start["modes"]:
            candidate = replace(at, mode=mode)
            if row is None or self.holds_at_start(row, candidate):
                return candidate
        raise AssertionError("the last mode has no condition")

    def holds_at_start(self, row: fmpq_mat, state: HybridState) -> bool:
        """Whether a condition holds at the start, by the motion forward in time."""
        order, sign = self.first_sign(row, state)
        if order and self.case.backward:
            raise Refused("the mode of a start of a run back in time hangs on a derivative")
        return sign > 0

    def run(self) -> None:
        """Fills `rows`; the last one says how the run ended."""
        self.add("", self.state, [arb(1)] * (1 + len(self.system.states)))
        try:
            self.enter_at_start()
            while self.pass_segment():
                pass
        except Ended as ending:
            if ending.args:
                self.add(str(ending), self.state, self.rows[-1].growth)

    def enter_at_start(self) -> None:
        try:
            firing = self.firing(self.state)
        except BeyondGuard:
            raise Refused("the start lies beyond a guard") from None
        if firing:
            self.leave(self.state, firing)

    def add(self, event: str, state: HybridState, growth: list) -> None:
        self.rows.append(Row(event, state.mode, self.elapsed, state.z, growth))

    def flow(self, mode: str) -> modal.Flow:
        if mode not in self.flows:
            self.flows[mode] = modal.Flow(self.matrices[mode])
        return self.flows[mode]

    def sign(self, row: fmpq_mat, state: HybridState) -> int:
        """The sign of a row that is not structurally zero."""
        value = (row * state.exact if state.exact is not None else arb_mat(row) * state.z)[0, 0]
        if value > 0 or value < 0:
            return 1 if value > 0 else -1
        if state.exact is not None:
            raise Refused("a derivative is zero by coincidence")
        raise Undecided("sign")

    def first_sign(self, row: fmpq_mat, state: HybridState) -> tuple:
        """(multiplicity, sign) of the first derivative that is not a structural zero, or None."""
        matrix = self.matrices[state.mode]
        order = multiplicity(row, matrix, state.space)
        if order is None:
            return None, 0
        for _ in range(order):
            row = row * matrix
        return order, self.sign(row, state)

    def firing(self, state: HybridState) -> list:
        """The events of `until` that fire at once on entry."""
        found = []
        for event in self.system.modes[state.mode].until:
            order, sign = self.first_sign(event.guard, state)
            if sign > 0:
                if order == 0:
                    raise BeyondGuard
                found.append(event)
        return found

    def guards(self, state: HybridState) -> list:
        """The guards of a segment, without those that stay zero."""
        mode, matrix = self.system.modes[state.mode], self.matrices[state.mode]
        exact = self.polynomial[state.mode] and state.exact is not None
        found = []
        for event in mode.until + mode.watch:
            zeros = multiplicity(event.guard, matrix, state.space)
            if zeros is not None:
                sine = self.harmonic(event, state)
                if sine is not None and sine.keeps_its_sign():
                    continue
                polynomial = exact_polynomial(event.guard, matrix, state.exact) if exact else None
                curve = self.flow(state.mode).curve(event.guard, state.z)
                found.append(Guard(event, zeros, curve, polynomial, sine))
        return found

    def harmonic(self, event: Event, state: HybridState) -> Harmonic | None:
        """The guard's sine, if it is one: of the angle since entry, or of the forcing."""
        matrix = self.matrices[state.mode]
        kept = state.space.carried(matrix)

        def known(row: fmpq_mat) -> fmpq | None:
            if state.exact is not None:
                return (row * state.exact)[0, 0]
            return structural_value(row, state.space)

        sine = since_entry(event.guard, matrix, known, kept)
        if sine is not None or not self.system.forced or self.case.backward:
            return sine
        theta = self.system.omega * self.case.clock(self.elapsed.ball) + self.system.phi
        return of_forcing(event.guard, kept, self.system.omega, theta)

    def advanced(self, state: HybridState, time: Time, space: Space) -> HybridState:
        """The state after a time within the segment."""
        exact = None
        if time.exact is not None and state.exact is not None and self.polynomial[state.mode]:
            exact = self.moved_exactly(state, time.exact)
            return HybridState(state.mode, arb_mat(exact), exact, space)
        z = self.flow(state.mode).matrix_at(time.ball) * state.z
        z[z.nrows() - 1, 0] = 1
        return HybridState(state.mode, z, None, space)

    def moved_exactly(self, state: HybridState, time: fmpq) -> fmpq_mat:
        matrix, size = self.matrices[state.mode], self.system.size
        rows = [modal.identity(size)]
        rows = [fmpq_mat([[rows[0][i, j] for j in range(size)]]) for i in range(size)]
        values = [evaluated(exact_polynomial(row, matrix, state.exact), time) for row in rows]
        return fmpq_mat([[value] for value in values])

    def pass_segment(self) -> bool:
        """One segment from `state` to the event that ends it; False at the horizon."""
        state, begins = self.state, self.elapsed
        space = state.space.carried(self.matrices[state.mode])
        left, self.segment = self.left(), Segment(state, begins, self.sensitivities)
        step = FIRST_STEP / (self.flow(state.mode).rates + 1 / arb(self.system.time_scale))
        reach = left.plus(Time.of(self.margin))
        for crossing in crossings(self.guards(state), space, reach, step):
            self.check_margin(crossing.time, left)
            rows = [guard.event.guard for guard in crossing.watches + crossing.untils]
            here = self.advanced(state, crossing.time, space.with_rows(rows))
            self.advance_sensitivities(begins.plus(crossing.time))
            for guard in crossing.watches:
                self.counted(guard.event, here)
            if crossing.untils:
                self.leave(here, [guard.event for guard in crossing.untils])
                return True
            self.segment = Segment(here, self.elapsed, self.sensitivities)
        self.state = self.advanced(state, left, space)
        self.advance_sensitivities(self.span)
        self.add("end", self.state, self.present_growth())
        return False

    def left(self) -> Time:
        """Time from the present instant to the horizon."""
        if self.elapsed.exact is not None:
            return Time.of(self.span.exact - self.elapsed.exact)
        return Time(self.span.ball - self.elapsed.ball, None)

    def check_margin(self, time: Time, left: Time) -> None:
        """Refuses an event close to the horizon, before or after it."""
        if left.ball - time.ball > arb(self.margin):
            return
        if left.ball - time.ball <= arb(self.margin):
            raise Refused("an event close to the horizon")
        raise Undecided("an event close to the horizon")

    def advance_sensitivities(self, elapsed: Time) -> None:
        """Takes the clock and the derivatives from the start of the segment to `elapsed`."""
        segment = self.segment
        self.segments.append(segment)
        exponential = self.flow(segment.state.mode).matrix_at(elapsed.ball - segment.begins.ball)
        flow = self.growth.flow(exponential, segment.state.z)
        self.sensitivities = [flow * sensitivity for sensitivity in segment.sensitivities]
        self.elapsed = elapsed

    def counted(self, event: Event, state: HybridState) -> None:
        """A row for an event of `watch`."""
        self.sensitivities = [*self.sensitivities, self.growth.identity]
        self.add(event.name, state, self.growth_without_reset(event, state, None))

    def leave_domain(self, event: Event, state: HybridState) -> None:
        """Back in time, the boundary of a mode ends the run."""
        single = multiplicity(event.guard, self.matrices[state.mode], state.space) == 1
        at_once = None if single else arb_mat(1, self.growth.width)
        self.sensitivities = [*self.sensitivities, self.growth.identity]
        self.add("leaves-domain", state, self.growth_without_reset(event, state, at_once))
        raise Ended

    def growth_without_reset(self, event: Event, state: HybridState, shared) -> list:
        matrix, identity = self.matrices[state.mode], modal.identity(self.system.size)
        derivative = self.growth.event_derivative(
            event.guard, matrix, identity, matrix, state.z, shared
        )
        return self.growth.measured(derivative.time, derivative.state, self.sensitivities)

    def present_growth(self) -> list:
        """Growth of the states at fixed time."""
        states = self.growth.of_states(self.growth.lift(self.state.z))
        return self.growth.measured(None, states, self.sensitivities)

    def leave(self, state: HybridState, events: list) -> None:
        """Ends a segment by the first of `events`; what else fires in the same instant follows."""
        self.state = state
        if self.case.backward:
            self.leave_domain(events[0], state)
        simultaneous = SimultaneousEvents(self, state, events)
        for (event, after), growth in zip(simultaneous.fired, simultaneous.growths(), strict=True):
            self.add(event.name, after, growth)
        if simultaneous.order_matters:
            self.order_matters.append(len(self.rows) - len(simultaneous.fired))
        self.state, self.sensitivities = simultaneous.fired[-1][1], simultaneous.sensitivities
        if simultaneous.ending:
            raise Ended(simultaneous.ending)
        impact = self.possible_impact(events[0], state, len(simultaneous.fired))
        if impact is not None:
            self.end_if_accumulating(impact)

    def possible_impact(self, event: Event, before: HybridState, count: int) -> Impact | None:
        """The impact that an event, just passed with so many in its instant, may be."""
        if count != 1:
            self.cycle = Cycle()
            return None
        turn = self.cycle.passed(event, before, self.state, self.leg)
        back = self.leg(self.state)
        if turn is not None:
            return Impact(event, before.space, back, turn.on, turn.event)
        return Impact(event, before.space, back, back) if before.mode == self.state.mode else None

    def leg(self, entry: HybridState) -> Leg:
        mode = self.system.modes[entry.mode]
        return Leg(mode, self.matrices[entry.mode], entry.space)

    def end_if_accumulating(self, impact: Impact) -> None:
        if impact.event.limit is not None:
            raise Refused("tables do not go on after an accumulation")
        self.remaining = self.accumulating(impact)
        if self.remaining is not None:
            raise Ended("accumulation")

    def accumulating(self, impact: Impact) -> Remaining | None:
        """What remains up to the limit of impacts, after one of them, if that is near."""
        return accumulation(impact, self.state.z, arb(self.system.time_scale))

    def fired(self, event: Event, state: HybridState) -> HybridState:
        """The state after the reset of an event, in the mode that follows."""
        z = arb_mat(event.reset) * state.z
        exact = None if state.exact is None else event.reset * state.exact
        after = HybridState(state.mode, z if exact is None else arb_mat(exact), exact, None)
        after.space = state.space.before(event.reset)
        for row, mode in event.successors:
            candidate = replace(after, mode=mode)
            if row is None or self.first_sign(row, candidate)[1] > 0:
                return candidate
        raise AssertionError("the last successor has no condition")


class SimultaneousEvents:
    """Everything that fires in one instant, in the order of the file and in all other orders.

    `fired` are the events with the states after them in the order of the file, `sensitivities` the
    derivatives that go on, by whatever order leads into the same mode.
    """

    def __init__(self, run: Run, state: HybridState, events: list):
        self.run, self.state, self.events, self.visits = run, state, events, 0
        self.explore(MOST_ORDERED)
        if self.visits > MOST_VISITS:
            self.explore(1)

    def explore(self, most: int) -> None:
        self.most, self.visits = most, 0
        self.fired, self.ending, self.leaves, self.measured = [], None, [], []
        at_once = arb_mat(1, self.run.growth.width)
        self.visit(self.state, self.events, self.run.sensitivities, 0, True, at_once)
        last = self.fired[-1][1]
        same = [leaf for leaf in self.leaves if leaf[0].mode == last.mode]
        self.sensitivities = distinct([s for _, sensitivities in same for s in sensitivities])
        self.order_matters = any(differ(state, last) for state, _ in self.leaves)

    def growths(self) -> list:
        return self.measured[: len(self.fired)]

    def visit(self, state, events, sensitivities, stage, first, shared) -> None:
        """Fires each of `events` in turn, and then whatever its reset makes fire at once."""
        self.visits += 1
        if self.visits > MOST_VISITS:
            return
        if not events or stage == MOST_IN_AN_INSTANT:
            self.leaves.append((state, sensitivities))
            if events and first:
                self.ending = "no-progress"
            return
        for index, event in enumerate(events if len(events) <= self.most else events[:1]):
            on = first and index == 0
            after = self.run.fired(event, state)
            derivative = self.event_derivative(event, state, after, shared)
            here = [*sensitivities, self.run.growth.identity]
            self.note(stage, self.run.growth.measured(derivative.time, derivative.state, here))
            if on:
                self.fired.append((event, after))
            following = self.next_events(after, on)
            carried = [derivative.saltation * sensitivity for sensitivity in here]
            self.visit(after, following, carried, stage + 1, on, derivative.time)

    def next_events(self, state: HybridState, first: bool) -> list:
        try:
            return self.run.firing(state)
        except BeyondGuard:
            if first:
                self.ending = "beyond-guard"
            return []

    def event_derivative(self, event: Event, state: HybridState, after: HybridState, shared):
        run, matrix = self.run, self.run.matrices[state.mode]
        rate = multiplicity(event.guard, matrix, state.space)
        return run.growth.event_derivative(
            event.guard, matrix, event.reset, run.matrices[after.mode], state.z,
            shared if rate != 1 else None,
        )  # fmt: skip

    def note(self, stage: int, growth: list) -> None:
        if stage == len(self.measured):
            self.measured.append(growth)
        else:
            pairs = zip(self.measured[stage], growth, strict=True)
            self.measured[stage] = [a.max(b) for a, b in pairs]


def differ(a: HybridState, b: HybridState) -> bool:
    """Do two orders of simultaneous events end differently?"""
    if a.exact is not None and b.exact is not None:
        return a.mode != b.mode or a.exact != b.exact
    return a.mode != b.mode or not a.z.overlaps(b.z)

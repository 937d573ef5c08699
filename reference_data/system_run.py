"""The joined run of a case: segment after segment, every event and every sign proved."""

from dataclasses import dataclass, replace
from typing import NamedTuple

from flint import arb, arb_mat, fmpq, fmpq_mat

import modal
from accumulation import Remaining, accumulation
from affine_expression import Refused
from crossing import Undecided
from structural import Space, left_kernel, multiplicity
from system_case import SystemCase
from system_crossing import Guard, Moment, crossings, evaluated, exact_polynomial, nilpotent
from system_file import Event
from system_growth import Growth, distinct

MOST_IN_AN_INSTANT = 64
MOST_ORDERED = 3  # guards that fire together, all of whose orders are followed
MOST_VISITS = 4000  # of orders at one instant; beyond, the order of the file alone is followed
FIRST_STEP = arb(1) / 8
MARGIN = fmpq(1, 10**6)  # of the time scale: from any event to the horizon or a tabulated instant


@dataclass
class Place:
    """A state in a mode: the ball, the rational state where it is known, what is zero in it."""

    mode: str
    z: arb_mat
    exact: fmpq_mat | None
    space: Space


class Row(NamedTuple):
    """What happens at one instant, and the state and mode after it."""

    event: str
    mode: str
    elapsed: Moment
    z: arb_mat
    growth: list


class Leg(NamedTuple):
    """One segment, for the samples on it; `sources` are the derivatives at its start."""

    place: Place
    begins: Moment
    sources: list


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
        self.rows, self.legs, self.order_matters = [], [], []
        self.sources = [self.growth.identity]
        self.elapsed, self.span = Moment.of(fmpq(0)), Moment.of(case.span())
        self.remaining: Remaining | None = None
        self.place = self.start()

    def start(self) -> Place:
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
        return Place(system.start["mode"], z, exact, Space(left_kernel(coefficients)))

    def run(self) -> None:
        """Fills `rows`; the last one says how the run ended."""
        self.add("", self.place, [arb(1)] * (1 + len(self.system.states)))
        try:
            self.enter_at_start()
            while self.pass_segment():
                pass
        except Ended as ending:
            if ending.args:
                self.add(str(ending), self.place, self.rows[-1].growth)

    def enter_at_start(self) -> None:
        try:
            firing = self.firing(self.place)
        except BeyondGuard:
            raise Refused("the start lies beyond a guard") from None
        if firing:
            self.leave(self.place, firing)

    def add(self, event: str, place: Place, growth: list) -> None:
        self.rows.append(Row(event, place.mode, self.elapsed, place.z, growth))

    def flow(self, mode: str) -> modal.Flow:
        if mode not in self.flows:
            self.flows[mode] = modal.Flow(self.matrices[mode])
        return self.flows[mode]

    def sign(self, row: fmpq_mat, place: Place) -> int:
        """The sign of a row that is not structurally zero."""
        value = (row * place.exact if place.exact is not None else arb_mat(row) * place.z)[0, 0]
        if value > 0 or value < 0:
            return 1 if value > 0 else -1
        if place.exact is not None:
            raise Refused("a derivative is zero by coincidence")
        raise Undecided("sign")

    def first_sign(self, row: fmpq_mat, place: Place) -> tuple:
        """(multiplicity, sign) of the first derivative that is not a structural zero, or None."""
        matrix = self.matrices[place.mode]
        order = multiplicity(row, matrix, place.space)
        if order is None:
            return None, 0
        for _ in range(order):
            row = row * matrix
        return order, self.sign(row, place)

    def firing(self, place: Place) -> list:
        """The events of `until` that fire at once on entry."""
        found = []
        for event in self.system.modes[place.mode].until:
            order, sign = self.first_sign(event.guard, place)
            if sign > 0:
                if order == 0:
                    raise BeyondGuard
                found.append(event)
        return found

    def guards(self, place: Place) -> list:
        """The guards of a segment, without those that stay zero."""
        mode, matrix = self.system.modes[place.mode], self.matrices[place.mode]
        exact = self.polynomial[place.mode] and place.exact is not None
        found = []
        for event in mode.until + mode.watch:
            zeros = multiplicity(event.guard, matrix, place.space)
            if zeros is not None:
                polynomial = exact_polynomial(event.guard, matrix, place.exact) if exact else None
                curve = self.flow(place.mode).curve(event.guard, place.z)
                found.append(Guard(event, zeros, curve, polynomial))
        return found

    def advanced(self, place: Place, time: Moment, space: Space) -> Place:
        """The place after a time within the segment."""
        exact = None
        if time.exact is not None and place.exact is not None and self.polynomial[place.mode]:
            exact = self.moved_exactly(place, time.exact)
            return Place(place.mode, arb_mat(exact), exact, space)
        z = self.flow(place.mode).matrix_at(time.ball) * place.z
        z[z.nrows() - 1, 0] = 1
        return Place(place.mode, z, None, space)

    def moved_exactly(self, place: Place, time: fmpq) -> fmpq_mat:
        matrix, size = self.matrices[place.mode], self.system.size
        rows = [modal.identity(size)]
        rows = [fmpq_mat([[rows[0][i, j] for j in range(size)]]) for i in range(size)]
        values = [evaluated(exact_polynomial(row, matrix, place.exact), time) for row in rows]
        return fmpq_mat([[value] for value in values])

    def pass_segment(self) -> bool:
        """One segment from `place` to the event that ends it; False at the horizon."""
        place, begins = self.place, self.elapsed
        space = place.space.carried(self.matrices[place.mode])
        left, self.anchor = self.left(), Leg(place, begins, self.sources)
        step = FIRST_STEP / (self.flow(place.mode).rates + 1 / arb(self.system.time_scale))
        reach = left.plus(Moment.of(self.margin))
        for crossing in crossings(self.guards(place), space, reach, step):
            self.check_margin(crossing.time, left)
            rows = [guard.event.guard for guard in crossing.watches + crossing.untils]
            here = self.advanced(place, crossing.time, space.with_rows(rows))
            self.advance_sources(begins.plus(crossing.time))
            for guard in crossing.watches:
                self.counted(guard.event, here)
            if crossing.untils:
                self.leave(here, [guard.event for guard in crossing.untils])
                return True
            self.anchor = Leg(here, self.elapsed, self.sources)
        self.place = self.advanced(place, left, space)
        self.advance_sources(self.span)
        self.add("end", self.place, self.present_growth())
        return False

    def left(self) -> Moment:
        """Time from the present instant to the horizon."""
        if self.elapsed.exact is not None:
            return Moment.of(self.span.exact - self.elapsed.exact)
        return Moment(self.span.ball - self.elapsed.ball, None)

    def check_margin(self, time: Moment, left: Moment) -> None:
        """No event of a proved table is close to its horizon, before or after it."""
        if left.ball - time.ball > arb(self.margin):
            return
        if left.ball - time.ball <= arb(self.margin):
            raise Refused("an event close to the horizon")
        raise Undecided("an event close to the horizon")

    def advance_sources(self, elapsed: Moment) -> None:
        """Takes the clock and the derivatives from the anchor, within its mode, to `elapsed`."""
        leg = self.anchor
        self.legs.append(leg)
        exponential = self.flow(leg.place.mode).matrix_at(elapsed.ball - leg.begins.ball)
        flow = self.growth.flow(exponential, leg.place.z)
        self.sources = [flow * source for source in leg.sources]
        self.elapsed = elapsed

    def counted(self, event: Event, place: Place) -> None:
        """A row for an event of `watch`."""
        self.sources = [*self.sources, self.growth.identity]
        self.add(event.name, place, self.growth_without_reset(event, place, None))

    def leave_domain(self, event: Event, place: Place) -> None:
        """Back in time, the boundary of a mode ends the run."""
        single = multiplicity(event.guard, self.matrices[place.mode], place.space) == 1
        at_once = None if single else arb_mat(1, self.growth.width)
        self.sources = [*self.sources, self.growth.identity]
        self.add("leaves-domain", place, self.growth_without_reset(event, place, at_once))
        raise Ended

    def growth_without_reset(self, event: Event, place: Place, shared) -> list:
        matrix, identity = self.matrices[place.mode], modal.identity(self.system.size)
        passing = self.growth.passing(event.guard, matrix, identity, matrix, place.z, shared)
        return self.growth.measured(passing.time, passing.state, self.sources)

    def present_growth(self) -> list:
        """Growth of the states at fixed time."""
        states = self.growth.of_states(self.growth.lift(self.place.z))
        return self.growth.measured(None, states, self.sources)

    def leave(self, place: Place, events: list) -> None:
        """Ends a segment by the first of `events`; whatever fires in the same instant follows."""
        self.place = place
        if self.case.backward:
            self.leave_domain(events[0], place)
        instant = Instant(self, place, events)
        for (event, after), growth in zip(instant.fired, instant.growths(), strict=True):
            self.add(event.name, after, growth)
        if instant.order_matters:
            self.order_matters.append(len(self.rows) - len(instant.fired))
        self.place, self.sources = instant.fired[-1][1], instant.sources
        if instant.ending:
            raise Ended(instant.ending)
        if len(instant.fired) == 1 and self.place.mode == place.mode:
            self.end_if_accumulating(events[0], place)

    def end_if_accumulating(self, event: Event, before: Place) -> None:
        matrix, mode = self.matrices[before.mode], self.system.modes[before.mode]
        self.remaining = accumulation(
            event, mode, matrix, before.space, self.place.z, arb(self.system.time_scale),
            lambda other: multiplicity(other.guard, matrix, self.place.space) is None,
        )  # fmt: skip
        if self.remaining is not None:
            raise Ended("accumulation")

    def fired(self, event: Event, place: Place) -> Place:
        """The place after the reset of an event, in the mode that follows."""
        z = arb_mat(event.reset) * place.z
        exact = None if place.exact is None else event.reset * place.exact
        after = Place(place.mode, z if exact is None else arb_mat(exact), exact, None)
        after.space = place.space.before(event.reset)
        for row, mode in event.successors:
            candidate = replace(after, mode=mode)
            if row is None or self.first_sign(row, candidate)[1] > 0:
                return candidate
        raise AssertionError("the last successor has no condition")


class Instant:
    """Everything that fires in one instant, in the order of the file and in all other orders.

    `fired` are the events with the places after them in the order of the file, `sources` the
    derivatives that go on, by whatever order leads into the same mode.
    """

    def __init__(self, run: Run, place: Place, events: list):
        self.run, self.place, self.events, self.visits = run, place, events, 0
        self.explore(MOST_ORDERED)
        if self.visits > MOST_VISITS:
            self.explore(1)

    def explore(self, most: int) -> None:
        self.most, self.visits = most, 0
        self.fired, self.ending, self.leaves, self.measured = [], None, [], []
        at_once = arb_mat(1, self.run.growth.width)
        self.visit(self.place, self.events, self.run.sources, 0, True, at_once)
        last = self.fired[-1][1]
        same = [leaf for leaf in self.leaves if leaf[0].mode == last.mode]
        self.sources = distinct([s for _, sources in same for s in sources])
        self.order_matters = any(differ(place, last) for place, _ in self.leaves)

    def growths(self) -> list:
        return self.measured[: len(self.fired)]

    def visit(self, place, events, sources, stage, first, shared) -> None:
        """Fires each of `events` in turn, and then whatever its reset makes fire at once."""
        self.visits += 1
        if self.visits > MOST_VISITS:
            return
        if not events or stage == MOST_IN_AN_INSTANT:
            self.leaves.append((place, sources))
            if events and first:
                self.ending = "no-progress"
            return
        for index, event in enumerate(events if len(events) <= self.most else events[:1]):
            on = first and index == 0
            after = self.run.fired(event, place)
            passing = self.passing(event, place, after, shared)
            here = [*sources, self.run.growth.identity]
            self.note(stage, self.run.growth.measured(passing.time, passing.state, here))
            if on:
                self.fired.append((event, after))
            following = self.next_events(after, on)
            carried = [passing.saltation * source for source in here]
            self.visit(after, following, carried, stage + 1, on, passing.time)

    def next_events(self, place: Place, first: bool) -> list:
        try:
            return self.run.firing(place)
        except BeyondGuard:
            if first:
                self.ending = "beyond-guard"
            return []

    def passing(self, event: Event, place: Place, after: Place, shared):
        run, matrix = self.run, self.run.matrices[place.mode]
        rate = multiplicity(event.guard, matrix, place.space)
        return run.growth.passing(
            event.guard, matrix, event.reset, run.matrices[after.mode], place.z,
            shared if rate != 1 else None,
        )  # fmt: skip

    def note(self, stage: int, growth: list) -> None:
        if stage == len(self.measured):
            self.measured.append(growth)
        else:
            pairs = zip(self.measured[stage], growth, strict=True)
            self.measured[stage] = [a.max(b) for a, b in pairs]


def differ(a: Place, b: Place) -> bool:
    """Do two orders of simultaneous events end differently?"""
    if a.exact is not None and b.exact is not None:
        return a.mode != b.mode or a.exact != b.exact
    return a.mode != b.mode or not a.z.overlaps(b.z)

"""Infinitely many impacts before a finite time, proved, and that time enclosed."""

from typing import NamedTuple

from flint import arb, arb_mat, fmpq, fmpq_mat

from crossing import Undecided
from modal import identity
from structural import Space, multiplicity

WORTH_PROVING = 4  # times the limit: an estimate above it is not worth a proof
ENLARGEMENTS = 40
LIMIT = arb(2) ** -30  # of the time scale


class Remaining(NamedTuple):
    """The time from the last impact to the instant of accumulation lies between these."""

    least: arb
    most: arb
    state: arb_mat  # at that instant, before a reset there


class Leg(NamedTuple):
    """A mode between two impacts, with what is structurally zero at its entry."""

    mode: object
    matrix: fmpq_mat
    space: Space


class Impact(NamedTuple):
    """An impact just passed.

    `space` is what was structurally zero before its reset. The motion goes `back` from the gap at
    zero and then `on` to the next impact: in one mode, or by a `turn` from one to the other.
    """

    event: object
    space: Space
    back: Leg
    on: Leg
    turn: object | None = None


class Jumps(NamedTuple):
    """What impacts that follow one another change: each entry by so much a unit of the guard's rate.

    Entries that are the same after each of them, and idle ones, have none.
    """

    by_rate: list
    renewed: set
    idle: set


def proportion(row: fmpq_mat, unit: fmpq_mat, space: Space) -> fmpq | None:
    """The c for which `row` = c `unit` up to the space, if there is one."""
    row, unit = space.rest(row), space.rest(unit)
    pivot = next((j for j in range(unit.ncols()) if unit[0, j] != 0), None)
    if pivot is None:
        return None
    factor = row[0, pivot] / unit[0, pivot]
    return factor if row == unit * factor else None


def changes_nothing(event) -> bool:
    """Are all changes by the reset of an event multiples of its guard, which is zero there?"""
    size = event.reset.nrows()
    change, nothing = event.reset - identity(size), Space(fmpq_mat(0, size))
    return all(proportion(row_of(change, i), event.guard, nothing) is not None for i in range(size))


def restitution(impact: Impact) -> fmpq | None:
    """e, if the event is an impact: its guard stays zero and its rate turns to -e times itself."""
    event, space = impact.event, impact.space
    if not space.holds(event.guard * event.reset):
        return None
    before = event.guard * impact.on.matrix
    factor = proportion(event.guard * impact.back.matrix * event.reset, before, space)
    return -factor if factor is not None and -1 < factor < 0 else None


def turns_back(impact: Impact) -> bool:
    """Does the turn, if there is one, end the way back, where the gap's rate is zero in both modes?

    The reset of a turn changes nothing.
    """
    event, turn, back, on = impact.event, impact.turn, impact.back, impact.on
    if turn is None:
        return True
    rates = [event.guard * leg.matrix for leg in (back, on)]
    lasting = back.space.carried(back.matrix)
    return (
        changes_nothing(turn)
        and back.space.holds(rates[0] - rates[1])
        and on.space.holds(rates[1])
        and proportion(turn.guard, rates[0], lasting) is not None
    )


def jumps(impact: Impact) -> Jumps | None:
    """`Jumps`, if the sums of all changes that matter are known.

    The others are those of entries that the reset sets to a constant, and of states on which nothing
    else depends in the modes between impacts.
    """
    event, space = impact.event, impact.space
    size = event.reset.nrows()
    change, rate = event.reset - identity(size), event.guard * impact.on.matrix
    found = Jumps([fmpq(0)] * size, set(), set())
    for i in range(size):
        row = row_of(change, i)
        factor = fmpq(0) if space.holds(row) else proportion(row, rate, space)
        if factor is not None:
            found.by_rate[i] = factor
        elif is_constant(row_of(event.reset, i), space):
            found.renewed.add(i)
        elif is_idle(i, impact.back) and is_idle(i, impact.on):
            found.idle.add(i)
        else:
            return None
    return found


def has_limit(impact: Impact) -> bool:
    """Do the limit's reset and its successors take no idle entry, whose sum has no limit?"""
    limit, changes = impact.event.limit, jumps(impact)
    rows = [row_of(limit.reset, k) for k in range(limit.reset.nrows())]
    rows += [row for row, _ in limit.successors if row is not None]
    return all(row[0, i] == 0 for row in rows for i in changes.idle)


def is_constant(row: fmpq_mat, space: Space) -> bool:
    last = row.ncols() - 1
    return space.holds(fmpq_mat([[*row.entries()[:last], 0]]))


def is_idle(i: int, leg: Leg) -> bool:
    """Does nothing but the entry itself depend on it, in a mode and where the mode ends?"""
    rows = lambda matrix: (row_of(matrix, k) for k in range(matrix.nrows()) if k != i)
    others = [*rows(leg.matrix)]
    for event in leg.mode.until:
        others += [event.guard, *rows(event.reset)]
        others += [row for row, _ in event.successors if row is not None]
    return all(row[0, i] == 0 for row in others)


class Tube:
    """A box of states about `z` that holds the motion during all impacts still to come."""

    def __init__(self, impact: Impact, e: fmpq, z: arb_mat, jumps: Jumps):
        guard, self.legs = impact.event.guard, [impact.back, impact.on]
        self.e, self.z, self.jumps = arb(e), z, jumps
        self.matrices = [arb_mat(leg.matrix) for leg in self.legs]
        self.accelerations = [arb_mat(guard * leg.matrix * leg.matrix) for leg in self.legs]
        self.speed = -(arb_mat(guard * impact.back.matrix) * z)[0, 0]
        self.turns = impact.turn is not None
        self.box = z

    def widened(self, radii: list) -> arb_mat:
        size = self.z.nrows()
        return arb_mat([[self.z[i, 0] + arb(0, radii[i])] for i in range(size)])

    def remaining(self):
        """(bounds of the time left on the way back and on the way on, of the speeds of arrival).

        None if the box does not hold infinitely many impacts.
        """
        back, on = [(row * self.box)[0, 0] for row in self.accelerations]
        if not (back > 0 and on > 0):
            return None
        (b1, b2), (a1, a2) = [(it.lower(), it.upper()) for it in (back, on)]
        slowest, fastest = (a1 / b2).sqrt(), (a2 / b1).sqrt()
        if not self.e * fastest < 1:
            return None
        fewest, most = self.speed / (1 - self.e * slowest), self.speed / (1 - self.e * fastest)
        ways = [[fewest / b2, most / b1], [fewest / (a2 * b2).sqrt(), most / (a1 * b1).sqrt()]]
        return ways, [slowest * fewest, fastest * most]

    def reach(self, time: arb, speeds: arb) -> list:
        """How far each entry can go in `time`, with jumps of so much speed in all."""
        rates = [matrix * self.box for matrix in self.matrices]
        reach = [
            (
                max(abs(rate[i, 0]).upper() for rate in rates) * time
                + abs(arb(self.jumps.by_rate[i])) * speeds
            ).upper()
            for i in range(self.z.nrows())
        ]
        return [arb(0) if i in self.jumps.idle else it for i, it in enumerate(reach)]

    def settle(self) -> Remaining | None:
        """Enlarges the box until it holds the motion that its own bounds allow."""
        radii = [arb(0)] * self.z.nrows()
        for _ in range(ENLARGEMENTS):
            self.box = self.widened(radii)
            found = self.remaining()
            if found is None:
                return None
            ways, speeds = found
            least, most = [ways[0][n] + ways[1][n] for n in (0, 1)]
            reach = self.reach(most, speeds[1])
            if all(r <= allowed for r, allowed in zip(reach, radii, strict=True)):
                return Remaining(least, most, self.limit(ways, least.union(most), speeds))
            radii = [2 * r for r in reach]
        return None

    def limit(self, ways: list, time: arb, speeds: list) -> arb_mat:
        """The state where the impacts end: by rates in the box, and jumps of all speeds left."""
        speed, rates = speeds[0].union(speeds[1]), [matrix * self.box for matrix in self.matrices]
        back, on = [way[0].union(way[1]) for way in ways]
        moved = []
        for i, jump in enumerate(self.jumps.by_rate):
            if i in self.jumps.renewed | self.jumps.idle:
                moved.append(arb(0))
                continue
            along = rates[0][i, 0] * back + rates[1][i, 0] * on if self.turns else rates[0][i, 0] * time
            moved.append(along + arb(jump) * speed)
        return arb_mat([[self.z[i, 0] + moved[i]] for i in range(self.z.nrows())])


def accumulation(impact: Impact, z: arb_mat, unit: arb) -> Remaining | None:
    """`Remaining` after an impact into state `z`, if it is proved and short enough, else None."""
    e = restitution(impact)
    if e is None or not turns_back(impact):
        return None
    changes = jumps(impact)
    if changes is None:
        return None
    tube = Tube(impact, e, z, changes)
    if not worth_proving(tube, unit):
        return None
    remaining = tube.settle()
    if remaining is None or not nothing_else_happens(impact, tube.box, z):
        return None
    if remaining.most > LIMIT * unit:
        return None
    if not remaining.most <= LIMIT * unit:
        raise Undecided("accumulation")
    return remaining


def worth_proving(tube: Tube, unit: arb) -> bool:
    found = tube.remaining()
    if found is None:
        return False
    return bool(found[0][0][1] + found[0][1][1] < WORTH_PROVING * LIMIT * unit)


def nothing_else_happens(impact: Impact, box: arb_mat, z: arb_mat) -> bool:
    """Over the box: all other guards of `until` negative, and every successor as it was."""
    event, turn, back, on = impact.event, impact.turn, impact.back, impact.on
    rate = event.guard * on.matrix

    def leads_back() -> bool:
        at = [z if keeps_sign(row, event, rate, impact.space) else box for row, _ in event.successors]
        return leads(event, back.mode, at)

    if turn is None:
        return stay_inside(event, back, [], box) and leads_back()
    rates = [event.guard * leg.matrix for leg in (back, on)]
    return (
        stay_inside(event, back, [rates[0], event.guard], box)
        and stay_inside(event, on, [rates[1]], box)
        and leads_back()
        and leads(turn, on.mode, [box for _ in turn.successors])
    )


def stay_inside(event, leg: Leg, kept: list, box: arb_mat) -> bool:
    """Are the guards of a mode's `until` negative, but for those that cannot fire?

    Those are the impact's own, those that stay zero, and multiples of `kept` rows: the impact and
    the turn give these a sign that they keep.
    """
    lasting = leg.space.carried(leg.matrix)
    for other in leg.mode.until:
        if other is event or multiplicity(other.guard, leg.matrix, leg.space) is None:
            continue
        if any(proportion(other.guard, row, lasting) is not None for row in kept):
            continue
        if not (arb_mat(other.guard) * box)[0, 0] < 0:
            return False
    return True


def keeps_sign(row: fmpq_mat | None, event, rate: fmpq_mat, space: Space) -> bool:
    """Is a condition after an impact a multiple of the guard's rate before it?"""
    return row is not None and proportion(row * event.reset, rate, space) not in (None, 0)


def leads(event, mode, boxes: list) -> bool:
    """Does an event lead into the mode, from all states of the box of each condition?"""
    for (row, name), box in zip(event.successors, boxes, strict=True):
        holds = None if row is None else (arb_mat(row) * box)[0, 0]
        if row is None or holds > 0:
            return name == mode.name
        if not holds < 0:
            return False
    return False


def row_of(matrix: fmpq_mat, index: int) -> fmpq_mat:
    return fmpq_mat([[matrix[index, j] for j in range(matrix.ncols())]])

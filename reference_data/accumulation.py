"""Infinitely many impacts before a finite time, proved, and that time enclosed."""

from typing import NamedTuple

from flint import arb, arb_mat, fmpq, fmpq_mat

from crossing import Undecided
from modal import identity
from structural import Space

WORTH_PROVING = 4  # times the limit: an estimate above it is not worth a proof
ENLARGEMENTS = 40
LIMIT = arb(2) ** -30  # of the time scale


class Remaining(NamedTuple):
    """The time from the last impact to the instant of accumulation lies between these."""

    least: arb
    most: arb
    state: arb_mat  # at that instant, before a reset there


def proportion(row: fmpq_mat, unit: fmpq_mat, space: Space) -> fmpq | None:
    """The c for which `row` = c `unit` up to the space, if there is one."""
    row, unit = space.rest(row), space.rest(unit)
    pivot = next((j for j in range(unit.ncols()) if unit[0, j] != 0), None)
    if pivot is None:
        return None
    factor = row[0, pivot] / unit[0, pivot]
    return factor if row == unit * factor else None


def restitution(event, matrix: fmpq_mat, space: Space) -> fmpq | None:
    """e, if the event is an impact: its guard stays zero and its rate turns to -e times itself.

    `space` is what is structurally zero at the event, before its reset.
    """
    if not space.holds(event.guard * event.reset):
        return None
    factor = proportion(event.guard * matrix * event.reset, event.guard * matrix, space)
    return -factor if factor is not None and -1 < factor < 0 else None


class Tube:
    """A box of states about `z` that holds the motion during all impacts still to come."""

    def __init__(self, event, e: fmpq, matrix: fmpq_mat, z: arb_mat, jumps: list):
        self.e, self.z, self.jumps, self.matrix = arb(e), z, jumps, arb_mat(matrix)
        self.acceleration = arb_mat(event.guard * matrix * matrix)
        self.speed = -(arb_mat(event.guard * matrix) * z)[0, 0]
        self.box = z

    def widened(self, radii: list) -> arb_mat:
        size = self.z.nrows()
        return arb_mat([[self.z[i, 0] + arb(0, radii[i])] for i in range(size)])

    def remaining(self):
        """(bounds of the time left and of the speeds of arrival), if the box holds the rest."""
        acceleration = (self.acceleration * self.box)[0, 0]
        if not acceleration > 0:
            return None
        least, most = acceleration.lower(), acceleration.upper()
        spread = (most / least).sqrt()
        ratio = self.e * spread
        if not ratio < 1:
            return None
        shortest = 2 * self.speed / (most * (1 - self.e / spread))
        longest = 2 * self.speed / (least * (1 - ratio))
        fewest = self.speed / (spread - self.e)
        return [shortest, longest], [fewest, self.speed * spread / (1 - ratio)]

    def reach(self, time: arb, speeds: arb) -> list:
        """How far each entry can go in `time`, with jumps of so much speed in all."""
        rates = self.matrix * self.box
        return [
            (abs(rates[i, 0]).upper() * time + abs(arb(self.jumps[i])) * speeds).upper()
            for i in range(self.z.nrows())
        ]

    def settle(self) -> Remaining | None:
        """Enlarges the box until it holds the motion that its own bounds allow."""
        radii = [arb(0)] * self.z.nrows()
        for _ in range(ENLARGEMENTS):
            self.box = self.widened(radii)
            found = self.remaining()
            if found is None:
                return None
            times, speeds = found
            reach = self.reach(times[1], speeds[1])
            if all(r <= allowed for r, allowed in zip(reach, radii, strict=True)):
                return Remaining(*times, self.limit(times, speeds))
            radii = [2 * r for r in reach]
        return None

    def limit(self, times: list, speeds: list) -> arb_mat:
        """The state where the impacts end: by rates in the box, and jumps of all speeds left."""
        time, speed = times[0].union(times[1]), speeds[0].union(speeds[1])
        rates = self.matrix * self.box
        moved = [rates[i, 0] * time + arb(jump) * speed for i, jump in enumerate(self.jumps)]
        return arb_mat([[self.z[i, 0] + moved[i]] for i in range(self.z.nrows())])


def accumulation(event, mode, matrix: fmpq_mat, space: Space, z: arb_mat, unit: arb, stays):
    """`Remaining` after an impact into state `z`, if it is proved and short enough, else None.

    `space` is what was structurally zero at the impact. `stays(event)` tells whether another
    guard of the mode stays structurally zero, and so cannot fire.
    """
    e = restitution(event, matrix, space)
    if e is None:
        return None
    size = matrix.nrows()
    change = event.reset - identity(size)
    rate, rows = event.guard * matrix, [row_of(change, i) for i in range(size)]
    jumps = [proportion(row, rate, space) for row in rows]
    tube = Tube(event, e, matrix, z, jumps)
    if None in jumps or not worth_proving(tube, unit):
        return None
    remaining = tube.settle()
    if remaining is None or not nothing_else_fires(event, mode, tube.box, stays):
        return None
    if remaining.most > LIMIT * unit:
        return None
    if not remaining.most <= LIMIT * unit:
        raise Undecided("accumulation")
    return remaining


def worth_proving(tube: Tube, unit: arb) -> bool:
    found = tube.remaining()
    return found is not None and bool(found[0][1] < WORTH_PROVING * LIMIT * unit)


def nothing_else_fires(event, mode, box: arb_mat, stays) -> bool:
    """Over the box: all other guards of `until` negative, and every successor the same mode."""
    others = [other for other in mode.until if other is not event and not stays(other)]
    if not all((arb_mat(other.guard) * box)[0, 0] < 0 for other in others):
        return False
    for row, name in event.successors:
        holds = None if row is None else (arb_mat(row) * box)[0, 0]
        if row is None or holds > 0:
            return name == mode.name
        if not holds < 0:
            return False
    return False


def row_of(matrix: fmpq_mat, index: int) -> fmpq_mat:
    return fmpq_mat([[matrix[index, j] for j in range(matrix.ncols())]])

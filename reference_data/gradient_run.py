"""The derivatives of a proved run's events by a name, one event after the other.

In a segment z' = M z, so that s, the derivative of z by the name at a given time, obeys s' = M s +
dM z. At an event with guard w the time moves by dT = -(w s + dw z)/(w M z), and s at that moving
time is more by M z dT; a reset R leaves R s + dR z. All coefficients and their derivatives are
exact; z comes from the run, whose errors do not pile up. Where motion and instants are rational, so
are the derivatives, and are known exactly.
"""

from typing import NamedTuple

from flint import arb, arb_mat, fmpq, fmpq_mat

from affine_expression import Refused
from coefficient_derivatives import Matrix, parts
from crossing import Undecided
from first_order import FirstOrder
from modal import Flow
from proved_events import EventRun
from structural import Space
from system_crossing import nilpotent
from system_file import Event, System


class Gradient(NamedTuple):
    """The derivatives of an event's time and of the states after it, and which are zero.

    `zeros` says of each, time first, whether the model makes it zero.
    """

    time: arb | fmpq
    states: list
    zeros: list


class GradientRun:
    """The derivatives along a run, at the precision at which it was made.

    `y` is (s, z), with s at the moving time of the last event that is no watched one; a matrix of
    rational numbers as long as they are known.
    """

    def __init__(self, run: EventRun, system: System):
        self.run, self.system, self.flows = run, system, {}
        self.previous = run.rows[0]
        self.time = parts(system.start["t"])[1]
        angle, turn = parts(system.omega * system.start["t"] + system.phi)
        coefficients = self.start_coefficients()
        self.y = self.at_start(coefficients, angle, turn)
        is_at_zero = system.forced and angle == 0
        self.zeros = FirstOrder.at_start(coefficients, turn, is_at_zero, self.time)
        self.check_entry(self.previous.mode)

    def start_coefficients(self) -> Matrix:
        """z at the start as coefficients of cos theta, sin theta and 1, or of 1 alone."""
        rows, size = self.system.start["state"], self.system.size
        appended = range(len(rows), size)
        kept = [[parts(row[j]) for j in appended] for row in rows]
        kept += [[parts(fmpq(int(i == j))) for j in appended] for i in appended]
        return Matrix(*(fmpq_mat([[entry[k] for entry in row] for row in kept]) for k in (0, 1)))

    def at_start(self, coefficients: Matrix, angle: fmpq, turn: fmpq):
        """(s, z) at the start."""
        if not self.system.forced:
            return joined(coefficients.rate, coefficients.value)
        sine, cosine = arb(angle).sin_cos()
        base = arb_mat([[cosine], [sine], [1]])
        slope = arb_mat([[-sine * turn], [cosine * turn], [0]])
        s = product(coefficients.rate, base) + product(coefficients.value, slope)
        return joined(s, self.previous.z)

    def gradients(self):
        """The derivatives of each row of the run, row 0 first."""
        yield self.gradient()
        for row in self.run.rows[1:]:
            before = self.y, self.time, self.zeros
            event = self.step(row)
            yield self.gradient()
            if event is not None and event.watched:
                self.y, self.time, self.zeros = before
            else:
                self.previous = row

    def gradient(self) -> Gradient:
        states = range(len(self.system.states))
        zeros = [self.zeros.still(), *(self.zeros.is_zero(i) for i in states)]
        return Gradient(self.time, [self.y[i, 0] for i in states], zeros)

    def step(self, row) -> Event | None:
        """Goes on to a row; the event that it is, unless it is the horizon."""
        mode = self.system.modes[self.previous.mode]
        if row.event == "end":
            self.zeros = FirstOrder.at_given_time(self.move(row))
            self.time = fmpq(0)
            return None
        events = [event for event in mode.until + mode.watch if event.name == row.event]
        if not events:
            raise Refused(f"the run ends with {row.event!r}: a case runs up to its horizon")
        if row.elapsed is not self.previous.elapsed:
            self.cross(self.move(row), events[0], mode)
        if not events[0].watched:
            self.leave(events[0], row)
            if isinstance(self.y, arb_mat):
                self.y = joined(half(self.y, 0), row.z)
        return events[0]

    def move(self, row) -> Space:
        """Takes s to that at a given time, and (s, z) to the time of a row; what is zero there."""
        matrix = self.system.modes[self.previous.mode].matrix
        self.shift(matrix, -self.time)
        lasting = self.zeros.lasting(matrix)
        times = [row.elapsed.exact, self.previous.elapsed.exact]
        if isinstance(self.y, fmpq_mat) and None not in times and nilpotent(matrix.value):
            self.y = moved_exactly(matrix.doubled(), self.y, times[0] - times[1])
            return lasting
        elapsed = row.elapsed.ball - self.previous.elapsed.ball
        self.y = self.flow(self.previous.mode).matrix_at(elapsed) * arb_mat(self.y)
        return lasting

    def flow(self, mode: str) -> Flow:
        if mode not in self.flows:
            self.flows[mode] = Flow(self.system.modes[mode].matrix.doubled())
        return self.flows[mode]

    def shift(self, matrix: Matrix, later) -> None:
        """Adds to s what the motion makes in a time that moves with the name."""
        s, z = half(self.y, 0), half(self.y, 1)
        if isinstance(later, arb):
            s, z = arb_mat(s), arb_mat(z)
        self.y = joined(s + product(matrix.value, z) * later, z)

    def cross(self, lasting: Space, event: Event, mode) -> None:
        """Goes from s at a given time to s at the time of the event."""
        rate = product(event.guard.value * mode.matrix.value, half(self.y, 1))[0, 0]
        if not (rate > 0 or rate < 0):
            raise Undecided("rate at an event")
        self.time = -product(event.guard.of_derivative(), self.y)[0, 0] / rate
        self.shift(mode.matrix, self.time)
        self.zeros = FirstOrder.crossed(lasting, event.guard, mode.matrix)
        for other in mode.until + mode.watch:
            if other is not event:
                self.check_other(other)

    def check_other(self, other: Event) -> None:
        """Refuses an instant at which another guard is zero, unless it is so to first order."""
        if self.zeros.holds(other.guard):
            return
        value = product(other.guard.of_value(), self.y)[0, 0]
        if value == 0 and isinstance(value, fmpq):
            raise Refused(f"one-sided: a tie with {other.name!r}")
        if not (value > 0 or value < 0):
            raise Undecided(f"a tie with {other.name!r}")

    def leave(self, event: Event, row) -> None:
        """Ends the mode by an event of `until`."""
        self.y = product(event.reset.doubled(), self.y)
        self.zeros = self.zeros.after(event.reset)
        for condition, mode in event.successors:
            if mode == row.mode and (condition is None or self.sign(condition, mode) > 0):
                break
            if condition is not None and self.sign(condition, mode) > 0:
                raise Refused(f"{event.name}: another successor than that of the run")
        self.check_entry(row.mode)

    def check_entry(self, mode: str) -> None:
        """Refuses an entry at which a guard is zero, but not to first order."""
        for event in self.system.modes[mode].until + self.system.modes[mode].watch:
            self.sign(event.guard, mode)

    def sign(self, row: Matrix, mode: str) -> int:
        """The sign of a row's first derivative that is not zero to first order; 0 if all are."""
        matrix = self.system.modes[mode].matrix
        order = self.zeros.order(row, matrix)
        if order is None:
            return 0
        derivative = row.value
        for _ in range(order):
            derivative = derivative * matrix.value
        value = product(derivative, half(self.y, 1))[0, 0]
        if not (value > 0 or value < 0):
            raise Undecided("sign at an entry")
        return 1 if value > 0 else -1


def product(matrix: fmpq_mat, y):
    """A product that is exact where y is."""
    return matrix * y if isinstance(y, fmpq_mat) else arb_mat(matrix) * y


def moved_exactly(matrix: fmpq_mat, y: fmpq_mat, time: fmpq) -> fmpq_mat:
    """exp(`matrix` `time`) y, for a nilpotent matrix."""
    term, total = y, y
    for k in range(1, matrix.nrows()):
        term = matrix * term * (time / k)
        total = total + term
    return total


def half(y, which: int):
    """s, or z."""
    size = y.nrows() // 2
    return type(y)([[y[which * size + i, 0]] for i in range(size)])


def joined(s, z):
    return type(s)([[entry] for entry in [*s.entries(), *z.entries()]])

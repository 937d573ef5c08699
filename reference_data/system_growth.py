"""How much a run amplifies an error made at, or before, any of its events.

The growth of a quantity at event n is the largest, over m <= n and at least 1, of the Euclidean
norm of its gradient with respect to the state just before event m (m = 0 is the start). The state
is theta, where the system is forced, and the states; states are divided by their scales and times
by the time scale before any norm.
"""

from flint import arb, arb_mat, fmpq_mat

from modal import identity
from system_file import System


class EventDerivative:
    """The gradients at an event: what the event does to small changes of the state.

    `before` is z just before the event, which has the guard row `guard` in a mode with matrix
    `matrix`; `reset` leads to a mode with matrix `following`. Where the guard's rate is
    structurally zero the event comes with the one before it, whose gradient of time is `shared`.
    """

    def __init__(self, growth, guard, matrix, reset, following, before, shared=None):
        velocity, lifted = matrix * before, growth.lift(before)
        self.time = shared if shared is not None else -(guard * lifted) / (guard * velocity)[0, 0]
        at_event = reset * (lifted + velocity * self.time)
        self.state = growth.of_states(at_event)
        later = growth.of_states(at_event - (following * (reset * before)) * self.time)
        self.saltation = growth.with_theta(later)


class Growth:
    """Collects derivatives of the present state by the states at which errors entered."""

    def __init__(self, system: System):
        self.count, self.size, self.forced = len(system.states), system.size, int(system.forced)
        self.width = self.count + self.forced
        self.scales = [arb(1)] * self.forced + [arb(s) for s in system.scales]
        self.time_scale = arb(system.time_scale)
        self.identity = arb_mat(identity(self.width))

    def lift(self, z: arb_mat) -> arb_mat:
        """Changes of z by changes of theta and the states."""
        lifted = arb_mat(self.size, self.width)
        for i in range(self.count):
            lifted[i, i + self.forced] = 1
        if self.forced:
            lifted[self.count, 0] = -z[self.count + 1, 0]
            lifted[self.count + 1, 0] = z[self.count, 0]
        return lifted

    def of_states(self, rows: arb_mat) -> arb_mat:
        return arb_mat([[rows[i, j] for j in range(rows.ncols())] for i in range(self.count)])

    def with_theta(self, states: arb_mat) -> arb_mat:
        """Puts theta, which no event and no flow changes, on top of the rows of the states."""
        top = [[int(j == 0) for j in range(self.width)]] if self.forced else []
        rows = [[states[i, j] for j in range(self.width)] for i in range(self.count)]
        return arb_mat(top + rows)

    def flow(self, exponential: arb_mat, z: arb_mat) -> arb_mat:
        """Changes at the end of a segment by those at its start, both at fixed time."""
        return self.with_theta(self.of_states(exponential * self.lift(z)))

    def event_derivative(
        self, guard: fmpq_mat, matrix, reset, following, before, shared=None
    ) -> EventDerivative:
        rational = (arb_mat(part) for part in (guard, matrix, reset, following))
        return EventDerivative(self, *rational, before, shared)

    def measured(self, time, states: arb_mat, sensitivities: list) -> list:
        """Growth of the time and of each state, given their gradients by the present state."""
        rows = [None if time is None else [time[0, j] for j in range(self.width)]]
        rows += [[states[i, j] for j in range(self.width)] for i in range(self.count)]
        units = [self.time_scale, *self.scales[self.forced :]]
        found = []
        for row, unit in zip(rows, units, strict=True):
            largest = arb(1)
            for sensitivity in sensitivities if row is not None else []:
                largest = largest.max(self.at_least_one(arb_mat([row]) * sensitivity, unit))
            found.append(largest)
        return found

    def at_least_one(self, gradient: arb_mat, unit: arb) -> arb:
        """The norm of a scaled gradient in a unit, or 1 where that is more."""
        scaled = (gradient[0, j] * self.scales[j] / unit for j in range(self.width))
        square = sum((entry * entry for entry in scaled), arb(0))
        return arb(1) if square < 1 else square.max(arb(1)).sqrt()


def distinct(sensitivities: list) -> list:
    """The sensitivities without repetitions, as orders of simultaneous events often make them."""
    kept = []
    for sensitivity in sensitivities:
        if not any(sensitivity.overlaps(other) for other in kept):
            kept.append(sensitivity)
    return kept

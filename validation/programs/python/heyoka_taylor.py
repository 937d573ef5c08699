"""heyoka's Taylor integrator with its own events, run by percuss.

heyoka looks for events in the Taylor polynomial of each step, and misses no crossing in it.
`taylor-default` is the documentation's first terminal event: an expression that stops the run, the
tolerance set, and nothing else. `taylor` is what an expert adds:

- The direction of a crossing is looked at in its callback. With a `direction` heyoka 7.13.2 misses a
  root in a step that begins on an exact zero, where the guard crosses in the other direction.
- A guard that is zero where a mode begins has roots near that begin which are rounding: of a zero of
  order k within eps^(1/k). They are passed over by the event's callback, as is a guard that stays
  zero. The cooldown is given: the one that heyoka deduces after a double zero hides the next event.
- What follows an event is told by the first derivative that is not zero.

Each mode is compiled once a run. A step counts as one right-hand side for each order.
"""

import time

import numpy as np
from percuss_program import Failure, serve, unavailable

try:
    import heyoka as hy
except ImportError as why:
    unavailable(str(why))

# After a crossing that was passed over, in the shortest time in which the system changes.
COOLDOWN = 1e-6
# Steps between two looks at the clock.
STEPS = 1000


def affine(row, names, system):
    """The expression of a row over (z, cos theta, sin theta, 1)."""
    theta = system.omega * hy.time + system.phi
    terms = [*names, hy.cos(theta), hy.sin(theta), hy.expression(1.0)]
    used = [value * term for value, term in zip(row.tolist(), terms) if value != 0.0]
    return hy.sum(used) if used else hy.expression(0.0) * names[0]


class Mode:
    """A mode, compiled, with what its events have found."""

    def __init__(self, course, place, is_default):
        self.course, self.is_default = course, is_default
        self.events = course.system.modes[place].events
        self.zeros, self.began, self.counted = {}, 0.0, []
        size = len(course.z)
        names = [hy.expression(f"x{n}") for n in range(size)]
        rows = course.system.modes[place].wide[:size]
        terminal, counted = [], []
        cooldown = COOLDOWN * course.run["times"]["shortest"]
        self.ending = [n for n, event in enumerate(self.events) if event.ends]
        for n, event in enumerate(self.events):
            guard = affine(event.row, names, course.system)
            if not event.ends:
                counted.append(hy.nt_event(guard, self.counter(n)))
            elif is_default:
                terminal.append(hy.t_event(guard))
            else:
                stop = self.stopper(n)
                terminal.append(hy.t_event(guard, callback=stop, cooldown=cooldown))
        self.integrator = hy.taylor_adaptive(
            [(name, affine(row, names, course.system)) for name, row in zip(names, rows)],
            course.z,
            tol=course.run["tolerance"]["relative"],
            t_events=terminal,
            nt_events=counted,
        )

    def is_none(self, place, t, sign):
        """Whether a crossing does not count: it has the other direction, or is that of a guard
        which was zero where the mode begins."""
        if self.events[place].sign not in (0, sign):
            return True
        if self.is_default or place not in self.zeros:
            return False
        order, after = self.zeros[place]
        if after == 0.0:
            return True
        near = (64 * np.finfo(float).eps) ** (1 / order)
        return t - self.began <= near * self.course.run["times"]["shortest"]

    def counter(self, place):
        def count(integrator, t, sign):
            if not self.is_none(place, t, sign):
                integrator.update_d_output(t)
                self.counted.append((t, place, integrator.d_output.copy()))

        return count

    def stopper(self, place):
        # True lets the run go on.
        return lambda integrator, sign: self.is_none(place, integrator.time, sign)

    def begin(self, zeros):
        course, integrator = self.course, self.integrator
        self.zeros, self.began, self.counted = zeros, course.t, []
        integrator.time = course.t
        integrator.state[:] = course.z
        integrator.reset_cooldowns()

    def run(self):
        """Runs to the next event that ends the mode, which is returned, or to the horizon."""
        course, integrator, meter = self.course, self.integrator, self.course.meter
        while True:
            due = course.pending()
            done = integrator.propagate_until(course.span, max_steps=STEPS, c_output=len(due) > 0)
            outcome, steps, output = done[0], done[3], done[4]
            meter.steps += steps
            meter.rhs += steps * integrator.order
            if meter.rhs > meter.most or time.monotonic() > meter.deadline:
                meter.give_up("too many steps")
            self.take(due, output)
            if outcome == hy.taylor_outcome.time_limit:
                return None
            if outcome == hy.taylor_outcome.err_nf_state:
                raise Failure("the state is not finite")
            if int(outcome) < 0 and int(outcome) >= -len(self.ending):
                return self.ending[-int(outcome) - 1]

    def take(self, due, output):
        """Takes over what was counted and sampled."""
        for t, place, state in sorted(self.counted, key=lambda it: it[0]):
            self.course.report(t, place, self.course.mode, state)
        self.counted.clear()
        if output is not None:
            inside = due[due < self.integrator.time]
            self.course.sample(inside, lambda t: output(t).copy())


def make(setup, course):
    is_default = setup.endswith("-default")
    switch = course.system.switch_plainly if is_default else None
    modes, passed = {}, None
    while course.goes_on():
        events = course.system.modes[course.mode].events
        fires, zeros = (None, {}) if is_default else course.system.entry(
            course.mode, course.t, course.z, passed
        )
        if fires is None:
            if course.mode not in modes:
                modes[course.mode] = Mode(course, course.mode, is_default)
            mode = modes[course.mode]
            mode.begin(zeros)
            fires = mode.run()
            t, z = mode.integrator.time, mode.integrator.state.copy()
        else:
            t, z = course.t, course.z
        if fires is None:
            course.t, course.z = course.span, z
            return
        passed = events[fires]
        course.pass_event(t, fires, z, switch)


def setups():
    for name in ("taylor", "taylor-default"):
        yield {
            "name": name,
            "method": "Taylor series of the order that the tolerance asks for",
            "class": "taylor",
            "events": "library",
            "dense_output": True,
            "stepping": "adaptive",
        }


if __name__ == "__main__":
    serve("heyoka", hy.__version__, list(setups()), make)

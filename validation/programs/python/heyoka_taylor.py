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

Derivatives of both are as the documentation computes the sensitivity of an event: the variational
equations of `var_ode_sys` run to the event's time, which moves by the change of the event's
expression over its rate. Each name is a parameter, by which every coefficient has its derivative.

Each mode is compiled once a run. A step counts as one right-hand side for each order.
"""

import time

import numpy as np
from percuss_program import Failure, by_hand, chained, serve, unavailable

try:
    import heyoka as hy
except ImportError as why:
    unavailable(str(why))

# After a crossing that was passed over, in the shortest time in which the system changes.
COOLDOWN_TIME = 1e-6
# Steps between two looks at the clock.
STEPS_PER_CLOCK_READING = 1000


def affine(row, names, system, theta=None):
    """The expression of a row over (z, cos theta, sin theta, 1)."""
    if theta is None:
        theta = system.omega * hy.time + system.phi
    terms = [*names, hy.cos(theta), hy.sin(theta), hy.expression(1.0)]
    used = [value * term for value, term in zip(row.tolist(), terms) if value != 0.0]
    return hy.sum(used) if used else hy.expression(0.0) * names[0]


class Variations:
    """The variational equations of the modes of a run, each compiled where it is needed."""

    def __init__(self, course):
        self.course, self.compiled = course, {}

    def of(self, mode, by):
        """The integrator of a mode whose parameters are changes of the names."""
        if mode in self.compiled:
            return self.compiled[mode]
        system, size = self.course.system, len(self.course.z)
        names = [hy.expression(f"x{n}") for n in range(size)]
        changes = [hy.par[n] for n in range(len(by))]
        moved = lambda own, of: own + sum(change * of(it) for change, it in zip(changes, by))
        omega = moved(hy.expression(system.omega), lambda it: it.omega)
        theta = omega * hy.time + moved(hy.expression(system.phi), lambda it: it.phi)
        rates = []
        for n, row in enumerate(system.modes[mode].wide[:size]):
            terms = [affine(row, names, system, theta)]
            for change, it in zip(changes, by):
                terms.append(change * affine(it.matrices[mode][n], names, system, theta))
            rates.append(hy.sum(terms))
        equations = hy.var_ode_sys(list(zip(names, rates)), changes)
        tolerance = self.course.run["tolerance"]["relative"]
        start = np.zeros(size * (1 + len(by)))
        self.compiled[mode] = hy.taylor_adaptive(equations, start, tol=tolerance, compact_mode=True)
        return self.compiled[mode]

    def along(self, began, end):
        """Derivatives at fixed times along a stretch."""
        mode = self.course.mode

        def sensitivity(by, states):
            integrator, (begin, z) = self.of(mode, by), began
            # Behind the state stand the derivatives of each state by all names.
            integrator.time = begin
            integrator.state[:] = [*z, *states.T.flatten()]
            if integrator.propagate_until(end)[0] != hy.taylor_outcome.time_limit:
                raise Failure("the variational equations have no end")
            return integrator.state[len(z) :].reshape(states.T.shape).T.copy()

        return sensitivity


class Mode:
    """A mode, compiled, with what its events have found."""

    def __init__(self, course, place, is_default, variations):
        self.variations = variations
        self.course, self.is_default = course, is_default
        self.events = course.system.modes[place].events
        self.zeros, self.began, self.counted = {}, 0.0, []
        size = len(course.z)
        names = [hy.expression(f"x{n}") for n in range(size)]
        rows = course.system.modes[place].wide[:size]
        terminal, counted = [], []
        cooldown = COOLDOWN_TIME * course.run["times"]["shortest"]
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
        self.last = course.t, course.z
        integrator.time = course.t
        integrator.state[:] = course.z
        if integrator.with_events:
            integrator.reset_cooldowns()

    def run(self):
        """Runs to the next event that ends the mode, which is returned, or to the horizon."""
        course, integrator, meter = self.course, self.integrator, self.course.meter
        while True:
            due = course.pending()
            done = integrator.propagate_until(
                course.span, max_steps=STEPS_PER_CLOCK_READING, c_output=len(due) > 0
            )
            outcome, steps, output = done[0], done[3], done[4]
            meter.steps += steps
            meter.rhs += steps * integrator.order
            if meter.rhs > meter.most or time.monotonic() > meter.deadline:
                meter.give_up("too many steps")
            self.take(due, output)
            if outcome == hy.taylor_outcome.time_limit:
                self.pass_on(course.span, integrator.state.copy(), None)
                return None
            if outcome == hy.taylor_outcome.err_nf_state:
                raise Failure("the state is not finite")
            if int(outcome) < 0 and int(outcome) >= -len(self.ending):
                place = self.ending[-int(outcome) - 1]
                self.pass_on(integrator.time, integrator.state.copy(), place)
                return place

    def pass_on(self, t, z, place):
        """Notes a stretch, for derivatives."""
        along = self.variations.along(self.last, t)
        self.course.trail.append(by_hand(self.course, self.last, (t, z), place, along))
        self.last = t, z

    def take(self, due, output):
        """Takes over what was counted and sampled."""
        for t, place, state in sorted(self.counted, key=lambda it: it[0]):
            self.pass_on(t, state, place)
            self.course.report(t, place, self.course.mode, state)
        self.counted.clear()
        if output is not None:
            inside = due[due < self.integrator.time]
            self.course.sample(inside, lambda t: output(t).copy())


def make(setup, course):
    is_default = setup.endswith("-default")
    switch = course.system.switch_plainly if is_default else None
    modes, passed, variations = {}, None, Variations(course)
    while course.goes_on():
        events = course.system.modes[course.mode].events
        fires, zeros = (None, {}) if is_default else course.system.entry(
            course.mode, course.t, course.z, passed
        )
        if fires is None:
            if course.mode not in modes:
                modes[course.mode] = Mode(course, course.mode, is_default, variations)
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


def gradients(setup, course):
    return chained(course)


def setups():
    for name in ("taylor", "taylor-default"):
        yield {
            "name": name,
            "method": "Taylor series of the order that the tolerance asks for",
            "class": "taylor",
            "events": "library",
            "dense_output": True,
            "stepping": "adaptive",
            "gradients": True,
        }


if __name__ == "__main__":
    serve("heyoka", hy.__version__, list(setups()), make, gradients)

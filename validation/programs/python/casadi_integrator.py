"""CasADi's CVODES and IDAS integrators, run by percuss.

`SOLVER-default` is CasADi's own event support, which it calls experimental: `zero` in the
dictionary of the system, a `transition` that notes when and where an indicator fell through zero
and stops the motion there, the tolerances, and nothing else. An indicator that rises never fires,
so that each guard is given with its sign turned, and twice where both directions count.

`SOLVER` is what its experts do, PyBaMM's "safe" mode among them: steps of the program's own, each
a call of the integrator, guards looked at by their signs at the ends of these steps, and the root
found with further calls.

- Steps are an eighth of a forcing period and of a turn.
- A guard that is zero where a mode begins has the sign that it has just after it, until it has
  moved away by more than the tolerance hides.
- What follows an event is told by the first derivative that is not zero.
"""

from functools import cache

import numpy as np
from percuss_program import Failure, serve, unavailable

try:
    import casadi as ca
    from scipy.optimize import brentq
except ImportError as why:
    unavailable(str(why))

METHODS = {"cvodes": "CVODES, BDF of orders 1 to 5", "idas": "IDAS, BDF of orders 1 to 5"}
MOST_STEPS = 1_000_000


@cache
def one_step(solver, size, tolerance):
    """An integrator over a step of any length, of any mode with so many states."""
    z, s = ca.SX.sym("z", size), ca.SX.sym("s")
    a, b, c = ca.SX.sym("a", size, size), ca.SX.sym("b", size, 2), ca.SX.sym("c", size)
    begin, length, omega, phi = (ca.SX.sym(name) for name in ("begin", "length", "omega", "phi"))
    theta = omega * (begin + s * length) + phi
    rates = a @ z + c + b @ ca.vertcat(ca.cos(theta), ca.sin(theta))
    given = ca.vertcat(ca.vec(a), ca.vec(b), c, begin, length, omega, phi)
    system = {"x": z, "t": s, "p": given, "ode": length * rates}
    options = {"reltol": tolerance, "abstol": tolerance, "max_num_steps": MOST_STEPS}
    return ca.integrator("step", solver, system, 0.0, 1.0, options)


def count(course, function):
    stats = function.stats()
    course.meter.rhs += int(stats.get("nfevals", 0))
    course.meter.steps += int(stats.get("nsteps", 0))
    course.meter.jacobians += int(stats.get("nlinsetups", 0))
    course.meter.call()


class Steps:
    """A mode from where it begins, step by step."""

    def __init__(self, course, solver):
        system = course.system
        mode = system.modes[course.mode]
        self.course = course
        self.function = one_step(solver, len(course.z), course.run["tolerance"]["relative"])
        self.given = [*mode.a.flatten("F"), *mode.b.flatten("F"), *mode.c]
        self.forcing = [system.omega, system.phi]

    def to(self, t):
        """The state at a time, from that where the step begins."""
        course = self.course
        if t <= course.t:
            return course.z
        given = [*self.given, course.t, t - course.t, *self.forcing]
        state = self.function(x0=course.z, p=given)["xf"]
        count(course, self.function)
        return np.array(state).flatten()

    def sample(self, until):
        course = self.course
        due = course.pending()
        course.sample(due[due < until], self.to)

    def roots(self, guards, before, end, after):
        """The crossings in the step that ends so, in the order of their times."""
        events = self.course.system.modes[self.course.mode].events
        found = []
        for place, guard in enumerate(guards):
            rises = before[place] < 0 <= after[place]
            falls = before[place] > 0 >= after[place]
            if (rises and events[place].sign >= 0) or (falls and events[place].sign <= 0):
                value = lambda t: guard(t, self.to(t)) if t > self.course.t else before[place]
                exact = after[place] == 0
                found.append((end if exact else brentq(value, self.course.t, end), place))
        return sorted(found)


def by_steps(course, solver, zeros):
    """Steps to the first crossing."""
    events = course.system.modes[course.mode].events
    guards = [course.guard(place, zeros) for place in range(len(events))]
    steps = Steps(course, solver)
    before = [guard(course.t, course.z) for guard in guards]
    while course.t < course.span:
        end = min(course.t + course.longest_step(), course.span)
        state = steps.to(end)
        after = [guard(end, state) for guard in guards]
        found = steps.roots(guards, before, end, after)
        if found:
            t, place = found[0]
            state = steps.to(t)
            steps.sample(t)
            if events[place].ends:
                course.pass_event(t, place, state)
                return place, {}
            course.report(t, place, course.mode, state)
            course.t, course.z = t, state
            return None, course.crossed(place)
        steps.sample(end)
        course.t, course.z, before = end, state, after
    return None, {}


def with_zeros(course, solver, times):
    """The mode with CasADi's own events: after the state whether there was one, when, and which."""
    system, mode = course.system, course.system.modes[course.mode]
    size = len(course.z)
    z, note, t = ca.SX.sym("z", size), ca.SX.sym("note", 3), ca.SX.sym("t")
    theta = system.omega * t + system.phi
    wide = ca.vertcat(z, ca.cos(theta), ca.sin(theta), 1)
    rates = (1 - note[0]) * (ca.DM(mode.wide[:size]) @ wide)
    signs = [
        (place, sign)
        for place, event in enumerate(mode.events)
        for sign in (1, -1)
        if event.sign in (0, sign)
    ]
    indicators = [-sign * (ca.DM(mode.events[place].row).T @ wide) for place, sign in signs]
    both = ca.vertcat(z, note)
    index, none = ca.SX.sym("index"), [ca.SX.sym(name, 0) for name in "zpu"]
    stopped = [ca.vertcat(z, 1, t, index), none[0]]
    transition = ca.Function(
        "transition", [index, t, both, *none], stopped, ca.event_in(), ca.event_out()
    )
    tolerance = course.run["tolerance"]
    options = {"reltol": tolerance["relative"], "abstol": tolerance["absolute"]}
    described = {"x": both, "t": t, "ode": ca.vertcat(rates, 0, 0, 0)}
    if signs:
        described["zero"] = ca.vertcat(*indicators)
        options["transition"] = transition
    function = ca.integrator("mode", solver, described, course.t, times, options)
    return function, [place for place, _ in signs]


def by_default(course, solver):
    while course.goes_on():
        due = course.pending()
        times = [*due[due < course.span].tolist(), course.span]
        function, places = with_zeros(course, solver, times)
        states = np.array(function(x0=[*course.z, 0, 0, 0])["xf"])
        count(course, function)
        size = len(course.z)
        happened = states[size] > 0.5
        course.sample(times[: int(np.sum(~happened[:-1]))], dict(zip(times, states[:size].T)).get)
        if not happened[-1]:
            course.t, course.z = course.span, states[:size, -1]
            continue
        t, place = states[size + 1, -1], places[int(round(states[size + 2, -1]))]
        if not course.t <= t <= course.span:
            raise Failure(f"an event is put at {t}, between {course.t} and {course.span}")
        if course.system.modes[course.mode].events[place].ends:
            course.pass_event(t, place, states[:size, -1], course.system.switch_plainly)
        else:
            course.report(t, place, course.mode, states[:size, -1])
            course.t, course.z = t, states[:size, -1]


def make(setup, course):
    solver = setup.removesuffix("-default")
    if setup == solver:
        course.by_experts(lambda zeros: by_steps(course, solver, zeros))
    else:
        by_default(course, solver)


def setups():
    for name, method in METHODS.items():
        for suffix, events in (("", "program"), ("-default", "library")):
            yield {
                "name": name + suffix,
                "method": method,
                "class": "multistep",
                "events": events,
                "dense_output": False,
                "stepping": "adaptive",
            }


if __name__ == "__main__":
    serve("casadi", ca.__version__, list(setups()), make)

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

Derivatives are CasADi's forward sensitivities. Those of `SOLVER-default` go through CasADi's own
event: the time that its transition notes and the state where the motion stops are differentiated by
`Function.forward`. `SOLVER` takes the sensitivities of a stretch without events, and adds the jump at
its end by hand: the time moves by the change of the guard over the guard's rate, and the state along
its rates.
"""

from functools import cache

import numpy as np
from percuss_program import Failure, by_hand, chained, serve, unavailable

try:
    import casadi as ca
    from scipy.optimize import brentq
except ImportError as why:
    unavailable(str(why))

METHODS = {"cvodes": "CVODES, BDF of orders 1 to 5", "idas": "IDAS, BDF of orders 1 to 5"}
MAX_STEPS = 1_000_000


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
    options = {"reltol": tolerance, "abstol": tolerance, "max_num_steps": MAX_STEPS}
    return ca.integrator("step", solver, system, 0.0, 1.0, options)


@cache
def sensitivities(solver, size, tolerance, names):
    """The forward sensitivities of one step."""
    return one_step(solver, size, tolerance).forward(names)


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


def along(course, solver, began, length):
    """Derivatives at fixed times along a stretch without events, by one step over all of it."""
    system, mode, tolerance = course.system, course.mode, course.run["tolerance"]["relative"]
    now, (begin, z0) = system.modes[mode], began
    given = [*now.a.flatten("F"), *now.b.flatten("F"), *now.c]
    given += [begin, length, system.omega, system.phi]

    def sensitivity(by, states):
        changes = [
            [*it.matrices[mode].flatten("F"), 0, 0, it.omega, it.phi] for it in by
        ]
        step = sensitivities(solver, len(z0), tolerance, len(by))
        found = step(x0=z0, p=given, fwd_x0=states.T, fwd_p=np.array(changes).T)
        return np.array(found["fwd_xf"]).T

    return sensitivity


def by_steps(course, solver, zeros):
    """Steps to the first crossing, or to the horizon."""
    began = course.t, course.z
    mode = course.mode
    t, place = to_crossing(course, solver, zeros)
    sensitivity = along(course, solver, began, t - began[0])
    course.trail.append(by_hand(course, began, (t, course.z), place, sensitivity))
    if place is None:
        return None, {}
    state = course.z
    if course.system.modes[mode].events[place].ends:
        course.pass_event(t, place, state)
        return place, {}
    course.report(t, place, mode, state)
    return None, course.crossed(place)


def to_crossing(course, solver, zeros):
    """Steps to the first crossing, which is returned with its time."""
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
            course.t, course.z = t, state
            return t, place
        steps.sample(end)
        course.t, course.z, before = end, state, after
    return course.t, None


def signs_of(mode):
    """Each event of a mode with the signs in which it counts."""
    ways = enumerate(mode.events)
    return [(n, sign) for n, it in ways for sign in (1, -1) if it.sign in (0, sign)]


def with_zeros(course, solver, times):
    """The mode with CasADi's own events: after the state whether there was one, when, and which.
    Its parameters are the coefficients and by how much it begins later."""
    mode, size = course.system.modes[course.mode], len(course.z)
    z, note, t = ca.SX.sym("z", size), ca.SX.sym("note", 3), ca.SX.sym("t")
    matrix = ca.SX.sym("matrix", size, size + 3)
    rows = ca.SX.sym("rows", len(mode.events), size + 3)
    omega, phi, late = (ca.SX.sym(name) for name in ("omega", "phi", "late"))
    given = ca.vertcat(ca.vec(matrix), ca.vec(rows), omega, phi, late)
    theta = omega * (t + late) + phi
    wide = ca.vertcat(z, ca.cos(theta), ca.sin(theta), 1)
    both, signs = ca.vertcat(z, note), signs_of(mode)
    rates = (1 - note[0]) * (matrix @ wide)
    tolerance = course.run["tolerance"]
    options = {"reltol": tolerance["relative"], "abstol": tolerance["absolute"]}
    described = {"x": both, "t": t, "p": given, "ode": ca.vertcat(rates, 0, 0, 0)}
    if signs:
        index, none = ca.SX.sym("index"), [ca.SX.sym(name, 0) for name in "zu"]
        taken = [index, t, both, none[0], given, none[1]]
        stopped = [ca.vertcat(z, 1, t + late, index), none[0]]
        said = ca.event_in(), ca.event_out()
        options["transition"] = ca.Function("transition", taken, stopped, *said)
        described["zero"] = ca.vertcat(*(-sign * (rows[n, :] @ wide) for n, sign in signs))
    return ca.integrator("mode", solver, described, course.t, times, options)


def coefficients(system, mode, size):
    """What `with_zeros` is given."""
    mode = system.modes[mode]
    rows = np.array([it.row for it in mode.events]).reshape(-1, size + 3)
    return [*mode.wide[:size].flatten("F"), *rows.flatten("F"), system.omega, system.phi, 0.0]


def through_zeros(course, solver):
    """Derivatives along a stretch that CasADi's own event ends, or the horizon."""
    system, mode, size = course.system, course.mode, len(course.z)
    begin = [*course.z, 0, 0, 0]
    function = with_zeros(course, solver, [course.span])

    def push(by, times, states):
        given = coefficients(system, mode, size)
        changes = [
            [*it.matrices[mode].flatten("F"), *it.rows[mode].flatten("F"), it.omega, it.phi, time]
            for it, time in zip(by, times)
        ]
        starts = np.hstack([states, np.zeros((len(by), 3))]).T
        sensitivity = function.forward(len(by))
        found = sensitivity(x0=begin, p=given, fwd_x0=starts, fwd_p=np.array(changes).T)
        found = np.array(found["fwd_xf"]).T
        end = np.array(function(x0=begin, p=given)["xf"]).flatten()
        if end[size] > 0.5:
            return found[:, size + 1], found[:, :size]
        rates = system.rates(mode, course.span, end[:size])
        return np.zeros(len(by)), found[:, :size] - np.outer(times, rates)

    return push


def by_default(course, solver):
    while course.goes_on():
        due = course.pending()
        times = [*due[due < course.span].tolist(), course.span]
        function, size = with_zeros(course, solver, times), len(course.z)
        given = coefficients(course.system, course.mode, size)
        states = np.array(function(x0=[*course.z, 0, 0, 0], p=given)["xf"])
        count(course, function)
        if course.run.get("gradients"):
            course.trail.append(through_zeros(course, solver))
        mode = course.system.modes[course.mode]
        happened = states[size] > 0.5
        course.sample(times[: int(np.sum(~happened[:-1]))], dict(zip(times, states[:size].T)).get)
        if not happened[-1]:
            course.t, course.z = course.span, states[:size, -1]
            continue
        t, place = states[size + 1, -1], signs_of(mode)[int(round(states[size + 2, -1]))][0]
        if not course.t <= t <= course.span:
            raise Failure(f"an event is put at {t}, between {course.t} and {course.span}")
        if mode.events[place].ends:
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


def gradients(setup, course):
    return chained(course)


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
                "gradients": True,
            }


if __name__ == "__main__":
    serve("casadi", ca.__version__, list(setups()), make, gradients)

"""SciPy's solve_ivp with its own events, run by percuss.

Each method is set up in two ways. `METHOD-default` is the first example of events in the
documentation of solve_ivp: events that are terminal and have a direction, the tolerances set, and
nothing else. `METHOD` is what an expert adds:

- Steps are at most an eighth of a forcing period and of a turn, because events are looked for by
  the zeros of guards at the ends of steps: two crossings in a step are none.
- A guard that is zero where a mode begins has the sign that it has just after it, until it has moved
  away by more than the tolerance hides. solve_ivp takes a guard that begins on zero and is not
  negative at the end of the step for an event at the begin.
- Whether an event follows at once, and which mode, is told by the first derivative that is not
  zero, instead of by the rounding of a zero.
- Implicit methods are given their Jacobian.
- Derivatives, which SciPy has none of, are central differences of whole runs over a step that the
  tolerance sets; `METHOD-default` takes forward ones over the step of approx_fprime.
"""

from percuss_program import Failure, differences, in_pairs, serve, unavailable

try:
    import numpy as np
    import scipy
    from scipy.integrate import solve_ivp
except ImportError as why:
    unavailable(str(why))

METHODS = {
    "rk45": ("RK45", "Runge-Kutta 5(4) of Dormand and Prince", "explicit", 5),
    "dop853": ("DOP853", "Runge-Kutta 8(5,3) of Dormand and Prince", "explicit", 8),
    "lsoda": ("LSODA", "Adams and BDF, switching", "multistep", None),
    "radau": ("Radau", "Radau IIA", "implicit", 5),
    "bdf": ("BDF", "BDF of orders 1 to 5 in quasi-constant steps", "multistep", None),
}
IMPLICIT = ("lsoda", "radau", "bdf")


def watched(course, place, zeros):
    """An event as solve_ivp takes it: a function with two attributes."""
    event = course.system.modes[course.mode].events[place]
    guard = course.guard(place, zeros)
    guard.terminal, guard.direction = event.ends, event.sign
    return guard


def stretch(course, method, zeros, **options):
    """Runs to the next event that ends the mode, or to the horizon."""
    system, meter, mode = course.system, course.meter, course.mode

    def rates(t, z):
        meter.call()
        return system.rates(mode, t, z)

    def each_step(t, z):
        # Called once where the run begins and once a step; never an event.
        meter.steps += 1
        return -1.0

    guards = [watched(course, place, zeros) for place in range(len(system.modes[mode].events))]
    tolerance = course.run["tolerance"]
    # The state at the horizon is wanted in any case: the next run begins there.
    times = [t for t in course.pending() if t < course.span] + [course.span]
    solved = solve_ivp(
        rates,
        (course.t, course.span),
        course.z,
        method=method,
        t_eval=times,
        events=[*guards, each_step],
        rtol=tolerance["relative"],
        atol=tolerance["absolute"],
        **options,
    )
    meter.steps -= 1
    meter.jacobians += solved.njev
    if solved.status < 0:
        raise Failure(solved.message)
    return solved


def take(course, solved, switch=None):
    """Takes over what solve_ivp has found, and returns the event that has ended the mode, if one has."""
    events = course.system.modes[course.mode].events
    found = sorted(
        (t, place)
        for place, times in enumerate(solved.t_events[:-1])
        for t in times
        if not events[place].ends
    )
    states = {
        (t, place): z
        for place in range(len(events))
        for t, z in zip(solved.t_events[place], solved.y_events[place])
    }
    for t, place in found:
        course.report(t, place, course.mode, states[t, place])
    states_at = dict(zip(solved.t, solved.y.T)) if len(solved.t) else {}
    course.sample([t for t in states_at if t < course.span], states_at.get)
    if solved.status == 1:
        t, place = next(it for it in sorted(states) if events[it[1]].ends)
        course.pass_event(t, place, states[t, place], switch)
        return place
    course.t, course.z = course.span, states_at[course.span]
    return None


def by_default(course, method):
    while course.goes_on():
        take(course, stretch(course, method, {}), course.system.switch_plainly)


def by_experts(course, method, implicit):
    options = {"max_step": course.longest_step()}

    def next_stretch(zeros):
        if implicit:
            matrix = course.system.modes[course.mode].a
            options["jac"] = lambda t, z: matrix
        return take(course, stretch(course, method, zeros, **options)), {}

    course.by_experts(next_stretch)


def make(setup, course):
    name = setup.removesuffix("-default")
    method = METHODS[name][0]
    if setup == name:
        by_experts(course, method, name in IMPLICIT)
    else:
        by_default(course, method)


def steps(setup, course):
    """The steps of differences. `METHOD-default` takes a forward difference over the step of
    scipy.optimize.approx_fprime. `METHOD` takes a central one over a step whose square is as small
    as the noise of the tolerance over the step."""
    tolerance = course.run["tolerance"]["relative"]

    def chosen(rates):
        if setup.endswith("-default"):
            return 0.0, float(np.sqrt(np.finfo(float).eps))
        step = np.cbrt(tolerance) * (abs(rates["value"]) or 1.0)
        return -step, step

    return chosen


def gradients(setup, course):
    return differences(make, setup, course, steps(setup, course))


if __name__ == "__main__":
    methods = {name: said[1:] for name, said in METHODS.items()}
    serve("scipy", scipy.__version__, in_pairs(methods, gradients=True, differences=True), make, gradients)

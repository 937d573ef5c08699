"""scikit-sundae's CVODE and IDA with their own events, run by percuss.

`SOLVER-default` is the documentation's first example of events: a function that fills an array,
with lists of what is terminal and of directions, the tolerances, and nothing else. `SOLVER` is
what an expert adds:

- Steps are at most an eighth of a forcing period and of a turn, because roots are looked for by
  signs at the ends of steps; and there is no limit on their number between outputs.
- A guard that is zero where a mode begins has the sign that it has just after it, until it has
  moved away by more than the tolerance hides.
- Whether an event follows at once, and which mode, is told by the first derivative that is not
  zero.
- Methods with Newton's iteration are given their Jacobian.
"""

import numpy as np
from percuss_program import Failure, in_pairs, serve, unavailable

try:
    import sksundae
    from sksundae.cvode import CVODE
    from sksundae.ida import IDA
except ImportError as why:
    unavailable(str(why))

METHODS = {
    "cvode-bdf": "CVODE, BDF of orders 1 to 5",
    "cvode-adams": "CVODE, Adams-Moulton of orders 1 to 12",
    "ida": "IDA, BDF of orders 1 to 5 for z' - f(z) = 0",
}
MAX_STEPS = 1_000_000


def watched(course, zeros):
    """The events of the mode as the library takes them: a function with two attributes."""
    events = course.system.modes[course.mode].events
    guards = [course.guard(place, zeros) for place in range(len(events))]

    def fill(t, z, out):
        out[:] = [guard(t, z) for guard in guards]

    def fill_residual(t, z, rates, out):
        fill(t, z, out)

    fill.terminal = fill_residual.terminal = [event.ends for event in events]
    fill.direction = fill_residual.direction = [event.sign for event in events]
    return {"cvode": fill, "ida": fill_residual, "count": len(events)}


def solver(course, name, zeros, options):
    system, meter, mode = course.system, course.meter, course.mode
    matrix = system.modes[mode].a
    tolerance = course.run["tolerance"]
    events = watched(course, zeros)
    options = dict(options, rtol=tolerance["relative"], atol=tolerance["absolute"])
    if events["count"]:
        which = events["ida" if name == "ida" else "cvode"]
        options |= {"eventsfn": which, "num_events": events["count"]}

    def rates(t, z, out):
        meter.call()
        out[:] = system.rates(mode, t, z)

    def residual(t, z, slope, out):
        meter.call()
        out[:] = slope - system.rates(mode, t, z)

    def jacobian(t, z, slope, out):
        out[:] = matrix

    def residual_jacobian(t, z, slope, residual, shift, out):
        out[:] = shift * np.eye(len(z)) - matrix

    has_jacobian = options.pop("has_jacobian", False)
    if name == "ida":
        if has_jacobian:
            options["jacfn"] = residual_jacobian
        return IDA(residual, **options)
    if has_jacobian and name == "cvode-bdf":
        options["jacfn"] = jacobian
    return CVODE(rates, method={"bdf": "BDF", "adams": "Adams"}[name[6:]], **options)


def stretch(course, name, zeros, options, switch=None):
    """Runs to the next event that ends the mode, which is returned, or to the horizon."""
    due = [t for t in course.pending() if t < course.span]
    times = np.array([course.t, *due, course.span])
    made = solver(course, name, zeros, options)
    start = [course.z]
    if name == "ida":
        start.append(course.system.rates(course.mode, course.t, course.z))
    solved = made.solve(times, *start)
    course.meter.jacobians += solved.njev
    if not solved.success:
        raise Failure(solved.message)
    return take(course, solved, due, switch)


def take(course, solved, due, switch):
    """Takes over what the library has found."""
    events = course.system.modes[course.mode].events
    ended = []
    found = [] if solved.t_events is None else zip(
        solved.t_events, solved.y_events, solved.i_events
    )
    for t, z, signs in found:
        for place in np.flatnonzero(signs):
            if events[place].ends:
                ended.append((t, place, z))
            else:
                course.report(t, int(place), course.mode, z)
    before = ended[0][0] if ended else np.inf
    states = dict(zip(solved.t, solved.y))
    course.sample([t for t in due if t < before and t in states], states.get)
    if ended:
        t, place, z = ended[0]
        course.pass_event(float(t), int(place), np.array(z), switch)
        return int(place)
    course.t, course.z = course.span, solved.y[-1].copy()
    return None


def make(setup, course):
    name = setup.removesuffix("-default")
    if setup != name:
        while course.goes_on():
            stretch(course, name, {}, {}, course.system.switch_plainly)
        return
    options = {
        "max_step": course.longest_step(),
        "max_num_steps": MAX_STEPS,
        "has_jacobian": True,
    }
    course.by_experts(lambda zeros: (stretch(course, name, zeros, options), {}))


if __name__ == "__main__":
    methods = {name: (method, "multistep", None) for name, method in METHODS.items()}
    version = f"{sksundae.__version__} with SUNDIALS {sksundae.SUNDIALS_VERSION}"
    serve("scikit-sundae", version, in_pairs(methods), make)

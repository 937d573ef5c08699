"""diffrax's Event with a root find by optimistix, run by percuss.

`METHOD-default` is the first example in the documentation of `Event`: conditions that are real,
found by `Newton(1e-5, 1e-5, rms_norm)`, a first step of 0.1, the tolerances, and nothing else but
directions and double precision, without which no tolerance below 1e-6 means anything. `METHOD` is
what an expert adds:

- The root is found by bisection to rounding: Newton's method may leave the step, and its
  tolerances are not those of the run. With several conditions diffrax 0.7.2 cannot bisect. There
  is one: the largest of all guards, each with the sign that makes it negative where the run
  begins. What crosses in a direction that does not count is passed over.
- Steps are at most an eighth of a forcing period and of a turn, because signs are compared at the
  ends of steps; and the first one is left to the controller.
- A guard that is zero where a mode begins has the sign that it has just after it, until it has
  moved away by more than the tolerance hides.
- What follows an event is told by the first derivative that is not zero.

Functions are compiled once for each number of states, of events, and of samples, and kept beside
the Python environment for the next process.
"""

import sys
from functools import cache
from pathlib import Path

import numpy as np
from percuss_program import Failure, in_pairs, serve, unavailable

try:
    import diffrax
    import jax
    import jax.numpy as jnp
    import optimistix
except ImportError as why:
    unavailable(str(why))

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_compilation_cache_dir", str(Path(sys.prefix) / "jax-cache"))
jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)

METHODS = {
    "tsit5": (diffrax.Tsit5, "Tsitouras 5(4)", "explicit", 5, 6),
    "dopri8": (diffrax.Dopri8, "Runge-Kutta 8(7) of Dormand and Prince", "explicit", 8, 13),
}
MOST_STEPS = 200_000
FIRST_STEP = 0.1
# Samples come in so many at a time, so that little is compiled.
BUCKETS = (16, 128, 1024, 8192)


def wide(t, z, given):
    theta = given["omega"] * t + given["phi"]
    return jnp.concatenate([z, jnp.stack([jnp.cos(theta), jnp.sin(theta), jnp.ones_like(theta)])])


def guard(place):
    """The condition of an event: its guard."""
    return lambda t, y, args, **_: args["rows"][place] @ wide(t, y, args)


def oriented(t, y, args):
    """All guards, negative where the run begins; one that was zero there is hidden for a while."""
    values = args["rows"] @ wide(t, y, args)
    return jnp.where(jnp.abs(values) <= args["hidden"], -1e-300, -args["signs"] * values)


@cache
def solver(name, is_default, directions):
    """A solve to the first event, compiled where it is needed."""
    count = len(directions)
    event = None
    if count and is_default:
        conditions = [guard(place) for place in range(count)]
        root_finder = optimistix.Newton(1e-5, 1e-5, optimistix.rms_norm)
        event = diffrax.Event(conditions, root_finder, list(directions))
    elif count:
        largest = lambda t, y, args, **_: jnp.max(oriented(t, y, args))
        event = diffrax.Event(largest, optimistix.Bisection(rtol=1e-15, atol=1e-15))

    @jax.jit
    def solve(given, t0, t1, z, times, tolerance, longest):
        term = diffrax.ODETerm(lambda t, z, given: given["matrix"] @ wide(t, z, given))
        usual = {"rtol": tolerance, "atol": tolerance}
        controller = diffrax.PIDController(**usual, **({} if is_default else {"dtmax": longest}))
        return diffrax.diffeqsolve(
            term,
            METHODS[name][0](),
            t0,
            t1,
            FIRST_STEP if is_default else None,
            z,
            args=given,
            saveat=diffrax.SaveAt(
                subs=[diffrax.SubSaveAt(ts=times), diffrax.SubSaveAt(t1=True)]
            ),
            stepsize_controller=controller,
            max_steps=MOST_STEPS,
            throw=False,
            event=event,
        )

    return solve


def known_guards(course, zeros):
    """What is hidden of each guard, and the sign that it has where the run begins."""
    events = course.system.modes[course.mode].events
    wide_now = course.system.wide(course.t, course.z)
    signs = np.array([np.sign(event.row @ wide_now) for event in events])
    hidden = np.full(len(events), -1.0)
    for place, (order, sign) in zeros.items():
        hidden[place] = np.inf if order is None else course.hidden(events[place], order, course.z)
        signs[place] = -1.0 if order is None else sign
    return hidden, signs


def padded(times, end):
    """The samples' times, as many as a bucket holds."""
    size = next(it for it in BUCKETS if it >= len(times))
    return np.concatenate([times, np.full(size - len(times), end)])


def stretch(course, name, is_default, zeros):
    """Runs to the first event, which is returned with what is known of it, or to the horizon."""
    system, mode, size = course.system, course.system.modes[course.mode], len(course.z)
    due = course.pending()
    due = due[due < course.span]
    hidden, signs = known_guards(course, zeros)
    given = {
        "matrix": mode.wide[:size],
        "omega": system.omega,
        "phi": system.phi,
        "rows": np.array([event.row for event in mode.events]).reshape(-1, size + 3),
        "hidden": hidden,
        "signs": signs,
    }
    way = {1: True, -1: False, 0: None}
    directions = tuple(way[event.sign] if is_default else None for event in mode.events)
    solve = solver(name, is_default, directions)
    tolerance = course.run["tolerance"]["relative"]
    times = padded(due, course.span)
    found = solve(given, course.t, course.span, course.z, times, tolerance, course.longest_step())
    steps = int(found.stats["num_steps"])
    course.meter.steps += steps
    course.meter.rhs += METHODS[name][4] * steps
    course.meter.call()
    (_, states), (t, z) = zip(found.ts, found.ys)
    t, z = float(t[-1]), np.array(z[-1])
    happened = [] if found.event_mask is None else np.flatnonzero(np.array(found.event_mask))
    if len(happened) and not is_default:
        happened = [int(np.argmax(oriented(t, z, given)))]
    if not len(happened) and found.result != diffrax.RESULTS.successful:
        raise Failure(diffrax.RESULTS[found.result])
    way = 0 if is_default or not len(happened) else -signs[happened[0]]
    return take(course, happened, (t, z, way), (due, np.array(states)), is_default)


def take(course, happened, end, sampled, is_default):
    """Takes over what diffrax has found."""
    events = course.system.modes[course.mode].events
    (t, z, way), (due, states) = end, sampled
    course.sample(due[due < t], dict(zip(due, states)).get)
    if not len(happened):
        course.t, course.z = course.span, z
        return None, {}
    if not course.t <= t <= course.span:
        raise Failure(f"an event is put at {t}, between {course.t} and {course.span}")
    place = int(happened[0])
    if events[place].ends:
        course.pass_event(t, place, z, course.system.switch_plainly if is_default else None)
        return place, {}
    if 0 in (way, events[place].sign) or way == events[place].sign:
        course.report(t, place, course.mode, z)
    course.t, course.z = t, z
    return None, course.crossed(place)


def make(setup, course):
    name = setup.removesuffix("-default")
    if setup == name:
        course.by_experts(lambda zeros: stretch(course, name, False, zeros))
    else:
        while course.goes_on():
            stretch(course, name, True, {})


if __name__ == "__main__":
    methods = {name: said[1:4] for name, said in METHODS.items()}
    serve("diffrax", diffrax.__version__, in_pairs(methods), make)

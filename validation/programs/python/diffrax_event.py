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

Derivatives are diffrax's own along each stretch from event to event, of the time and the state that
it returns; stretches and resets are joined by the chain rule, as JAX joins them where the loop over
events is in Python. `METHOD-default` and `tsit5-checkpoint` have the adjoint that diffrax takes where
none is named, RecursiveCheckpointAdjoint, and reverse mode. The others have forward mode, by
ForwardMode or, as `tsit5-direct-default`, by DirectAdjoint. `tsit5-backsolve-default` has
BacksolveAdjoint, which says that it is not compatible with events.

Functions are compiled once for each number of states, of events, and of samples, and kept beside
the Python environment for the next process.
"""

import sys
from functools import cache, partial
from pathlib import Path

import numpy as np
from percuss_program import Failure, chained, in_pairs, serve, unavailable

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
ADJOINTS = {
    "checkpoint": diffrax.RecursiveCheckpointAdjoint,
    "forward": diffrax.ForwardMode,
    "direct": diffrax.DirectAdjoint,
    "backsolve": diffrax.BacksolveAdjoint,
}
# The adjoint of set-ups that are not named after one.
DEFAULT_ADJOINT, EXPERT_ADJOINT = "checkpoint", "forward"
REVERSE_ADJOINTS = ("checkpoint", "backsolve")
FURTHER_SETUPS = ("tsit5-checkpoint", "tsit5-direct-default", "tsit5-backsolve-default")
MAX_STEPS = 200_000
FIRST_STEP = 0.1
# Samples come in so many at a time, so that little is compiled.
BUCKETS = (16, 128, 1024, 8192)
# Names by which is differentiated, too.
NAMES = 12


def wide(t, z, given):
    theta = given["omega"] * t + given["phi"]
    return jnp.concatenate([z, jnp.stack([jnp.cos(theta), jnp.sin(theta), jnp.ones_like(theta)])])


def guard(place):
    """The condition of an event: its guard."""
    return lambda t, y, args, **_: args["rows"][place] @ wide(t, y, args)


def oriented(t, y, args):
    """All guards, negative where the run begins; one that was zero there has to go further than
    the tolerance hides."""
    values = -args["signs"] * (args["rows"] @ wide(t, y, args)) - args["hidden"]
    return jnp.where(args["stays"] > 0, -1.0, values)


def event_of(is_default, directions):
    """The event of a mode whose events have these directions."""
    if not directions:
        return None
    if is_default:
        conditions = [guard(place) for place in range(len(directions))]
        root_finder = optimistix.Newton(1e-5, 1e-5, optimistix.rms_norm)
        return diffrax.Event(conditions, root_finder, list(directions))
    largest = lambda t, y, args, **_: jnp.max(oriented(t, y, args))
    return diffrax.Event(largest, optimistix.Bisection(rtol=1e-15, atol=1e-15))


def solve(method, is_default, directions, adjoint, given, t0, z, t1, times, tolerance, longest):
    """A solve to the first event. Without times nothing but the end is saved."""
    term = diffrax.ODETerm(lambda t, z, given: given["matrix"] @ wide(t, z, given))
    usual = {"rtol": tolerance, "atol": tolerance}
    controller = diffrax.PIDController(**usual, **({} if is_default else {"dtmax": longest}))
    end, saved = diffrax.SubSaveAt(t1=True), diffrax.SaveAt(t1=True)
    if times is not None:
        saved = diffrax.SaveAt(subs=[diffrax.SubSaveAt(ts=times), end])
    return diffrax.diffeqsolve(
        term,
        METHODS[method][0](),
        t0,
        t1,
        FIRST_STEP if is_default else None,
        z,
        args=given,
        saveat=saved,
        stepsize_controller=controller,
        max_steps=MAX_STEPS,
        throw=False,
        event=event_of(is_default, directions),
        adjoint=ADJOINTS[adjoint](),
    )


@cache
def solver(*chosen):
    """A solve, compiled where it is needed."""
    return jax.jit(partial(solve, *chosen))


@cache
def along(*chosen):
    """Derivatives of where a solve ends along many directions, compiled where they are needed."""

    def end(rest, given, t0, z):
        t1, tolerance, longest = rest
        found = solve(*chosen, given, t0, z, t1, None, tolerance, longest)
        return found.ts[-1], found.ys[-1]

    def forward(begin, changes, *rest):
        one = lambda change: jax.jvp(partial(end, rest), begin, change)[1]
        return jax.vmap(one)(changes)

    def reverse(begin, changes, *rest):
        (_, z), back = jax.vjp(partial(end, rest), *begin)
        size = len(z)
        rows = jnp.eye(size + 1)
        all_ = jax.vmap(back)((rows[:, 0], rows[:, 1:]))
        product = lambda a, b: jnp.einsum("kx,nx->nk", *(flat(a, size + 1), flat(b, NAMES)))
        flat = lambda it, count: jnp.reshape(it, (count, it.size // count))
        found = sum(jax.tree.leaves(jax.tree.map(product, all_, changes)))
        return found[:, 0], found[:, 1:]

    return jax.jit(reverse if chosen[-1] in REVERSE_ADJOINTS else forward)


def padded(times, end):
    """The samples' times, as many as a bucket holds."""
    size = next(it for it in BUCKETS if it >= len(times))
    return np.concatenate([times, np.full(size - len(times), end)])


def pushed(course, chosen, given, rest):
    """The derivatives along a stretch from where the run is."""
    begin, mode = (given, course.t, course.z), course.mode

    def push(by, times, states):
        rates = jax.tree.map(lambda it: np.zeros((NAMES, *np.shape(it))), given)
        changed = np.zeros(NAMES), np.zeros((NAMES, len(begin[2])))
        for n, name in enumerate(by):
            rates["matrix"][n], rates["rows"][n] = name.matrices[mode], name.rows[mode]
            rates["omega"][n], rates["phi"][n] = name.omega, name.phi
        changed[0][: len(by)], changed[1][: len(by)] = times, states
        times, states = along(*chosen)(begin, (rates, *changed), *rest)
        return times[: len(by)], states[: len(by)]

    return push


def stretch(course, name, is_default, adjoint, zeros):
    """Runs to the first event, which is returned with what is known of it, or to the horizon."""
    system, mode, size = course.system, course.system.modes[course.mode], len(course.z)
    due = course.pending()
    due = due[due < course.span]
    hidden, signs, stays = course.known_guards(zeros)
    given = {
        "matrix": mode.wide[:size],
        "omega": float(system.omega),
        "phi": float(system.phi),
        "rows": np.array([event.row for event in mode.events]).reshape(-1, size + 3),
        "hidden": hidden,
        "signs": signs,
        "stays": stays.astype(float),
    }
    way = {1: True, -1: False, 0: None}
    directions = tuple(way[event.sign] if is_default else None for event in mode.events)
    rest = course.span, course.run["tolerance"]["relative"], course.longest_step()
    chosen = name, is_default, directions
    times = padded(due, course.span)
    found = solver(*chosen, DEFAULT_ADJOINT)(given, course.t, course.z, rest[0], times, *rest[1:])
    course.trail.append(pushed(course, (*chosen, adjoint), given, rest))
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
    way = 0
    if len(happened) and not is_default:
        way = -signs[happened[0]]
        happened = [course.that_counts(happened[0], way)]
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
    name, *words = setup.split("-")
    is_default = "default" in words
    named = [word for word in words if word in ADJOINTS]
    adjoint = (named or [DEFAULT_ADJOINT if is_default else EXPERT_ADJOINT])[0]
    if is_default:
        while course.goes_on():
            stretch(course, name, True, adjoint, {})
    else:
        course.by_experts(lambda zeros: stretch(course, name, False, adjoint, zeros))


def gradients(setup, course):
    return chained(course)


def setups():
    methods = {name: said[1:4] for name, said in METHODS.items()}
    pairs = in_pairs(methods, gradients=True)
    usual = next(it for it in pairs if it["name"] == "tsit5")
    return [*pairs, *(usual | {"name": name} for name in FURTHER_SETUPS)]


if __name__ == "__main__":
    serve("diffrax", diffrax.__version__, setups(), make, gradients)

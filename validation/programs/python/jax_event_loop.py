"""An event loop written by hand in JAX, with its derivatives by jax.jvp, run by percuss.

JAX has no solver with events. Who needs one writes what stands here: steps of Dormand and Prince in
`jax.lax.while_loop` until the largest guard is positive, and bisection for the part of the last
step that leads to the event. Step sizes are held out of the derivatives by `stop_gradient`. All
set-ups have the same events; they differ in the derivative of the event's time:

- `dopri5-default` differentiates the loop as it is. Bisection halves an interval of numbers, whatever
  the parameters are: the derivative that JAX finds there is zero.
- `dopri5` is what an expert adds: one step of Newton's method after the bisection, which has the
  derivative of the implicit function theorem.
- `custom-root` has the bisection inside `jax.lax.custom_root`, as JAX documents implicit
  differentiation.

The rest is what an expert sets: steps of an eighth of a forcing period and of a turn at most, and a
guard that is zero where a mode begins is hidden until it has moved away by more than the tolerance
hides. Functions are compiled once for each number of states and events, and kept beside the Python
environment for the next process.
"""

import sys
from functools import cache, partial
from pathlib import Path

import numpy as np
from percuss_program import Failure, chained, serve, unavailable

try:
    import jax
    import jax.numpy as jnp
    from jax import lax
except ImportError as why:
    unavailable(str(why))

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_compilation_cache_dir", str(Path(sys.prefix) / "jax-cache"))
jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)

NODES = (0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0)
STAGES = (
    (),
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
)
STEP = (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)
# The step of order 5 less that of order 4, the slope at the end last.
ERROR = (
    71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40,
)
SAFETY_FACTOR, MIN_STEP_FACTOR, MAX_STEP_FACTOR = 0.9, 0.2, 5.0
MAX_STEPS = 200_000
HALVINGS = 60
# Samples and names come in so many at a time, so that little is compiled.
BUCKETS = (0, 16, 128, 1024, 8192)
NAMES = 12


def wide(given, t, z):
    theta = given["omega"] * t + given["phi"]
    return jnp.concatenate([z, jnp.stack([jnp.cos(theta), jnp.sin(theta), jnp.ones_like(theta)])])


def step(given, t, z, h):
    """A step, and the estimate of its error."""
    slopes = []
    for node, row in zip(NODES, STAGES):
        inner = z + h * sum(a * k for a, k in zip(row, slopes)) if row else z
        slopes.append(given["matrix"] @ wide(given, t + node * h, inner))
    after = z + h * sum(b * k for b, k in zip(STEP, slopes))
    slopes.append(given["matrix"] @ wide(given, t + h, after))
    return after, h * sum(e * k for e, k in zip(ERROR, slopes))


def guards(given, t, z):
    """All guards, negative where the run begins. One that was zero there has to go further than
    the tolerance hides. The last is none."""
    values = -given["signs"] * (given["rows"] @ wide(given, t, z)) - given["hidden"]
    return jnp.concatenate([jnp.where(given["stays"] > 0, -1.0, values), jnp.array([-1.0])])


def bisected(value, h):
    """The part of a step after which a function is not negative any more."""

    def halve(it):
        n, low, high = it
        middle = 0.5 * (low + high)
        is_past = value(middle) >= 0
        return n + 1, jnp.where(is_past, low, middle), jnp.where(is_past, middle, high)

    start = (0, jnp.zeros_like(h), h)
    return lax.while_loop(lambda it: it[0] < HALVINGS, halve, start)[2]


def located(way, given, t, z, h):
    """The part of a step that leads to the first event in it."""
    largest = lambda part: jnp.max(guards(given, t + part, step(given, t, z, part)[0]))
    h = lax.stop_gradient(h)
    if way == "custom-root":
        solve = lambda value, guess: bisected(value, h)
        return lax.custom_root(largest, h, solve, lambda linear, it: it / linear(1.0))
    part = bisected(largest, h)
    if way == "dopri5":
        part = lax.stop_gradient(part)
        value, slope = jax.jvp(largest, (part,), (jnp.ones_like(part),))
        part -= value / lax.stop_gradient(slope)
    return part


def solve(way, given, t0, z0, t1, times, tolerance, longest):
    """Time and state at the first event or at t1; which guard it was, the last for none; samples;
    steps, accepted and all; and the length of the last."""
    count = times.shape[0]
    due = jnp.append(times, jnp.inf)

    def goes_on(it):
        return (it["t"] < t1) & ~it["happened"] & (it["tries"] < MAX_STEPS)

    def go(it):
        t, z = it["t"], it["z"]
        most = lax.stop_gradient(jnp.minimum(longest, due[it["k"]] - t))
        h = lax.stop_gradient(jnp.minimum(it["h"], most))
        is_last = h >= t1 - t
        h = jnp.where(is_last, t1 - t, h)
        after, error = step(given, t, z, h)
        scale = tolerance * (1.0 + jnp.maximum(jnp.abs(z), jnp.abs(after)))
        size = lax.stop_gradient(jnp.sqrt(jnp.mean((error / scale) ** 2)))
        is_good = size <= 1.0
        later = jnp.where(is_last, t1, t + h)
        happened = is_good & (jnp.max(guards(given, later, after)) >= 0)
        accepted = is_good & ~happened
        is_due = accepted & (lax.stop_gradient(later) >= due[it["k"]])
        samples = it["samples"]
        if count:
            k = jnp.minimum(it["k"], count - 1)
            samples = samples.at[k].set(jnp.where(is_due, after, samples[k]))
        factor = SAFETY_FACTOR * jnp.maximum(size, 1e-10) ** -0.2
        factor = jnp.clip(factor, MIN_STEP_FACTOR, MAX_STEP_FACTOR)
        return {
            "t": jnp.where(accepted, later, t),
            "z": jnp.where(accepted, after, z),
            "h": jnp.where(happened, h, lax.stop_gradient(h) * factor),
            "k": it["k"] + is_due,
            "samples": samples,
            "happened": happened,
            "steps": it["steps"] + is_good,
            "tries": it["tries"] + 1,
        }

    first = {
        "t": t0, "z": z0, "h": longest, "k": 0, "samples": jnp.zeros((count, z0.shape[0])),
        "happened": False, "steps": 0, "tries": 0,
    }
    end = lax.while_loop(goes_on, go, first)
    t, z, happened = end["t"], end["z"], end["happened"]
    part = located(way, given, t, z, jnp.where(happened, end["h"], 1.0))
    t_event, z_event = t + part, step(given, t, z, part)[0]
    which = jnp.argmax(guards(given, t_event, z_event)[:-1]) if given["signs"].shape[0] else 0
    t, z = jnp.where(happened, t_event, t), jnp.where(happened, z_event, z)
    place = jnp.where(happened, which, -1)
    return t, z, (place, end["samples"], end["steps"], end["tries"])


@cache
def compiled(way):
    return jax.jit(partial(solve, way))


@cache
def along(way):
    """Derivatives of a stretch along many directions."""

    def push(given, t0, z0, rates, dt0, dz0, *rest):
        run = lambda given, t0, z0: solve(way, given, t0, z0, *rest)[:2]
        one = lambda *changes: jax.jvp(run, (given, t0, z0), changes)[1]
        return jax.vmap(one)(rates, dt0, dz0)

    return jax.jit(push)


def stacked(by, given, mode):
    """The derivatives of what a stretch is given, by each name, padded."""
    zeros = jax.tree.map(lambda it: np.zeros((NAMES, *np.shape(it))), given)
    for n, rates in enumerate(by):
        zeros["matrix"][n], zeros["rows"][n] = rates.matrices[mode], rates.rows[mode]
        zeros["omega"][n], zeros["phi"][n] = rates.omega, rates.phi
    return zeros


def padded(values, size, with_=0.0):
    values = np.asarray(values, dtype=float)
    more = np.full((size - len(values), *values.shape[1:]), with_)
    return np.concatenate([values, more])


def stretch(course, way, zeros):
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
    times = padded(due, next(it for it in BUCKETS if it >= len(due)), np.inf)
    tolerance = course.run["tolerance"]["relative"]
    rest = (course.span, times, tolerance, course.longest_step())
    begin, place_of_mode = (course.t, course.z), course.mode
    t, z, (place, samples, steps, tries) = compiled(way)(given, *begin, *rest)
    t, z, place = float(t), np.array(z), int(place)
    course.meter.steps += int(steps)
    course.meter.rhs += len(ERROR) * int(tries) + len(ERROR) * HALVINGS * (place >= 0)
    course.meter.call()
    if int(tries) >= MAX_STEPS:
        raise Failure(f"{MAX_STEPS} steps were too few")

    def push(by, times, states):
        rates = stacked(by, given, place_of_mode)
        changed = padded(times, NAMES), padded(states, NAMES)
        times, states = along(way)(given, *begin, rates, *changed, *rest)
        return times[: len(by)], states[: len(by)]

    course.trail.append(push)
    course.sample(due[due <= t], dict(zip(due, np.array(samples))).get)
    if place < 0:
        course.t, course.z = course.span, z
        return None, {}
    place = course.that_counts(place, -signs[place])
    event = mode.events[place]
    if event.ends:
        course.pass_event(t, place, z)
        return place, {}
    if event.sign in (0, -signs[place]):
        course.report(t, place, course.mode, z)
    course.t, course.z = t, z
    return None, course.crossed(place)


def make(setup, course):
    course.by_experts(lambda zeros: stretch(course, setup, zeros))


def gradients(setup, course):
    return chained(course)


def setups():
    for name in ("dopri5", "dopri5-default", "custom-root"):
        yield {
            "name": name,
            "method": "Runge-Kutta 5(4) of Dormand and Prince",
            "class": "explicit",
            "order": 5,
            "events": "program",
            "dense_output": False,
            "stepping": "adaptive",
            "gradients": True,
        }


if __name__ == "__main__":
    serve("jax", jax.__version__, list(setups()), make, gradients)

"""Programs that percuss runs as engines, for Python: the protocol, and a system's equations.

A program calls `serve` with what it can do and with a function that makes a run. The protocol is
described in docs/PROTOCOL.md.
"""

import json
import os
import platform
import sys
import time

import numpy as np

# Displacements of so many roundings are none: those of thousands of steps add up.
ROUNDING = 1024 * np.finfo(float).eps
# How much of a guard that was zero where its mode begins the first steps may hide, in tolerances:
# of a simple zero, which it leaves at once, and of a multiple one, which it leaves slowly.
SIMPLE_ZERO_TOLERANCES, MULTIPLE_ZERO_TOLERANCES = 0.1, 10
# So many stretches in so little of a run are one event that is found again and again.
MAX_STRETCHES, PROGRESS_TOLERANCE = 200, 1e-9
# So many events in one instant end a run.
MAX_SIMULTANEOUS_EVENTS = 64
INSTANT_TOLERANCE = 8 * np.finfo(float).eps


class Failure(Exception):
    """Why there is no run."""


class GaveUp(Exception):
    """How a run went beyond its limits."""


class Meter:
    """What a run costs, and the end of one that costs too much."""

    def __init__(self, limits):
        self.most, self.events = limits["calls"], limits["events"]
        self.deadline = time.monotonic() + limits["wall_s"]
        self.rhs = self.jacobians = self.linear_solves = self.steps = 0
        # Kept here, because a library may raise an exception of its own instead.
        self.gave_up = None

    def give_up(self, why):
        self.gave_up = why
        raise GaveUp(why)

    def call(self):
        """Counts a right-hand side."""
        self.rhs += 1
        if self.rhs + self.jacobians > self.most:
            self.give_up(f"{self.most} calls were too few")
        if self.rhs % 1024 == 0 and time.monotonic() > self.deadline:
            self.give_up("the time is over")

    def work(self):
        names = ("rhs", "jacobians", "linear_solves", "steps")
        return {name: int(getattr(self, name)) for name in names}


class Event:
    """An event of a mode. Its row is over (z, cos theta, sin theta, 1)."""

    def __init__(self, wire, size):
        self.row = np.array(wire["guard"])
        self.sign = {"rising": 1, "falling": -1, "both": 0}[wire["direction"]]
        self.ends = bool(wire["successors"])
        self.reset = np.eye(size + 3)
        if wire["reset"] is not None:
            self.reset[:size] = wire["reset"]
        self.successors = [
            (None if it["when"] is None else np.array(it["when"]), it["mode"])
            for it in wire["successors"]
        ]


class Mode:
    """A mode: z' = A z + c + B (cos theta, sin theta)."""

    def __init__(self, wire, omega):
        self.a, self.b, self.c = (np.array(wire[key], dtype=float) for key in "ABc")
        size = len(self.c)
        self.events = [Event(it, size) for it in wire["events"]]
        # The matrix M of w' = M w, with w = (z, cos theta, sin theta, 1).
        self.wide = np.zeros((size + 3, size + 3))
        self.wide[:size] = np.hstack([self.a, self.b, self.c[:, None]])
        self.wide[size, size + 1], self.wide[size + 1, size] = -omega, omega


class System:
    """The equations of a request."""

    def __init__(self, run):
        wire = run["system"]
        self.omega, self.phi = wire["omega"], wire["phi"]
        self.modes = [Mode(mode, self.omega) for mode in wire["modes"]]
        self.backward = run["backward"]

    def wide(self, t, z):
        """The vector (z, cos theta, sin theta, 1)."""
        theta = self.omega * t + self.phi
        return np.concatenate([z, [np.cos(theta), np.sin(theta), 1.0]])

    def rates(self, mode, t, z):
        """The right-hand side."""
        mode = self.modes[mode]
        theta = self.omega * t + self.phi
        return mode.a @ z + mode.c + mode.b @ (np.cos(theta), np.sin(theta))

    def leading(self, row, mode, t, z, passed=None):
        """The first derivative of row . w along a mode that is not zero, and its order. What is a
        multiple of the guard that was `passed` is zero there, whatever rounding says."""
        w = self.wide(t, z)
        for order in range(len(w)):
            known = passed is not None and is_multiple(row @ passed.reset, passed.row)
            value = row @ w
            if not known and abs(value) > ROUNDING * (abs(row) @ abs(w)):
                return order, value
            row = row @ self.modes[mode].wide
        return None, 0.0

    def switch(self, mode, event, t, z):
        """The mode that follows an event, and the state after it."""
        event = self.modes[mode].events[event]
        z = (event.reset @ self.wide(t, z))[: len(z)]
        for when, following in event.successors:
            if when is None or self.leading(when, following, t, z, event)[1] > 0:
                return following, z
        raise Failure("no mode follows")

    def switch_plainly(self, mode, event, t, z):
        """As `switch`, by the signs of conditions alone, zero or not."""
        event = self.modes[mode].events[event]
        wide = event.reset @ self.wide(t, z)
        for when, following in event.successors:
            if when is None or when @ wide > 0:
                return following, wide[: len(z)]
        raise Failure("no mode follows")

    def entry(self, mode, t, z, passed=None):
        """The first event that ends a mode where it begins, if there is one; and, of each guard
        that is zero there, the order of its first derivative that is not zero, and its sign."""
        fires, zeros = None, {}
        for place, event in enumerate(self.modes[mode].events):
            order, value = self.leading(event.row, mode, t, z, passed)
            if event.ends and value > 0 and fires is None:
                fires = place
            if order != 0:
                zeros[place] = (order, float(np.sign(value)))
        return fires, zeros


def is_multiple(row, of):
    """Whether a row is a multiple of another one, of 0 at the least."""
    size = of @ of
    return np.linalg.norm(row * size - of * (row @ of)) <= 1e-12 * size * np.linalg.norm(row)


class Course:
    """A run as it is made: its state, and what is reported of it."""

    def __init__(self, run):
        self.run, self.system = run, System(run)
        self.meter = Meter(run["limits"])
        self.t, self.mode, self.z = 0.0, run["mode"], np.array(run["state"], dtype=float)
        self.span, self.samples = run["span"], np.array(run["samples"], dtype=float)
        self.events, self.sampled, self.ended = [], [], None
        # What the derivatives of this run are made of: see `chained`.
        self.trail = []
        self.crowd = 0
        self.stretches, self.progress = 0, 0.0
        self.sample(self.samples[self.samples <= 0.0], lambda t: self.z)

    def pending(self):
        """When the state is still wanted, after now."""
        due = self.samples[len(self.sampled) :]
        self.sample(due[due <= self.t], lambda t: self.z)
        return self.samples[len(self.sampled) :]

    def hidden(self, event, order, z):
        """What the first steps may hide of a guard that was zero where its mode begins."""
        tolerance = self.run["tolerance"]
        errors = tolerance["absolute"] + tolerance["relative"] * abs(z)
        errors = abs(event.row[: len(z)]) @ errors
        return (SIMPLE_ZERO_TOLERANCES if order == 1 else MULTIPLE_ZERO_TOLERANCES) * errors

    def guard(self, place, zeros):
        """The guard of an event as a function. One that is zero where the mode begins has the sign
        that it has just after it, until it has moved away by more than the tolerance hides."""
        event = self.system.modes[self.mode].events[place]
        order, sign = zeros.get(place, (0, 0.0))
        # When the guard was first seen away from its zero: in the step before, a root is looked for
        # with the values that the search was begun with.
        moved = float("inf") if order != 0 else self.t

        def guard(t, z):
            nonlocal moved
            if order is None:
                return -1.0  # it stays zero
            value = event.row @ self.system.wide(t, z)
            if t >= moved or abs(value) > self.hidden(event, order, z):
                moved = min(t, moved)
                return value
            return sign * 1e-300

        return guard

    def longest_step(self):
        """The longest step that an expert allows where events are looked for at the ends of steps:
        an eighth of a forcing period and of a turn."""
        times = self.run["times"]
        return 0.125 * min(times["period"], times["turn"] or times["period"])

    def by_experts(self, stretch):
        """Runs from mode to mode. `stretch` is given what is known of guards that are zero where it
        begins. It returns the event that has ended the mode, if one has, and what is known of the
        guards where it has stopped otherwise."""
        passed, stopped = None, {}
        while self.goes_on():
            events = self.system.modes[self.mode].events
            fires, zeros = self.system.entry(self.mode, self.t, self.z, passed)
            if fires is not None and not stopped:
                passed = events[fires]
                self.pass_event(self.t, fires, self.z)
                continue
            place, stopped = stretch(zeros | stopped)
            passed = None if place is None else events[place]

    def with_guard(self, place):
        """The events of the mode that have the guard of this one, or a multiple of it."""
        events = self.system.modes[self.mode].events
        row = events[place].row
        alike = lambda it: is_multiple(it.row, row) and it.row @ row > 0
        return [n for n, it in enumerate(events) if alike(it)]

    def known_guards(self, zeros):
        """What is hidden of each guard, the sign that it has where the run begins, and whether it
        stays zero."""
        events = self.system.modes[self.mode].events
        now = self.system.wide(self.t, self.z)
        signs = np.array([np.sign(event.row @ now) for event in events])
        hidden, stays = np.zeros(len(events)), np.zeros(len(events), dtype=bool)
        for place, (order, sign) in zeros.items():
            signs[place], stays[place] = sign, order is None
            if order is not None:
                hidden[place] = self.hidden(events[place], order, self.z)
        return hidden, signs, stays

    def that_counts(self, place, way):
        """The event that a guard's crossing is: of those with this guard, the one whose direction
        counts, if there is one."""
        events = self.system.modes[self.mode].events
        counts = (n for n in self.with_guard(place) if events[n].sign in (0, way))
        return next(counts, place)

    def crossed(self, place):
        """What is known of guards that were crossed where a run stops and goes on."""
        mode = self.system.modes[self.mode]
        rate = mode.events[place].row @ mode.wide @ self.system.wide(self.t, self.z)
        return {n: (1, float(np.sign(rate))) for n in self.with_guard(place)}

    def sample(self, times, state):
        self.sampled.extend(np.array(state(t)).tolist() for t in times)

    def report(self, t, event, mode, z, before=None):
        """Reports an event and the state after it. `before` is the state before its reset; of an
        event that is only counted it is the state itself."""
        if len(self.events) >= self.meter.events:
            self.meter.give_up(f"{len(self.events)} events were too few")
        z = np.array(z).tolist()
        before = z if before is None else np.array(before).tolist()
        self.events.append(
            {"time": float(t), "event": event, "mode": mode, "before": before, "state": z}
        )
        self.trail.append((self.mode, event, float(t), np.array(before)))

    def pass_event(self, t, event, z, switch=None):
        """Goes through an event that ends its mode."""
        if self.system.backward:
            self.t, self.z, self.ended = t, z, "leaves-domain"
            return
        follows, after = (switch or self.system.switch)(self.mode, event, t, z)
        self.report(t, event, follows, after, z)
        self.crowd = self.crowd + 1 if t - self.t <= INSTANT_TOLERANCE * t else 1
        self.t, self.mode, self.z = t, follows, after
        if self.crowd >= MAX_SIMULTANEOUS_EVENTS:
            self.ended = "no-progress"

    def goes_on(self):
        """Whether the run has not come to its end; asked once a stretch."""
        self.stretches += 1
        if self.t - self.progress > PROGRESS_TOLERANCE * self.span:
            self.stretches, self.progress = 0, self.t
        if self.stretches > MAX_STRETCHES:
            raise Failure(f"events at {self.t} are found again and again")
        return self.ended is None and self.span - self.t > 2 * INSTANT_TOLERANCE * self.span

    def answer(self, took):
        ended = self.ended or "horizon"
        if ended == "horizon":
            # What rounding has left over.
            self.sample(self.pending(), lambda t: self.z)
        return {
            "events": self.events,
            "samples": self.sampled,
            "end": np.array(self.z).tolist(),
            "ended": ended,
            "ended_at": float(self.span if ended == "horizon" else self.t),
            "work": self.meter.work(),
            "own_ns": took,
        }


def moved(run, rates, step):
    """The request for another value of a name, which is larger by a step: every coefficient is
    moved by its derivative. What is not linear in the name is off by the square of the step."""

    def along(own, rate):
        if own is None or rate is None:
            return own
        return (np.array(own, dtype=float) + step * np.array(rate, dtype=float)).tolist()

    def event(own, rate):
        return own | {key: along(own[key], rate[key]) for key in ("guard", "reset")}

    def mode(own, rate):
        coefficients = {key: along(own[key], rate[key]) for key in "ABc"}
        events = [event(*both) for both in zip(own["events"], rate["events"])]
        return own | coefficients | {"events": events}

    system = run["system"]
    system = system | {
        "omega": system["omega"] + step * rates["omega"],
        "phi": system["phi"] + step * rates["phi"],
        "modes": [mode(*both) for both in zip(system["modes"], rates["modes"])],
    }
    return run | {"system": system, "state": along(run["state"], rates["state"])}


def differences(make, setup, course, steps):
    """Derivatives by differences of whole runs. `steps` takes the rates of a name, and gives the
    two steps of that name between whose runs the difference is taken. A name has none where one of
    the two runs has other events than the course."""

    def word(course):
        return [(it["event"], it["mode"]) for it in course.events]

    found = []
    for rates in course.run["gradients"]:
        below, above = steps(rates)
        runs = []
        for step in (below, above):
            other = Course(moved(course.run, rates, step))
            other.meter = course.meter
            make(setup, other)
            runs.append(other)
        if any(word(run) != word(course) for run in runs):
            continue
        first, last = runs

        def slope(a, b):
            return ((np.array(b) - np.array(a)) / (above - below)).tolist()

        events = [
            {key: slope(*both) for key, both in (
                ("time", (a["time"], b["time"])), ("state", (a["state"], b["state"]))
            )}
            for a, b in zip(first.events, last.events)
        ]
        end = slope(first.z, last.z)
        found.append({"wrt": rates["wrt"], "events": events, "end": end})
    return found


class Rates:
    """The derivatives of a system's coefficients by a name."""

    def __init__(self, wire, course):
        self.wrt, self.omega, self.phi = wire["wrt"], wire["omega"], wire["phi"]
        self.state = np.array(wire["state"], dtype=float)
        size = len(self.state)
        self.matrices, self.rows, self.resets = [], [], []
        for mode in wire["modes"]:
            a, b, c = (np.array(mode[key], dtype=float).reshape(size, -1) for key in "ABc")
            self.matrices.append(np.hstack([a, b, c]))
            events = mode["events"]
            rows = np.array([it["guard"] for it in events], dtype=float)
            self.rows.append(rows.reshape(-1, size + 3))
            none = np.zeros((size, size + 3))
            resets = [it["reset"] for it in events]
            self.resets.append([none if it is None else np.array(it) for it in resets])

    def of_wide(self, system, t, z, dt, dz):
        """The derivative of (z, cos theta, sin theta, 1) at a time that moves."""
        wide = system.wide(t, z)
        angle = self.omega * t + system.omega * dt + self.phi
        size = len(z)
        return np.concatenate([dz, [-wide[size + 1] * angle, wide[size] * angle, 0.0]])


def finite(value):
    """What JSON can hold of a number or of numbers: none where one is not finite."""
    return value.tolist() if np.all(np.isfinite(value)) else None


def chained(course):
    """Derivatives along a run by the chain rule. The trail of the run has, for each stretch, a
    function that takes the derivatives of the time and of the state where it begins, by each name,
    and gives those where it ends; and each event. Resets are differentiated here."""
    system = course.system
    by = [Rates(it, course) for it in course.run["gradients"]]
    times, states = np.zeros(len(by)), np.array([it.state for it in by])
    found = [[] for _ in by]
    for step in course.trail:
        if not isinstance(step, tuple):
            times, states = (np.array(it) for it in step(by, times, states))
            continue
        mode, event, t, z = step
        reset = system.modes[mode].events[event].reset[: len(z)]
        for n, rates in enumerate(by):
            wide = rates.of_wide(system, t, z, times[n], states[n])
            states[n] = reset @ wide + rates.resets[mode][event] @ system.wide(t, z)
            found[n].append({"time": finite(times[n]), "state": finite(states[n])})
    return [
        {"wrt": rates.wrt, "events": events, "end": end.tolist()}
        for rates, events, end in zip(by, found, states)
        if np.all(np.isfinite(end))
    ]


def by_hand(course, began, ended, place, along):
    """Derivatives along a stretch that was run without events, for a trail: the jump where an event
    ends it is added here. `began` and `ended` are time and state; `along` takes the derivatives of
    the state at the fixed time at which the stretch begins, a row for each name, and gives those at
    the fixed time at which it ends."""
    system, mode, (begin, z0), (end, z) = course.system, course.mode, began, ended

    def push(by, times, states):
        fixed = states - np.outer(times, system.rates(mode, begin, z0))
        if end > begin:
            fixed = along(by, fixed)
        if place is None:
            return np.zeros(len(by)), fixed
        event, wide = system.modes[mode].events[place], system.wide(end, z)
        rate = event.row @ system.modes[mode].wide @ wide
        times = np.zeros(len(by))
        for n, rates in enumerate(by):
            change = event.row @ rates.of_wide(system, end, z, 0.0, fixed[n])
            times[n] = -(change + rates.rows[mode][place] @ wide) / rate
        return times, fixed + np.outer(times, system.rates(mode, end, z))

    return push


def in_pairs(methods, **more):
    """The set-ups `NAME` and `NAME-default` of each method that finds events by itself. `methods`
    has for each name what the method is, its class, and its order, or None; `more` is what all of
    them declare besides."""
    return [
        {
            "name": name + suffix,
            "method": method,
            "class": class_,
            "order": order,
            "events": "library",
            "dense_output": True,
            "stepping": "adaptive",
            **more,
        }
        for name, (method, class_, order) in methods.items()
        for suffix in ("", "-default")
    ]


def serve(library, version, setups, make, gradients=None):
    """Answers requests until there are no more. `make` takes the name of a set-up and a `Course`,
    and runs it to its end. Set-ups that declare `gradients` need that function: it takes the same
    two after a run, and returns the derivatives by the names that it has."""
    said = {
        "library": library,
        "version": version,
        "language": f"Python {platform.python_version()}",
        "setups": setups,
    }
    # What a library prints is no answer, whatever language it is printed from.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for line in sys.stdin:
        request = json.loads(line)
        answer = {"percuss_protocol": 1, "id": request["id"]}
        if request["ask"] == "capabilities":
            answer["capabilities"] = said
        elif request["ask"] == "ready":
            answer["ready"] = True
        else:
            answer.update(made(make, request["run"], gradients))
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def made(make, run, gradients):
    """A run, or why there is none."""
    course = Course(run)
    try:
        began = time.perf_counter_ns()
        make(run["setup"], course)
        took = time.perf_counter_ns() - began
        answer = course.answer(took)
        if run.get("gradients"):
            answer["gradients"] = gradients(run["setup"], course)
        json.dumps(answer, allow_nan=False)
        return {"run": answer}
    except Exception as why:  # whatever a library raises is its reason
        if course.meter.gave_up:
            return {"gave_up": course.meter.gave_up}
        return {"failure": f"{type(why).__name__}: {why}"}


def unavailable(why):
    """Says why nothing can be run here, and ends the program."""
    request = json.loads(sys.stdin.readline())
    print(json.dumps({"percuss_protocol": 1, "id": request["id"], "unavailable": why}))
    sys.exit(0)

"""Walks the modes of a problem with a function like SciPy's `solve_ivp`.

In the set-up `documentation` it is called as the first example of events in SciPy's documentation
does: events that are terminal and have a direction, the tolerances set, and nothing else. The
set-up `experts` adds what an expert adds, and is that of `validation/programs/python/`:

- Steps are at most an eighth of a forcing period and of a turn.
- A guard that is zero where a mode begins has the sign that it has just after it, until it has
  moved away by more than the tolerance hides.
- Whether an event follows at once, and which mode, is told by the first derivative that is not
  zero.
- Implicit methods are given their Jacobian.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from percuss import _program as _untyped
from percuss._problem import Answer, Happened, Problem

# The module is a program's, and has no types.
_program: Any = _untyped

SETUPS = ("experts", "documentation")

_CALLS, _EVENTS, _WALL_S = 20_000_000, 100_000, 120.0


class NoAnswer(Exception):
    """Why there is no answer to a problem."""


class Walker:
    """A `solve_ivp` with its method and its options, as a solver of problems."""

    def __init__(
        self,
        solve_ivp: Callable[..., Any],
        method: str | None,
        options: dict[str, Any],
        setup: str,
        has_jacobian: bool,
    ) -> None:
        self.solve_ivp = solve_ivp
        self.options = dict(options) if method is None else {"method": method, **options}
        self.setup = setup
        self.has_jacobian = has_jacobian

    def __call__(self, problem: Problem) -> Answer:
        """Answer a problem, or say by `NoAnswer` why there is no answer."""
        course = _program.Course(_request(problem))
        try:
            if self.setup == "documentation":
                self._by_default(course)
            else:
                self._by_experts(course)
            told = course.answer(None)
        except Exception as error:  # whatever a library raises is its reason
            if course.meter.gave_up:
                raise NoAnswer(course.meter.gave_up) from None
            raise NoAnswer(f"{type(error).__name__}: {error}") from error
        return _answer(problem, told)

    def _by_default(self, course: Any) -> None:
        while course.goes_on():
            solved = self._stretch(course, {}, {})
            self._take(course, solved, course.system.switch_plainly)

    def _by_experts(self, course: Any) -> None:
        extra: dict[str, Any] = {"max_step": course.longest_step()}

        def stretch(zeros: dict[int, Any]) -> tuple[int | None, dict[int, Any]]:
            if self.has_jacobian:
                matrix = course.system.modes[course.mode].a
                extra["jac"] = lambda t, z: matrix
            return self._take(course, self._stretch(course, zeros, extra), None), {}

        course.by_experts(stretch)

    def _stretch(self, course: Any, zeros: dict[int, Any], extra: dict[str, Any]) -> Any:
        """Runs to the next event that ends the mode, or to the horizon."""
        system, meter, mode = course.system, course.meter, course.mode

        def rates(t: float, z: Any) -> Any:
            meter.call()
            return system.rates(mode, t, z)

        def each_step(t: float, z: Any) -> float:
            # Called once where the run begins and once a step; never an event.
            meter.steps += 1
            return -1.0

        guards = [_watched(course, place, zeros) for place in range(len(system.modes[mode].events))]
        tolerance = course.run["tolerance"]
        tolerances = {"rtol": tolerance["relative"], "atol": tolerance["absolute"]}
        # The state at the horizon is wanted in any case: the next run begins there.
        times = [t for t in course.pending() if t < course.span] + [course.span]
        solved = self.solve_ivp(
            rates,
            (course.t, course.span),
            course.z,
            t_eval=times,
            events=[*guards, each_step],
            **{**tolerances, **extra, **self.options},
        )
        meter.steps -= 1
        meter.jacobians += int(getattr(solved, "njev", 0) or 0)
        if solved.status < 0:
            raise _program.Failure(solved.message)
        return solved

    def _take(self, course: Any, solved: Any, switch: Any) -> int | None:
        """Takes over what was found, and returns the event that has ended the mode, if one has."""
        events = course.system.modes[course.mode].events
        states = {
            (float(t), place): z
            for place in range(len(events))
            for t, z in zip(solved.t_events[place], solved.y_events[place])
        }
        for t, place in sorted(it for it in states if not events[it[1]].ends):
            course.report(t, place, course.mode, states[t, place])
        at = (
            dict(zip(np.asarray(solved.t).tolist(), np.asarray(solved.y).T))
            if len(solved.t)
            else {}
        )
        course.sample([t for t in at if t < course.span], at.get)
        if solved.status == 1:
            ending = (it for it in sorted(states) if events[it[1]].ends)
            t, place = next(ending, (np.nan, -1))
            if place < 0:
                raise _program.Failure("status is 1, and no event in t_events has a state")
            course.pass_event(t, place, states[t, place], switch)
            return place
        if course.span not in at:
            raise _program.Failure(f"no state at {course.span!r}, the end of the span")
        course.t, course.z = course.span, at[course.span]
        return None


def _watched(course: Any, place: int, zeros: dict[int, Any]) -> Any:
    """An event as `solve_ivp` takes it: a function with two attributes."""
    event = course.system.modes[course.mode].events[place]
    guard = course.guard(place, zeros)
    guard.terminal, guard.direction = event.ends, event.sign
    return guard


def _request(problem: Problem) -> dict[str, Any]:
    """What the protocol would ask of a program."""
    asked = problem.asked
    parameters = asked["parameters"]
    modes = {"omega": parameters["omega"], "phi": parameters["phi"], "modes": asked["modes"]}
    return {
        "system": modes,
        "backward": asked["backward"],
        "mode": asked["start"]["mode"],
        "state": asked["start"]["state"],
        "span": asked["horizon"],
        "samples": asked["sample_times"],
        "tolerance": {"relative": problem.tolerance, "absolute": problem.tolerance},
        "times": asked["times"],
        "limits": {"calls": _CALLS, "events": _EVENTS, "wall_s": _WALL_S},
    }


def _answer(problem: Problem, told: dict[str, Any]) -> Answer:
    """What a program would answer, with names in place of numbers."""
    modes = list(problem.modes.values())
    mode, events = problem.modes[problem.mode], []
    for it in told["events"]:
        following = modes[it["mode"]]
        name = mode.events[it["event"]].name
        events.append(Happened(it["time"], name, following.name, it["state"], it["before"]))
        mode = following
    is_early = told["ended"] != "horizon"
    names = ("rhs", "jacobians", "linear_solves", "steps")
    rhs, jacobians, solves, steps = (told["work"][name] for name in names)
    return Answer(
        events,
        np.array(told["samples"], dtype=np.float64).reshape(-1, len(problem.states)),
        told["ended"] if is_early else None,
        told["ended_at"] if is_early else None,
        told["end"] if is_early else None,
        (rhs, jacobians, solves, steps),
    )

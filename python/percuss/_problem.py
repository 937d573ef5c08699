"""What a case asks of a solver, and what a solver answers."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from percuss._run import Floats


@dataclass(frozen=True, eq=False)
class Successor:
    """A mode that may follow an event: the first whose row `when` is positive, or is None, does."""

    when: Floats | None
    mode: str


@dataclass(frozen=True, eq=False)
class EventRule:
    """An event of a mode: where its guard crosses zero in its direction.

    Attributes
    ----------
    name : str
        The event's name.
    guard : ndarray, shape (d + 3,)
        A row over (z, cos theta, sin theta, 1).
    direction : {1, -1, 0}
        Rising, falling or both, as SciPy has it.
    terminal : bool
        Whether the event ends its mode.
    reset : ndarray, shape (d, d + 3), or None
        The state after it, as rows; None where it stays.
    successors : tuple of Successor
        The modes that may follow, of an event that ends its mode.
    """

    name: str
    guard: Floats
    direction: int
    terminal: bool
    reset: Floats | None
    successors: tuple[Successor, ...]


@dataclass(frozen=True, eq=False)
class ModeRule:
    """A mode: z' = A z + c + B (cos theta, sin theta), and its events."""

    name: str
    A: Floats
    B: Floats
    c: Floats
    events: tuple[EventRule, ...]


@dataclass(frozen=True, eq=False)
class ModeRates:
    """The derivatives of a mode's coefficients, in the places of :class:`ModeRule`.

    Attributes
    ----------
    A, B, c : ndarray
        Of the right-hand side.
    guards : ndarray, shape (e, d + 3)
        Of the guard of each event, in their order.
    resets : tuple of ndarray or None
        Of each reset; None where the state stays.
    """

    A: Floats
    B: Floats
    c: Floats
    guards: Floats
    resets: tuple[Floats | None, ...]


@dataclass(frozen=True, eq=False)
class Rates:
    """The derivatives of a problem's coefficients by a parameter or by a state of the start.

    Attributes
    ----------
    wrt : str
        The name, which is `start.STATE` of a state.
    value : float
        The value of what the name says.
    omega, phi : float
        Of theta = omega t + phi.
    state : ndarray, shape (d,)
        Of the state at the start.
    modes : dict of str to ModeRates
        Of the modes.
    """

    wrt: str
    value: float
    omega: float
    phi: float
    state: Floats
    modes: dict[str, ModeRates]


class Problem:
    """A case: begin in `mode` at `state` at the time 0, and run to `horizon`.

    Attributes
    ----------
    case : str
        The case's name.
    tolerance : float
        The relative and the absolute tolerance that is asked for.
    states : list of str
        The names of the d states.
    modes : dict of str to ModeRule
        The modes, by name.
    mode, state
        The mode and the state of shape (d,) at the start.
    omega, phi : float
        theta = omega t + phi.
    horizon : float
        The time at which the run ends.
    sample_times : ndarray, shape (m,)
        The times at which the state is wanted.
    backward : bool
        Whether time runs back: the first terminal event then ends the run.
    by : tuple of Rates
        What one differentiates by, of a case of derivatives; empty of others.
    asked : dict
        All of it as ``percuss export`` writes it.
    """

    def __init__(self, text: str, tolerance: float) -> None:
        asked: dict[str, Any] = json.loads(text)
        self.asked = asked
        self.case: str = asked["case"]
        self.tolerance = tolerance
        self.states: list[str] = asked["states"]
        names = [mode["name"] for mode in asked["modes"]]
        self.modes = {mode["name"]: _mode(mode, names) for mode in asked["modes"]}
        self.mode: str = names[asked["start"]["mode"]]
        self.state: Floats = np.array(asked["start"]["state"], dtype=np.float64)
        self.omega: float = asked["parameters"]["omega"]
        self.phi: float = asked["parameters"]["phi"]
        self.horizon: float = asked["horizon"]
        self.sample_times: Floats = np.array(asked["sample_times"], dtype=np.float64)
        self.backward: bool = asked["backward"]
        gradients = asked.get("gradients", {"by": []})
        self.by = tuple(_rates(it, names) for it in gradients["by"])

    def wide(self, t: float, z: ArrayLike) -> Floats:
        """The vector (z, cos theta, sin theta, 1), over which all rows are."""
        theta = self.omega * t + self.phi
        return np.concatenate([np.asarray(z, float), [np.cos(theta), np.sin(theta), 1.0]])

    def rates(self, mode: str, t: float, z: ArrayLike) -> Floats:
        """The right-hand side in a mode."""
        rule, theta = self.modes[mode], self.omega * t + self.phi
        forced = rule.B @ np.array([np.cos(theta), np.sin(theta)])
        return np.asarray(rule.A @ np.asarray(z, float) + rule.c + forced)

    def after(self, event: EventRule, t: float, z: ArrayLike) -> tuple[str, Floats]:
        """The mode and the state that follow a terminal event, by the signs of its conditions."""
        state = np.array(z, dtype=np.float64)
        if event.reset is not None:
            state = event.reset @ self.wide(t, state)
        wide = self.wide(t, state)
        for successor in event.successors:
            if successor.when is None or successor.when @ wide > 0:
                return successor.mode, state
        raise ValueError(f"{event.name}: no mode follows")

    def __repr__(self) -> str:
        return f"Problem({self.case!r}, tolerance={self.tolerance:g})"


def _mode(mode: Mapping[str, Any], names: list[str]) -> ModeRule:
    a, b, c = (np.array(mode[key], dtype=np.float64) for key in "ABc")
    events = tuple(_event(event, names) for event in mode["events"])
    return ModeRule(mode["name"], a, b, c, events)


def _rates(rates: Mapping[str, Any], names: list[str]) -> Rates:
    modes = {name: _mode_rates(mode) for name, mode in zip(names, rates["modes"])}
    state = np.array(rates["state"], dtype=np.float64)
    return Rates(rates["wrt"], rates["value"], rates["omega"], rates["phi"], state, modes)


def _mode_rates(mode: Mapping[str, Any]) -> ModeRates:
    a, b, c = (np.array(mode[key], dtype=np.float64) for key in "ABc")
    guards = [it["guard"] for it in mode["events"]]
    return ModeRates(
        a,
        b,
        c,
        np.array(guards, dtype=np.float64).reshape(len(guards), len(c) + 3),
        tuple(_row(it["reset"]) for it in mode["events"]),
    )


def _row(it: Any) -> Floats | None:
    return None if it is None else np.array(it, dtype=np.float64)


def _event(event: Mapping[str, Any], names: list[str]) -> EventRule:
    successors = tuple(
        Successor(_row(it["when"]), names[int(it["mode"])]) for it in event["successors"]
    )
    return EventRule(
        event["name"],
        np.array(event["guard"], dtype=np.float64),
        {"rising": 1, "falling": -1, "both": 0}[event["direction"]],
        bool(successors),
        _row(event["reset"]),
        successors,
    )


@dataclass
class Happened:
    """An event as a solver found it.

    Attributes
    ----------
    time : float
        The time of the event.
    name : str
        The event's name.
    mode : str
        The mode that begins or goes on.
    state : array_like, shape (d,)
        The state after it.
    before : array_like, shape (d,), optional
        The state before its reset, without which it is not judged how well it was located.
    """

    time: float
    name: str
    mode: str
    state: ArrayLike
    before: ArrayLike | None = None


@dataclass
class Differentiated:
    """The derivatives of a run by one name, as a solver has them.

    Attributes
    ----------
    wrt : str
        The name, one of ``problem.by``.
    times : array_like, shape (n,)
        Of the time of each event; NaN where there is none.
    states : array_like, shape (n, d)
        Of the state after each event at its own time, which moves; NaN where there is none.
    end : array_like, shape (d,)
        Of the state at the horizon.
    """

    wrt: str
    times: ArrayLike
    states: ArrayLike
    end: ArrayLike


@dataclass
class Answer:
    """What a solver answers to a problem.

    Attributes
    ----------
    events : sequence of Happened
        The events in the order of their times.
    samples : array_like, shape (m, d), optional
        The states at the problem's ``sample_times``; fewer where the run ended before.
    ending : str, optional
        How a run ended before its horizon: ``accumulation``, ``leaves-domain``, ``no-progress``.
    end_time, end_state : optional
        When, and in which state.
    work : (int, int, int, int), optional
        Right-hand sides, Jacobians, linear systems solved, and steps.
    gradients : sequence of Differentiated, optional
        The derivatives by each name of ``problem.by``, of a case of derivatives.
    """

    events: Sequence[Happened]
    samples: ArrayLike | None = None
    ending: str | None = None
    end_time: float | None = None
    end_state: ArrayLike | None = None
    work: tuple[int, int, int, int] | None = None
    gradients: Sequence[Differentiated] | None = None

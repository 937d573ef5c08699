"""Systems built in Python, from expressions or from matrices."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percuss._run import pair, real
from percuss._system import System, toml_number


_Kind = TypeVar("_Kind")


@dataclass
class Until:
    """A guard that ends its mode where it becomes positive.

    Parameters
    ----------
    name : str
        The event's name: lower-case words joined by hyphens.
    guard : str or array_like
        A condition such as ``"x < 0"``, or a row over (states, 1) or (states, cos, sin, 1) whose
        value is negative inside the mode.
    reset : sequence of str, or array_like, optional
        Assignments such as ``"v = -v/2"``, or one row for each state.
    next : str, or sequence of (condition or None, str), optional
        The mode that follows, the same by default; or modes with their conditions, the last
        without one.
    """

    name: str
    guard: str | ArrayLike
    reset: Sequence[str] | ArrayLike = ()
    next: str | Sequence[tuple[str | None, str]] | None = None


@dataclass
class Watch:
    """A guard whose crossings are counted.

    Parameters
    ----------
    name : str
        The event's name.
    guard : str or array_like
        A condition or a row, as that of :class:`Until`.
    direction : {'rising', 'falling', 'both'}, optional
        The crossings that count.
    """

    name: str
    guard: str | ArrayLike
    direction: str = "rising"


@dataclass
class Mode:
    """A mode: its motion, and the events that it has.

    Parameters
    ----------
    name : str
        The mode's name: lower-case words joined by hyphens.
    equations : sequence of str, optional
        One a state, such as ``"x' = v"``.
    A, c, B : array_like, optional
        In place of equations: x' = A x + c + B (cos theta, sin theta), of shapes (d, d), (d,) and
        (d, 2).
    until : sequence of Until, optional
        The guards that end the mode.
    watch : sequence of Watch, optional
        The guards that are only counted.
    """

    name: str
    equations: Sequence[str] | None = None
    A: ArrayLike | None = None
    c: ArrayLike | None = None
    B: ArrayLike | None = None
    until: Sequence[Until] = field(default_factory=list)
    watch: Sequence[Watch] = field(default_factory=list)


def _numbers(item: str, value: ArrayLike) -> NDArray[np.float64]:
    """An array of numbers."""
    try:
        found = np.asarray(value)
        if found.dtype.kind not in "biufO":
            raise TypeError
        return found.astype(np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{item}: {value!r} is not accepted: an array of numbers is") from None


def _each(name: str, given: Any, kind: type[_Kind]) -> list[_Kind]:
    """The entries of a sequence, each of one kind."""
    entries = list(given) if isinstance(given, Iterable) else [given]
    for it in entries:
        if not isinstance(it, kind):
            raise TypeError(f"{name} = {given!r} is not accepted: a list of {kind.__name__} is")
    return entries


class _Writer:
    """The text of a system; numbers of matrices become parameters: expressions have none."""

    def __init__(self, states: Sequence[str], parameters: Mapping[str, float]) -> None:
        self.states = list(states)
        self.parameters = {name: real(name, value) for name, value in parameters.items()}

    def term(self, name: str, value: float, factor: str) -> str:
        """A number times a factor, as a signed term of an expression; nothing of a zero."""
        if value == 0:
            return ""
        if value != int(value) or abs(value) >= 2**53:
            self.parameters[name] = value
            return f" + {name}" + (f"*{factor}" if factor else "")
        sign, size = ("-" if value < 0 else "+"), abs(int(value))
        if not factor:
            return f" {sign} {size}"
        return f" {sign} " + (factor if size == 1 else f"{size}*{factor}")

    def form(self, name: str, row: ArrayLike, item: str) -> str:
        """A row over (states, 1) or (states, cos, sin, 1) as an expression."""
        numbers = _numbers(item, row)
        size = len(self.states)
        if numbers.shape not in [(size + 1,), (size + 3,)]:
            shape = numbers.shape
            raise ValueError(
                f"{item}: a row of shape {shape}: ({size + 1},) or ({size + 3},) is accepted"
            )
        if not np.isfinite(numbers).all():
            raise ValueError(
                f"{item}: {numbers[~np.isfinite(numbers)][0]}: finite numbers are accepted"
            )
        extra = ["cos", "sin"] if len(numbers) == size + 3 else []
        factors = [*self.states, *extra, ""]
        terms = "".join(
            self.term(f"{name}_{place}", float(number), factor)
            for place, (number, factor) in enumerate(zip(numbers, factors, strict=True))
        )
        if terms.startswith(" - "):
            return "-" + terms.removeprefix(" - ")
        return terms.removeprefix(" + ") or "0"

    def equations(self, mode: Mode) -> list[str]:
        """The equations of a mode, one a state."""
        if mode.equations is not None:
            if mode.A is not None or mode.B is not None or mode.c is not None:
                raise TypeError(f"mode {mode.name!r} is accepted with equations or with matrices")
            return list(mode.equations)
        size = len(self.states)
        shapes = {"A": (size, size), "B": (size, 2), "c": (size,)}
        found = {}
        for name, shape in shapes.items():
            given = getattr(mode, name)
            item = f"mode {mode.name!r}: {name}"
            found[name] = np.zeros(shape) if given is None else _numbers(item, given)
            if found[name].shape != shape:
                raise ValueError(f"{item} of shape {found[name].shape}: {shape} is accepted")
        if mode.A is None and mode.c is None and mode.B is None:
            raise TypeError(f"mode {mode.name!r} has no motion: equations or A, c, B are accepted")
        forced = [found["B"]] if found["B"].any() else []
        rows = np.hstack([found["A"], *forced, found["c"][:, None]])
        item = f"mode {mode.name!r}"
        return [
            f"{state}' = {self.form(f'{_plain(mode.name)}_{state}', row, item)}"
            for state, row in zip(self.states, rows, strict=True)
        ]

    def condition(self, name: str, guard: str | ArrayLike, item: str) -> str:
        """The condition of an event."""
        return guard if isinstance(guard, str) else f"{self.form(name, guard, item)} > 0"

    def reset(self, name: str, reset: Any, item: str) -> list[str]:
        """The assignments of a reset."""
        if len(reset) == 0 or all(isinstance(it, str) for it in reset):
            return list(reset)
        if len(reset) != len(self.states):
            raise ValueError(
                f"{item}: {len(reset)} rows of a reset: {len(self.states)} are accepted"
            )
        return [
            f"{state} = {self.form(f'{name}_{state}', row, item)}"
            for state, row in zip(self.states, reset, strict=True)
        ]

    def mode(self, mode: Mode) -> list[str]:
        """The lines of a mode."""
        lines = ["[[mode]]", f"name = {_quoted(mode.name)}"]
        lines.append(f"equations = {_list(self.equations(mode))}")
        for event in _each(f"until of mode {mode.name!r}", mode.until, Until):
            item, name = f"event {event.name!r}", f"{_plain(mode.name)}_{_plain(event.name)}"
            lines += ["[[mode.until]]", f"name = {_quoted(event.name)}"]
            lines.append(f"guard = {_quoted(self.condition(name, event.guard, item))}")
            if len(assignments := self.reset(f"{name}_reset", event.reset, item)) > 0:
                lines.append(f"reset = {_list(assignments)}")
            if event.next is not None:
                following = [(None, event.next)] if isinstance(event.next, str) else event.next
                lines.append(f"next = [{', '.join(_successor(*it) for it in following)}]")
        for watch in _each(f"watch of mode {mode.name!r}", mode.watch, Watch):
            item, name = f"event {watch.name!r}", f"{_plain(mode.name)}_{_plain(watch.name)}"
            lines += ["[[mode.watch]]", f"name = {_quoted(watch.name)}"]
            lines.append(f"guard = {_quoted(self.condition(name, watch.guard, item))}")
            lines.append(f"direction = {_quoted(watch.direction)}")
        return lines


def _plain(name: str) -> str:
    """A name as a part of a parameter's."""
    return name.replace("-", "_")


def _quoted(text: str) -> str:
    if not isinstance(text, str):
        raise TypeError(f"{text!r} is not accepted: a text is")
    return json.dumps(text)


def _list(texts: Sequence[str]) -> str:
    return f"[{', '.join(_quoted(it) for it in texts)}]"


def _successor(when: str | None, mode: str) -> str:
    condition = "" if when is None else f"when = {_quoted(when)}, "
    return f"{{ {condition}mode = {_quoted(mode)} }}"


def _value(name: str, value: str | float) -> str:
    return _quoted(value) if isinstance(value, str) else toml_number(real(name, value))


def build(
    name: str,
    *,
    states: Sequence[str],
    modes: Sequence[Mode],
    start: Mapping[str, str | float] | None = None,
    parameters: Mapping[str, float] | None = None,
    forcing: tuple[float, float] | None = None,
    definitions: Mapping[str, str] | None = None,
    scales: Sequence[float] | None = None,
    time_scale: float | None = None,
) -> System:
    """Build a system from expressions or from matrices.

    Parameters
    ----------
    name : str
        The system's name: lower-case words joined by hyphens.
    states : sequence of str
        The names of the states, 1 to 11.
    modes : sequence of Mode
        The modes.
    start : mapping, optional
        ``mode``, every state, and ``t`` where it is not 0.
    parameters : mapping of str to float, optional
        The numbers that expressions name.
    forcing : (float, float), optional
        omega and phi of the forcing angle theta = omega t + phi.
    definitions : mapping of str to str, optional
        Names for expressions.
    scales : sequence of float, optional
        A positive size of each state.
    time_scale : float, optional
        The unit of time.

    Raises
    ------
    ValueError
        What the reader of systems' files refuses, and arrays of a wrong shape.

    Examples
    --------
    From expressions:

    >>> import percuss
    >>> from percuss import Mode, Until
    >>> impact = Until("impact", "x < 0", reset=["x = 0", "v = -e*v"])
    >>> ball = percuss.build(
    ...     "ball",
    ...     states=["x", "v"],
    ...     parameters={"e": 0.5},
    ...     modes=[Mode("flight", ["x' = v", "v' = -10"], until=[impact])],
    ...     start={"mode": "flight", "x": 5, "v": 0},
    ... )
    >>> ball.events(count=3).time
    array([0. , 1. , 2. , 2.5])

    From matrices, with the same motion:

    >>> impact = Until("impact", [-1, 0, 0], reset=[[0, 0, 0], [0, -0.5, 0]])
    >>> flight = Mode("flight", A=[[0, 1], [0, 0]], c=[0, -10], until=[impact])
    >>> start = {"mode": "flight", "x": 5, "v": 0}
    >>> ball = percuss.build("ball", states=["x", "v"], modes=[flight], start=start)
    >>> ball.events(count=3).time
    array([0. , 1. , 2. , 2.5])
    """
    writer = _Writer(states, parameters or {})
    modes = _each("modes", modes, Mode)
    if forcing is None and (unforced := next((it for it in modes if it.B is not None), None)):
        raise ValueError(f"B of mode {unforced.name!r} is not accepted without forcing")
    body = [line for mode in modes for line in writer.mode(mode)]
    lines = ["schema = 1", f"name = {_quoted(name)}", f"states = {_list(states)}"]
    if scales is not None:
        lines.append(f"scales = [{', '.join(toml_number(real('scales', it)) for it in scales)}]")
    if time_scale is not None:
        lines.append(f"time_scale = {toml_number(real('time_scale', time_scale))}")
    if forcing is not None:
        omega, phi = (toml_number(it) for it in pair("forcing", forcing))
        lines.append(f"forcing = {{ omega = {omega}, phi = {phi} }}")
    lines.append("[parameters]")
    lines += [f"{_quoted(it)} = {toml_number(value)}" for it, value in writer.parameters.items()]
    if definitions:
        lines.append("[let]")
        lines += [f"{_quoted(it)} = {_quoted(value)}" for it, value in definitions.items()]
    lines += body
    if start is not None:
        lines.append("[start]")
        lines += [f"{_quoted(it)} = {_value(it, value)}" for it, value in start.items()]
    return System("\n".join(lines) + "\n")

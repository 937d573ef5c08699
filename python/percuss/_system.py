"""Systems: read from files and texts, changed, and run."""

from __future__ import annotations

import difflib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from percuss import _percuss
from percuss._dynamics import Dynamics, name_of, section_of
from percuss._run import Run, Stream, real, whole
from percuss._sweep import Swept, SweptSystem

_MOST_EVENTS = 1_000_000


class System(Dynamics, Swept):
    """A piecewise-affine system: modes with affine equations, and the guards that end them.

    Parameters
    ----------
    source : str or os.PathLike
        The path of a ``*.system.toml``, or its text: a string with a line break is a text.

    Raises
    ------
    FileNotFoundError
        A path at which there is no file.
    ValueError
        A text that is no system, with its line and what is accepted.

    Examples
    --------
    >>> import percuss
    >>> ball = percuss.System('''
    ... schema = 1
    ... name = "ball"
    ... states = ["x", "v"]
    ... [[mode]]
    ... name = "flight"
    ... equations = ["x' = v", "v' = -10"]
    ... [[mode.until]]
    ... name = "impact"
    ... guard = "x < 0"
    ... reset = ["x = 0", "v = -v/2"]
    ... [start]
    ... mode = "flight"
    ... x = 5
    ... v = 0
    ... ''')
    >>> ball.events(count=3).time
    array([0. , 1. , 2. , 2.5])
    """

    def __init__(self, source: str | os.PathLike[str]) -> None:
        if isinstance(source, str) and "\n" in source:
            self._native = _percuss.System.parse("text", source)
            return
        if not isinstance(source, (str, os.PathLike)):
            raise TypeError(f"a {type(source).__name__} is no system: a path or a text is accepted")
        if not os.fspath(source):
            raise ValueError("a system's path is empty: a path or a text is accepted")
        path = Path(source)
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise ValueError(f"{path}: {error.reason}: UTF-8 is accepted") from None
        self._native = _percuss.System.parse(str(path), text)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, self._native.origin

    @classmethod
    def _of(cls, native: _percuss.System) -> System:
        system = System.__new__(System)
        system._native = native
        return system

    def __call__(self, /, **parameters: float) -> System:
        """Make the system with other values of some parameters.

        Raises
        ------
        ValueError
            A name that is no parameter, or a value that the system does not accept.

        Examples
        --------
        >>> import percuss
        >>> percuss.systems["bouncing-ball"](e=0.6).parameters["e"]
        0.6
        """
        values = {name: real(name, value) for name, value in parameters.items()}
        return System._of(self._native.with_parameters(values))

    def at(self, /, mode: str | None = None, t: float | None = None, **states: float) -> System:
        """Make the system with another start.

        Parameters
        ----------
        mode : str, optional
            The mode; may be left out where the system has one alone.
        t : float, optional
            The time, 0 by default.
        **states : float
            The value of every state.

        Raises
        ------
        ValueError
            An unknown mode, and states that are missing or that the system has not.

        Examples
        --------
        >>> import percuss
        >>> high = percuss.systems["bouncing-ball"].at("flight", x=4, v=0)
        >>> high.events(count=1).time
        array([0., 2.])
        """
        if mode is None:
            if len(self.modes) != 1:
                raise ValueError(f"a mode is missing: accepted is one of {', '.join(self.modes)}")
            mode = self.modes[0]
        if not isinstance(mode, str):
            raise TypeError(f"mode = {mode!r} is not accepted: a name is")
        numbers = {name: real(name, value) for name, value in states.items()}
        return self._started(mode, 0.0 if t is None else real("t", t), numbers)

    def _started(self, mode: str, t: float, states: Mapping[str, str | float]) -> System:
        """Make the system with another start, whose states may be expressions of parameters."""
        lines = ["[start]", f"mode = {json.dumps(mode)}", f"t = {toml_number(real('t', t))}"]
        for name, value in states.items():
            text = json.dumps(value) if isinstance(value, str) else toml_number(real(name, value))
            lines.append(f"{json.dumps(name)} = {text}")
        return System._of(self._native.with_start("\n".join(lines)))

    def _of_sweep(self) -> tuple[Mapping[str, Any], SweptSystem | None]:
        return {}, SweptSystem(*self._native.origin)

    @property
    def name(self) -> str:
        """The system's name."""
        return self._native.name

    @property
    def why(self) -> str:
        """The purpose of the system, in a sentence, or nothing."""
        return self._native.why

    @property
    def source(self) -> str:
        """The publication or program that the system is from, or nothing."""
        return self._native.source

    @property
    def trouble(self) -> list[str]:
        """The kinds of trouble that the system makes for integrators."""
        return self._native.trouble

    @property
    def event_names(self) -> list[str]:
        """The names of the events, each once."""
        return self._native.event_names

    @property
    def parameters(self) -> dict[str, float]:
        """The values of the parameters, by name."""
        return self._native.parameters

    @property
    def time_scale(self) -> float:
        """The unit by which times are divided before any comparison."""
        return self._native.time_scale

    @property
    def omega(self) -> float | None:
        """The angular frequency of the forcing, or None."""
        return self._native.omega

    def events(
        self,
        until: float | None = None,
        *,
        count: int | None = None,
        digits: int = 17,
        max_bits: int | None = None,
        max_events: int | None = None,
        backward: bool = False,
    ) -> Run:
        """Run the system with proved events and proved digits.

        Exactly one of `until` and `count` is given.

        Parameters
        ----------
        until : float, optional
            The time at which the run ends.
        count : int, optional
            The number of events after which it ends.
        digits : int, optional
            The significant digits that are wanted, 1 to 300.
        max_bits : int, optional
            The most bits that the run may take, 106 to 3392 (default).
        max_events : int, optional
            The run is stopped after as many events: 1000000 by default where `until` is given.
        backward : bool, optional
            Run back in time.

        Returns
        -------
        Run
            The rows that ``percuss events`` prints.

        Raises
        ------
        TypeError
            None or both of `until` and `count`, and what is no number.
        ValueError
            A number that is not accepted, and a system without a start.

        Examples
        --------
        >>> import percuss
        >>> run = percuss.systems["bouncing-ball"].events(count=1, digits=25)
        >>> print(run.digits.time[1], run.name[1], run.mode[1])
        1.500000000000000000000000 impact flight
        """
        length = self._length(until, count, max_events)
        wanted = whole("digits", digits)
        bits = None if max_bits is None else whole("max_bits", max_bits, most=2**32 - 1)
        until, count, most = length
        asked = until, count, wanted, bits, most, bool(backward)
        return Run(self._native.events(*asked), self, wanted, ("events", *asked))

    def simulate(
        self,
        until: float | None = None,
        *,
        count: int | None = None,
        returns: int | None = None,
        transient: int = 0,
        section: str | None = None,
        every: int = 1,
        max_time: float | None = None,
        max_events: int | None = None,
        backward: bool = False,
    ) -> Run:
        """Run the system in f64, which is quicker and proves no digits.

        Exactly one of `until`, `count` and `returns` is given.

        Parameters
        ----------
        until, count, max_events, backward
            As :meth:`events` takes them.
        returns : int, optional
            The number of returns to the section with which the run ends, the start not counted.
        transient : int, optional
            Returns that are left out: row 0 is the state at the last of them, and `count`,
            `returns` and `max_events` count from there.
        section : str, optional
            The section of these returns, as all :class:`Dynamics` take it; by default the forcing's
            angle at the start, so that a return is a forcing period.
        every, max_time
            As all :class:`Dynamics` take them.

        Returns
        -------
        Run
            The rows that ``percuss simulate SYSTEM`` prints. ``undecidable`` counts the choices
            that rounding leaves open, and ``cause`` is why a run does not return in time.

        Raises
        ------
        TypeError
            None or several of `until`, `count` and `returns`, and what is no number.
        ValueError
            A number or a section that is not accepted, and a system without a start.

        Examples
        --------
        >>> import percuss
        >>> run = percuss.systems["bouncing-ball"].simulate(2.0)
        >>> run.ending, len(run)
        ('end', 3)
        >>> relay = percuss.systems["relay-feedback"]
        >>> relay.simulate(returns=1, transient=50, section="switch-up").name.tolist()
        ['', 'switch-down', 'switch-up']
        """
        left_out = whole("transient", transient)
        wanted = None if returns is None else whole("returns", returns, 1)
        is_measured = wanted is not None or left_out > 0
        is_plain = section is None and type(every) is int and every == 1 and max_time is None
        measured = None
        if is_measured or not is_plain:
            text = None if section is None else name_of("section", section)
            measured = wanted, left_out, section_of(text, every, max_time)
        until, count, most = self._length(until, count, max_events, wanted)
        if not (is_measured or is_plain):
            flags = {"section": section, "every": None if every == 1 else every}
            given = {**flags, "max_time": max_time}
            name = next(name for name, value in given.items() if value is not None)
            accepted = "it is accepted with returns and with transient"
            raise ValueError(f"{name} = {given[name]!r} has no effect here: {accepted}")
        if is_measured and backward:
            name, number = ("returns", wanted) if wanted is not None else ("transient", left_out)
            raise ValueError(f"{name} = {number} is not accepted of a run back in time: until is")
        asked = until, count, most, bool(backward), measured
        return Run(self._native.simulate(*asked), self, 17, ("simulate", *asked))

    def iterate(
        self,
        until: float | None = None,
        *,
        count: int | None = None,
        digits: int = 17,
        max_bits: int | None = None,
        backward: bool = False,
    ) -> Stream:
        """Go through the rows of :meth:`events` one by one, and keep none.

        Without `until` and `count` the run goes on for 1e9 of the system's units of time.

        Examples
        --------
        >>> import percuss
        >>> for event in percuss.systems["bouncing-ball"].iterate(count=2):
        ...     print(event.time, event.name or "start")
        0.0 start
        1.5 impact
        2.25 impact
        """
        until, count, _ = self._length(until, count, None)
        bits = None if max_bits is None else whole("max_bits", max_bits, most=2**32 - 1)
        wanted = whole("digits", digits)
        return Stream(self._native.stream(until, count, wanted, bits, bool(backward)))

    def _length(
        self, until: float | None, count: int | None, most: int | None, returns: int | None = None
    ) -> tuple[float | None, int | None, int | None]:
        """The length of a run, its numbers checked for their types."""
        end = None if until is None else real("until", until)
        number = None if count is None else whole("count", count, 1)
        if most is not None:
            most = whole("max_events", most, 1)
        elif count is None and returns is None:
            most = _MOST_EVENTS
        return end, number, most

    def __repr__(self) -> str:
        parameters = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"<System {self.name}({parameters}): states {', '.join(self.states)}>"


def _restored(text: str, parameters: Mapping[str, float], start: str | None) -> System:
    """The system of a text, with other values of parameters and another start."""
    native = _percuss.System.parse("text", text)
    if start is not None:
        native = native.with_start(start)
    return System._of(native.with_parameters(dict(parameters)))


class Systems(Mapping[str, System]):
    """The systems inside the package, by the names that ``percuss systems`` prints.

    Examples
    --------
    >>> import percuss
    >>> len(percuss.systems)
    14
    >>> percuss.systems["bouncing-ball"].states
    ['x', 'v']
    """

    def __getitem__(self, name: str) -> System:
        native = _percuss.System.named(name) if isinstance(name, str) else None
        if native is None:
            near = difflib.get_close_matches(str(name), list(self), n=3) or list(self)
            raise KeyError(f"{name!r} is no system of percuss: {', '.join(near)}")
        return System._of(native)

    def __iter__(self) -> Iterator[str]:
        return iter(_percuss.system_names())

    def __len__(self) -> int:
        return len(_percuss.system_names())

    def __repr__(self) -> str:
        return f"<systems: {', '.join(self)}>"


systems = Systems()


def toml_number(value: float) -> str:
    """A number as TOML writes it, so that the same f64 is read."""
    return repr(float(value))


def exact(value: float) -> str:
    """A number as an expression, which holds integers alone: a quotient by powers of two."""
    numerator, denominator = value.as_integer_ratio()
    shift = denominator.bit_length() - 1
    # An exponent is at most 64, and an integer at most 2^63: more bits stand in further factors.
    excess = max(numerator.bit_length() - 53, 0)
    powers = [f"*2^{min(64, excess - k)}" for k in range(0, excess, 64)]
    powers += [f"/2^{min(64, shift - k)}" for k in range(0, shift, 64)]
    sign, size = ("-" if numerator < 0 else ""), abs(numerator) >> excess
    return f"{sign}{size}{''.join(powers)}"

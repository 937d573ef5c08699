"""Runs: the start, the events and the ending, as arrays and as proved digits."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percuss import _percuss
from percuss._gradient import Gradient
from percuss._numbers import number_maker
from percuss._xarray import dataset

if TYPE_CHECKING:
    import pandas as pd

    from percuss._system import System

Floats = NDArray[np.float64]
Texts = NDArray[np.str_]


class Digits(NamedTuple):
    """Decimals all of whose digits are proved."""

    time: Texts
    """Times, shape (n,)."""
    state: Texts
    """States, shape (n, d)."""


class Enclosure(NamedTuple):
    """Numbers between which the true ones lie, rounded outward."""

    time: Floats
    """Lower and upper bounds of the times, shape (n, 2)."""
    state: Floats
    """Lower and upper bounds of the states, shape (n, d, 2)."""


def _between(middle: Floats, error: Floats) -> Floats:
    """The two ends of intervals, given by their middles, rounded to f64, and bounds of errors."""
    is_exact = error == 0
    # A middle is rounded to f64, and so is what is taken off it: a unit each.
    low = np.nextafter(np.nextafter(middle, -np.inf) - error, -np.inf)
    high = np.nextafter(np.nextafter(middle, np.inf) + error, np.inf)
    zero = is_exact & (middle == 0)
    return np.stack([np.where(zero, 0.0, low), np.where(zero, 0.0, high)], axis=-1)


class Sol:
    """The motion between the events of a run, as a function of the time.

    It is called as SciPy's dense output is. A time outside the run raises ``ValueError``; at the
    time of an event the state is that just after it.
    """

    def __init__(self, rows: _percuss.Rows) -> None:
        self._rows = rows

    def __call__(self, t: ArrayLike) -> Floats:
        """Compute the state at times of the run.

        Parameters
        ----------
        t : float or array_like, shape (m,)
            Times, in the system's unit.

        Returns
        -------
        ndarray, shape (d,) or (d, m)
            The states.
        """
        if np.iscomplexobj(t):
            raise TypeError("t is not accepted: it is complex, and times are real")
        times = np.asarray(t, dtype=np.float64)
        if times.ndim > 1:
            raise ValueError(f"t of {times.ndim} dimensions is not accepted: 0 or 1 are")
        states = self._rows.at(np.ascontiguousarray(np.atleast_1d(times)))
        return states[0] if times.ndim == 0 else np.ascontiguousarray(states.T)


class Run:
    """A run of a system: its start, each of its events, and its ending.

    Row k is row k of the command ``percuss events``: row 0 is the start, whose name is empty, and
    a run that ends by itself has its ending last.

    Attributes
    ----------
    states : list of str
        The names of the d states.
    ending : str or None
        ``end`` (the time that was asked for), ``accumulation``, ``leaves-domain``, ``no-progress``,
        ``beyond-guard``, ``undecided``, ``stopped`` (by ``max_events``), ``no-digits``, or None
        where the run has the number of events that was asked for.
    """

    def __init__(
        self, rows: _percuss.Rows, system: System, digits: int, made: tuple[Any, ...]
    ) -> None:
        self._rows = rows
        self._system = system._native
        self._digits = digits
        self._made = system, made, digits

    def __reduce__(self) -> tuple[Any, ...]:
        return _made_again, self._made

    @cached_property
    def states(self) -> list[str]:
        """The names of the d states."""
        return self._system.states

    @cached_property
    def ending(self) -> str | None:
        """The name of the ending."""
        return self._rows.ending

    def __len__(self) -> int:
        return len(self._rows)

    @cached_property
    def time(self) -> Floats:
        """The times in the system's unit, shape (n,); the f64 next to the proved ones."""
        return self._rows.times()

    @cached_property
    def state(self) -> Floats:
        """The states just after the events, shape (n, d)."""
        return self._rows.states()

    @cached_property
    def mode(self) -> Texts:
        """The names of the modes that begin or go on, shape (n,)."""
        return np.array(self._system.modes)[self._rows.modes()]

    @cached_property
    def name(self) -> Texts:
        """The names of the events, shape (n,): that of the start is empty."""
        return np.array(self._rows.names(), dtype=np.str_)

    @cached_property
    def digits(self) -> Digits:
        """The decimals that the command prints: all their digits are proved.

        Raises
        ------
        AttributeError
            Of a run in f64, of which no digit is proved.
        """
        found = self._rows.digits(self._digits)
        if found is None:
            raise AttributeError("a run in f64 has no proved digits: one of events() has")
        time, state = found
        shape = (len(self), len(self.states))
        return Digits(np.array(time, dtype=np.str_), np.array(state, dtype=np.str_).reshape(shape))

    def digits_as(self, kind: str) -> Digits:
        """Make numbers of another library of the proved digits; needs that library.

        Parameters
        ----------
        kind : {'mpmath', 'flint', 'decimal'}
            ``mpmath.mpf``, which are rounded to the precision of the longest decimal; ``flint.arb``,
            balls that hold the true numbers; or ``decimal.Decimal``.

        Returns
        -------
        Digits
            Arrays of objects, shapes (n,) and (n, d).

        Raises
        ------
        ValueError
            An unknown kind.
        AttributeError
            Of a run in f64, of which no digit is proved.

        Examples
        --------
        >>> import percuss
        >>> run = percuss.systems["bouncing-ball"].events(count=1, digits=25)
        >>> run.digits_as("decimal").time[1]
        Decimal('1.500000000000000000000000')
        """
        make = number_maker(kind)
        time, state = self.digits

        def made(texts: Texts) -> Any:
            cells = np.empty(texts.shape, dtype=object)
            for place, text in np.ndenumerate(texts):
                cells[place] = make(str(text))
            return cells

        return Digits(made(time), made(state))

    @cached_property
    def enclosure(self) -> Enclosure:
        """Numbers between which the true times and states lie.

        Raises
        ------
        AttributeError
            Of a run in f64, whose errors have no bounds.
        """
        errors = self._rows.errors()
        if errors is None:
            raise AttributeError("a run in f64 has no bounds of its errors: one of events() has")
        # Of the run's own numbers: those of `time` and `state` may have been changed.
        time, state = self._rows.times(), self._rows.states()
        return Enclosure(_between(time, errors[0]), _between(state, errors[1]))

    @property
    def sol(self) -> Sol:
        """The motion between the events, called as SciPy's dense output is."""
        return Sol(self._rows)

    @property
    def is_decided(self) -> bool:
        """Whether the run ends because the model says so or because the time is over."""
        return self._rows.is_decided

    @property
    def cause(self) -> str | None:
        """The cause of an ending that was not decided, or of fewer returns than were asked for."""
        return self._rows.cause

    @property
    def accumulation(self) -> tuple[str, str] | None:
        """The times between which infinitely many impacts accumulate, as decimals."""
        return self._rows.accumulation

    @property
    def bits(self) -> int:
        """The bits of the arithmetic that the run came to."""
        return self._rows.bits

    @property
    def undecidable(self) -> int:
        """The choices that rounding leaves open; 0 of a run with proved digits."""
        return self._rows.undecidable

    def gradient(self, wrt: str | Sequence[str]) -> Gradient:
        """Differentiate the times and states of the run by parameters and by its start.

        The run is made again: in as many bits as its derivatives need for the digits that were
        asked for, or in f64 for a run in f64.

        Parameters
        ----------
        wrt : str or sequence of str
            Parameters of the system, and ``start.STATE`` for states at the start.

        Returns
        -------
        Gradient
            The derivatives that ``percuss gradient`` prints.

        Raises
        ------
        ValueError
            A name that the system has not, one that is there twice, and a run back in time.

        Examples
        --------
        >>> import percuss
        >>> run = percuss.systems["bouncing-ball"].events(count=1)
        >>> gradient = run.gradient(["e", "start.v"])
        >>> print(gradient.digits.time[1])
        ['0' '1.0000000000000000']
        >>> gradient.state[1, 0]
        array([0. , 1.5])
        """
        names = [wrt] if isinstance(wrt, str) else list(wrt)
        if not names or not all(isinstance(name, str) for name in names):
            raise TypeError(f"wrt = {wrt!r} is not accepted: one name or more are")
        if len(set(names)) < len(names):
            raise ValueError(f"wrt = {wrt!r} is not accepted: each name once is")
        return Gradient(self, self._rows.differentiated(names), names, self._digits)

    @property
    def columns(self) -> list[str]:
        """The names of the states' columns in tables: a state named as another column differs."""
        return columns_of(self.states)

    def to_pandas(self) -> pd.DataFrame:
        """Make a table of the run, with the columns of the command; needs pandas."""
        import pandas as pd

        columns: dict[str, Any] = {"time": self.time, "event": self.name, "mode": self.mode}
        columns |= {name: self.state[:, place] for place, name in enumerate(self.columns)}
        return pd.DataFrame(columns).rename_axis("n")

    def to_xarray(self, t: ArrayLike) -> Any:
        """Make a data set of the states at times of the run; needs xarray.

        Parameters
        ----------
        t : array_like, shape (m,)
            Times of the run.
        """
        times = np.atleast_1d(np.asarray(t, dtype=np.float64))
        states = self.sol(times)
        named = {name: (("time",), states[place]) for place, name in enumerate(self.columns)}
        return dataset(named, {"time": times}, ending=self.ending or "")

    def plot(self, ax: Any = None, *, points: int = 1000) -> Any:
        """Draw the states over the time, with a mark at each event; needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            The axes to draw on; new ones by default.
        points : int, optional
            The number of times between start and end.

        Returns
        -------
        matplotlib.axes.Axes
        """
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.figure().add_subplot()
        times = np.union1d(np.linspace(self.time[0], self.time[-1], points), self.time)
        states = self.sol(times)
        for place, name in enumerate(self.states):
            (line,) = ax.plot(times, states[place], label=name, linewidth=1)
            ax.plot(self.time, self.state[:, place], ".", color=line.get_color(), markersize=4)
        ax.set_xlabel("time")
        ax.set_ylabel(", ".join(self.states))
        if len(self.states) > 1:
            ax.legend(loc="upper right", frameon=False)
        return ax

    def __repr__(self) -> str:
        ending = "" if self.ending is None else f", ending {self.ending!r}"
        return f"Run({len(self)} rows from {self.time[0]:.6g} to {self.time[-1]:.6g}{ending})"


class Stream:
    """The rows of a run one by one, none of which is kept.

    Each has ``time``, ``state``, ``mode``, ``name`` and ``digits`` (the time's, then those of the
    states). ``ending`` and ``cause`` are known once the run is over.
    """

    def __init__(self, rows: _percuss.Stream) -> None:
        self._rows = rows

    def __iter__(self) -> Stream:
        return self

    def __next__(self) -> _percuss.Row:
        return next(self._rows)

    @property
    def ending(self) -> str | None:
        """The ending, as that of a :class:`Run`."""
        return self._rows.ending

    @property
    def cause(self) -> str | None:
        """The cause of an ending that was not decided."""
        return self._rows.cause


def _made_again(system: System, made: tuple[Any, ...], digits: int) -> Run:
    """Make a run that was pickled again: the same call gives the same numbers."""
    verb, *arguments = made
    return Run(getattr(system._native, verb)(*arguments), system, digits, made)


def columns_of(states: Iterable[str], *others: str) -> list[str]:
    """The columns of states: one that is named as another column has a longer name."""
    taken = {"n", "time", "mode", "event", *others}
    return [f"state.{name}" if name in taken else name for name in states]


def whole(name: str, number: Any, least: int = 0, most: int = sys.maxsize) -> int:
    """A number as an integer of a range.

    Raises
    ------
    TypeError
        What is no integer.
    ValueError
        An integer outside the range.
    """
    if isinstance(number, bool) or not hasattr(number, "__index__"):
        raise TypeError(f"{name} = {number!r} is not accepted: an integer is")
    integer: int = number.__index__()
    if not least <= integer <= most:
        raise ValueError(f"{name} = {integer} is not accepted: {least} to {most} is")
    return integer


def real(name: str, number: Any) -> float:
    """A number as an f64.

    Raises
    ------
    TypeError
        What is no number.
    """
    if isinstance(number, (str, bytes)):
        raise TypeError(f"{name} = {number!r} is not accepted: a number is")
    try:
        return float(number)
    except TypeError:
        raise TypeError(f"{name} = {number!r} is not accepted: a number is") from None
    except OverflowError:
        raise ValueError(f"{name} is not accepted: it is too large for an f64") from None


def pair(name: str, ends: Any) -> tuple[float, float]:
    """The two ends of a range."""
    try:
        low, high = ends
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {ends!r} is not accepted: two numbers are") from None
    return real(name, low), real(name, high)

"""The dynamics of any system, from its returns to a section."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percuss import _percuss
from percuss._progress import Progress, telling
from percuss._returns import (
    Branch,
    ReturnAttractor,
    ReturnBasins,
    ReturnDiagram,
    ReturnExponents,
    ReturnOrbit,
    Returns,
)
from percuss._run import pair, real, whole

_MOST = 2**32 - 1


def name_of(what: str, name: Any) -> str:
    """A name.

    Raises
    ------
    TypeError
        What is no string.
    """
    if not isinstance(name, str):
        raise TypeError(f"{what} = {name!r} is not accepted: a name is")
    return name


def steps_of(values: Sequence[float] | NDArray[np.float64]) -> tuple[float, float, int]:
    """The ends and the number of values in equal steps.

    Raises
    ------
    ValueError
        Values that are not in equal steps, and none.
    """
    grid = np.asarray(values, dtype=np.float64)
    if grid.ndim != 1 or len(grid) == 0:
        raise ValueError("values are accepted as a list of one number or more")
    if not np.isfinite(grid).all():
        raise ValueError(f"values are accepted as finite numbers: {values!r} are not")
    steps = np.linspace(grid[0], grid[-1], len(grid))
    if not np.allclose(grid, steps, rtol=1e-9, atol=1e-9 * abs(grid[-1] - grid[0])):
        raise ValueError("values are accepted in equal steps, as of numpy.linspace")
    return float(grid[0]), float(grid[-1]), len(grid)


def cells_of(grid: int | tuple[int, int]) -> tuple[int, int]:
    """The cells of a grid across and up."""
    try:
        columns, rows = grid if isinstance(grid, Iterable) else (grid, grid)
    except (TypeError, ValueError):
        raise ValueError(f"grid = {grid!r} is not accepted: one or two integers are") from None
    return whole("grid", columns, 1, _MOST), whole("grid", rows, 1, _MOST)


class Dynamics:
    """The methods of a system that look at the returns of its motions to a section.

    All of them take these parameters:

    section : str, optional
        ``strobe`` or ``strobe:ANGLE`` (a forcing angle in radians, such as ``strobe:pi/2``), or
        ``EVENT`` or ``EVENT@MODE``, just after it.
    every : int, optional
        Takes every so many of the returns alone.
    max_time : float, optional
        The longest time to wait for a return: 1000 of the system's units by default.
    progress : bool or callable, optional
        True for a bar of tqdm, or a function of the parts that are done and of all.
    """

    _native: _percuss.System

    @property
    def states(self) -> list[str]:
        """The names of the states."""
        return self._native.states

    @property
    def modes(self) -> list[str]:
        """The names of the modes."""
        return self._native.modes

    def poincare(
        self,
        *,
        returns: int,
        transient: int = 0,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
        progress: Progress = None,
    ) -> Returns:
        """Compute the returns to a section, as ``percuss poincare SYSTEM`` does.

        Parameters
        ----------
        returns : int
            The number of returns.
        transient : int, optional
            Returns that are left out before.
        section, every, max_time, progress
            As all :class:`Dynamics` take them.

        Raises
        ------
        ValueError
            A section that the system has not, and a number that is not accepted.

        Examples
        --------
        >>> import percuss
        >>> ball = percuss.systems["bouncing-ball"]
        >>> ball.poincare(returns=3, section="impact").state[:, 1]
        array([0.75  , 0.375 , 0.1875])
        """
        cut = _section(section, every, max_time)
        counts = whole("transient", transient), whole("returns", returns)
        with telling(progress, "returns") as told:
            found = _percuss.system_poincare(self._native, cut, *counts, told)
        return Returns(found, self.modes, self.states)

    def lyapunov(
        self,
        *,
        returns: int,
        transient: int = 0,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
        progress: Progress = None,
    ) -> ReturnExponents:
        """Compute the Lyapunov exponents of the motion, as ``percuss lyapunov SYSTEM`` does.

        Parameters
        ----------
        returns : int
            The returns over which they are taken.
        transient : int, optional
            Returns that are left out before.
        section, every, max_time, progress
            As all :class:`Dynamics` take them.

        Raises
        ------
        ValueError
            A motion that does not return as often, and what :meth:`poincare` does not accept.
        """
        cut = _section(section, every, max_time)
        counts = whole("transient", transient), whole("returns", returns)
        with telling(progress, "returns") as told:
            return ReturnExponents(_percuss.system_lyapunov(self._native, cut, *counts, told))

    def orbit(
        self,
        period: int,
        *,
        transient: int = 0,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
    ) -> ReturnOrbit:
        """Find the periodic orbit to which the motion leads, as ``percuss orbit SYSTEM`` does.

        Parameters
        ----------
        period : int
            The returns after which it closes.
        transient : int, optional
            Returns after which the motion from the start is the guess of Newton's method.
        section, every, max_time
            As all :class:`Dynamics` take them.

        Raises
        ------
        ValueError
            Where no orbit is reached, with the reason.
        """
        cut = _section(section, every, max_time)
        before, number = whole("transient", transient), whole("period", period, 0, _MOST)
        found = _percuss.system_orbit(self._native, cut, before, number)
        return ReturnOrbit(found, self.modes, self.states)

    def orbits(
        self,
        period: int,
        across: tuple[float, float],
        up: tuple[float, float],
        *,
        grid: int | tuple[int, int],
        axes: tuple[str, str] | None = None,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
        progress: Progress = None,
    ) -> list[ReturnOrbit]:
        """Find the orbits that are reached from a grid of starts, the stable ones first.

        ``percuss orbit SYSTEM --all`` prints the same orbits; none where none was found.

        Parameters
        ----------
        period : int
            The returns after which they close, or after a divisor of them.
        across, up, grid, axes
            The starts, as :meth:`basins` takes them.
        section, every, max_time, progress
            As all :class:`Dynamics` take them.
        """
        cut = _section(section, every, max_time)
        _, places = self._axes(axes)
        with telling(progress, "starts") as told:
            found = _percuss.system_orbits(
                self._native,
                cut,
                places,
                (pair("across", across), pair("up", up)),
                cells_of(grid),
                whole("period", period, 0, _MOST),
                told,
            )
        return [ReturnOrbit(it, self.modes, self.states) for it in found]

    def continue_(
        self,
        parameter: str,
        from_: float,
        to: float,
        *,
        period: int,
        transient: int = 0,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
        progress: Progress = None,
    ) -> Branch:
        """Follow a periodic orbit, stable or not, as ``percuss continue SYSTEM`` does.

        Parameters
        ----------
        parameter : str
            The parameter that varies.
        from_, to : float
            Its first and its last value.
        period : int
            The returns after which the orbit closes.
        transient : int, optional
            Returns after which the motion from the start, at the first value, is the guess.
        section, every, max_time, progress
            As all :class:`Dynamics` take them.

        Raises
        ------
        ValueError
            Where there is no orbit to begin with, and a value that the system does not accept.
        """
        cut = _section(section, every, max_time)
        ends = real("from_", from_), real("to", to)
        counts = whole("transient", transient), whole("period", period, 0, _MOST)
        name = name_of("parameter", parameter)
        with telling(progress, "permille") as told:
            found = _percuss.system_follow(self._native, cut, name, ends, *counts, told)
        return Branch(parameter, found, self.states)

    def bifurcation(
        self,
        parameter: str,
        values: Sequence[float] | NDArray[np.float64],
        *,
        returns: int = 1,
        transient: int = 0,
        reset: bool = False,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
        progress: Progress = None,
    ) -> ReturnDiagram:
        """Make a diagram over equal steps of a parameter, as ``percuss bifurcation SYSTEM`` does.

        Parameters
        ----------
        parameter : str
            The parameter that varies.
        values : array_like, shape (n,)
            Its values in equal steps, as of ``numpy.linspace``.
        returns, transient : int, optional
            Returns at each value, and those that are left out before.
        reset : bool, optional
            Begin at each value from the start, not from the last state of the value before.
        section, every, max_time, progress
            As all :class:`Dynamics` take them.
        """
        cut = _section(section, every, max_time)
        first, last, count = steps_of(values)
        with telling(progress, "values") as told:
            found = _percuss.system_bifurcation(
                self._native,
                cut,
                name_of("parameter", parameter),
                (first, last),
                count,
                whole("transient", transient),
                whole("returns", returns, 0, _MOST),
                bool(reset),
                told,
            )
        return ReturnDiagram(parameter, found, self.modes, self.states)

    def basins(
        self,
        across: tuple[float, float],
        up: tuple[float, float],
        *,
        grid: int | tuple[int, int],
        transient: int,
        axes: tuple[str, str] | None = None,
        max_period: int = 1024,
        section: str = "strobe",
        every: int = 1,
        max_time: float | None = None,
        progress: Progress = None,
    ) -> ReturnBasins:
        """Find which start of a grid reaches which attractor, as ``percuss basins SYSTEM`` does.

        Parameters
        ----------
        across, up : (float, float)
            The rectangle of starts in two states; each is the centre of a cell.
        grid : int or (int, int)
            Cells across and up.
        transient : int
            Returns that a start is followed before it is examined.
        axes : (str, str), optional
            The two states: the system's first two by default. The others are those of the start.
        max_period : int, optional
            The longest period of an orbit that is looked for.
        section, every, max_time, progress
            As all :class:`Dynamics` take them.
        """
        cut = _section(section, every, max_time)
        names, places = self._axes(axes)
        with telling(progress, "starts") as told:
            found = _percuss.system_basins(
                self._native,
                cut,
                places,
                (pair("across", across), pair("up", up)),
                cells_of(grid),
                whole("transient", transient),
                whole("max_period", max_period, 1, _MOST),
                told,
            )
        return ReturnBasins(names, found, self.modes, self.states)

    def attractors(
        self, across: tuple[float, float], up: tuple[float, float], **options: Any
    ) -> list[ReturnAttractor]:
        """List the attractors of :meth:`basins`, whose parameters these are."""
        return self.basins(across, up, **options).attractors

    def _axes(self, axes: tuple[str, str] | None) -> tuple[tuple[str, str], tuple[int, int]]:
        """The names and the places of the two states of a grid."""
        states = self.states
        if axes is None and len(states) < 2:
            raise ValueError(f"a grid of two states is none of a system with {states[0]} alone")
        names = tuple(states[:2] if axes is None else axes)
        if len(names) != 2 or names[0] == names[1] or not set(names) <= set(states):
            accepted = f"two of {', '.join(states)} are"
            raise ValueError(f"axes = {axes!r} is not accepted: {accepted}")
        return (names[0], names[1]), (states.index(names[0]), states.index(names[1]))


def _section(section: str, every: int, max_time: float | None) -> _percuss.Section:
    return section_of(name_of("section", section), every, max_time)


def section_of(text: str | None, every: int, max_time: float | None) -> _percuss.Section:
    """Make a section of what it is written as, or that of the start's forcing angle."""
    longest = None if max_time is None else real("max_time", max_time)
    return _percuss.Section(text, whole("every", every, 1, 1_000_000_000), longest)

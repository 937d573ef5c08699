"""The visco-elastic impact oscillator with drift, which has a solver of its own."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percuss import _percuss
from percuss._dynamics import cells_of, name_of, steps_of
from percuss._progress import Progress, telling
from percuss._results import Attractor, Basins, Bifurcation, Lyapunov, Orbit, Section
from percuss._returns import Branch
from percuss._run import Floats, Run, Stream, Texts, pair, real, whole
from percuss._sweep import Swept, SweptSystem
from percuss._system import System, exact, systems

_STATES = ("p", "y", "q", "v")
_PARAMETERS = {"a": "a", "b": "b", "xi": "xi", "omega": "frequency", "g": "g", "phi": "phase"}


class Simulation:
    """A run of the oscillator in f64, as ``percuss simulate`` prints it.

    Attributes
    ----------
    time : ndarray, shape (n,)
        The times at which the phases begin; of a run with an end that of the end last.
    state : ndarray, shape (n, 4)
        p, y, q and v there.
    phase : ndarray of str, shape (n,)
        The phases that begin: ``no-contact``, ``contact``, ``progression``; ``end`` in the row of
        the end, ``undecidable`` in that from which on rounding leaves the run open.
    undecidable : int
        The touches that rounding does not decide, counted as no events.
    endless : str or None
        Why the last phase never ends, where that is proved.
    """

    def __init__(self, found: _percuss.Simulated) -> None:
        self.states = list(_STATES)
        self.time: Floats = found["times"]
        self.state: Floats = found["states"]
        self.phase: Texts = np.array(found["phases"], dtype=np.str_)
        self.undecidable = found["undecidable"]
        self.endless = found["endless"]

    def __len__(self) -> int:
        return len(self.time)

    def to_pandas(self) -> Any:
        """Make a table of the run, with the columns of the command; needs pandas."""
        import pandas as pd

        columns: dict[str, Any] = {"phase": self.phase, "tau": self.time}
        columns |= {name: self.state[:, place] for place, name in enumerate(_STATES)}
        return pd.DataFrame(columns).rename_axis("index")

    def __repr__(self) -> str:
        return f"Simulation({len(self)} rows from {self.time[0]:.6g} to {self.time[-1]:.6g})"


class Oscillator(Swept):
    """The impact oscillator of Pavlovskaia and Wiercigroch (2004), at a start.

    Parameters
    ----------
    a, b : float, optional
        Amplitude of the harmonic force, and static force.
    xi : float, optional
        Damping ratio of the slider, 1e-8 to 1e4.
    omega, phi : float, optional
        Frequency of the harmonic force, 1e-6 to 1e6, and its phase, radians.
    g : float, optional
        Gap.
    tau : float, optional
        Time of the start, and `cycle` forcing periods more.
    p, y, q, v : float, optional
        Displacement and velocity of the mass, displacement of the slider's top, and drift. `q` is
        by default p - g where p >= g, and else 0.
    phase : str, optional
        The phase of the start, for states copied from rounded tables.

    Raises
    ------
    ValueError
        A number outside its range, with what is accepted.

    Examples
    --------
    >>> import percuss
    >>> run = percuss.Oscillator(a=0.3, b=0.1).simulate(count=2)
    >>> [str(phase) for phase in run.phase]
    ['no-contact', 'contact', 'no-contact']
    """

    def __init__(
        self,
        *,
        a: float = 0.3,
        b: float = 0.1,
        xi: float = 0.01,
        omega: float = 1.4,
        g: float = 0.02,
        phi: float = math.pi / 2,
        tau: float = 0.0,
        cycle: int = 0,
        p: float = 0.0,
        y: float = 0.0,
        q: float | None = None,
        v: float = 0.0,
        phase: str | None = None,
    ) -> None:
        numbers = {"a": a, "b": b, "xi": xi, "omega": omega, "g": g, "phi": phi}
        self.parameters = {name: real(name, value) for name, value in numbers.items()}
        if phase is not None and not isinstance(phase, str):
            raise TypeError(f"phase = {phase!r} is not accepted: a name is")
        # Given starts are known from those that are not: an orbit is looked for from one.
        self._has_guess = not (p == 0 and y == 0 and q is None and phase is None)
        self._start = (
            real("tau", tau),
            whole("cycle", cycle, -(2**53), 2**53),
            real("p", p),
            real("y", y),
            None if q is None else real("q", q),
            real("v", v),
            phase,
        )
        self._native = self._made(self.parameters)

    def _made(self, parameters: dict[str, float]) -> _percuss.Oscillator:
        """The oscillator with these parameters, at this start."""
        return _percuss.Oscillator(list(parameters.values()), *self._start)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_native"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._native = self._made(self.parameters)

    def _at(self, parameter: str, value: float) -> _percuss.Oscillator:
        """The oscillator with another value of a parameter, at the same start."""
        if parameter not in self.parameters:
            accepted = ", ".join(self.parameters)
            raise ValueError(f"parameter = {parameter!r} is not accepted: one of {accepted} is")
        return self._made(self.parameters | {parameter: value})

    @property
    def period(self) -> float:
        """The forcing period, 2 pi/omega."""
        return self._native.period

    @property
    def states(self) -> list[str]:
        """The names of the states."""
        return list(_STATES)

    @property
    def system(self) -> System:
        """The oscillator written down as any other system is, at this start."""
        values = {_PARAMETERS[name]: value for name, value in self.parameters.items()}
        mode, time, (p, y, q, v) = self._native.started
        system = systems["percussive-oscillator"](**values)
        touches = mode != "no-contact" or abs(p - (q + self.parameters["g"])) <= 4 * math.ulp(p)
        start: dict[str, Any] = {"p": p, "y": y, "q": q, "v": v}
        if touches:
            # On the slider p is q + g, not the f64 next to it.
            start["p"] = f"{exact(q)} + g"
        return system._started(mode, time, start)

    def events(self, until: float | None = None, **options: Any) -> Run:
        """Run with proved events and proved digits, as :meth:`System.events` does.

        Examples
        --------
        >>> import percuss
        >>> run = percuss.Oscillator().events(count=1)
        >>> print(run.digits.time[1], run.name[1])
        4.4310249414332583 impact
        """
        return self.system.events(until, **options)

    def iterate(self, until: float | None = None, **options: Any) -> Stream:
        """Go through the rows of :meth:`events` one by one, and keep none."""
        return self.system.iterate(until, **options)

    def simulate(
        self,
        until: float | None = None,
        *,
        count: int | None = None,
        periods: int | None = None,
        max_periods: int | None = None,
    ) -> Simulation:
        """Run in f64 by the solver that is built in, as ``percuss simulate`` does.

        Exactly one of `until`, `count` (events) and `periods` (forcing periods) is given; a run
        with `count` stops after `max_periods`, 1000000 by default.
        """
        found = self._native.simulate(
            None if until is None else real("until", until),
            None if count is None else whole("count", count),
            None if periods is None else whole("periods", periods),
            None if max_periods is None else whole("max_periods", max_periods, 1),
        )
        return Simulation(found)

    def poincare(
        self,
        *,
        periods: int,
        transient: int = 0,
        section: float = 0.0,
        progress: Progress = None,
    ) -> Section:
        """Compute the state once a forcing period, as ``percuss poincare`` does.

        Parameters
        ----------
        periods : int
            The number of points.
        transient : int, optional
            Forcing periods that are left out.
        section : float, optional
            The forcing angle omega tau of the section, radians.
        progress : bool or callable, optional
            True for a bar of tqdm, or a function of the parts that are done and of all.
        """
        counts = whole("transient", transient), whole("periods", periods)
        with telling(progress, "periods") as told:
            return Section(_percuss.poincare(self._native, *counts, real("section", section), told))

    def lyapunov(self, *, periods: int, transient: int = 0, progress: Progress = None) -> Lyapunov:
        """Compute the Lyapunov exponents and the drift, as ``percuss lyapunov`` does.

        Parameters
        ----------
        periods : int
            The forcing periods over which they are taken.
        transient : int, optional
            Forcing periods that are left out before.
        progress : bool or callable, optional
            True for a bar of tqdm, or a function of the parts that are done and of all.
        """
        counts = whole("transient", transient), whole("periods", periods)
        with telling(progress, "periods") as told:
            return Lyapunov(_percuss.lyapunov(self._native, *counts, told))

    def orbits(self, period: int, *, progress: Progress = None) -> list[Orbit]:
        """Find the periodic orbits of a period by a scan of starts, the stable ones first.

        `period` is a number of forcing periods; ``percuss orbit --all`` prints the same orbits.
        """
        with telling(progress, "permille") as told:
            found = _percuss.orbits(self._native, whole("period", period), False, told)
        return [Orbit(it) for it in found]

    def orbit(self, period: int, *, progress: Progress = None) -> Orbit:
        """Find one periodic orbit: from this start, if p, y or q was given, or else by a scan.

        Raises
        ------
        ValueError
            Where no orbit of the period is found.
        """
        number = whole("period", period)
        with telling(progress, "permille") as told:
            found = _percuss.orbits(self._native, number, self._has_guess, told)
        if not found:
            raise ValueError(f"no orbit of period {number} was found by a scan of starts")
        return Orbit(found[0])

    def continue_(
        self,
        parameter: str,
        from_: float,
        to: float,
        *,
        period: int,
        progress: Progress = None,
    ) -> Branch:
        """Follow a periodic orbit, stable or not, as ``percuss continue`` does.

        It begins with the orbit of this start, if p, y or q was given, or else of a scan.

        Parameters
        ----------
        parameter : {'a', 'b', 'xi', 'omega', 'g', 'phi'}
            What varies.
        from_, to : float
            Its first and its last value.
        period : int
            The forcing periods after which the orbit closes.
        progress : bool or callable, optional
            True for a bar of tqdm, or a function of the parts that are done and of all.

        Raises
        ------
        ValueError
            Where there is no orbit to begin with, and a value that the model does not accept.
        """
        name = name_of("parameter", parameter)
        ends = real("from_", from_), real("to", to)
        at_first = self._at(name, ends[0])
        with telling(progress, "permille") as told:
            found = _percuss.follow(
                at_first, name, ends, whole("period", period, 0, 2**32 - 1), self._has_guess, told
            )
        return Branch(parameter, found, list(_STATES[:3]))

    def bifurcation(
        self,
        parameter: str,
        values: Sequence[float] | NDArray[np.float64],
        *,
        periods: int,
        transient: int,
        reset: bool = False,
        progress: Progress = None,
    ) -> Bifurcation:
        """Make a diagram over equal steps of a parameter, as ``percuss bifurcation`` does.

        Parameters
        ----------
        parameter : {'a', 'b', 'xi', 'omega', 'g', 'phi'}
            What varies.
        values : array_like, shape (n,)
            Its values in equal steps, as of ``numpy.linspace``.
        periods, transient : int
            Points at each value, and forcing periods that are left out before.
        reset : bool, optional
            Begin at each value from this start, not from the last state of the value before.
        progress : bool or callable, optional
            True for a bar of tqdm, or a function of the parts that are done and of all.
        """
        steps = steps_of(values)
        with telling(progress, "values") as told:
            found = _percuss.bifurcation(
                self._native,
                name_of("parameter", parameter),
                *steps,
                whole("transient", transient),
                whole("periods", periods, 1, 2**32 - 1),
                bool(reset),
                told,
            )
        return Bifurcation(parameter, found)

    def _of_sweep(self) -> tuple[Mapping[str, Any], SweptSystem | None]:
        _, _, p, y, q, v, phase = self._start
        tau, cycle = self._start[:2]
        start = {"tau": tau, "cycle": cycle, "p": p, "y": y, "q": q, "v": v, "phase": phase}
        given = {name: value for name, value in start.items() if value not in (None, 0.0)}
        return self.parameters | given, None

    def basins(
        self,
        p: tuple[float, float],
        y: tuple[float, float],
        *,
        grid: int | tuple[int, int],
        transient: int,
        max_period: int = 1024,
        progress: Progress = None,
    ) -> Basins:
        """Find which start of a grid reaches which attractor, as ``percuss basins`` does.

        Parameters
        ----------
        p, y : (float, float)
            The rectangle of starts; each is the centre of a cell.
        grid : int or (int, int)
            Cells along p and along y.
        transient : int
            Forcing periods that a start is followed before it is examined.
        max_period : int, optional
            The longest period of an orbit that is looked for.
        progress : bool or callable, optional
            True for a bar of tqdm, or a function of the parts that are done and of all.
        """
        with telling(progress, "starts") as told:
            found = _percuss.basins(
                self._native,
                (pair("p", p), pair("y", y)),
                cells_of(grid),
                whole("transient", transient),
                whole("max_period", max_period, 1, 2**32 - 1),
                told,
            )
        return Basins(found)

    def attractors(
        self, p: tuple[float, float], y: tuple[float, float], **options: Any
    ) -> list[Attractor]:
        """List the attractors of :meth:`basins`, whose parameters these are."""
        return self.basins(p, y, **options).attractors

    def __repr__(self) -> str:
        parameters = ", ".join(f"{name}={value:g}" for name, value in self.parameters.items())
        return f"Oscillator({parameters})"

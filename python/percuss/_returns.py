"""What the dynamics of a system are told as: returns to a section, as arrays and pictures."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percuss import _percuss
from percuss._pictures import axes_or_new, cells, cloud, curve, named
from percuss._run import Floats, Texts, columns_of
from percuss._xarray import dataset


def _complex(pairs: list[tuple[float, float]]) -> NDArray[np.complex128]:
    return np.array([complex(re, im) for re, im in pairs], dtype=np.complex128)


class _Points:
    """Returns to a section: their times, modes and states."""

    def __init__(self, found: _percuss.Points, modes: list[str], states: list[str]) -> None:
        self.time: Floats = found["time"]
        self.state: Floats = found["state"]
        self.states = states
        self._modes = modes
        self._places = found["mode"]

    @cached_property
    def mode(self) -> Texts:
        """The names of the modes."""
        return np.array(self._modes)[self._places]


class Returns(_Points):
    """The returns of a motion to a section.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Their times, in the system's unit.
    state : ndarray, shape (n, d)
        The states there, just after the event of the section.
    mode : ndarray of str, shape (n,)
        The modes.
    states : list of str
        The names of the d states.
    cause : str or None
        The reason for which there are fewer returns than were asked for.
    undecidable : int
        The ties and touches of which rounding leaves one side to be taken.
    """

    def __init__(self, found: _percuss.Returned, modes: list[str], states: list[str]) -> None:
        super().__init__(found["points"], modes, states)
        self.cause = found["cause"]
        self.undecidable = found["undecidable"]

    def __len__(self) -> int:
        return len(self.time)

    def to_pandas(self) -> Any:
        """Make a table with the columns of the command; needs pandas."""
        import pandas as pd

        columns: dict[str, Any] = {"time": self.time, "mode": self.mode}
        names = columns_of(self.states)
        columns |= {name: self.state[:, place] for place, name in enumerate(names)}
        return pd.DataFrame(columns).rename_axis("n")

    def to_xarray(self) -> Any:
        """Make a data set of the states over the times of the returns; needs xarray."""
        names = columns_of(self.states)
        columns: dict[str, tuple[tuple[str, ...], Any]] = {
            name: (("time",), self.state[:, place]) for place, name in enumerate(names)
        }
        return dataset(columns | {"mode": (("time",), self.mode)}, {"time": self.time})

    def plot(self, ax: Any = None) -> Any:
        """Draw the second state over the first; needs matplotlib. Returns the axes.

        Of a system with one state the returns are drawn one by one.
        """
        ax = axes_or_new(ax)
        if len(self.states) == 1:
            cloud(ax, np.arange(len(self), dtype=np.float64), self.state[:, 0])
            return named(ax, "return", self.states[0])
        cloud(ax, self.state[:, 0], self.state[:, 1])
        return named(ax, self.states[0], self.states[1])

    def __repr__(self) -> str:
        cause = "" if self.cause is None else f", then {self.cause}"
        return f"Returns({len(self)} returns{cause})"


class ReturnExponents:
    """The Lyapunov exponents of a motion, and its drifts.

    Attributes
    ----------
    exponents, standard_error : ndarray, shape (d,)
        Per return, the largest first, with their standard errors.
    per_time : ndarray, shape (d,)
        Per unit of time; one of a system without forcing is that along the flow, 0.
    mean_return_time : float
        The mean time of a return.
    batches : int
        The batches of which the standard errors are.
    stationary : bool or None
        Whether the means of batches scatter about one value; None where too few tell.
    drift, drift_standard_error : dict of str to float
        The mean drift per return by the name of its state.
    undecidable : int
        The ties and touches of which rounding leaves one side to be taken.
    """

    def __init__(self, found: _percuss.ReturnExponents) -> None:
        self.exponents = np.array(found["exponents_per_return"])
        self.standard_error = np.array(found["standard_error"])
        self.per_time = np.array(found["exponents_per_time"])
        self.mean_return_time = found["mean_return_time"]
        self.batches = found["batches"]
        self.stationary = found["stationary"]
        self.drift = found["drift_per_return"]
        self.drift_standard_error = found["drift_standard_error"]
        self.undecidable = found["undecidable"]

    def __repr__(self) -> str:
        pairs = zip(self.exponents, self.standard_error, strict=True)
        shown = ", ".join(f"{value:.4g} +- {error:.1g}" for value, error in pairs)
        return f"ReturnExponents({shown} per return)"


class ReturnOrbit:
    """A periodic orbit of a section's return map.

    Attributes
    ----------
    points : ndarray, shape (period, d)
        The states at the returns.
    mode : ndarray of str, shape (period,)
        The modes there.
    time : float
        The time of the whole orbit.
    events : list of str
        Its events, as ``EVENT@MODE``, in order.
    multipliers : ndarray of complex
        The multipliers of the whole orbit.
    stable : bool
        Whether all multipliers lie inside the unit circle.
    drift : dict of str to float
        The drift per return by the name of its state.
    residual : float
        How far the orbit is from closed.
    is_decided : bool
        Whether the order of its events is known: else the multipliers are those of one side.
    """

    def __init__(self, found: _percuss.ReturnOrbit, modes: list[str], states: list[str]) -> None:
        points = _Points(found["points"], modes, states)
        self.points = points.state
        self.mode = points.mode
        self.time = found["time"]
        self.events = found["events"]
        self.multipliers = _complex(found["multipliers"])
        self.stable = found["stable"]
        self.drift = found["drift_per_return"]
        self.residual = found["residual"]
        self.is_decided = found["is_decided"]

    @property
    def period(self) -> int:
        """The number of returns after which the orbit closes."""
        return len(self.points)

    def __repr__(self) -> str:
        return f"ReturnOrbit(period {self.period}, {'stable' if self.stable else 'unstable'})"


class ReturnDiagram:
    """The returns at each value of a parameter.

    Attributes
    ----------
    parameter : str
        What varies.
    values : ndarray, shape (n,)
        Its values.
    points : ndarray, shape (m, d)
        The states at all returns.
    mode : ndarray of str, shape (m,)
        The modes there.
    steps : ndarray of int, shape (m,)
        The index of its value for each return.
    left_out : list of str, length n
        The reasons for which values have no returns: empty where they have.
    undecidable : ndarray of int, shape (n,)
        The ties and touches of which rounding leaves one side to be taken.
    states : list of str
        The names of the d states.
    """

    def __init__(
        self, parameter: str, found: _percuss.ReturnsDiagrammed, modes: list[str], states: list[str]
    ) -> None:
        points = _Points(found["points"], modes, states)
        self.parameter = parameter
        self.values = found["values"]
        self.points = points.state
        self.mode = points.mode
        self.steps = found["steps"]
        self.left_out = found["left_out"]
        self.undecidable = found["undecidable"]
        self.states = states

    def to_xarray(self) -> Any:
        """Make a data set of the returns, each with its value of the parameter; needs xarray."""
        return points_over(self.parameter, self.values[self.steps], self.points, self.states)

    def plot(self, ax: Any = None) -> Any:
        """Draw the first state over the parameter; needs matplotlib. Returns the axes."""
        ax = axes_or_new(ax)
        cloud(ax, self.values[self.steps], self.points[:, 0])
        return named(ax, self.parameter, self.states[0])

    def __repr__(self) -> str:
        ends = f"{self.values[0]:g} to {self.values[-1]:g}"
        return f"ReturnDiagram({self.parameter} from {ends}, {len(self.points)} points)"


def points_over(parameter: str, values: Floats, points: Floats, states: list[str]) -> Any:
    """Make a data set of the points of a diagram, along one dimension."""
    names = columns_of(states, "point", parameter)
    columns = {name: (("point",), points[:, place]) for place, name in enumerate(names)}
    return dataset(columns, {parameter: ("point", values)})


class ReturnAttractor:
    """An attractor, and the share of starts that reach it.

    Attributes
    ----------
    kind : str
        ``periodic``, ``chaotic``, ``quasi-periodic`` or ``equilibrium``.
    period : int or None
        The period of an orbit, in returns.
    fraction, fraction_error : float
        The share of starts that reach it, with its standard error.
    points : ndarray, shape (n, d)
        The states at successive returns.
    mode : ndarray of str, shape (n,)
        The modes there.
    multipliers : ndarray of complex
        Those of an orbit; none of what is no orbit.
    lyapunov, lyapunov_error : float
        The largest exponent per return; NaN of what rests.
    drift, drift_standard_error : dict of str to float
        The mean drift per return by the name of its state.
    """

    def __init__(self, found: _percuss.Reached, modes: list[str], states: list[str]) -> None:
        points = _Points(found["points"], modes, states)
        self.kind = found["kind"]
        self.period = found["period"]
        self.fraction = found["fraction"]
        self.fraction_error = found["fraction_error"]
        self.points = points.state
        self.mode = points.mode
        self.multipliers = _complex(found["multipliers"])
        self.lyapunov = found["lyapunov_per_return"]
        self.lyapunov_error = found["lyapunov_error"]
        self.drift = found["drift_per_return"]
        self.drift_standard_error = found["drift_standard_error"]

    def __repr__(self) -> str:
        return f"ReturnAttractor({described(self.kind, self.period)}, {self.fraction:.1%})"


def described(kind: str, period: int | None) -> str:
    """An attractor in a word or two."""
    return kind if period is None else f"period {period}"


class ReturnBasins:
    """The attractor that each start of a grid in two states reaches.

    Attributes
    ----------
    axes : (str, str)
        The names of the two states, across and up.
    across, up : ndarray, shapes (nx,) and (ny,)
        The centres of the cells.
    labels : ndarray of int, shape (ny, nx)
        The index of the attractor, -1 of what is not known, -2 of what escapes, -3 of what is no
        start because a guard is positive there, -4 of what ends.
    attractors : list of ReturnAttractor
        The attractors that starts reach, orbits first.
    escaping, unresolved, inadmissible, ended : float
        The shares of starts with the labels -2, -1, -3 and -4.
    """

    def __init__(
        self,
        axes: tuple[str, str],
        found: _percuss.ReturnsSurveyed,
        modes: list[str],
        states: list[str],
    ) -> None:
        self.axes = axes
        self.across = found["across"]
        self.up = found["up"]
        self.labels: NDArray[np.int32] = found["labels"]
        self.attractors = [ReturnAttractor(it, modes, states) for it in found["attractors"]]
        self.escaping = found["escaping"]
        self.unresolved = found["unresolved"]
        self.inadmissible = found["inadmissible"]
        self.ended = found["ended"]

    def to_xarray(self) -> Any:
        """Make a data set of the labels over the two states; needs xarray."""
        across, up = columns_of(self.axes, "labels")
        labels = {"labels": ((up, across), self.labels)}
        return dataset(labels, {across: self.across, up: self.up})

    def plot(self, ax: Any = None) -> Any:
        """Draw the labels over the two states; needs matplotlib. Returns the axes."""
        ax = axes_or_new(ax)
        names = [described(it.kind, it.period) for it in self.attractors]
        cells(ax, self.across, self.up, self.labels, names)
        return named(ax, *self.axes)

    def __repr__(self) -> str:
        rows, columns = self.labels.shape
        return f"ReturnBasins({columns} x {rows} starts, {len(self.attractors)} attractors)"


class BranchBifurcation:
    """A bifurcation of a branch.

    Attributes
    ----------
    kind : str
        ``fold``, ``flip``, ``neimark-sacker``, ``grazing``, ``corner``, ``event-gained`` or
        ``event-lost``.
    value, error : float
        The parameter's value, and a bound of its error.
    event : str or None
        The event that is touched, gained, lost or at once with another, of a system.
    period : int
        The period of the orbit there.
    turns : bool
        Whether the branch turns back in the parameter.
    """

    def __init__(self, found: _percuss.FoundBifurcation) -> None:
        self.kind = found["kind"]
        self.value = found["value"]
        self.error = found["error"]
        self.event = found["event"]
        self.period = found["period"]
        self.turns = found["turns"]

    def __repr__(self) -> str:
        event = "" if self.event is None else f" by {self.event}"
        return f"BranchBifurcation({self.kind}{event} at {self.value:.10g})"


class Branch:
    """A branch of periodic orbits, stable or not, that was followed in a parameter.

    Attributes
    ----------
    parameter : str
        What varies.
    values : ndarray, shape (n,)
        Its values along the branch, which may turn.
    points : ndarray, shape (n, d)
        The first point of each orbit.
    multipliers : ndarray of complex, shape (n, m)
        The multipliers of each orbit.
    stable : ndarray of bool, shape (n,)
        Whether it is stable.
    mode : list of str
        The modes of the first points; of the oscillator none.
    time : ndarray
        The times of the orbits; of the oscillator none.
    events : list of list of str
        The events of the orbits; of the oscillator none.
    drift : ndarray
        The drift per forcing period, of the oscillator.
    bifurcations : list of BranchBifurcation
        The bifurcations on the way, in order.
    period : int
        The period of its first orbit.
    complete : bool
        Whether the branch was followed to the value that was asked for.
    ending : str
        How and where it ends.
    states : list of str
        The names of the d states.
    """

    def __init__(self, parameter: str, found: _percuss.FollowedBranch, states: list[str]) -> None:
        self.parameter = parameter
        self.values = found["values"]
        self.points = found["points"]
        self.multipliers = np.array([_complex(it) for it in found["multipliers"]])
        self.stable = np.array(found["stable"], dtype=np.bool_)
        self.mode = found["modes"]
        self.time = np.array(found["times"])
        self.events = found["events"]
        self.drift = np.array(found["drift"])
        self.bifurcations = [BranchBifurcation(it) for it in found["bifurcations"]]
        self.period = found["period"]
        self.complete = found["complete"]
        self.ending = found["ending"]
        self.states = states

    def __len__(self) -> int:
        return len(self.values)

    def to_pandas(self) -> Any:
        """Make a table of the orbits in order, by their first points; needs pandas."""
        import pandas as pd

        columns: dict[str, Any] = {self.parameter: self.values}
        names = columns_of(self.states, "stable", self.parameter)
        columns |= {name: self.points[:, place] for place, name in enumerate(names)}
        if self.mode:
            columns |= {"mode": self.mode, "time": self.time}
        return pd.DataFrame(columns | {"stable": self.stable}).rename_axis("n")

    def to_xarray(self) -> Any:
        """Make a data set of the orbits in order, by their first points; needs xarray."""
        names = columns_of(self.states, "point", "multipliers", "stable", self.parameter)
        columns: dict[str, tuple[tuple[str, ...], Any]] = {
            name: (("point",), self.points[:, place]) for place, name in enumerate(names)
        }
        columns["stable"] = (("point",), self.stable)
        columns["multipliers"] = (("point", "multiplier"), self.multipliers)
        return dataset(columns, {self.parameter: ("point", self.values)}, ending=self.ending)

    def plot(self, ax: Any = None) -> Any:
        """Draw the first state over the parameter; needs matplotlib. Returns the axes.

        The line is full where the orbit is stable; bifurcations are marked and named.
        """
        ax = axes_or_new(ax)
        curve(ax, self.values, self.points[:, 0], self.stable)
        for found in self.bifurcations:
            place = int(np.argmin(abs(self.values - found.value)))
            height = self.points[place, 0]
            ax.plot(found.value, height, "o", color="#d55e00", markersize=4)
            ax.annotate(
                found.kind,
                (found.value, height),
                xytext=(-4, 4),
                textcoords="offset points",
                ha="right",
            )
        return named(ax, self.parameter, self.states[0])

    def __repr__(self) -> str:
        ends = f"{self.values[0]:g} to {self.values[-1]:g}"
        return f"Branch({self.parameter} from {ends}, {len(self)} orbits of period {self.period})"

"""What the oscillator's dynamics are told as: arrays, and pictures of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from percuss import _percuss
from percuss._pictures import axes_or_new, cells, cloud, named
from percuss._returns import described, points_over
from percuss._run import Floats
from percuss._xarray import dataset


class Section:
    """A stroboscopic section: the state once a forcing period.

    Attributes
    ----------
    points : ndarray, shape (n, 4)
        p, y, q and v.
    """

    def __init__(self, points: Floats) -> None:
        self.points = points

    def __len__(self) -> int:
        return len(self.points)

    def to_pandas(self) -> Any:
        """Make a table with the columns of the command; needs pandas."""
        import pandas as pd

        return pd.DataFrame(self.points, columns=["p", "y", "q", "v"]).rename_axis("n")

    def plot(self, ax: Any = None) -> Any:
        """Draw y over p; needs matplotlib. Returns the axes."""
        ax = axes_or_new(ax)
        cloud(ax, self.points[:, 0], self.points[:, 1])
        return named(ax, "p", "y")

    def __repr__(self) -> str:
        return f"Section({len(self)} points)"


class Lyapunov:
    """The Lyapunov exponents of a motion, and its drift.

    Attributes
    ----------
    exponents, standard_error : ndarray, shape (3,)
        Per forcing period, the largest first, with their standard errors.
    stationary : bool or None
        Whether the means of batches scatter about one value; None where too few tell.
    contraction : float
        The mean growth of the area per forcing period.
    drift, drift_standard_error : float
        The mean drift per forcing period.
    undecidable : bool
        Whether rounding hides how a phase ends: nothing else is known then.
    """

    def __init__(self, found: _percuss.Exponents) -> None:
        self.exponents = np.array(found["exponents_per_period"])
        self.standard_error = np.array(found["standard_error"])
        self.stationary = found["stationary"]
        self.contraction = found["contraction_per_period"]
        self.drift = found["drift_per_period"]
        self.drift_standard_error = found["drift_standard_error"]
        self.undecidable = found["undecidable"]

    def __repr__(self) -> str:
        pairs = zip(self.exponents, self.standard_error, strict=True)
        shown = ", ".join(f"{value:.4g} +- {error:.1g}" for value, error in pairs)
        return f"Lyapunov({shown} per forcing period)"


class Orbit:
    """A periodic orbit.

    Attributes
    ----------
    points : ndarray, shape (period, 3)
        p, y and q at the strobes.
    multipliers : ndarray of complex, shape (3,)
        The multipliers of the whole orbit.
    phases : list of str
        The phases that are met, in order.
    stable : bool
        Whether all multipliers lie inside the unit circle.
    drift : float
        The drift per forcing period.
    residual : float
        How far the orbit is from closed.
    """

    def __init__(self, found: _percuss.FoundOrbit) -> None:
        self.points = found["points"]
        self.multipliers = np.array([complex(re, im) for re, im in found["multipliers"]])
        self.phases = found["phases"]
        self.stable = found["stable"]
        self.drift = found["drift_per_period"]
        self.residual = found["residual"]

    @property
    def period(self) -> int:
        """The number of forcing periods after which the orbit closes."""
        return len(self.points)

    def __repr__(self) -> str:
        return f"Orbit(period {self.period}, {'stable' if self.stable else 'unstable'})"


class Bifurcation:
    """The strobes at each value of a parameter.

    Attributes
    ----------
    parameter : str
        What varies.
    values : ndarray, shape (n,)
        Its values.
    points : ndarray, shape (m, 3)
        p, y and q of all strobes.
    steps : ndarray of int, shape (m,)
        The index of its value for each strobe.
    drift, drift_standard_error : ndarray, shape (n,)
        The mean drift per forcing period at each value.
    escapes, undecidable : ndarray of bool, shape (n,)
        Whether the motion escapes, and whether rounding cuts its strobes short.
    """

    def __init__(self, parameter: str, found: _percuss.Diagrammed) -> None:
        self.parameter = parameter
        self.values = found["values"]
        self.points = found["points"]
        self.steps = found["steps"]
        self.drift = found["drift_per_period"]
        self.drift_standard_error = found["drift_standard_error"]
        self.escapes = found["escapes"]
        self.undecidable = found["undecidable"]

    def to_xarray(self) -> Any:
        """Make a data set of the strobes, each with its value of the parameter; needs xarray."""
        states = ["p", "y", "q"]
        return points_over(self.parameter, self.values[self.steps], self.points, states)

    def plot(self, ax: Any = None) -> Any:
        """Draw p over the parameter; needs matplotlib. Returns the axes."""
        ax = axes_or_new(ax)
        cloud(ax, self.values[self.steps], self.points[:, 0])
        return named(ax, self.parameter, "p")

    def __repr__(self) -> str:
        ends = f"{self.values[0]:g} to {self.values[-1]:g}"
        return f"Bifurcation({self.parameter} from {ends}, {len(self.points)} points)"


class Attractor:
    """An attractor, and the share of starts that reach it.

    Attributes
    ----------
    kind : str
        ``periodic``, ``chaotic`` or ``quasi-periodic``.
    period : int or None
        The period of an orbit, in forcing periods.
    fraction, fraction_error : float
        The share of starts that reach it, with its standard error.
    points : ndarray, shape (n, 3)
        p, y and q at successive strobes.
    drift, drift_standard_error : float
        The mean drift per forcing period.
    lyapunov, lyapunov_error : float
        The largest exponent per forcing period.
    """

    def __init__(self, found: _percuss.Found) -> None:
        self.kind = found["kind"]
        self.period = found["period"]
        self.fraction = found["fraction"]
        self.fraction_error = found["fraction_error"]
        self.points = found["points"]
        self.drift = found["drift_per_period"]
        self.drift_standard_error = found["drift_standard_error"]
        self.lyapunov = found["lyapunov_per_period"]
        self.lyapunov_error = found["lyapunov_error"]

    def __repr__(self) -> str:
        period = "" if self.period is None else f" of period {self.period}"
        return f"Attractor({self.kind}{period}, {self.fraction:.1%} of the starts)"


class Basins:
    """The attractor that each start of a grid reaches.

    Attributes
    ----------
    p, y : ndarray, shapes (nx,) and (ny,)
        The centres of the cells.
    labels : ndarray of int, shape (ny, nx)
        The index of the attractor, -1 of what is not known, -2 of what escapes.
    attractors : list of Attractor
        The attractors that starts reach, orbits first.
    escaping, unresolved : float
        The shares of starts that escape, and of which it is not known where they lead.
    """

    def __init__(self, found: _percuss.Surveyed) -> None:
        self.p = found["p"]
        self.y = found["y"]
        self.labels: NDArray[np.int32] = found["labels"]
        self.attractors = [Attractor(it) for it in found["attractors"]]
        self.escaping = found["escaping"]
        self.unresolved = found["unresolved"]

    def to_xarray(self) -> Any:
        """Make a data set of the labels over p and y; needs xarray."""
        return dataset({"labels": (("y", "p"), self.labels)}, {"p": self.p, "y": self.y})

    def plot(self, ax: Any = None) -> Any:
        """Draw the labels over p and y; needs matplotlib. Returns the axes.

        Starts that escape are white, those that are not resolved are grey.
        """
        ax = axes_or_new(ax)
        names = [described(it.kind, it.period) for it in self.attractors]
        cells(ax, self.p, self.y, self.labels, names)
        return named(ax, "p", "y")

    def __repr__(self) -> str:
        rows, columns = self.labels.shape
        return f"Basins({columns} x {rows} starts, {len(self.attractors)} attractors)"

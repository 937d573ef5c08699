"""Derivatives of a run's events by parameters and starts."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percuss import _percuss

if TYPE_CHECKING:
    import pandas as pd

    from percuss._run import Digits, Run

Floats = NDArray[np.float64]
Texts = NDArray[np.str_]


class Derivatives:
    """The derivatives of the rows of a run by k names, on both sides of their values or on one.

    They are total derivatives: of an event's time, and of the state just after it as it stands at
    that time, which moves with the name too.
    """

    def __init__(
        self, rows: _percuss.Rows, names: list[str], digits: int, side: int | None
    ) -> None:
        self._rows = rows
        self._names = names
        self._digits = digits
        self._side = side

    @cached_property
    def _found(self) -> _percuss.FoundDerivatives:
        return self._rows.derivatives(len(self._names), self._side)

    @property
    def time(self) -> Floats:
        """Those of the times, shape (n, k); NaN where there is none."""
        return self._found["time"]

    @property
    def state(self) -> Floats:
        """Those of the states, shape (n, k, d); NaN where there is none."""
        return self._found["state"]

    @cached_property
    def reason(self) -> Texts:
        """The reasons why there is none, shape (n, k): empty where there is one."""
        return np.array(self._found["reason"], dtype=np.str_)

    @cached_property
    def digits(self) -> Digits:
        """The decimals that the command prints, shapes (n, k) and (n, k, d): empty for no value.

        Raises
        ------
        AttributeError
            Of a run in f64, of which no digit is proved.
        """
        from percuss._run import Digits

        found = self._rows.derivative_digits(self._side, self._digits)
        if found is None:
            raise AttributeError("a run in f64 has no proved digits: one of events() has")
        time, state = found["time"], found["state"]
        return Digits(np.array(time, dtype=np.str_), np.array(state, dtype=np.str_))


class Gradient(Derivatives):
    """The derivatives of a run's events by names, as ``percuss gradient`` prints them.

    Row k is that of row k of the run. Where the derivatives of the two sides of a name's value
    differ, those of this object are NaN, and `below` and `above` have them.

    Attributes
    ----------
    names : list of str
        The k names: parameters, and ``start.STATE`` for states at the start.
    below, above : Derivatives
        The derivatives towards smaller and towards larger values: those of both sides where these
        do not differ.
    """

    def __init__(self, run: Run, rows: _percuss.Rows, names: list[str], digits: int) -> None:
        super().__init__(rows, names, digits, None)
        self._run = run
        self.names = names
        self.below = Derivatives(rows, names, digits, 0)
        self.above = Derivatives(rows, names, digits, 1)

    def __reduce__(self) -> tuple[Any, ...]:
        return self._run.gradient, (self.names,)

    @cached_property
    def side(self) -> Texts:
        """``-+`` where the derivatives of the two sides differ, else empty, shape (n, k)."""
        return np.where(np.array(self._found["differs"], dtype=np.bool_), "-+", "")

    def to_pandas(self) -> pd.DataFrame:
        """Make a table with the columns of the command, a row an event and name; needs pandas.

        A name whose derivatives differ has a row for each side.
        """
        import pandas as pd

        columns = [f"d{it}" for it in self._run.columns]
        rows: list[dict[str, Any]] = []
        for n in range(len(self._run)):
            for k, name in enumerate(self.names):
                sides = {"": self} if not self.side[n, k] else {"-": self.below, "+": self.above}
                for side, found in sides.items():
                    row = {"n": n, "event": self._run.name[n], "mode": self._run.mode[n]}
                    row |= {"wrt": name, "side": side, "dtime": found.time[n, k]}
                    rows.append(row | dict(zip(columns, found.state[n, k], strict=True)))
        return pd.DataFrame(rows)

    def __repr__(self) -> str:
        missing = "" if not (self.reason != "").any() else ", some of which have none"
        return f"Gradient({len(self._run)} rows by {', '.join(self.names)}{missing})"

"""Sweeps: a verb of the dynamics at every point of one or two parameters."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percuss._dynamics import name_of, steps_of
from percuss._xarray import dataset

Floats = NDArray[np.float64]


class Sweep:
    """The results of a verb over one or two parameters.

    Attributes
    ----------
    axes : dict of str to ndarray
        The values of the parameters, by name.
    arrays : dict of str to ndarray
        The arrays of ``percuss sweep merge``: their first dimensions are those of the axes.
    """

    def __init__(self, axes: dict[str, Floats], arrays: dict[str, NDArray[Any]]) -> None:
        self.axes = axes
        self.arrays = arrays

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[name]

    def to_xarray(self) -> Any:
        """Make a data set over the axes; needs xarray."""
        shape = tuple(len(values) for values in self.axes.values())
        variables: dict[str, tuple[tuple[str, ...], Any]] = {}
        for name, array in self.arrays.items():
            if array.shape[: len(shape)] == shape:
                others = tuple(f"{name}_{n}" for n in range(array.ndim - len(shape)))
                variables[name] = ((*self.axes, *others), array)
        return dataset(variables, dict(self.axes))

    def __repr__(self) -> str:
        sizes = ", ".join(f"{name}: {len(values)}" for name, values in self.axes.items())
        return f"Sweep({sizes}; {', '.join(self.arrays)})"


# Flags of the command that a system in Python has already.
_OF_SYSTEM = {"set": "system(NAME=VALUE)", "start": "system.at(...)"}


@dataclass
class SweptSystem:
    """The texts and values of which a system is made."""

    text: str
    parameters: Mapping[str, float]
    start: str | None

    def lines(self, folder: Path, axes: Iterable[str]) -> tuple[list[str], list[str]]:
        """Write the files that a plan names; the plan's lines about it, for [sweep] and [fixed]."""
        (folder / "swept.system.toml").write_text(self.text, encoding="utf-8")
        fixed = []
        if self.start is not None:
            (folder / "start.toml").write_text(self.start, encoding="utf-8")
            fixed.append('start = "start.toml"')
        given = {name: value for name, value in self.parameters.items() if name not in axes}
        if given:
            entries = (f"{json.dumps(name)} = {value!r}" for name, value in given.items())
            fixed.append(f"set = {{ {', '.join(entries)} }}")
        return ['system = "swept.system.toml"'], fixed


class Swept:
    """The method of a model that runs a verb over one or two of its parameters."""

    def _of_sweep(self) -> tuple[Mapping[str, Any], SweptSystem | None]:
        """The flags of the command that the model has itself, and its system if it is one."""
        raise NotImplementedError

    def sweep(
        self,
        verb: str,
        axes: Mapping[str, Sequence[float] | Floats],
        *,
        out: str | Path | None = None,
        **flags: Any,
    ) -> Sweep:
        """Run a verb at every point of one or two parameters, as ``percuss sweep`` does.

        Parameters
        ----------
        verb : {'basins', 'attractors', 'bifurcation', 'lyapunov', 'continue'}
            The verb that is run.
        axes : mapping of str to array_like
            One or two parameters, each with its values in equal steps.
        out : path, optional
            A folder for the shards, from which a sweep that was interrupted goes on.
        **flags
            The flags of the verb by their long names, with ``from_`` for ``from``.

        Raises
        ------
        ValueError
            What the command does not accept, with its reason.

        Examples
        --------
        >>> import percuss
        >>> axes = {"omega": [0.9, 1.0, 1.1]}
        >>> found = percuss.Oscillator().sweep("lyapunov", axes, transient=20, periods=50)
        >>> found["drift_per_period"].shape
        (3,)
        >>> rig = percuss.systems["rigid-impact-oscillator"]
        >>> found = rig.sweep("lyapunov", {"A": [0.5, 0.6, 0.7]}, transient=20, returns=50)
        >>> found["exponents_per_return"].shape
        (3, 2)
        """
        own, system = self._of_sweep()
        if "progress" in flags:
            raise TypeError("progress is not accepted: a sweep goes on from its shards in out")
        # The parameter that the verb varies has no value of its own.
        own = {name: value for name, value in own.items() if name != flags.get("parameter")}
        fixed = {**own, **{name.rstrip("_"): value for name, value in flags.items()}}
        if system is not None and (name := next((it for it in fixed if it in _OF_SYSTEM), None)):
            raise ValueError(f"{name} is not accepted: {_OF_SYSTEM[name]} is")
        return _swept(verb, axes, fixed, out, system)


def _swept(
    verb: str,
    axes: Mapping[str, Sequence[float] | Floats],
    fixed: Mapping[str, Any],
    out: str | Path | None,
    system: SweptSystem | None,
) -> Sweep:
    """Run the plan of a sweep by the command, and read the arrays that it merges."""
    with tempfile.TemporaryDirectory(prefix="percuss-") as own:
        path, merged = Path(own) / "plan.toml", Path(own) / "merged.npz"
        of_system = ([], []) if system is None else system.lines(Path(own), axes)
        plan = _plan(name_of("verb", verb), axes, fixed, of_system)
        path.write_text(plan, encoding="utf-8")
        folder = Path(own) / "shards" if out is None else Path(out)
        where = ("--plan", str(path), "--out", str(folder))
        _command(path, "run", *where)
        _command(path, "merge", *where, "--output", str(merged))
        with np.load(merged) as stored:
            arrays = {name: stored[name] for name in stored.files}
    # An axis whose name is that of an array is stored under a longer one.
    stored_as = {name: f"parameter.{name}" for name in axes if f"parameter.{name}" in arrays}
    return Sweep({name: arrays.pop(stored_as.get(name, name)) for name in axes}, arrays)


def _command(plan: Path, step: str, *words: str) -> None:
    call = [sys.executable, "-m", "percuss", "--quiet", "sweep", step, *words]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        told = lines[0].removeprefix("percuss: ") if lines else "the sweep failed"
        # The plan is none of the caller's files.
        raise ValueError(told.removeprefix(f"--plan {plan}: ").removeprefix("[fixed]: "))


def _plan(
    verb: str,
    axes: Mapping[str, Any],
    fixed: Mapping[str, Any],
    of_system: tuple[list[str], list[str]],
) -> str:
    if not 1 <= len(axes) <= 2:
        raise ValueError(f"axes of {len(axes)} parameters are not accepted: one or two are")
    head, given = of_system
    lines = ["[sweep]", f"verb = {json.dumps(verb)}", "shards = 1", *head, "[fixed]", *given]
    for name, value in fixed.items():
        if name not in axes and value is not None:
            lines.append(f"{name.replace('_', '-')} = {_toml(name, value)}")
    for name, values in axes.items():
        first, last, count = steps_of(values)
        lines += ["[[axis]]", f"parameter = {json.dumps(name)}"]
        lines += [f"from = {first!r}", f"to = {last!r}", f"steps = {count}"]
    return "\n".join(lines) + "\n"


def _toml(name: str, value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, (bool, str)):
        return json.dumps(value)
    if name == "grid" and isinstance(value, (list, tuple)):
        return json.dumps("x".join(str(it) for it in value))
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_toml(name, it) for it in value)}]"
    if hasattr(value, "__index__"):
        return str(value.__index__())
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"{name} = {value!r} is not accepted: a finite number is")
    return repr(number)

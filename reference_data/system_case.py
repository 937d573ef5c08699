"""A case of a system: which file, its parameters and start, and how far it runs."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from flint import fmpq

import system_file
from affine_expression import Refused, number
from system_file import System, check_trouble, only

SAMPLES = 100
LARGEST_SAMPLES = 100_000


@dataclass
class SystemCase:
    """What the generators read of a case file."""

    name: str
    system: System
    written_start: dict
    until: fmpq
    written_until: float
    samples: int
    backward: bool

    @classmethod
    def read(cls, path: Path, folder: Path):
        """The case of a file; its system is beside it or in `folder`."""
        table = tomllib.loads(path.read_text())
        only(table, "case parameters start horizon", str(path))
        only(table["case"], "name system why trouble", f"{path}: case")
        check_trouble(table["case"], str(path))
        only(table["horizon"], "until samples backward", f"{path}: horizon")
        name, horizon = table["case"]["name"], table["horizon"]
        if name != path.stem:
            raise Refused(f"{path}: the case calls itself {name!r}")
        file = system_path(table["case"]["system"], path.parent, folder)
        system = system_file.read(file, table.get("parameters"), table.get("start"))
        written = table.get("start") or tomllib.loads(file.read_text())["start"]
        samples, backward = horizon.get("samples", SAMPLES), horizon.get("backward", False)
        if not 1 <= samples <= LARGEST_SAMPLES:
            raise Refused(f"{path}: samples are 1 to {LARGEST_SAMPLES}")
        until = number(horizon["until"])
        if not (until < system.start["t"] if backward else until > system.start["t"]):
            raise Refused(f"{path}: `until` lies on the wrong side of the start")
        return cls(name, system, written, until, horizon["until"], samples, backward)

    def clock(self, elapsed):
        """The clock of theta at an elapsed time, a rational or a ball."""
        return self.system.start["t"] + (-elapsed if self.backward else elapsed)

    def span(self) -> fmpq:
        """Time from start to horizon."""
        length = self.until - self.system.start["t"]
        return -length if self.backward else length


def system_path(name: str, beside: Path, folder: Path) -> Path:
    for place in (beside, folder):
        path = place / f"{name}.system.toml"
        if path.exists():
            return path
    raise Refused(f"no file {name}.system.toml beside the case or in {folder}")

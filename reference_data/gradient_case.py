"""The cases of `gradients/cases.toml`: a system, its settings, the names, and how far it runs."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import coefficient_derivatives
import system_file
from affine_expression import Refused
from generate_events import HERE
from generate_systems import SYSTEMS
from system_case import system_path
from system_file import System, only

GRADIENTS = HERE / "gradients"
CASES = GRADIENTS / "cases.toml"


@dataclass
class GradientCase:
    """A case of derivatives; `names` are those by which is differentiated."""

    name: str
    path: Path
    parameters: dict
    start: dict | None
    names: list
    until: float

    def system(self) -> System:
        return system_file.read(self.path, self.parameters, self.start)

    def derivatives(self, name: str) -> System:
        """The system in dual numbers."""
        return coefficient_derivatives.read(self.path, name, self.parameters, self.start)

    def file_start(self) -> dict:
        """The start as it is written."""
        return self.start or tomllib.loads(self.path.read_text())["start"]


def read(wanted: list) -> list:
    """The cases, or those of some names."""
    tables = tomllib.loads(CASES.read_text())["case"]
    cases = [of(table) for table in tables]
    names = [case.name for case in cases]
    if len(set(names)) < len(names):
        raise Refused(f"{CASES}: two cases have one name")
    for name in wanted:
        if name not in names:
            raise Refused(f"no case {name!r}; cases are {', '.join(names)}")
    return [case for case in cases if not wanted or case.name in wanted]


def of(table: dict) -> GradientCase:
    only(table, "name system why wrt until parameters start", "a case of gradients")
    for key in ("name", "system", "why", "wrt", "until"):
        if key not in table:
            raise Refused(f"case {table.get('name')!r}: {key} is missing")
    path = system_path(table["system"], GRADIENTS, SYSTEMS)
    parameters, start = table.get("parameters", {}), table.get("start")
    return GradientCase(table["name"], path, parameters, start, table["wrt"], table["until"])


"""The pytest plugin: each case of percuss is a test of a solver.

``pytest --percuss=mylib.adapters:solve --percuss-cases="graze*" --percuss-rtol=1e-6,1e-9``
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Optional

import pytest

from percuss._report import Report, reason


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options of the plugin."""
    group = parser.getgroup("percuss", "solvers held against the proved events of percuss")
    group.addoption(
        "--percuss",
        metavar="MODULE:SOLVER",
        help="test this solver: a function like scipy.integrate.solve_ivp, or one that takes a"
        " percuss.Problem and returns a percuss.Answer",
    )
    group.addoption("--percuss-cases", metavar="PATTERNS", default="*", help="cases, with commas")
    group.addoption("--percuss-rtol", metavar="T,...", default="1e-6,1e-9", help="tolerances")
    group.addoption("--percuss-method", metavar="METHOD", help="the method that the solver takes")
    group.addoption(
        "--percuss-setup",
        metavar="SETUP",
        default="experts",
        help="of a solver like solve_ivp: experts, documentation, or both with a comma",
    )
    group.addoption("--percuss-kind", metavar="CLASS", help="explicit, implicit, multistep, taylor")
    group.addoption("--percuss-order", metavar="N", type=int, help="the order of the method")
    group.addoption(
        "--percuss-stepping",
        metavar="STEPPING",
        default="adaptive",
        help="the rule of its steps: adaptive, per-step or fixed",
    )
    group.addoption("--percuss-out", metavar="DIR", help="a folder for the files of the report")
    group.addoption(
        "--percuss-baseline",
        metavar="FILE",
        action="append",
        default=[],
        help="an earlier report.json: a test fails where a row is worse; given again, the best of"
        " all counts",
    )
    group.addoption(
        "--percuss-known",
        metavar="FILE",
        help="declared shortcomings: lines of CASE or CASE@TOLERANCE, a space, and the reason;"
        " these tests have to fail",
    )


def _solver(name: str) -> Any:
    """The solver of a name such as `scipy.integrate:solve_ivp`."""
    module, separator, attribute = name.partition(":")
    if not separator:
        raise pytest.UsageError(f"--percuss={name} is not accepted: MODULE:SOLVER is")
    try:
        found: Any = importlib.import_module(module)
        for part in attribute.split("."):
            found = getattr(found, part)
    except Exception as error:  # a module may raise anything where it is imported
        raise pytest.UsageError(f"--percuss={name}: {type(error).__name__}: {error}") from error
    return found


# A case at a tolerance, or at all of them.
_Known = dict[tuple[str, Optional[float]], str]


def _known(path: str | None) -> _Known:
    """The declared shortcomings, with their reasons."""
    from percuss import _percuss

    if path is None:
        return {}
    try:
        lines = Path(path).read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise pytest.UsageError(f"--percuss-known={path}: {error.strerror}") from error
    known: _Known = {}
    cases = _percuss.case_names()
    for number, line in enumerate(lines, 1):
        words = line.split(maxsplit=1)
        if not words or words[0].startswith("#"):
            continue
        case, _, tolerance = words[0].partition("@")
        place = f"--percuss-known={path}: line {number}: {words[0]}"
        if case not in cases:
            raise pytest.UsageError(f"{place}: {case} is no case: percuss.case_names() has them")
        try:
            at = float(tolerance) if "@" in words[0] else None
        except ValueError:
            raise pytest.UsageError(f"{place}: a number is accepted after the @") from None
        known[case, at] = words[1] if len(words) > 1 else "declared"
    return known


def _report(config: pytest.Config) -> Report:
    """The judgement of the solver on all cases that are asked for."""
    import percuss

    def option(name: str) -> Any:
        return config.getoption(name)

    tolerances = option("--percuss-rtol")
    try:
        return percuss.score(
            _solver(option("--percuss")),
            method=option("--percuss-method"),
            rtol=[float(it) for it in tolerances.split(",")],
            cases=option("--percuss-cases").split(","),
            setup=option("--percuss-setup").split(","),
            kind=option("--percuss-kind"),
            order=option("--percuss-order"),
            stepping=option("--percuss-stepping"),
            out=option("--percuss-out"),
            baseline=option("--percuss-baseline"),
        )
    except (ValueError, TypeError, OSError) as error:
        raise pytest.UsageError(f"--percuss: {error}") from error


class RowFailure(Exception):
    """A row that is out of bounds or gave no result."""


class _Item(pytest.Item):
    """A test of the plugin, whose failure is a line or more."""

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Say the reason, without lines of this file."""
        if isinstance(excinfo.value, RowFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """The place and the name of the test."""
        return self.path, None, f"percuss: {self.name}"


class Row(_Item):
    """A row of the report, as a test."""

    def __init__(self, *, row: dict[str, Any], **options: Any) -> None:
        super().__init__(**options)
        self.row = row

    def runtest(self) -> None:
        """Fail where the row does."""
        verdict = self.row["verdict"]
        if verdict in ("fail", "error"):
            raise RowFailure(reason(self.row))
        if verdict in ("not-run", "unavailable", "not-scored"):
            pytest.skip(f"{verdict}: {self.row['why']}")


class BaselineTest(_Item):
    """The comparison with the baseline, as a test."""

    def __init__(self, *, worse: list[str], **options: Any) -> None:
        super().__init__(**options)
        self.worse = worse

    def runtest(self) -> None:
        """Fail where a row is worse, or gone."""
        if self.worse:
            raise RowFailure("\n".join(f"worse than the baseline: {it}" for it in self.worse))


class Rows(pytest.Collector):
    """The rows of the report, with the shortcomings that are declared."""

    def __init__(self, *, report: Report, known: _Known, **options: Any) -> None:
        super().__init__(**options)
        self.report = report
        self.known = known

    def collect(self) -> Iterator[pytest.Item]:
        """One test a row, and one of the baseline; declared shortcomings are expected to fail."""
        for row in self.report.rows:
            tolerance = f"{row['tolerance']:g}"
            item = Row.from_parent(
                self, name=f"{row['case']}[{row['engine']}-{tolerance}]", row=row
            )
            everywhere = self.known.get((row["case"], None))
            why = self.known.get((row["case"], row["tolerance"]), everywhere)
            if why is not None:
                item.add_marker(pytest.mark.xfail(reason=why, strict=True))
            yield item
        if self.config.getoption("--percuss-baseline"):
            yield BaselineTest.from_parent(self, name="baseline", worse=self.report.worse)


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session: pytest.Session) -> None:
    """Say early what is wrong with the solver's name."""
    name = session.config.getoption("--percuss")
    if name is not None:
        _solver(name)


def pytest_collection_modifyitems(session: pytest.Session, items: list[pytest.Item]) -> None:
    """Put the rows behind the tests that files have."""
    config = session.config
    if config.getoption("--percuss") is None:
        return
    known = _known(config.getoption("--percuss-known"))
    rows = Rows.from_parent(session, name="percuss", report=_report(config), known=known)
    # Counted as those of a file are, by whoever shows the tests.
    found = rows.ihook.pytest_make_collect_report(collector=rows)
    rows.ihook.pytest_collectreport(report=found)
    items.extend(found.result)

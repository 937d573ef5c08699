"""The verdict on a solver: rows, the ranking, and files."""

from __future__ import annotations

import html
import json
import shutil
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

_BAD = ("fail", "error")


class ScoreFailure(AssertionError):
    """A row that is out of bounds, or whose run gave no result."""


def raise_for(lines: Sequence[str], of_all: str) -> None:
    """Raise with the first ten of these lines, if there are any."""
    if lines:
        more = [f"and {len(lines) - 10} more"] if len(lines) > 10 else []
        raise ScoreFailure("\n".join([f"{len(lines)} {of_all}:", *lines[:10], *more]))


def html_table(heads: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A table of rows under heads."""
    head = "".join(f"<th>{it}</th>" for it in heads)
    body = "".join(
        f"<tr>{''.join(f'<td>{html.escape(str(it))}</td>' for it in row)}</tr>" for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


class Report:
    """What percuss says of a solver: a row for each case, set-up and tolerance.

    Attributes
    ----------
    rows : list of dict
        The rows, with the keys of ``results`` in `report.json`.
    ranking : list of dict
        The set-ups, the best first, with the keys of ``ranking``.
    summary : dict of str to int
        The number of rows of each verdict.
    worse : list of str
        What is worse than in the baseline, a line each.
    folder : pathlib.Path
        The folder with report.json, report.html, errors.csv, junit.xml and pictures.
    """

    def __init__(
        self,
        folder: Path,
        owned: tempfile.TemporaryDirectory[str] | None = None,
        worse: Sequence[str] = (),
    ) -> None:
        self._owned = owned
        self.worse = list(worse)
        self.folder = folder
        found: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
        self.rows: list[dict[str, Any]] = found["results"]
        self.ranking: list[dict[str, Any]] = found["ranking"]
        self.summary: dict[str, int] = found["summary"]

    @property
    def rank(self) -> dict[str, int]:
        """The rank of each set-up by its name; 1 is the best, and equals share a rank."""
        return {it["engine"]: it["rank"] for it in self.ranking}

    @property
    def failures(self) -> list[dict[str, Any]]:
        """The rows that are out of bounds or gave no result."""
        return [row for row in self.rows if row["verdict"] in _BAD]

    def raise_for_failures(self) -> None:
        """Raise for rows that are out of bounds or gave no result.

        Raises
        ------
        ScoreFailure
            With a line for each of the first ten.
        """
        raise_for([reason(row) for row in self.failures], f"of {len(self.rows)} rows")

    def to_pandas(self) -> Any:
        """Make a table of the rows; needs pandas."""
        import pandas as pd

        return pd.json_normalize(self.rows)

    def html(self, path: str | Path) -> Path:
        """Write the page of the report to a file; its pictures are inside it."""
        target = Path(path)
        shutil.copyfile(self.folder / "report.html", target)
        return target

    def save(self, folder: str | Path) -> Path:
        """Copy all files of the report into a folder."""
        target = Path(folder)
        shutil.copytree(self.folder, target, dirs_exist_ok=True)
        return target

    def __str__(self) -> str:
        width = max([len(row["engine"]) for row in self.rows], default=6)
        cases = max([len(row["case"]) for row in self.rows], default=4)
        lines = [f"{'engine':{width}}  {'case':{cases}}  {'tol':>5}  right/judged  verdict"]
        for row in self.rows:
            judged = f"{_shown(row['events_right'])}/{_shown(row['events_judged'])}"
            head = f"{row['engine']:{width}}  {row['case']:{cases}}  {_tolerance(row):>5}"
            lines.append(f"{head}  {judged:>12}  {row['verdict']}")
        counts = ", ".join(f"{count} {name}" for name, count in self.summary.items() if count)
        return "\n".join([*lines, f"{len(self.rows)} rows: {counts}"])

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {name}" for name, count in self.summary.items() if count)
        return f"Report({len(self.rows)} rows: {counts})"

    def _repr_html_(self) -> str:
        heads = ("engine", "case", "tolerance", "right", "judged", "verdict", "why")
        cells = [
            (
                row["engine"],
                row["case"],
                _tolerance(row),
                _shown(row["events_right"]),
                _shown(row["events_judged"]),
                row["verdict"],
                row["why"],
            )
            for row in self.rows
        ]
        return html_table(heads, cells)


def _tolerance(row: dict[str, Any]) -> str:
    tolerance = row["tolerance"]
    if tolerance is None:
        return "-"
    mantissa, exponent = f"{tolerance:e}".split("e")
    return f"{float(mantissa):g}e{int(exponent)}"


def _shown(number: Any) -> str:
    return "-" if number is None else str(number)


def reason(row: dict[str, Any]) -> str:
    """A line about a row: its place, its verdict and its reason."""
    place = f"{row['case']}: {row['engine']} at {_tolerance(row)}"
    why = row["why"] or "; ".join(
        f"{it['quantity']} {it['value']} over {it['limit']}"
        for it in row["bounds"]
        if it["verdict"] == "fail"
    )
    return f"{place}: {row['verdict']}: {why}"

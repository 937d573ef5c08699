"""The verdict on derivatives through events."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from percuss import _percuss
from percuss._problem import Answer, Problem
from percuss._report import html_table, raise_for
from percuss._run import real
from percuss._score import Declared, Whose, answers, matching, tolerances_of

_WRONG = ("noisy", "wrong-limit", "zero", "missing-term")


@dataclass(frozen=True)
class Verdict:
    """The verdict on the derivatives by one name of a case, at a tolerance.

    Attributes
    ----------
    engine, case, wrt : str
        Who answered, the case, and the name.
    tolerance : float
        The tolerance.
    verdict : str
        ``right``, ``noisy``, ``wrong-limit``, ``zero``, ``missing-term``, ``refused`` or
        ``none-asked``, as the page on derivatives says.
    missing_term : str or None
        The wrong rule, where it is recognised.
    why : str
        The reason.
    """

    engine: str
    case: str
    wrt: str
    tolerance: float
    verdict: str
    missing_term: str | None
    why: str

    @property
    def is_wrong(self) -> bool:
        """Whether derivatives were answered that are not right."""
        return self.verdict in _WRONG

    def __str__(self) -> str:
        term = f" ({self.missing_term})" if self.missing_term else ""
        place = f"{self.case} by {self.wrt}: {self.engine} at {self.tolerance:g}"
        return f"{place}: {self.verdict}{term}: {self.why}"


class GradientReport:
    """What percuss says of derivatives: a verdict for each case, name and tolerance.

    Attributes
    ----------
    verdicts : list of Verdict
        In the order of the cases.
    """

    def __init__(self, verdicts: Sequence[Verdict]) -> None:
        self.verdicts = list(verdicts)

    @property
    def summary(self) -> dict[str, int]:
        """The number of names of each verdict."""
        return dict(Counter(it.verdict for it in self.verdicts))

    @property
    def failures(self) -> list[Verdict]:
        """The verdicts on derivatives that were answered and are not right."""
        return [it for it in self.verdicts if it.is_wrong]

    def raise_for_failures(self) -> None:
        """Raise for derivatives that are not right.

        Raises
        ------
        ScoreFailure
            With a line for each of the first ten.
        """
        raise_for([str(it) for it in self.failures], f"of {len(self.verdicts)} derivatives")

    def to_pandas(self) -> Any:
        """Make a table of the verdicts; needs pandas."""
        import pandas as pd

        return pd.DataFrame([asdict(it) for it in self.verdicts])

    def __str__(self) -> str:
        return "\n".join([*map(str, self.failures), self._counts()])

    def __repr__(self) -> str:
        return f"GradientReport({self._counts()})"

    def _counts(self) -> str:
        counts = ", ".join(f"{count} {name}" for name, count in self.summary.items())
        return f"{len(self.verdicts)} derivatives: {counts}"

    def _repr_html_(self) -> str:
        heads = ("engine", "case", "wrt", "tolerance", "verdict", "missing_term", "why")
        rows = [[getattr(it, key) for key in heads] for it in self.verdicts]
        return html_table(heads, [["" if it is None else it for it in row] for row in rows])


def gradient_case_names(pattern: str | Iterable[str] = "*") -> list[str]:
    """List the cases of derivatives whose names match a pattern, or one of several.

    Raises
    ------
    ValueError
        A pattern that matches nothing.

    Examples
    --------
    >>> import percuss
    >>> percuss.gradient_case_names("ball-*")[:2]
    ['ball-dropped', 'ball-elastic']
    """
    return matching(pattern, _percuss.gradient_case_names())


def gradient_problem(case: str, tolerance: float = 1e-6) -> Problem:
    """Read what a case of derivatives asks: ``problem.by`` has the derivatives of coefficients.

    Examples
    --------
    >>> import percuss
    >>> [it.wrt for it in percuss.gradient_problem("torchdiffeq-208").by]
    ['bound', 'collapse', 'drift', 'leak']
    """
    if case not in _percuss.gradient_case_names():
        raise KeyError(f"{case!r} is no case of derivatives: gradient_case_names() lists them")
    return Problem(_percuss.GradientCases({case}).ask(case), real("tolerance", tolerance))


def score_gradients(
    solver: Callable[[Problem], Answer],
    *,
    rtol: float | Sequence[float] = (1e-6, 1e-9),
    cases: str | Iterable[str] = "*",
    name: str | None = None,
    library: str | None = None,
    version: str | None = None,
    differences: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> GradientReport:
    """Judge the derivatives of a solver through events, against proved ones.

    Parameters
    ----------
    solver : callable
        Takes a :class:`Problem`, whose ``by`` has what one differentiates by, and returns an
        :class:`Answer` with ``gradients``.
    rtol : float or sequence of float, optional
        The tolerances. A limit that is wrong shows where there are two or more.
    cases : str or iterable of str, optional
        Patterns of the cases' names, such as ``"ball-*"``.
    name, library, version : str, optional
        Who answers.
    differences : bool, optional
        Whether the derivatives are differences of whole runs, whose step may be too large.
    progress : callable, optional
        Called with the number of answers made and their whole number.

    Returns
    -------
    GradientReport

    Raises
    ------
    ValueError
        No case that matches, and a tolerance outside 1e-16 to 0.1.

    Examples
    --------
    >>> import percuss
    >>> def nothing(problem):
    ...     return percuss.Answer(events=[])
    >>> percuss.score_gradients(nothing, cases="torchdiffeq-208", rtol=1e-6).summary
    {'refused': 4}
    """
    if not callable(solver):
        raise TypeError(f"{solver!r} is no solver: a callable is accepted")
    tolerances = tolerances_of(rtol)
    chosen = _percuss.GradientCases(set(gradient_case_names(cases)))
    who = Whose(solver, None, library, version)
    own = name or who.name(solver)
    declared = Declared(
        solver, own, who.library, who.version, None, None, "adaptive", bool(differences)
    )
    # What is wrong with a name or a tolerance is said before the work begins.
    _percuss.GradientCases(set()).judge([declared.at(it) for it in tolerances])
    texts = {case: chosen.ask(case) for case in chosen.names}
    with tempfile.TemporaryDirectory(prefix="percuss-gradients-") as folder:
        answered = answers(texts, [declared], tolerances, Path(folder), progress)
        rows = chosen.judge([it.told() for it in answered])
    return GradientReport([Verdict(*row) for row in rows])

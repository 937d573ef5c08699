"""Verdicts on solvers: percuss asks, the solver answers, and percuss judges."""

from __future__ import annotations

import csv
import fnmatch
import inspect
import json
import math
import platform
import re
import sys
import tempfile
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from percuss import _percuss
from percuss._problem import Answer, Differentiated, Problem
from percuss._report import Report
from percuss._run import real, whole
from percuss._walk import SETUPS, NoAnswer, Walker

# The class, the order and whether the method wants a Jacobian, of SciPy's methods.
_METHODS: dict[str, tuple[str, int | None, bool]] = {
    "RK23": ("explicit", 3, False),
    "RK45": ("explicit", 5, False),
    "DOP853": ("explicit", 8, False),
    "LSODA": ("multistep", None, True),
    "Radau": ("implicit", 5, True),
    "BDF": ("multistep", None, True),
}

Solver = Callable[[Problem], Answer]


@dataclass
class Declared:
    """A solver of problems, and what is declared of it."""

    solve: Solver
    name: str
    library: str
    version: str
    kind: str | None
    order: int | None
    stepping: str
    differences: bool = False

    def __post_init__(self) -> None:
        for what in ("name", "library", "version", "stepping"):
            if not isinstance(text := getattr(self, what), str):
                raise TypeError(f"{what} = {text!r} is not accepted: a text is")
        if self.kind is not None and not isinstance(self.kind, str):
            raise TypeError(f"kind = {self.kind!r} is not accepted: a text is")
        if self.order is not None:
            self.order = whole("order", self.order, 1, 64)

    def at(self, tolerance: float, folder: str = "") -> dict[str, Any]:
        """What the judge is told of answers at a tolerance."""
        return {
            "name": self.name,
            "library": self.library,
            "version": self.version,
            "language": f"Python {platform.python_version()}",
            "class": self.kind,
            "order": self.order,
            "stepping": self.stepping,
            "differences": self.differences,
            "tolerance": tolerance,
            "folder": folder,
            "failures": {},
            "work": {},
        }


@dataclass
class Answered:
    """The answers of a solver at one tolerance, in the files of a folder."""

    declared: Declared
    tolerance: float
    folder: Path
    failures: dict[str, str] = field(default_factory=dict)
    work: dict[str, tuple[int, int, int, int]] = field(default_factory=dict)

    def answer(self, problem: Problem) -> None:
        """Asks the solver, and keeps what it answers, or why it does not."""
        try:
            answer = self.declared.solve(problem)
            if not isinstance(answer, Answer):
                raise NoAnswer(f"a {type(answer).__name__} is no answer: percuss.Answer is")
            write(self.folder, problem, answer)
            if answer.work is not None:
                self.work[problem.case] = _counts(answer.work)
        except NoAnswer as why:
            self.failures[problem.case] = _line(str(why))
        except Exception as error:  # what a solver raises is the reason of its row
            self.failures[problem.case] = _line(f"{type(error).__name__}: {_text(error)}")

    def told(self) -> dict[str, Any]:
        """What the judge is told of these answers."""
        told = self.declared.at(self.tolerance, str(self.folder))
        return told | {"failures": self.failures, "work": self.work}


def _counts(work: Sequence[int]) -> tuple[int, int, int, int]:
    """The four counts of an answer's work."""
    counts = tuple(int(it) for it in work)
    if len(counts) != 4 or not all(0 <= it < 2**64 for it in counts):
        raise NoAnswer(f"work = {work!r} is not accepted: four counts from 0 on are")
    return counts


def _text(error: Exception) -> str:
    """What an exception says; nothing where it cannot."""
    try:
        return str(error)
    except Exception:  # of a solver's own class
        return ""


def _line(text: str) -> str:
    """A text in one line, of characters that UTF-8 has."""
    return " ".join(text.encode("utf-8", "replace").decode("utf-8").split()) or "no reason was given"


def write(folder: Path, problem: Problem, answer: Answer) -> None:
    """Write an answer into the two files of a case."""
    states = problem.states
    before = [f"before.{name}" for name in states]
    events = list(answer.events)
    if answer.ending is not None and answer.ending not in (known := _percuss.ending_names()):
        raise NoAnswer(f"ending = {answer.ending!r} is not accepted: {', '.join(known)} are")
    has_before = all(it.before is not None for it in events)

    def numbers(values: Any) -> list[float]:
        return [float(it) for it in np.asarray(values, dtype=np.float64).reshape(-1)]

    with open(folder / f"{problem.case}.events.csv", "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time", "event", "mode", *states, *(before if has_before else [])])
        mode = problem.mode
        for event in events:
            tail = numbers(event.before) if has_before else []
            rows.writerow([float(event.time), event.name, event.mode, *numbers(event.state), *tail])
            mode = event.mode
        if answer.ending is not None:
            end_state = numbers(answer.end_state)
            tail = end_state if has_before else []
            time = math.nan if answer.end_time is None else float(answer.end_time)
            rows.writerow([time, answer.ending, mode, *end_state, *tail])
    if answer.gradients is not None:
        _write_gradients(folder, problem, [it.name for it in events], answer.gradients)
    if answer.samples is None:
        return
    samples, asked = np.asarray(answer.samples, dtype=np.float64), len(problem.sample_times)
    if len(samples) > asked:
        raise NoAnswer(f"{len(samples)} samples are not accepted: {asked} are, one for each time")
    with open(folder / f"{problem.case}.samples.csv", "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time", *states])
        for time, state in zip(problem.sample_times, samples):
            rows.writerow([float(time), *numbers(state)])


def _write_gradients(
    folder: Path, problem: Problem, events: Sequence[str], gradients: Sequence[Differentiated]
) -> None:
    """Write the derivatives of an answer with these events into the third file of a case."""
    size = len(problem.states)

    def cells(values: Any) -> list[float | str]:
        numbers = np.asarray(values, dtype=np.float64).reshape(-1)
        return ["" if math.isnan(it) else float(it) for it in numbers]

    with open(folder / f"{problem.case}.gradients.csv", "w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["n", "event", "wrt", "dtime", *(f"d{name}" for name in problem.states)])
        for by in gradients:
            times = np.asarray(by.times, dtype=np.float64).reshape(len(events))
            states = np.asarray(by.states, dtype=np.float64).reshape(len(events), size)
            for n, (name, time, state) in enumerate(zip(events, times, states), start=1):
                rows.writerow([n, name, by.wrt, *cells(time), *cells(state)])
            rows.writerow([len(events) + 1, "end", by.wrt, "", *cells(by.end)])


def case_names(pattern: str | Iterable[str] = "*") -> list[str]:
    """List the cases whose names match a pattern such as ``graze*``, or one of several.

    Raises
    ------
    ValueError
        A pattern that matches nothing.

    Examples
    --------
    >>> import percuss
    >>> percuss.case_names("small-*")
    ['small-b']
    """
    return matching(pattern, _percuss.case_names())


def matching(pattern: str | Iterable[str], names: Sequence[str]) -> list[str]:
    """The names of cases that match one of some patterns, each of which has to match one."""
    patterns = [pattern] if isinstance(pattern, str) else list(pattern)
    if not patterns:
        raise ValueError("cases are empty: a pattern such as 'graze*' is accepted")
    for it in patterns:
        if not isinstance(it, str):
            raise TypeError(f"cases = {it!r} is not accepted: a pattern such as 'graze*' is")
        if not fnmatch.filter(names, it):
            raise ValueError(f"cases = {it!r} matches none of the {len(names)} cases")
    return [name for name in names if any(fnmatch.fnmatchcase(name, it) for it in patterns)]


def problem(case: str, tolerance: float = 1e-6) -> Problem:
    """Read what a case asks.

    Examples
    --------
    >>> import percuss
    >>> percuss.problem("small-b").states
    ['p', 'y', 'q', 'v']
    """
    if case not in _percuss.case_names():
        raise KeyError(f"{case!r} is no case of percuss: case_names() lists them")
    return Problem(_percuss.Cases({case}).ask(case), real("tolerance", tolerance))


def score(
    solver: Callable[..., Any],
    *,
    method: str | None = None,
    rtol: float | Sequence[float] = (1e-6, 1e-9),
    cases: str | Iterable[str] = "*",
    setup: str | Sequence[str] = SETUPS,
    options: dict[str, Any] | None = None,
    name: str | None = None,
    library: str | None = None,
    version: str | None = None,
    kind: str | None = None,
    order: int | None = None,
    stepping: str = "adaptive",
    out: str | Path | None = None,
    baseline: str | Path | Sequence[str | Path] = (),
    progress: Callable[[int, int], object] | None = None,
) -> Report:
    """Judge a solver on the cases of percuss.

    Parameters
    ----------
    solver : callable
        A function with the signature of ``scipy.integrate.solve_ivp``, with events; or one that
        takes a :class:`Problem` and returns an :class:`Answer`.
    method : str, optional
        The method, as `solver` takes it.
    rtol : float or sequence of float, optional
        The tolerances, each of which is the absolute one too.
    cases : str or iterable of str, optional
        Patterns of the cases' names, such as ``"graze*"``.
    setup : str or sequence of str, optional
        For a `solve_ivp`: ``documentation``, as its documentation shows, ``experts``, as experts
        set it up, or both.
    options : dict, optional
        Further arguments of a `solve_ivp`; they win over those of the set-up.
    name, library, version : str, optional
        Who answers, for the report.
    kind : {'explicit', 'implicit', 'multistep', 'taylor'}, optional
        The class of the method, which decides how far it may be off; known of SciPy's methods.
    order : int, optional
        The order of the method; known of SciPy's.
    stepping : {'adaptive', 'per-step', 'fixed'}, optional
        How the tolerance holds the error.
    out : path, optional
        A folder for the files of the report.
    baseline : path or sequence of paths, optional
        An earlier report.json, or several, of which the best counts figure by figure: what is
        worse stands in ``Report.worse``.
    progress : callable, optional
        Called with the number of answers made and their whole number.

    Returns
    -------
    Report

    Raises
    ------
    ValueError
        No case that matches, a tolerance outside 1e-16 to 0.1, and an unknown set-up or class.

    Examples
    --------
    >>> import percuss
    >>> from scipy.integrate import solve_ivp
    >>> report = percuss.score(solve_ivp, method="DOP853", rtol=1e-6, cases="small-b")
    >>> sorted(report.rank)
    ['scipy-dop853', 'scipy-dop853-default']
    """
    if not callable(solver):
        raise TypeError(f"{solver!r} is no solver: a callable is accepted")
    tolerances = tolerances_of(rtol)
    whose = Whose(solver, method, library, version)
    declared = [
        Declared(solve, name_, whose.library, whose.version, *whose.traits(kind, order), stepping)
        for solve, name_ in _solvers(solver, whose, setup, options or {}, name)
    ]
    paths = [baseline] if isinstance(baseline, (str, Path)) else baseline
    earlier = [_earlier(Path(path)) for path in paths]
    if out is not None:
        # A folder that cannot be made is told before the work begins.
        Path(out).mkdir(parents=True, exist_ok=True)
    chosen = _percuss.Cases(set(case_names(cases)))
    for it in declared:
        # What is wrong with it is said before the work begins.
        chosen.beyond_budget(it.at(tolerances[0]))

    def beyond_budget(method: Answered) -> set[str]:
        return set(chosen.beyond_budget(method.declared.at(method.tolerance)))

    with tempfile.TemporaryDirectory(prefix="percuss-answers-") as folder:
        texts = {name: chosen.ask(name) for name in chosen.names}
        answered = answers(texts, declared, tolerances, Path(folder), progress, beyond_budget)
        owned = None if out is not None else tempfile.TemporaryDirectory(prefix="percuss-report-")
        target = Path(out if owned is None else owned.name)  # type: ignore[arg-type]
        worse = chosen.judge([it.told() for it in answered], str(target), earlier)
    return Report(target, owned, worse)


def _earlier(path: Path) -> str:
    """The text of an earlier report."""
    text = path.read_text(encoding="utf-8")
    try:
        is_report = "results" in json.loads(text)
    except (ValueError, TypeError):
        is_report = False
    if not is_report:
        raise ValueError(f"baseline = {str(path)!r} is not accepted: a report.json is")
    return text


def tolerances_of(rtol: float | Sequence[float]) -> list[float]:
    """The tolerances, each once."""
    tolerances = [real("rtol", it) for it in np.atleast_1d(np.asarray(rtol, dtype=object))]
    if not tolerances or len(set(tolerances)) < len(tolerances):
        raise ValueError(f"rtol = {rtol!r} is not accepted: tolerances, each once, are")
    return tolerances


class Whose:
    """Whose a solver is: its library with its version, and its method."""

    def __init__(
        self,
        solver: Callable[..., Any],
        method: str | None,
        library: str | None,
        version: str | None,
    ) -> None:
        if method is not None and not isinstance(method, str):
            raise TypeError(f"method = {method!r} is not accepted: a name is")
        module = getattr(solver, "__module__", None) or type(solver).__module__
        self.library = library or module.split(".")[0].lstrip("_") or "own"
        self.version = version or _version(self.library)
        self.method = method
        # SciPy's own default.
        self.known = _METHODS.get("RK45" if method is None else method) if self.is_scipy else None

    @property
    def is_scipy(self) -> bool:
        return self.library == "scipy"

    def traits(self, kind: str | None, order: int | None) -> tuple[str | None, int | None]:
        """The class and the order: those given, or those that are known."""
        known = self.known or (None, None, False)
        return kind or known[0], order if order is not None or kind else known[1]

    def name(self, solver: Callable[..., Any]) -> str:
        own = self.method or ("rk45" if self.is_scipy else getattr(solver, "__name__", "solver"))
        text = re.sub(r"[^a-z0-9_.+-]+", "-", f"{self.library}-{own}".lower()).strip("-")
        return text[:32]


def _version(library: str) -> str:
    try:
        return metadata.version(library)
    except Exception:  # a module that belongs to no distribution
        return str(getattr(sys.modules.get(library), "__version__", "unknown"))


def _solvers(
    solver: Callable[..., Any],
    whose: Whose,
    setup: str | Sequence[str],
    options: dict[str, Any],
    name: str | None,
) -> list[tuple[Solver, str]]:
    """The solvers of problems, with their names: one for each set-up of a `solve_ivp`."""
    own = name or whose.name(solver)
    setups = [setup] if isinstance(setup, str) else list(setup)
    for it in setups:
        if it not in SETUPS:
            raise ValueError(f"setup = {it!r} is not accepted: {' and '.join(SETUPS)} are")
    if not _takes_solve_ivp(solver):
        if whose.method is not None or options:
            raise TypeError("method and options are accepted of a solver like solve_ivp alone")
        return [(solver, own)]
    if not setups:
        raise ValueError(f"setup is empty: {' and '.join(SETUPS)} are accepted")
    has_jacobian = whose.known is not None and whose.known[2]
    names = {"experts": own, "documentation": f"{own}-default"}
    return [
        (Walker(solver, whose.method, options, it, has_jacobian), names[it])
        for it in dict.fromkeys(setups)
    ]


def _takes_solve_ivp(solver: Callable[..., Any]) -> bool:
    """Whether a callable takes a function, a span of time and a start, as `solve_ivp` does."""
    try:
        parameters = inspect.signature(solver).parameters.values()
    except (TypeError, ValueError):  # of a callable that is not Python's
        return True
    plain = [it for it in parameters if it.kind in (it.POSITIONAL_ONLY, it.POSITIONAL_OR_KEYWORD)]
    wanted = [it for it in plain if it.default is it.empty]
    if len(wanted) == 1:  # a problem, whatever may follow it
        return False
    return len(wanted) >= 3 or any(it.kind is it.VAR_POSITIONAL for it in parameters)


def answers(
    texts: Mapping[str, str],
    declared: Sequence[Declared],
    tolerances: Sequence[float],
    folder: Path,
    progress: Callable[[int, int], object] | None,
    beyond_budget: Callable[[Answered], Container[str]] = lambda _: (),
) -> list[Answered]:
    """The answers of all solvers at all tolerances to the questions of these cases. Those beyond
    the budget are not asked, as the quick suite does not ask them: this is told without an
    answer."""
    answered = []
    for n, (it, tolerance) in enumerate((it, rtol) for it in declared for rtol in tolerances):
        own = folder / str(n)
        own.mkdir()
        answered.append(Answered(it, tolerance, own))
    done, whole = 0, len(texts) * len(answered)
    for method in answered:
        beyond = beyond_budget(method)
        for name, text in texts.items():
            if name in beyond:
                method.failures[name] = "beyond the budget"
            else:
                method.answer(Problem(text, method.tolerance))
            done += 1
            if progress is not None:
                progress(done, whole)
    return answered

"""Scores: the judgement is the command's."""

import dataclasses
import json
import sys

import numpy as np
import pytest

import percuss

scipy_integrate = pytest.importorskip("scipy.integrate")
solve_ivp = scipy_integrate.solve_ivp

KEYS = (
    "case",
    "events_judged",
    "events_right",
    "events_missed",
    "events_spurious",
    "events_wrong_mode",
    "event_time_error",
    "state_error",
    "verdict",
    "why",
)


def test_answers_are_judged_as_the_command_judges_files(command, tmp_path):
    """The answers of a solver, written where the command reads them."""
    from percuss._problem import Problem
    from percuss._score import write
    from percuss._walk import Walker

    walker = Walker(solve_ivp, "DOP853", {}, "experts", False)
    for name in percuss.case_names("graze-*")[:2] + ["small-b"]:
        write(tmp_path, problem := percuss.problem(name, 1e-6), walker(problem))
        assert isinstance(problem, Problem)
    words = ["--name", "scipy-dop853", "--tolerance", "1e-6", "--answers", str(tmp_path)]
    words += ["--method", "explicit", "--order", "8", "--out", str(tmp_path / "report")]
    code, _, err = command("score", *words, "-c", "^(graze-|small-b$)", "--allow-unanswered")
    assert code in (0, 1), err
    told = json.loads((tmp_path / "report/report.json").read_text())["results"]
    told = {row["case"]: row for row in told if row["verdict"] != "unavailable"}
    report = percuss.score(solve_ivp, method="DOP853", rtol=1e-6, cases=list(told), setup="experts")
    assert len(report.rows) == len(told) == 3
    for row in report.rows:
        assert {key: row[key] for key in KEYS} == {key: told[row["case"]][key] for key in KEYS}
        assert row["rhs_evaluations"] > 100


def test_the_two_set_ups_of_scipy_differ_as_documented():
    report = percuss.score(solve_ivp, method="DOP853", rtol=1e-6, cases="small-b")
    right = {row["engine"]: row["events_right"] for row in report.rows}
    # docs/SCORE_YOUR_INTEGRATOR.md: two events are stepped over where steps are not kept short.
    assert right["scipy-dop853"] > right["scipy-dop853-default"] == 2
    with pytest.raises(percuss.ScoreFailure, match="small-b: scipy-dop853-default at 1e-6: fail"):
        report.raise_for_failures()
    percuss.score(solve_ivp, rtol=1e-6, cases="table1-first-row").raise_for_failures()


def test_a_row_is_that_of_the_program(command, repository, tmp_path):
    """The same calls as those of the program that percuss runs: every figure is the same."""
    program = repository / "validation/programs/python/scipy_solve_ivp.py"
    programs = tmp_path / "programs.toml"
    words = json.dumps([sys.executable, str(program)])
    programs.write_text(f'[[program]]\nname = "scipy"\ncommand = {words}\ntimeout_s = 300\n')
    chosen = ["-e", "^scipy-rk45(-default)?$", "-c", "^(small-b|table1-first-row)$"]
    out = tmp_path / "out"
    code, _, err = command("validate", "--programs", str(programs), *chosen, "--out", str(out))
    assert code in (0, 1), err
    told = json.loads((out / "report.json").read_text())["results"]
    report = percuss.score(
        solve_ivp,
        method="RK45",
        rtol=[1e-6, 1e-9, 1e-12],
        cases=["small-b", "table1-first-row"],
    )
    rows = {(row["case"], row["engine"], row["tolerance"]): row for row in report.rows}
    assert len(told) == len(rows) == 12
    for row in told:
        own_row = rows[row["case"], row["engine"], row["tolerance"]]
        # Only the clock differs.
        assert own_row | {"wall_ns": row["wall_ns"], "own_ns": row["own_ns"]} == row


def own(problem):
    raise RuntimeError(f"no idea\nof {problem.case}")


def test_a_solver_that_raises_is_an_error_with_its_reason():
    report = percuss.score(own, rtol=1e-6, cases="small-b", name="own")
    (row,) = report.rows
    assert row["verdict"] == "error" and "RuntimeError: no idea of small-b" in row["why"]


def test_a_solver_that_answers_nonsense_is_an_error():
    def nonsense(problem):
        samples = np.full((len(problem.sample_times), len(problem.states)), np.nan)
        return percuss.Answer(events=[], samples=samples)

    (row,) = percuss.score(nonsense, rtol=1e-6, cases="small-b", name="own").rows
    assert row["verdict"] == "error" and "nan" in row["why"].lower()
    (row,) = percuss.score(lambda it: 3, rtol=1e-6, cases="small-b", name="own").rows
    assert row["verdict"] == "error" and "int is no answer" in row["why"]


class Silent(Exception):
    def __str__(self):
        raise RuntimeError("no text")


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (Silent(), "Silent"),
        (ValueError("\ud800"), "ValueError: ?"),
        ({"work": (1, 2, 3)}, "four counts"),
        ({"work": (1, 2, 3, -4)}, "four counts"),
        ({"work": (1, 2, 3, 2**64)}, "four counts"),
        ({"ending": "impact"}, "accumulation, leaves-domain, no-progress"),
        ({"samples": np.zeros((10**6, 4))}, "1000000 samples are not accepted"),
    ],
)
def test_an_answer_that_cannot_be_read_is_the_error_of_its_row(fault, said):
    def solve(problem):
        if isinstance(fault, Exception):
            raise fault
        answer = stepped(problem)
        return dataclasses.replace(answer, **fault)

    (row,) = percuss.score(solve, rtol=1e-6, cases="small-b", name="own").rows
    assert row["verdict"] == "error" and said in row["why"]


def test_events_may_come_from_an_iterator():
    def solve(problem):
        answer = stepped(problem)
        return percuss.Answer(events=iter(list(answer.events)), samples=answer.samples)

    declared = {"rtol": 1e-6, "cases": "small-b", "name": "own", "kind": "explicit", "order": 8}
    (row,) = percuss.score(solve, **declared).rows
    assert row["verdict"] == "pass", row["why"]


def test_options_win_over_the_set_up():
    seen = set()

    def spied(fun, t_span, y0, **options):
        seen.add((options["rtol"], options["atol"]))
        return solve_ivp(fun, t_span, y0, **options)

    percuss.score(spied, rtol=1e-6, cases="small-b", setup="experts", options={"atol": 1e-9})
    assert seen == {(1e-6, 1e-9)}


@pytest.mark.parametrize("nothing", [{"cases": []}, {"setup": []}])
def test_nothing_selected_is_refused(nothing):
    with pytest.raises(ValueError, match="empty"):
        percuss.score(solve_ivp, **nothing)


def test_a_solver_of_problems_is_judged_right_where_it_is():
    report = percuss.score(
        stepped, rtol=1e-6, cases="small-b", name="stepped", kind="explicit", order=8
    )
    (row,) = report.rows
    assert (row["verdict"], row["events_right"]) == ("pass", row["events_judged"]), row["why"]


ANSWERS = {}


def stepped(problem):
    """The answer of `walked`, made once for each case because it takes seconds."""
    if problem.case not in ANSWERS:
        ANSWERS[problem.case] = walked(problem)
    return ANSWERS[problem.case]


def walked(problem):
    """Steps of 1/64 by SciPy's DOP853 at 1e-12, with events by bisection in each."""
    from scipy.optimize import brentq

    t, mode, z = 0.0, problem.mode, problem.state
    events, samples = [], []
    wanted = list(problem.sample_times)
    while t < problem.horizon:
        rule = problem.modes[mode]
        end = min(t + 2**-6, problem.horizon)
        dense = solve_ivp(
            lambda s, w: problem.rates(mode, s, w),
            (t, end),
            z,
            "DOP853",
            rtol=1e-12,
            atol=1e-12,
            dense_output=True,
        ).sol
        found = []
        for event in rule.events:
            value = lambda s: event.guard @ problem.wide(s, dense(s))  # noqa: B023, E731
            # Just after the step's begin: a guard that is zero there has moved away.
            begin = t + 1e-9
            if value(begin) < 0 < value(end):
                found.append((brentq(value, begin, end, xtol=1e-14), event))
        until = min([s for s, _ in found], default=end)
        while wanted and wanted[0] <= until and (wanted[0] < until or not found):
            samples.append(dense(wanted.pop(0)))
        before, t = dense(until), until
        z = before
        if found:
            event = min(found, key=lambda it: it[0])[1]
            mode, z = problem.after(event, t, before)
            events.append(percuss.Happened(t, event.name, mode, z, before))
    samples += [z] * len(wanted)
    return percuss.Answer(events, np.array(samples))


def test_reports_are_files_and_tables(tmp_path):
    report = percuss.score(
        solve_ivp, method="RK45", rtol=[1e-6, 1e-9], cases="small-b", setup="experts"
    )
    assert [row["tolerance"] for row in report.rows] == [1e-6, 1e-9]
    page = report.html(tmp_path / "page.html").read_text()
    assert page.startswith("<!") and "small-b" in page
    assert (report.save(tmp_path / "all") / "junit.xml").exists()
    assert "small-b" in report._repr_html_() and "small-b" in str(report)
    pandas = pytest.importorskip("pandas")
    assert isinstance(report.to_pandas(), pandas.DataFrame)


def test_the_walk_is_that_of_the_programs(repository):
    """The program that percuss runs for Python's libraries is the module that walks the modes."""
    program = repository / "validation/programs/python/percuss_program.py"
    own_module = repository / "python/percuss/_program.py"
    assert own_module.read_bytes() == program.read_bytes()


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"y_events": lambda it: [np.empty((0, 4)) for _ in it.t_events]}, "no event in t_events"),
        ({"t": lambda it: 0 * it.t, "status": lambda _: 0}, "the end of the span"),
    ],
)
def test_what_a_result_lacks_is_the_reason(changes, why):
    def solve(fun, t_span, y0, method="RK45", **options):
        found = scipy_integrate.solve_ivp(fun, t_span, y0, method=method, **options)
        for name, change in changes.items():
            found[name] = change(found)
        return found

    rows = percuss.score(solve, rtol=1e-6, cases="small-b", name="own").rows
    assert all(row["verdict"] == "error" and why in row["why"] for row in rows)

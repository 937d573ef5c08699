"""The pytest plugin."""

import json

import pytest

pytest.importorskip("scipy")

SOLVER = "--percuss=scipy.integrate:solve_ivp"
ASKED = ("--percuss-method=RK45", "--percuss-cases=table1-first-row", "--percuss-rtol=1e-6")
WRONG = ("--percuss-method=DOP853", "--percuss-cases=small-b", "--percuss-rtol=1e-6")


def test_each_row_is_a_test(pytester):
    pytester.makepyfile("def test_own():\n    pass\n")
    done = pytester.runpytest_subprocess(SOLVER, *ASKED, "-v")
    done.assert_outcomes(passed=2)
    done.stdout.fnmatch_lines(["*table1-first-row?scipy-rk45-1e-06*"])


def test_a_row_out_of_bounds_fails_with_its_reason(pytester):
    done = pytester.runpytest_subprocess(SOLVER, *WRONG, "--percuss-setup=documentation")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["*small-b: scipy-dop853-default at 1e-6: fail*"])


def test_declared_shortcomings_have_to_fail(pytester):
    lines = "small-b@1e-6 steps over two events\ntable1-first-row it has none\n"
    known = f"--percuss-known={pytester.makefile('.txt', known=lines)}"
    pytester.runpytest_subprocess(SOLVER, *WRONG, known).assert_outcomes(xfailed=1)
    pytester.runpytest_subprocess(SOLVER, *ASKED, known).assert_outcomes(failed=1)


@pytest.mark.parametrize(
    ("line", "told"), [("small-c it", "small-c is no case"), ("small-b@low", "a number")]
)
def test_a_misspelt_shortcoming_is_refused(pytester, line, told):
    known = f"--percuss-known={pytester.makefile('.txt', known=line)}"
    done = pytester.runpytest_subprocess(SOLVER, *WRONG, known)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines([f"*line 1: {line.split()[0]}: {told}*"])


def test_the_rule_of_steps_is_that_of_score(pytester):
    done = pytester.runpytest_subprocess(SOLVER, *ASKED, "--percuss-stepping=per-step")
    done.assert_outcomes(passed=1)
    done = pytester.runpytest_subprocess(SOLVER, *ASKED, "--percuss-stepping=sometimes")
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines(["*stepping = *sometimes*per-step and fixed are*"])


def test_rows_are_shown_without_being_run(pytester):
    done = pytester.runpytest_subprocess(SOLVER, *ASKED, "--collect-only")
    done.stdout.fnmatch_lines(["*table1-first-row?scipy-rk45-1e-06*", "*1 test collected*"])


def test_the_report_is_a_folder(pytester):
    pytester.runpytest_subprocess(SOLVER, *ASKED, "--percuss-out=report").assert_outcomes(passed=1)
    assert (pytester.path / "report/report.html").exists()


def test_a_row_that_is_worse_than_the_baseline_fails(pytester):
    loose = [it.replace("1e-6", "1e-4") for it in ASKED]
    pytester.runpytest_subprocess(SOLVER, *ASKED, "--percuss-out=first")
    path = pytester.path / "first/report.json"
    same = pytester.runpytest_subprocess(SOLVER, *ASKED, f"--percuss-baseline={path}")
    same.assert_outcomes(passed=2)
    # The earlier run was better: its errors, made smaller, are what a better method had.
    better = json.loads(path.read_text())
    for row in better["results"]:
        row["state_error"]["max"] *= 1e-3
    path.write_text(json.dumps(better))
    worse = pytester.runpytest_subprocess(SOLVER, *ASKED, f"--percuss-baseline={path}")
    worse.assert_outcomes(passed=1, failed=1)
    worse.stdout.fnmatch_lines(["*worse than the baseline: table1-first-row*"])
    other = pytester.runpytest_subprocess(SOLVER, *loose, f"--percuss-baseline={path}")
    assert other.ret == pytest.ExitCode.USAGE_ERROR
    gone = pytester.runpytest_subprocess(SOLVER, *ASKED, "--percuss-baseline=no-such.json")
    assert gone.ret == pytest.ExitCode.USAGE_ERROR
    gone.stderr.fnmatch_lines(["*no-such.json*"])


def test_without_the_option_nothing_changes(pytester):
    pytester.makepyfile("def test_own():\n    pass\n")
    pytester.runpytest_subprocess().assert_outcomes(passed=1)


@pytest.mark.parametrize("name", ["scipy", "no.such:solve", "scipy.integrate:no_such"])
def test_a_name_of_no_solver_is_told(pytester, name):
    done = pytester.runpytest_subprocess(f"--percuss={name}")
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    done.stderr.fnmatch_lines([f"*--percuss={name}*"])

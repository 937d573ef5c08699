"""Ctrl-C ends long work, and callbacks that fail end nothing else."""

import signal
import subprocess
import sys
import time

import pytest

WORK = {
    "events": "percuss.systems['rigid-impact-oscillator'].events(count=10**8)",
    "f64": "percuss.systems['rigid-impact-oscillator'].simulate(count=10**8)",
    "f64 in returns": "percuss.systems['rigid-impact-oscillator'].simulate(returns=10**8)",
    "f64 in a transient": "percuss.systems['rigid-impact-oscillator']"
    ".simulate(count=1, transient=10**8)",
    "f64 in a transient of events": "percuss.systems['rigid-impact-oscillator']"
    ".simulate(count=1, transient=10**8, section='impact')",
    "iteration": "[None for _ in percuss.systems['rigid-impact-oscillator'].iterate()]",
    "oscillator": "percuss.Oscillator().simulate(periods=10**9)",
    "section": "percuss.Oscillator().poincare(periods=10**8)",
    "exponents": "percuss.Oscillator().lyapunov(periods=10**9)",
    "returns": "percuss.systems['rigid-impact-oscillator'].poincare(returns=10**8)",
    "exponents of returns": "percuss.systems['rigid-impact-oscillator'].lyapunov(returns=10**9)",
    "orbit after a transient": "percuss.systems['rigid-impact-oscillator']"
    ".orbit(1, transient=10**8)",
    "branch after a transient": "percuss.systems['rigid-impact-oscillator']"
    ".continue_('A', .5, .9, period=1, transient=10**8)",
    "basins": "percuss.Oscillator().basins((-1, 1), (-1, 1), grid=4000, transient=10**4)",
    "orbits": "percuss.systems['rigid-impact-oscillator']"
    ".orbits(50, (-1, .4), (-1, 1), grid=300)",
    "basins of a system": "percuss.systems['rigid-impact-oscillator']"
    ".basins((-1, .4), (-1, 1), grid=4000, transient=1000)",
    "a value of a system's diagram": "percuss.systems['rigid-impact-oscillator']"
    ".bifurcation('A', [.5], returns=1, transient=10**9 - 1)",
    "diagram": "percuss.Oscillator().bifurcation("
    "'b', np.linspace(0, .3, 1000), transient=10**7, periods=1)",
    "a value of a diagram": "percuss.Oscillator().bifurcation("
    "'b', [0, .3], transient=10**9 - 1, periods=1)",
}


@pytest.mark.parametrize("name", WORK)
def test_ctrl_c_ends_long_work(name):
    """Each of these would take minutes to hours."""
    # A job in the background inherits that it ignores the signal.
    heard = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)"
    code = f"{heard}\nimport numpy as np, percuss\nprint('begun', flush=True)\n{WORK[name]}"
    work = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert work.stdout.readline() == "begun\n"
    time.sleep(0.5)
    work.send_signal(signal.SIGINT)
    _, err = work.communicate(timeout=60)
    assert err.strip().endswith("KeyboardInterrupt"), err


def test_what_a_callback_raises_reaches_no_other_row():
    import percuss

    def solve(problem):
        if problem.case == "small-b":
            raise ZeroDivisionError("of its own")
        return percuss.Answer([])

    report = percuss.score(solve, rtol=1e-6, cases=["small-b", "graze-miss-1e-3"], name="own")
    why = {row["case"]: row["why"] for row in report.rows}
    assert "ZeroDivisionError: of its own" in why["small-b"]
    assert "ZeroDivisionError" not in why["graze-miss-1e-3"]


def test_ctrl_c_in_a_callback_is_not_a_reason():
    import percuss

    def solve(problem):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        percuss.score(solve, rtol=1e-6, cases="small-b", name="own")

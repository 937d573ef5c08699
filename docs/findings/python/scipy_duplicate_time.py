"""SciPy: a terminal event at the very beginning of a step, with dense output (scipy/scipy issues 17066
and 19418). The guard jumps just after t = 1/2, at which a step ends."""

import scipy
from scipy.integrate import solve_ivp


def guard(t, y):
    return 1e-300 if t <= 0.5 else -1.0


guard.terminal = True
print("scipy", scipy.__version__, "- expected: the run ends at t = 0.5")
try:
    found = solve_ivp(
        lambda t, y: [1.0], (0, 1), [0.0], events=guard, dense_output=True, max_step=0.125,
        first_step=0.125,
    )
    print("ended at", found.t[-1], "after", found.t[-2])
except ValueError as why:
    print("ValueError:", why)

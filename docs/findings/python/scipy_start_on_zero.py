"""SciPy: a guard that is zero where the run begins is an event there, if it then goes the way that
counts, and hides the next crossing from a program that restarts at events."""

import scipy
from scipy.integrate import solve_ivp


def ground(t, y):
    return y[0]


ground.terminal, ground.direction = True, 0
print("scipy", scipy.__version__, "- a ball is thrown up from the ground and lands at t = 2")
for direction in (0, -1):
    ground.direction = direction
    found = solve_ivp(lambda t, y: [y[1], -1.0], (0, 3), [0.0, 1.0], events=ground, rtol=1e-9)
    print(f"direction {direction}: {found.t_events[0]}")

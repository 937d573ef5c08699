"""SciPy: two crossings in one step are none (scipy/scipy issue 9228)."""

import numpy as np
import scipy
from scipy.integrate import solve_ivp


def rates(t, y):
    return 3 * t**2 + 12 * t - 4


def guard(t, y):
    return y[0]


print("scipy", scipy.__version__, "- y crosses zero at -6, -2 and 2")
for tolerance in (1e-3, 1e-6, 1e-9):
    found = solve_ivp(rates, (-8, 4), [-120.0], events=guard, rtol=tolerance, atol=tolerance)
    print(f"tolerance {tolerance:.0e}: {np.round(found.t_events[0], 6)}")
found = solve_ivp(rates, (-8, 4), [-120.0], events=guard, max_step=1.0)
print("a longest step of 1:", np.round(found.t_events[0], 6))

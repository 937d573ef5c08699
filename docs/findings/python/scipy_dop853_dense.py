"""SciPy's DOP853 where a mode that has decayed limits the steps: what is between their ends."""

import numpy as np
from scipy.integrate import solve_ivp


def rates(t, z):
    """A free oscillation, and a mode that decays."""
    return [z[1], -z[0], -20 * z[2]]


def exact(t):
    return np.array([np.cos(t), -np.sin(t), np.exp(-20 * t)])


t = np.linspace(0, 20, 200_001)
for method in ("RK45", "DOP853"):
    for tol in (1e-6, 1e-9):
        run = solve_ivp(
            rates, (0, 20), [1.0, 0.0, 1.0], method, rtol=tol, atol=tol, dense_output=True
        )
        ends = np.abs(run.y - exact(run.t)).max()
        between = np.abs(run.sol(t) - exact(t)).max()
        print(f"{method} {tol:.0e}: at the ends of steps {ends:.1e}, between them {between:.1e}")

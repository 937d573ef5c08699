"""The library's own tests."""

import numpy as np
from mylib.adapters import solve


def test_a_pendulum_swings():
    found = solve(lambda t, y: [y[1], -y[0]], (0, 10), [1.0, 0.0], rtol=1e-8, atol=1e-8)
    # A tolerance of 1e-8 a step, over some thousand steps.
    assert abs(found.y[0, -1] - np.cos(10)) < 1e-5

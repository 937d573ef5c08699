"""Bogacki and Shampine, Applied Mathematics Letters 2 (1989) 321, with cubic dense output."""

import numpy as np
from scipy.integrate import DenseOutput, OdeSolver

SAFETY, SMALLEST, LARGEST = 0.9, 0.2, 5.0


class BogackiShampine(OdeSolver):
    """An adaptive method that `solve_ivp` takes as its `method`."""

    def __init__(
        self, fun, t0, y0, t_bound, rtol=1e-3, atol=1e-6, vectorized=False, **_
    ):
        super().__init__(fun, t0, y0, t_bound, vectorized)
        self.rtol, self.atol = rtol, atol
        self.slope = self.fun(t0, self.y)
        size = np.linalg.norm(self.slope / self._scale(self.y, self.y)) + 1e-10
        self.proposed = min(abs(t_bound - t0), 0.1 / size)

    def _scale(self, before, after):
        return self.atol + self.rtol * np.maximum(abs(before), abs(after))

    def _step_impl(self):
        t, y, k1 = self.t, self.y, self.slope
        while True:
            h = self.direction * min(self.proposed, abs(self.t_bound - t))
            if abs(h) < 10 * np.spacing(abs(t)):
                return False, self.TOO_SMALL_STEP
            k2 = self.fun(t + h / 2, y + h / 2 * k1)
            k3 = self.fun(t + 3 * h / 4, y + 3 * h / 4 * k2)
            after = y + h * (2 * k1 + 3 * k2 + 4 * k3) / 9
            k4 = self.fun(t + h, after)
            error = h * (-5 * k1 / 72 + k2 / 12 + k3 / 9 - k4 / 8)
            ratio = np.sqrt(np.mean((error / self._scale(y, after)) ** 2))
            factor = SAFETY * max(ratio, 1e-10) ** (-1 / 3)
            self.proposed = abs(h) * min(LARGEST, max(SMALLEST, factor))
            if ratio < 1:
                self.before, self.ends = (y, k1), (after, k4)
                self.t, self.y, self.slope = t + h, after, k4
                return True, None

    def _dense_output_impl(self):
        return _Cubic(self.t_old, self.t, self.before, self.ends)


class _Cubic(DenseOutput):
    """Hermite's cubic between the ends of a step."""

    def __init__(self, t_old, t, before, ends):
        super().__init__(t_old, t)
        self.before, self.ends = before, ends

    def _call_impl(self, t):
        h = self.t - self.t_old
        x = (np.asarray(t) - self.t_old) / h
        (y0, f0), (y1, f1) = self.before, self.ends
        if x.ndim:
            y0, f0, y1, f1 = (it[:, None] for it in (y0, f0, y1, f1))
        bend = (1 - 2 * x) * (y1 - y0) + (x - 1) * h * f0 + x * h * f1
        return (1 - x) * y0 + x * y1 + x * (x - 1) * bend

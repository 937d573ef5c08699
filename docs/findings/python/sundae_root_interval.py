"""SUNDIALS: a root function that is zero over an interval ends the run with an error
(llnl/sundials issue 881)."""

import numpy as np
import sksundae
from sksundae.cvode import CVODE
from sksundae.ida import IDA


def fill(y, out):
    out[0] = min(max(y[0] - 0.5, 0.0), 0.25) - 0.25


def rates(t, y, out):
    out[0] = 1.0


def residual(t, y, rate, out):
    out[0] = rate[0] - 1.0


def events(t, y, out):
    fill(y, out)


def residual_events(t, y, rate, out):
    fill(y, out)


events.terminal = residual_events.terminal = [False]
print("scikit-sundae", sksundae.__version__, "with SUNDIALS", sksundae.SUNDIALS_VERSION)
print("the guard rises to zero at t = 0.75 and stays there; expected: an event at 0.75, the end at 2")
times = np.array([0.0, 1.0, 2.0])
found = CVODE(rates, eventsfn=events, num_events=1).solve(times, [0.0])
print("CVODE:", found.t_events, "the end at", found.t[-1], "-", found.message)
found = IDA(residual, eventsfn=residual_events, num_events=1).solve(times, [0.0], [1.0])
print("IDA:", found.t_events, "the end at", found.t[-1], "-", found.message)

"""The library as percuss calls it: a function like `scipy.integrate.solve_ivp`."""

from mylib.method import BogackiShampine
from scipy.integrate import solve_ivp


def solve(fun, t_span, y0, **options):
    """Integrate by the library's own method, whatever method is asked for."""
    return solve_ivp(fun, t_span, y0, **{**options, "method": BogackiShampine})

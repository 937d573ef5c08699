"""diffrax: a root finder that needs a bracket works with one condition and fails with a list."""

import diffrax
import jax.numpy as jnp
import optimistix


def level(value):
    return lambda t, y, args, **_: y - value


print("diffrax", diffrax.__version__, "- y = t; expected: t = 0.5 in both cases")
for name, condition in (("one", level(0.5)), ("a list of one", [level(0.5)])):
    try:
        found = diffrax.diffeqsolve(
            diffrax.ODETerm(lambda t, y, args: jnp.ones_like(y)),
            diffrax.Tsit5(),
            0.0,
            10.0,
            2.0,
            jnp.array(0.0),
            event=diffrax.Event(condition, optimistix.Bisection(rtol=1e-5, atol=1e-5)),
        )
        print(f"{name}: the run ends at t = {float(found.ts[-1]):.4f}")
    except AttributeError as why:
        print(f"{name}: AttributeError: {why}")

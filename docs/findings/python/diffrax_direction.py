"""diffrax: events have a direction since 0.7.1 (patrick-kidger/diffrax issue 640): gone."""

import diffrax
import jax
import jax.numpy as jnp
import optimistix

jax.config.update("jax_enable_x64", True)
print("diffrax", diffrax.__version__, "- y = sin t rises through 0.5 at 0.523599, falls at 2.617994")
for direction in (None, True, False):
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: jnp.cos(t)),
        diffrax.Tsit5(),
        0.0,
        6.0,
        0.1,
        jnp.array(0.0),
        stepsize_controller=diffrax.PIDController(rtol=1e-9, atol=1e-9),
        event=diffrax.Event(
            lambda t, y, args, **_: y - 0.5,
            optimistix.Newton(1e-9, 1e-9, optimistix.rms_norm),
            direction,
        ),
    )
    print(f"direction {direction}: the run ends at t = {float(found.ts[-1]):.6f}")

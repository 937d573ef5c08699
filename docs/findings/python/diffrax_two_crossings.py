"""diffrax: two crossings in one step are none (patrick-kidger/diffrax issue 507)."""

import diffrax
import jax
import jax.numpy as jnp
import optimistix

jax.config.update("jax_enable_x64", True)
print("diffrax", diffrax.__version__, "- y = sin t first exceeds 0.99 at t = 1.429257")
for tolerance in (1e-3, 1e-6, 1e-9):
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: jnp.cos(t)),
        diffrax.Dopri8(),
        0.0,
        6.0,
        0.1,
        jnp.array(0.0),
        stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance),
        event=diffrax.Event(
            lambda t, y, args, **_: y - 0.99, optimistix.Newton(1e-9, 1e-9, optimistix.rms_norm)
        ),
    )
    print(f"tolerance {tolerance:.0e}: the run ends at t = {float(found.ts[-1]):.6f}")

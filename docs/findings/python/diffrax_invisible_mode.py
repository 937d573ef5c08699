"""diffrax: steps are chosen by the state alone, so that a derivative may grow without bound."""

import diffrax
import jax
import jax.numpy as jnp

jax.config.update("jax_enable_x64", True)
print("diffrax", diffrax.__version__, "- y' = -50 y, y(0) = a = 0: dy(4)/da = exp(-200) = 1.4e-87")


def end(a, longest):
    return diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: -50.0 * y),
        diffrax.Tsit5(),
        0.0,
        4.0,
        None,
        a,
        stepsize_controller=diffrax.PIDController(rtol=1e-9, atol=1e-9, dtmax=longest),
        adjoint=diffrax.ForwardMode(),
    ).ys[-1]


for longest in (0.5, 0.01):
    _, slope = jax.jvp(lambda a: end(a, longest), (jnp.array(0.0),), (jnp.array(1.0),))
    print(f"steps up to {longest}: {float(slope):.1e}")

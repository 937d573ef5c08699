"""JAX: an event's time found by bisection has the derivative zero."""

import jax
import jax.numpy as jnp
from jax import lax

jax.config.update("jax_enable_x64", True)
print("jax", jax.__version__, "- x' = -g t, x(0) = h, event at x = 0: T = sqrt(2 h/g)")


def height(t, g, h):
    return h - g * t**2 / 2


def bisected(g, h):
    def halve(_, it):
        low, high = it
        middle = (low + high) / 2
        is_below = height(middle, g, h) < 0
        return jnp.where(is_below, low, middle), jnp.where(is_below, middle, high)

    return lax.fori_loop(0, 60, halve, (0.0, 10.0))[1]


def with_newton(g, h):
    t = lax.stop_gradient(bisected(g, h))
    rate = lax.stop_gradient(jax.grad(height)(t, g, h))
    return t - height(t, g, h) / rate


g, h = 2.0, 4.0
print(f"expected: T = 2, dT/dg = {-0.5:.6f}, dT/dh = {0.25:.6f}")
for name, solve in (("bisection", bisected), ("and one step of Newton", with_newton)):
    by_g, by_h = jax.jacfwd(solve, (0, 1))(g, h)
    print(f"{name}: T = {solve(g, h):.6f}, dT/dg = {by_g:.6f}, dT/dh = {by_h:.6f}")

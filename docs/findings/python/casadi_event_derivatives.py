"""CasADi: an event, and its derivatives with it, is located as well at 1e-6 as at 1e-12."""

import casadi as ca

print("casadi", ca.__version__, "- x' = -p x, x(0) = 1, event at x = 0.5: T = ln 2/p")
x, note, t, p = ca.SX.sym("x"), ca.SX.sym("note", 2), ca.SX.sym("t"), ca.SX.sym("p")
both, index = ca.vertcat(x, note), ca.SX.sym("index")
z, u = ca.SX.sym("z", 0), ca.SX.sym("u", 0)
# The transition notes the time, and stops the motion.
stopped = ca.vertcat(x, 1, t)
transition = ca.Function(
    "transition", [index, t, both, z, p, u], [stopped, z], ca.event_in(), ca.event_out()
)
rates = ca.vertcat(-(1 - note[0]) * p * x, 0, 0)
system = {"x": both, "t": t, "p": p, "ode": rates, "zero": x - 0.5}
print("expected: T = 0.346574, dT/dp = -0.173287")
for tolerance in (1e-6, 1e-9, 1e-12):
    options = {"transition": transition, "reltol": tolerance, "abstol": tolerance}
    solve = ca.integrator("solve", "cvodes", system, 0.0, [1.0], options)
    time = float(solve(x0=[1, 0, 0], p=2)["xf"][2])
    forward = solve.forward(1)(x0=[1, 0, 0], p=2, fwd_p=1)["fwd_xf"]
    print(f"{tolerance:.0e}: T = {time:.6f}, forward dT/dp = {float(forward[2]):.6f}")

"""CasADi's experimental events (casadi/casadi issue 4393): one direction, coarse times, and an
error where CVODES has to go back over more than its last step."""

import casadi as ca

x, note, t = ca.SX.sym("x"), ca.SX.sym("note"), ca.SX.sym("t")
index, none = ca.SX.sym("index"), [ca.SX.sym(name, 0) for name in "zpu"]
state = ca.vertcat(x, note)
transition = ca.Function(
    "transition", [index, t, state, *none], [ca.vertcat(x, t), none[0]], ca.event_in(),
    ca.event_out(),
)


def run(solver, ode, zero, times):
    system = {"x": state, "t": t, "ode": ca.vertcat(ode, 0), "zero": zero}
    options = {"transition": transition, "reltol": 1e-10, "abstol": 1e-10}
    try:
        found = ca.integrator("run", solver, system, 0.0, times, options)(x0=[0, -1])
        return f"{float(found['xf'][1, -1]):.9f}"
    except RuntimeError as why:
        return str(why).splitlines()[-1].split(": ")[-1]


print("casadi", ca.__version__, "- an indicator crosses zero; -1.000000000 is no event")
for solver in ("cvodes", "idas"):
    print(f"{solver}: x = t, 0.5 - x falls at 0.5:", run(solver, 1, 0.5 - x, [1.0]))
    print(f"{solver}: x = t, x - 0.5 rises at 0.5:", run(solver, 1, x - 0.5, [1.0]))
    fall, fell = 1 - t, 0.5 + x
    print(f"{solver}: x = t - t^2/2 falls through -0.5 at 2.414213562:", run(solver, fall, fell, [3.0]))

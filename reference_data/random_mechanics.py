"""Random systems as engineers write them: masses, springs, stops, friction, relays."""

import math

from system_text import Chance, Draft, event, mode, rounded, watch

ROUND_MASSES = (0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 1.5, 1, 2, 3, 5, 7, 12, 13, 30, 0.05)
ROUND_STIFFNESSES = (1, 2, 3, 5, 7, 10, 13, 20, 30, 41, 50, 70, 100, 150, 200, 250, 1000, 2500)


def si_quotients(c: Chance) -> Draft:
    """One mass between stops, with quotients of round SI numbers as coefficients."""
    m, k = c.one_of(*ROUND_MASSES), c.one_of(*ROUND_STIFFNESSES)
    omega = math.sqrt(k / m)
    damping = c.one_of(0, 0, round(0.02 * m * omega, 4), 1, 0.1, 3, round(2 * m * omega, 1))
    amplitude = c.one_of(1, 2, 3, 5, 8, 10, 20) / 1000
    stop = amplitude * c.one_of(0.3, 0.5, 0.6, 0.8, 0.9, 1.25, 4 / 3, 2)
    parameters = {"m": m, "k": k, "stop": round(stop, 6), "r": c.one_of(0.5, 0.7, 0.8, 0.9, 1)}
    drag = c.one_of("k*x/m", "k/m*x", "x*k/m")
    force = f"-{drag}"
    if damping:
        parameters["c"] = damping
        force = c.one_of("-(k*x + c*v)/m", f"-{drag} - c*v/m", f"-{drag} - c/m*v", "(-c*v - k*x)/m")
    if c.happens(0.25):
        parameters["g"] = 9.81
        force += " - g"
    hit = event("hit", "x > stop", ["x = stop", "v = -r*v"])
    other = c.one_of(
        [hit],
        [hit, watch("middle", "x > 0")],
        [watch("level", "x > stop", c.one_of("both", "rising", "falling"))],
        [hit, event("other-side", "x < -stop", ["x = -stop", "v = -r*v"])],
    )
    states, equations = ["x", "v"], ["x' = v", f"v' = {force}"]
    start = {"mode": "free", "x": c.one_of(-amplitude, amplitude / 4, 0), "v": c.one_of(0, 0, 0.01)}
    if c.happens(0.15):
        states, equations, start = [*states, "u"], [*equations, "u' = 0"], start | {"u": 1}
    if start["x"] == 0 and start["v"] == 0:
        start["v"] = rounded(amplitude * omega, 2)
    scales = c.one_of(None, [amplitude, rounded(amplitude * omega, 1)])
    if scales is not None and len(states) == 3:
        scales = [*scales, 1]
    until = c.horizon(c.between(1, 6) * 2 * math.pi / omega)
    return Draft(states, [mode("free", equations, *other)], start, until, parameters, scales=scales)


def si_impacts(c: Chance) -> Draft:
    """A forced impact oscillator in SI units, with a rigid or a soft stop."""
    m, k = c.one_of(*ROUND_MASSES), c.one_of(*ROUND_STIFFNESSES)
    natural = math.sqrt(k / m)
    frequency = c.number(0.4, 2.5) * natural
    frequency = c.one_of(round(frequency, 1) or 1.0, frequency)
    force, gap = c.one_of(0.1, 0.5, 1, 2, 5, 10, 20), 0.0
    reach = force / k / max(abs(1 - (frequency / natural) ** 2), 0.2)
    gap = c.one_of(float(f"{reach * c.between(0.05, 0.9):.1g}"), float(f"{reach:.3g}") * 0.4, 0)
    parameters = {"m": m, "k": k, "F": force, "gap": gap, "w": frequency}
    parameters["c"] = c.one_of(round(2 * c.between(0.01, 0.2) * m * natural, 3), 0.5, 2)
    pull = c.one_of("(F*cos - k*x - c*v)/m", "F/m*cos - k/m*x - c/m*v", "(-k*x - c*v + F*sin)/m")
    start = {"mode": "free", "x": c.one_of(0, -gap, -0.001), "v": c.one_of(0, 0.02, -0.1)}
    modes = rigid_stops(c, parameters, pull) if c.happens(0.6) else soft_stop(c, parameters, pull)
    if gap == 0 and start["x"] == 0:
        start["x"] = -0.001
    scales = c.one_of(None, None, [0.001, 0.1], [0.01, 1])
    until = c.horizon(c.between(2, 8) * 2 * math.pi / frequency)
    return Draft(
        ["x", "v"], modes, start, until, parameters, omega="w",
        phi=c.one_of(None, 0.5, math.pi / 2), scales=scales, time_scale=c.one_of(None, 0.01, 1),
    )  # fmt: skip


def rigid_stops(c: Chance, parameters: dict, pull: str) -> list:
    parameters["r"] = c.one_of(0.3, 0.5, 0.6, 0.75, 0.8, 0.9)
    stops = [event("hit", "x > gap", ["x = gap", "v = -r*v"])]
    if parameters["gap"] > 0 and c.happens(0.4):
        stops.append(event("back", "x < -gap", ["x = -gap", "v = -r*v"]))
    if c.happens(0.3):
        stops.append(watch("turn", "v > 0"))
    return [mode("free", ["x' = v", f"v' = {pull}"], *stops)]


def soft_stop(c: Chance, parameters: dict, pull: str) -> list:
    parameters["ks"] = parameters["k"] * c.one_of(2, 5, 9, 30)
    touch = event("touch", "x > gap", follows="contact")
    leave = event("leave", "x < gap", follows="free")
    pushed = f"{pull} - ks*(x - gap)/m"
    return [
        mode("free", ["x' = v", f"v' = {pull}"], touch),
        mode("contact", ["x' = v", f"v' = {pushed}"], leave),
    ]


def chattering(c: Chance) -> Draft:
    """A ball that bounces on a shaking table, or a mass pressed against a stop."""
    e = c.one_of(0.3, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.98, c.between(0.3, 0.98))
    parameters = {"g": c.one_of(1, 9.81, 2), "A": c.number(0.001, 0.3), "e": e}
    omega = c.number(0.5, 12)
    if parameters["A"] * omega**2 > 0.9 * parameters["g"] and c.happens(0.7):
        parameters["A"] = float(f"{0.5 * parameters['g'] / omega**2:.2g}")
    height = parameters["A"] + c.number(0.01, 1)
    reset = ["x = A*cos", "v = -e*v - (1 + e)*A*omega*sin"]
    states, equations = ["x", "v"], ["x' = v", "v' = -g"]
    start = {"mode": "fly", "x": height, "v": c.one_of(0, 0, 0.5)}
    if c.happens(0.3):
        parameters["d"] = c.number(0.01, 1)
        equations[1] = "v' = -g - d*v"
    if c.happens(0.2):
        parameters["q"] = c.number(0.01, 3)
        states, equations = [*states, "u"], [*equations, c.one_of("u' = -q*u", "u' = 0")]
        start |= {"u": 1}
    impact = event("hit", "A*cos > x", reset)
    events = [impact, watch("above", f"x > {c.one_of('A', '2*A')}")] if c.happens(0.2) else [impact]
    fall = math.sqrt(2 * height / parameters["g"])
    bounces = fall * (1 + e) / (1 - e) if e < 0.86 else fall * (1 + 2 * 12 * e)
    if c.happens(0.15):
        start["t"] = c.one_of(1e3, 1e6, 12345.678)
    until = start.get("t", 0) + c.horizon(min(bounces * 1.3, 40 * fall))
    return Draft(
        states, [mode("fly", equations, *events)], start, until, parameters, omega=omega,
        phi=c.one_of(None, 0.5, 1),
    )  # fmt: skip


def sticking(c: Chance) -> Draft:
    """What chatters until it sticks, and comes loose again: a ball on a table, a pressed mass."""
    return c.one_of(sticking_ball, pressed_mass)(c)


def sticking_ball(c: Chance) -> Draft:
    """A ball that sticks to a shaking table until that falls faster than the ball would."""
    g, omega = c.one_of(1, 9.81, 2), c.number(0.5, 12)
    lifted = c.between(1.02, 1.6) if c.happens(0.8) else c.between(0.2, 0.9)
    parameters = {"g": g, "A": float(f"{lifted * g / omega**2:.3g}")}
    parameters["e"] = c.one_of(0, 0.1, 0.25, 0.4, 0.5, 0.6, c.between(0.02, 0.7))
    force = "-g"
    if c.happens(0.3):
        parameters["d"], force = c.number(0.01, 1), "-g - d*v"
    touching = ["x = A*cos", "v = -A*omega*sin"]
    reset = [touching[0], "v = -e*v - (1 + e)*A*omega*sin"]
    states, equations = ["x", "v"], ["x' = v", f"v' = {force}"]
    stuck = ["x' = v", "v' = -A*omega^2*cos"]
    start = {"mode": "fly", "x": parameters["A"] * c.between(1.01, 2), "v": c.one_of(0, 0, 0.5)}
    if c.happens(0.3):
        # Impacts kick another state, or are counted in it.
        states = [*states, "u"]
        equations, stuck = [*equations, c.one_of("u' = -u", "u' = x")], [*stuck, "u' = 0"]
        reset.append("u = u + 3*(v + A*omega*sin)")
        start |= {"u": 1}
    follows = c.one_of("stuck", [("A*omega^2*cos > g", "fly"), (None, "stuck")])
    limit = (c.one_of([], touching), follows)
    hit = event("hit", "A*cos > x", reset, limit=limit)
    loose = event("loose", f"-A*omega^2*cos < {force}", touching, "fly")
    until = c.horizon(c.between(1, 4) * 2 * math.pi / omega)
    return Draft(
        states, [mode("fly", equations, hit), mode("stuck", stuck, loose)], start, until,
        parameters, omega=omega, phi=c.one_of(None, 0.5, 1),
    )  # fmt: skip


def pressed_mass(c: Chance) -> Draft:
    """A mass on a spring that a force presses against a stop, beside one that it may pull on."""
    parameters = {"k": c.number(0.1, 3), "load": c.number(0.3, 1.5), "stop": c.number(0.05, 0.4)}
    parameters["r"] = c.one_of(0, 0.1, 0.3, 0.5, 0.6, c.between(0.02, 0.7))
    omega, states = c.number(0.3, 1.5), ["x", "v"]
    force = "load + cos - k*x"
    equations, stuck, reset = ["x' = v"], ["x' = 0", "v' = 0"], ["x = stop", "v = -r*v"]
    start = {"mode": "free", "x": 0, "v": 0}
    if c.happens(0.5):
        parameters["kc"], force = c.number(0.1, 1), f"{force} - kc*(x - y)"
        states, start = [*states, "y", "w"], start | {"y": 0, "w": 0}
        others = ["y' = w", "w' = kc*(x - y) - y - w/10"]
        reset += c.one_of([], ["w = w + (1 + r)*v/4"])
    else:
        others = []
    damped = c.one_of("", " - v/5")
    hit = event(
        "hit", "x > stop", reset, limit=(
            c.one_of([], ["x = stop", "v = 0"]),
            c.one_of("stuck", [(f"{force} > 0", "stuck"), (None, "free")]),
        ),
    )  # fmt: skip
    loose = event("loose", f"{force} < 0", (), "free")
    free = mode("free", [*equations, f"v' = {force}{damped}", *others], hit)
    return Draft(
        states, [free, mode("stuck", [*stuck, *others], loose)], start,
        c.horizon(c.between(1, 3) * 2 * math.pi / omega), parameters, omega=omega,
    )  # fmt: skip


def beside_impacts(c: Chance) -> Draft:
    """What chatters until it sticks, with timers and counts of the impacts beside."""
    draft = sticking(c)
    hit = draft.modes[0]["events"][0]
    kinds = ["since", "left", "hits", "worn", "gone"]
    for name in [it for it in kinds if c.happens(0.4)] or [c.one_of(*kinds)]:
        rates = {"since": "1", "left": "-2", "hits": "0", "worn": "1 - worn/4", "gone": "v"}
        jumps = {
            "since": "0", "left": "5", "hits": "hits + 1", "worn": "worn/3 + 1", "gone": "gone + 2"
        }  # fmt: skip
        draft.states = [*draft.states, name]
        for one in draft.modes:
            rate = rates[name] if one is draft.modes[0] else c.one_of("0", rates[name])
            one["equations"] = [*one["equations"], f"{name}' = {rate}"]
        hit["reset"].append(f"{name} = {jumps[name]}")
        reset, follows = hit["limit"]
        # A sum that the limit does not set ends the run there.
        if name in ("since", "left") or c.happens(0.15):
            reset = [*reset, *c.one_of([], [f"{name} = 1"])]
        else:
            reset = [*reset, f"{name} = {c.one_of('0', '1/3')}"]
        hit["limit"] = (reset, follows)
        draft.start |= {name: c.one_of(0, 1, 0.3)}
    return draft


def chains(c: Chance) -> Draft:
    """Two to four masses in a row on springs and dashpots, with a stop or knocking together."""
    n = c.count(2, 4)
    m, k = c.one_of(0.1, 0.5, 1, 2, 3), c.one_of(1, 10, 100, 30, 7)
    parameters = {"m": m, "k": k, "c": c.one_of(0.01, 0.05, 0.1, 0.3) * math.sqrt(k * m)}
    parameters["c"] = c.one_of(round(parameters["c"], 2) or 0.01, parameters["c"])
    forced, natural = c.happens(0.5), math.sqrt(k / m)
    equations = []
    for i in range(1, n + 1):
        left = f"k*(x{i - 1} - x{i}) + c*(v{i - 1} - v{i})" if i > 1 else "-k*x1 - c*v1"
        right = f" + k*(x{i + 1} - x{i}) + c*(v{i + 1} - v{i})" if i < n else ""
        push = " + F*cos" if forced and i == n else ""
        equations += [f"x{i}' = v{i}", f"v{i}' = ({left}{right}{push})/m"]
    states = [f"{letter}{i}" for i in range(1, n + 1) for letter in "xv"]
    if forced:
        parameters["F"] = c.one_of(0.1, 1, 0.5) * k
    parameters |= {"stop": c.number(0.05, 0.8), "r": c.one_of(0.5, 0.7, 0.9)}
    stop = event("stop", f"x{n} > stop", [f"x{n} = stop", f"v{n} = -r*v{n}"])
    knock = event(
        "knock", "x1 - x2 > stop",
        ["x2 = x1 - stop", "v1 = ((1 - r)*v1 + (1 + r)*v2)/2", "v2 = ((1 + r)*v1 + (1 - r)*v2)/2"],
    )  # fmt: skip
    events = c.one_of([stop], [stop, watch("first", "x1 > 0")], [knock], [stop, knock])
    start = {"mode": "all"} | {name: 0 for name in states}
    start |= {f"x{n}": c.one_of(-1, -0.5, -2), f"v{c.count(1, n)}": c.one_of(0, 0.5, 1)}
    until = c.horizon(c.between(1.5, 4) * 2 * math.pi / natural)
    omega = c.number(0.3, 2) * natural if forced else None
    return Draft(states, [mode("all", equations, *events)], start, until, parameters, omega=omega)


def stick_slip(c: Chance) -> Draft:
    """A mass on a belt, a forced mass with dry friction, or a drill string."""
    return c.one_of(belt, dry_friction, drill_string)(c)


def belt(c: Chance) -> Draft:
    parameters = {"m": c.one_of(*ROUND_MASSES), "k": c.one_of(*ROUND_STIFFNESSES)}
    natural = math.sqrt(parameters["k"] / parameters["m"])
    parameters |= {"c": c.one_of(0, 0.1, 0.05), "Fs": c.one_of(1, 0.5, 2), "belt": 0.2}
    parameters["Fk"] = parameters["Fs"] * c.one_of(0.3, 0.5, 0.75, 1)
    parameters["belt"] = float(f"{c.number(0.1, 1) * parameters['Fs'] / natural:.1g}")
    slip = "(-k*x - c*v + {})/m"
    stick = mode(
        "stick", ["x' = belt", "v' = 0"], event("slips", "k*x + c*belt > Fs", follows="slip")
    )
    caught = event(
        "sticks", "v > belt", ["v = belt"],
        [("k*x + c*belt > Fs", "slip"), ("k*x + c*belt + Fs < 0", "fast"), (None, "stick")],
    )  # fmt: skip
    slowed = event(
        "sticks", "v < belt", ["v = belt"], [("k*x + c*belt > Fs", "slip"), (None, "stick")]
    )
    modes = [
        stick,
        mode("slip", ["x' = v", f"v' = {slip.format('Fk')}"], caught),
        mode("fast", ["x' = v", f"v' = {slip.format('-Fk').replace('+ -', '- ')}"], slowed),
    ]
    start = {"mode": "stick", "x": 0, "v": "belt"}
    if c.happens(0.3):
        start = {"mode": "slip", "x": 0, "v": c.one_of(0, -0.1, "-belt")}
    stretch = parameters["Fs"] / parameters["k"]
    period = 2 * math.pi / natural + 2 * stretch / parameters["belt"]
    return Draft(["x", "v"], modes, start, c.horizon(c.between(1.5, 5) * period), parameters)


def dry_friction(c: Chance) -> Draft:
    parameters = {
        "A": c.between(0.5, 4),
        "Fs": 1,
        "Fk": c.one_of(1, 0.8, 0.5),
        "z": c.between(0.01, 0.2),
    }
    lets = {"force": c.one_of("A*cos - x", "A*sin - x")}
    drag = c.one_of("", " - z*v")
    stop = "stop"
    right = event(stop, "v < 0", ["v = 0"], [("force + Fs < 0", "left"), (None, "stick")])
    left = event(stop, "v > 0", ["v = 0"], [("force > Fs", "right"), (None, "stick")])
    modes = [
        mode("right", ["x' = v", f"v' = force - Fk{drag}"], right),
        mode("left", ["x' = v", f"v' = force + Fk{drag}"], left),
        mode(
            "stick",
            ["x' = 0", "v' = 0"],
            event("slip-right", "force > Fs", follows="right"),
            event("slip-left", "force + Fs < 0", follows="left"),
        ),
    ]
    start = {"mode": "right", "x": c.between(-1, 1), "v": c.between(0.1, 2)}
    omega = c.number(0.2, 2.5)
    until = c.horizon(c.between(2, 6) * 2 * math.pi / omega)
    return Draft(["x", "v"], modes, start, until, parameters, lets, omega, c.one_of(None, 0.3))


def drill_string(c: Chance) -> Draft:
    parameters = {
        "J": c.one_of(374, 100, 40, 7),
        "k": c.one_of(473, 300, 30, 41),
        "c": c.one_of(23, 10, 1, 0.5),
        "drive": c.one_of(1, 2, 3, 5),
        "Ts": c.one_of(300, 100, 500),
        "Tk": 0,
    }
    parameters["Tk"] = parameters["Ts"] * c.one_of(0.4, 0.5, 0.6, 0.75)
    torque = "(k*a + c*(drive - w)"
    stick = mode(
        "stick", ["a' = drive", "w' = 0"], event("breaks", "k*a + c*drive > Ts", follows="slip")
    )
    back = event("stops", "w < 0", ["w = 0"], [("k*a + c*drive > Ts", "slip"), (None, "stick")])
    slip = mode("slip", ["a' = drive - w", f"w' = {torque} - Tk)/J"], back)
    start = {"mode": "stick", "a": 0, "w": 0}
    natural = math.sqrt(parameters["k"] / parameters["J"])
    winding = parameters["Ts"] / parameters["k"] / parameters["drive"]
    until = c.horizon(c.between(1.5, 4) * (2 * math.pi / natural + 2 * winding))
    return Draft(["a", "w"], [stick, slip], start, until, parameters)


def relays(c: Chance) -> Draft:
    """A process of order one to three under a switch with hysteresis."""
    n = c.count(1, 3)
    names = [f"y{i}" for i in range(1, n + 1)]
    parameters = {
        f"T{i}": c.one_of(0.3, 0.5, 1, 2, 3, 7, 10, c.number(0.1, 10)) for i in range(1, n + 1)
    }
    parameters |= {"high": c.between(0.3, 0.8), "low": 0.0, "K": c.one_of(1, 2, 5, 3)}
    parameters["low"] = parameters["high"] - c.one_of(0.1, 0.2, 0.05, 0.01, c.number(1e-4, 0.1))
    measured = "y1" if n == 1 or c.happens(0.7) else f"y1 + {c.one_of('y2/4', '2*y2', 'y2')}"

    def equations(drive: str) -> list:
        inputs = [*names[1:], drive]
        return [
            f"{y}' = ({u} - {y})/T{i}"
            for i, (y, u) in enumerate(zip(names, inputs, strict=True), 1)
        ]

    forced = c.happens(0.3)
    on, off = c.one_of("K", "K + 1"), c.one_of("0", "-K", "-1")
    if forced:
        parameters["D"], on = c.between(0.01, 0.3), f"{on} + D*cos"
        off += " + D*cos"
    modes = [
        mode("on", equations(on), event("off", f"{measured} > high", follows="off")),
        mode("off", equations(off), event("on", f"{measured} < low", follows="on")),
    ]
    start = {"mode": "on"} | {name: 0 for name in names}
    largest = max(value for key, value in parameters.items() if key.startswith("T"))
    least = min(value for key, value in parameters.items() if key.startswith("T"))
    dwell = (parameters["high"] - parameters["low"]) * least / (3 * (parameters["K"] + 1))
    until = c.horizon(
        min(
            c.between(1, 3) * (largest if n == 1 else least + largest),
            100 * dwell + (least if n > 1 and measured == "y1" else 0),
        )
    )
    return Draft(names, modes, start, until, parameters, omega=c.number(0.3, 5) if forced else None)


def bilinear(c: Chance) -> Draft:
    """A mass that meets a second spring, on an orbit that is mostly stable, for many events."""
    parameters = {
        "z": c.one_of(0.05, 0.1, 0.2, c.between(0.03, 0.3)), "k": c.one_of(1, 3, 9, 4, 20),
        "A": c.one_of(1, 0.5, 2), "e": c.one_of(0.5, 0.1, 0, -0.2, 0.3),
    }  # fmt: skip
    free = "-x - 2*z*v + A*cos"
    modes = [
        mode("free", ["x' = v", f"v' = {free}"], event("touch", "x > e", follows="contact")),
        mode(
            "contact",
            ["x' = v", f"v' = {free} - k*(x - e)"],
            event("leave", "x < e", follows="free"),
        ),
    ]
    start = {"mode": "free", "x": c.one_of(-1, -0.5), "v": c.one_of(0, 0.25)}
    omega = c.one_of(0.8, 0.5, 1.3, c.between(0.4, 2.2))
    until = c.horizon(c.between(6, 16) * 2 * math.pi / omega)
    return Draft(["x", "v"], modes, start, until, parameters, omega=omega)

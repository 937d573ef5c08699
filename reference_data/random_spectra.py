"""Random systems whose matrices are slow, stiff, defective, nearly so, or near resonance."""

import math

from system_text import Chance, Draft, event, mode, rounded, watch


def thermostat(c: Chance, names: list, equations, high: str, low: str) -> list:
    """Two modes whose drive is 1 and 0 (or -1), switched by the first state."""
    off = c.one_of("0", "-1")
    return [
        mode("on", equations("1"), event("off", f"{names[0]} > {high}", follows="off")),
        mode("off", equations(off), event("on", f"{names[0]} < {low}", follows="on")),
    ]


def far(c: Chance, name: str) -> dict:
    return watch("far", c.one_of(f"{name} > 1000", f"{name} + 7 < 0", f"{name} > 5"), "rising")


def slow_pairs(c: Chance) -> Draft:
    """Two coupled decays whose rates are closer than 2^-8 over the time scale."""
    a = c.number(1e-6, 2e-2)
    d = c.number(1e-9, 3.9e-3)
    form = c.count(1, 4)
    parameters, states = {"a": a, "d": d}, ["x", "v"]
    start = {"mode": "only", "x": 1, "v": c.one_of(0, 0.5 * a, -a, 1e-3)}
    if form == 1:
        pair = ["x' = v", "v' = -a*(a + d)*x - (2*a + d)*v"]
    elif form == 2:
        pair = ["x' = -a*x + v", "v' = -(a + d)*v"]
    elif form == 3:
        parameters = {"k": a * a, "c": 2 * a}
        pair = ["x' = v", "v' = -k*x - c*v"]
    else:
        pair = ["x' = -a*x + d*v", "v' = d*x - (a + d)*v"]
        parameters["d"] = min(d, a / 3)
    if c.happens(0.4):
        parameters |= {"high": 0.6, "low": c.one_of(0.5, 0.4, 0.55)}
        start |= {"mode": "on", "x": 0.45, "v": 0}

        def equations(drive: str) -> list:
            return [pair[0], f"{pair[1]} + a*{'a*' if form in (1, 3) else ''}{drive}"]

        parameters["a"] = a
        modes = thermostat(c, states, equations, "high", "low")
    else:
        parameters["level"] = c.between(0.05, 0.9)
        marks = c.one_of(
            [far(c, "x")], [far(c, "x"), watch("level", "x > level")], [watch("zero", "v > 0")]
        )
        if c.happens(0.3):
            marks.append(event("jump", "x < level", ["x = x + 1"]))
        modes = [mode("only", pair, *marks)]
    rate = 2 * parameters.get("a", a)
    return Draft(states, modes, start, c.horizon(c.number(0.5, 6) / rate), parameters)


def stiff_pairs(c: Chance) -> Draft:
    """A fast and a slow decay, rates 1e3 to 1e7 apart, switched or watched."""
    parameters = {"fast": c.number(1e3, 1e7), "a": c.number(0.1, 5), "b": c.between(-0.5, 0.5)}
    parameters |= {"high": c.between(0.5, 0.8), "low": c.between(0.1, 0.45)}
    states = ["x", "y"]
    kind = c.count(1, 3)

    def equations(drive: str) -> list:
        if kind == 1:
            return [f"x' = a*({drive} - x) + b*y", f"y' = fast*({drive}/2 - y)"]
        if kind == 2:
            return ["x' = fast*(y - x)", f"y' = a*({drive} - y)"]
        return [f"x' = a*({drive} - y)", "y' = fast*(x - y)"]

    modes = thermostat(c, states, equations, "high", "low")
    if c.happens(0.5):
        for one in modes:
            one["events"] = (
                *one["events"],
                watch("second", c.one_of("y > x", "y > high", "x > y + b")),
            )
    start = {"mode": "on", "x": c.one_of(0, 0.3), "y": c.one_of(0, 1, -2)}
    until = c.horizon(c.between(1, 8) / parameters["a"])
    return Draft(states, modes, start, until, parameters, time_scale=c.one_of(None, None, 1e-3))


def ladder(c: Chance, gap: bool) -> Draft:
    """A chain of two to four stages with rates all alike, or a little apart, under a relay."""
    n = c.count(2, 4)
    names = [f"x{i}" for i in range(1, n + 1)]
    parameters = {"a": c.one_of(1, 0.5, 2, 3, c.number(0.1, 5))}
    rates = ["a"] * n
    if gap:
        for i in range(1, n):
            if c.happens(0.7) or i == 1:
                parameters[f"d{i}"] = c.signed(1e-12, 1e-3) * (1 if i == 1 else c.one_of(1, 2))
                rates[i] = f"(a + d{i})"
    parameters |= {"high": c.between(0.2, 0.7), "low": c.between(-0.3, 0.15)}

    def equations(drive: str) -> list:
        return [
            f"{x}' = {r}*({u} - {x})"
            for x, r, u in zip(names, rates, [*names[1:], drive], strict=True)
        ]

    modes = thermostat(c, names, equations, "high", "low")
    start = {"mode": "on"} | {name: c.one_of(0, 0, 0.1, -1) for name in names}
    start["x1"] = 0
    omega = None
    if c.happens(0.3):
        omega = c.number(0.3, 4)
        for one in modes:
            one["equations"][-1] += " + a*cos/4"
    return Draft(
        names, modes, start, c.horizon(c.between(3, 14) / parameters["a"]), parameters, omega=omega
    )


def critical(c: Chance, gap: bool) -> Draft:
    """An oscillator that is damped critically, or a little off it, against a stop."""
    parameters = {"a": c.number(0.2, 4), "stop": c.between(0.1, 0.6), "r": c.one_of(0.5, 0.8)}
    parameters["F"] = c.between(0.5, 4) * parameters["a"] ** 2
    pull = "-a^2*x - 2*a*v"
    if gap:
        parameters["d"] = c.signed(1e-12, 1e-3)
        pull = c.one_of(
            "-a*(a + d)*x - (2*a + d)*v", "-a^2*x - 2*(a + d)*v", "-(a^2 + d)*x - 2*a*v"
        )
    hit = event("hit", "x > stop", ["x = stop", "v = -r*v"])
    equations = ["x' = v", f"v' = {pull} + F*cos"]
    start = {"mode": "free", "x": 0, "v": c.one_of(0, 1)}
    omega = c.number(0.4, 4)
    until = c.horizon(c.between(2, 8) * 2 * math.pi / omega)
    modes = [mode("free", equations, hit, watch("middle", "x > 0"))]
    return Draft(["x", "v"], modes, start, until, parameters, omega=omega)


def jordan(c: Chance, gap: bool) -> Draft:
    """Two oscillators of one frequency in a row: a pair of complex roots twice."""
    parameters = {"w": c.number(0.5, 3), "z": c.one_of(0, 0.05, 0.1), "level": c.between(0.3, 2)}
    second = "w"
    if gap:
        parameters["d"], second = c.signed(1e-12, 1e-3), "(w + d)"
    equations = [
        "x' = v", "v' = -w^2*x - 2*z*v + w^2*y", "y' = u", f"u' = -{second}^2*y - 2*z*u",
    ]  # fmt: skip
    marks = [watch("level", "x > level"), watch("middle", "y > 0")]
    if c.happens(0.4):
        marks = [event("hit", "x > level", ["x = level", "v = -v/2"])]
    start = {"mode": "free", "x": 0, "v": 0, "y": c.one_of(1, 0.5), "u": c.one_of(0, 0.25)}
    until = c.horizon(c.between(2, 5) * 2 * math.pi / parameters["w"])
    return Draft(["x", "v", "y", "u"], [mode("free", equations, *marks)], start, until, parameters)


def integrators(c: Chance, _gap: bool) -> Draft:
    """A chain of integrators: a motion that is a polynomial."""
    n = c.count(2, 4)
    names = [f"x{i}" for i in range(1, n + 1)]
    parameters = {"u": c.between(0.5, 3), "level": c.between(0.5, 3), "r": c.one_of(0.5, 0.9, 1)}
    chain = [f"{x}' = {y}" for x, y in zip(names, [*names[1:], "-u"], strict=True)]
    marks = [event("floor", "x1 < 0", ["x1 = 0", *[f"{x} = -r*{x}" for x in names[1:2]]])]
    marks += [watch("level", "x1 > level")] if c.happens(0.6) else []
    start = {"mode": "only"} | {name: c.between(0.2, 2) for name in names}
    until = c.horizon(c.between(2, 5 if n > 2 else 8))
    return Draft(names, [mode("only", chain, *marks)], start, until, parameters)


def defective(c: Chance) -> Draft:
    return c.one_of(ladder, ladder, critical, jordan, integrators)(c, False)


def nearly_defective(c: Chance) -> Draft:
    return c.one_of(ladder, critical, jordan)(c, True)


def near_resonance(c: Chance) -> Draft:
    """A free or lightly damped oscillator whose forcing misses its frequency by little."""
    parameters = {"w": c.one_of(1, 2, 3, 0.5, c.number(0.3, 6)), "d": c.signed(1e-9, 1e-2)}
    parameters |= {"F": c.number(0.05, 2), "level": c.between(0.2, 2)}
    drag = ""
    if c.happens(0.5):
        parameters["z"], drag = c.one_of(1e-3, 1e-2, 1e-6, c.number(1e-9, 0.05)), " - 2*z*v"
    marks = c.one_of(
        [watch("middle", "x > 0")],
        [watch("level", "x > level", "rising"), watch("turn", "v > 0", "falling")],
        [event("hit", "x > level", ["x = level", "v = -v/2"])],
    )
    equations = ["x' = v", f"v' = -w^2*x{drag} + F*{c.one_of('cos', 'sin')}"]
    start = {"mode": "free", "x": c.one_of(0, -0.5), "v": c.one_of(0, 0.1)}
    until = c.horizon(c.between(3, 15) * 2 * math.pi / parameters["w"])
    return Draft(
        ["x", "v"], [mode("free", equations, *marks)], start, until, parameters, omega="w + d",
        phi=c.one_of(None, None, 0.5),
    )  # fmt: skip


def decays(c: Chance) -> Draft:
    """Motions that decay for very long, with guards at zero that they cross early or never."""
    a = c.one_of(1, 2, c.number(1e-3, 1e3), c.number(1e-3, 1e3))
    lifetimes = c.number(5, 2000)
    parameters, form = {"a": a, "b": a * c.one_of(1.000000001, 1.5, 2, 3, 1.0001)}, c.count(1, 5)
    states, start = ["x", "y"], {"mode": "only", "x": 1, "y": c.one_of(0.5, 1, -0.25)}
    equations = ["x' = -a*x", "y' = -b*y + x*a"]
    zero = c.one_of("x < 0", "y < 0", "x + y < 0", "x - y < 0", "y > x")
    if form == 1:
        states, equations, start, zero = ["x"], ["x' = -a*x"], {"mode": "only", "x": 1}, "x < 0"
    elif form == 2:
        equations[1] = "y' = -b*y"
    elif form == 3:
        equations = ["x' = -a*x - b*y", "y' = -a*y"]
    elif form == 4:
        parameters |= {"tiny": c.number(1e-40, 1e-6)}
        zero = "x < tiny"
    marks = [watch("zero", zero, "both")]
    if form == 5:
        parameters["lift"] = c.one_of(1, 0.5)
        parameters["tiny"] = c.number(1e-25, 1e-3)
        marks.append(event("again", "x < tiny", ["x = x + lift"]))
        lifetimes = min(lifetimes, 400)
    until = rounded(lifetimes / a, 6)
    return Draft(states, [mode("only", equations, *marks)], start, until, parameters)

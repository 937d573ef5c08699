"""Random systems aimed at what is hard to decide: ties, grazes, starts on guards, exact touches."""

import math

from mpmath import mp, mpf

from system_text import Chance, Draft, event, mode, watch

CREST_DIGITS = 80
TRIPLES = ((3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25), (20, 21, 29))


def split(number) -> list:
    """A number as a sum of three f64, which hold some 150 of its bits."""
    parts = []
    for _ in range(3):
        parts.append(float(number))
        number -= mpf(parts[-1])
    return parts


def near_ties(c: Chance) -> Draft:
    """Two states reach their guards almost together, or exactly so."""
    gap = c.one_of(c.signed(1e-30, 1e-6), c.signed(1e-36, 1e-24), c.signed(1e-16, 1e-10), 0.0)
    form = c.one_of("clocks", "decays", "oscillators", "oscillators", "forced")
    parameters = {"gap": gap, "level": c.between(0.2, 0.8), "s": c.one_of(1, 2, 3, 0.5)}
    states, omega, until = ["x", "y"], None, 4.0
    start = {"mode": "both", "x": 0, "y": 0}
    if form == "clocks":
        equations = ["x' = 1", "y' = s"]
    elif form == "decays":
        parameters["a"] = c.number(0.3, 3)
        equations = ["x' = a*(1 - x)", "y' = a*(s - y)"]
        until = 3 / parameters["a"]
    else:
        parameters |= {"w": c.number(0.5, 3), "z": c.one_of(0, 0.1, c.between(0.01, 0.2))}
        states, start = ["x", "v", "y", "u"], {"mode": "both", "x": 0, "y": 0, "v": 1, "u": "s"}
        parameters["level"] = c.between(0.1, 0.45) / max(parameters["w"], 1)
        push = ""
        if form == "forced":
            omega, push = c.number(0.4, 3), " + cos"
        equations = [
            "x' = v", f"v' = -w^2*x - 2*z*v{push}",
            "y' = u", f"u' = -w^2*y - 2*z*u{push.replace('cos', 's*cos')}",
        ]  # fmt: skip
        until = 3 * math.pi / parameters["w"]
    if c.happens(0.5):
        marks = tied_guards(c, "x > level", "y > s*level + gap")
    else:
        marks = tied_guards(c, "x > level", "y > s*level")
        start["y"] = "gap"
    order = c.one_of(1, -1)
    modes = [mode("both", equations, *marks[::order])]
    return Draft(states, modes, start, c.horizon(until), parameters, omega=omega)


def tied_guards(c: Chance, first: str, second: str) -> list:
    """Two watches, a watch and an `until`, or two of `until` with resets of their own."""
    down = ["x = x - level", "y = y/2"]
    kind = c.count(1, 4)
    if kind == 1:
        return [watch("one", first), watch("two", second)]
    if kind == 2:
        return [event("one", first, down), watch("two", second)]
    if kind == 3:
        return [watch("one", first), event("two", second, down)]
    return [event("one", first, down[:1]), event("two", second, ["y = y/3"])]


class Oscillation:
    """x'' = -w^2 x - 2 z x' + F cos(omega t) from x0, v0, underdamped, in closed form."""

    def __init__(self, p: dict, x0: float, v0: float):
        w, z, force, self.omega = (mpf(p[key]) for key in ("w", "z", "F", "omega"))
        self.z, self.turn = z, mp.sqrt(w * w - z * z)
        stiffness, drag = w * w - self.omega**2, 2 * z * self.omega
        size = stiffness**2 + drag**2
        self.cosine, self.sine = force * stiffness / size, force * drag / size
        self.a = mpf(x0) - self.cosine
        self.b = (mpf(v0) - self.sine * self.omega + z * self.a) / self.turn

    def x(self, t):
        free = mp.exp(-self.z * t) * (self.a * mp.cos(self.turn * t) + self.b * mp.sin(self.turn * t))
        angle = self.omega * t
        return free + self.cosine * mp.cos(angle) + self.sine * mp.sin(angle)

    def v(self, t):
        return mp.diff(self.x, t)

    def rate(self, t):
        ca, sa = mp.cos(self.turn * t), mp.sin(self.turn * t)
        free = mp.exp(-self.z * t) * (
            (self.b * self.turn - self.z * self.a) * ca - (self.a * self.turn + self.z * self.b) * sa
        )
        angle = self.omega * t
        return free + self.omega * (self.sine * mp.cos(angle) - self.cosine * mp.sin(angle))

    def crests(self, horizon: float) -> list:
        """(time, height) of the maxima up to the horizon, those that a scan sees."""
        found, steps = [], 400
        times = [mpf(horizon) * i / steps for i in range(steps + 1)]
        with mp.workdps(20):
            rates = [self.rate(t) for t in times]
        for left, right, before, after in zip(times, times[1:], rates, rates[1:], strict=False):
            if before > 0 > after:
                top = mp.findroot(self.rate, (left, right), solver="anderson", tol=mpf(10) ** -150)
                found.append((top, self.x(top)))
        return found


def grazes(c: Chance) -> Draft:
    """A guard at the height of a crest, but for 1e-6 to 1e-36 above or below."""
    with mp.workdps(CREST_DIGITS):
        while True:
            p = {"w": c.number(0.5, 3), "z": c.one_of(0, 0.05, c.between(0.001, 0.2))}
            p |= {"F": c.one_of(0, 1, c.between(0.1, 2)), "omega": c.number(0.4, 3)}
            if abs(p["omega"] - p["w"]) < 0.05:
                continue
            start = {"mode": "free", "x": c.one_of(-1, -0.5, 0), "v": c.one_of(0, 0.5, 1)}
            span = c.between(2, 5) * 2 * math.pi / p["w"]
            crests = Oscillation(p, start["x"], start["v"]).crests(span)
            if crests:
                return grazing(c, p, start, crests, span)


def grazing(c: Chance, p: dict, start: dict, crests: list, span: float) -> Draft:
    _, height = c.one_of(crests[0], max(crests, key=lambda crest: crest[1]), c.one_of(*crests))
    gap = mpf(10) ** -c.between(6, c.one_of(30, 30, 36)) * c.one_of(1, -1)
    shown = c.one_of("x", "x", "s*x")
    scale = c.one_of(2, 3) if shown != "x" else 1
    level = split((height + gap * max(abs(height), mpf("0.1"))) * scale)
    p = p | {"top": level[0], "more": level[1], "rest": level[2]}
    if scale != 1:
        p["s"] = scale
    guard = f"{shown} > top + more + rest"
    touching = event("hit", guard, c.one_of(["v = -v/2"], ["v = -v", "x = x/2"], ["x = x - 1"]))
    marks = c.one_of(
        [watch("crest", guard)], [watch("crest", guard, "rising"), watch("middle", "x > 0")],
        [touching], [touching, watch("turn", "v < 0", "rising")],
    )  # fmt: skip
    omega, push = p.pop("omega"), "" if p["F"] == 0 else " + F*cos"
    if p["F"] == 0:
        del p["F"]
    modes = [mode("free", ["x' = v", f"v' = -w^2*x - 2*z*v{push}"], *marks)]
    return Draft(
        ["x", "v"], modes, start, c.horizon(span), p, omega=omega if push else None
    )


def on_guards(c: Chance) -> Draft:
    """Starts on one or two guards, moving in, moving out, or with rates that are zero."""
    parameters = {"d": c.one_of(0.3, 0.1, 1, 0, c.between(0.05, 2)), "w": c.number(0.5, 3), "z": 0.05}
    parameters |= {"r": c.one_of(0.5, 0.8, 0.9), "A": c.between(0.1, 2), "g": c.one_of(0, 1, 0.5)}
    form = c.count(1, 4)
    states, omega = ["x", "v"], None
    start = {"mode": "free", "x": c.one_of("d", "d", parameters["d"]), "v": c.one_of(0, 0, -1, 1, -0.25)}
    hit = event("hit", "x > d", ["x = d", "v = -r*v"])
    pull = "-w^2*(x - d) - 2*z*v - g"
    if form == 2:
        omega, pull = c.number(0.4, 4), "-w^2*x - 2*z*v + A*cos"
    elif form == 3:
        omega, pull = c.number(0.4, 4), "-g - 1"
        start |= {"x": "A*cos", "v": c.one_of("-A*omega*sin", 0, "-A*omega*sin + r")}
        hit = event("hit", "A*cos > x", ["x = A*cos", "v = -r*v - (1 + r)*A*omega*sin"])
    elif form == 4:
        states = ["x", "v", "y"]
        start |= {"y": c.one_of("d", "2*d", 0)}
    marks = [hit]
    if c.happens(0.5):
        marks.append(watch("same", c.one_of("x > d", "2*x > 2*d", "v > 0", "x < d")))
    if c.happens(0.3):
        marks.append(event("turn", "v < 0", c.one_of(["v = v + 1"], ["v = -2*v"])))
    equations = ["x' = v", f"v' = {pull}"]
    if form == 4:
        equations.append(c.one_of("y' = v", "y' = -y", "y' = 1"))
        marks.append(watch("other", c.one_of("y > d", "y + x > 2*d", "y > x")))
    until = c.horizon(c.between(1, 4) * 2 * math.pi / (omega or parameters["w"]))
    if form == 3:
        until = c.horizon(c.between(1, 3))
    phi = c.one_of(None, None, 0.5) if omega else None
    return Draft(states, [mode("free", equations, *marks)], start, until, parameters, omega=omega, phi=phi)


def exact(c: Chance) -> Draft:
    """Guards that the model makes touch or tie exactly."""
    return c.one_of(sine_and_cosine, sine_and_cosine, exact_touch, free_circle, scaled_rows, parabola)(c)


def sine_and_cosine(c: Chance) -> Draft:
    """A sine and a cosine of one angle pass a rational point of the circle together."""
    a, b, h = c.one_of(*TRIPLES)
    parameters = {"amp": h, "a": a, "b": b, "w": c.one_of(1, 2, 2 * math.pi, c.number(0.3, 5))}
    marks = c.one_of(
        [watch("sine", "amp*sin > a"), watch("cosine", f"amp*cos {c.one_of('<', '>')} {c.one_of('-b', 'b')}")],
        [watch("sine", "amp*sin > a"), watch("mixed", "amp*sin + amp*cos > a + b")],
        [watch("sine", "amp*sin > -a"), watch("cosine", "3*amp*cos < -3*b"), watch("x", "x > 1")],
        [event("sine", "amp*sin > a", follows="after"), watch("cosine", "amp*cos > b")],
    )
    equations = [c.one_of("x' = 0", "x' = 1", "x' = -x + cos")]
    modes = [mode("first", equations, *marks)]
    if any(one["next"] for one in marks):
        modes.append(mode("after", equations, event("back", "amp*sin < a", follows="first")))
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    return Draft(["x"], modes, {"mode": "first", "x": 0}, until, parameters, omega="w", phi=c.one_of(None, None, 0.5))


def exact_touch(c: Chance) -> Draft:
    """A sum of sine and cosine whose amplitude is the level exactly."""
    a, b, h = c.one_of(*TRIPLES)
    parameters = {"a": a, "b": b, "h": h, "w": c.one_of(1, 2 * math.pi, c.number(0.3, 5))}
    guard = c.one_of("a*cos + b*sin > h", "a*cos - b*sin < -h", "h*sin > h", "cos > 1", "-b*cos > b")
    touching = event("touch", guard, ["x = x + 1"])
    marks = c.one_of([touching], [watch("touch", guard)], [touching, watch("middle", "b*sin > a*cos")])
    equations = [c.one_of("x' = 0", "x' = 1", "x' = sin - x")]
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    phi = c.one_of(None, 0.5)
    return Draft(["x"], [mode("only", equations, *marks)], {"mode": "only", "x": 0}, until, parameters, omega="w", phi=phi)


def free_circle(c: Chance) -> Draft:
    """An undamped oscillator from a rational start: its crest, or a point of its circle, exactly."""
    a, b, h = c.one_of(*TRIPLES)
    parameters = {"w": c.one_of(1, 2, 0.5, c.number(0.3, 4)), "h": h, "a": a, "b": b}
    start = {"mode": "free", "x": c.one_of("h", "-h", 0), "v": 0}
    if start["x"] == 0:
        start["v"] = c.one_of("h*w", "-h*w")
    marks = c.one_of(
        [watch("crest", "x > h"), watch("middle", "x > 0")],
        [event("crest", "x > h", ["v = -v"])],
        [watch("place", "x > a"), watch("speed", c.one_of("v > w*b", "v < -w*b"))],
        [watch("crest", "a*w*x + b*v > h^2*w"), watch("middle", "v > 0")],
    )
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    return Draft(["x", "v"], [mode("free", ["x' = v", "v' = -w^2*x"], *marks)], start, until, parameters)


def scaled_rows(c: Chance) -> Draft:
    """One guard and a multiple of it, watched or ending the mode, on any motion."""
    parameters = {"w": c.number(0.5, 3), "z": c.between(0.01, 0.2), "level": c.between(0.1, 0.6), "r": 0.7}
    hit = event("hit", "x > level", ["x = level", "v = -r*v"])
    marks = c.one_of(
        [watch("one", "x > level"), watch("three", "3*x > 3*level")],
        [hit, watch("three", "3*x > 3*level")],
        [watch("one", "x > level", "rising"), watch("minus", "-x < -level"), watch("turn", "v > 0")],
        [hit, event("again", "w*x > w*level", ["v = v/2"])],
        [hit, watch("under", "x < level", "falling")],
    )
    omega, push = c.one_of((None, ""), (c.number(0.4, 3), " + cos"))
    start = {"mode": "free", "x": c.one_of(-1, 0), "v": c.one_of(1, 0.5)}
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    equations = ["x' = v", f"v' = -w^2*x - 2*z*v{push}"]
    return Draft(["x", "v"], [mode("free", equations, *marks)], start, until, parameters, omega=omega)


def parabola(c: Chance) -> Draft:
    """Throws whose heights and instants are rational: touches and ties that are decided exactly."""
    g, v, n = c.one_of(2, 1, 4, 8), c.one_of(1, 2, 3, 4), c.count(1, 3)
    parameters = {"g": g, "v0": v, "top": v * v / (2 * g), "instant": v / g * c.one_of(1, 2, 1, 0.5)}
    marks = c.one_of(
        [watch("top", "x > top"), watch("clock", "s > instant")],
        [event("top", "x > top", ["v = -v"]), watch("clock", "s > instant")],
        [event("clock", "s > instant", ["s = 0"]), watch("turn", "v < 0"), watch("top", "x > top")],
        [event("clock", "s > instant", follows="other"), watch("top", "x > top")],
        [event("floor", "x < 0", ["x = 0", "v = -v"]), event("clock", "s > instant", ["s = 0"])],
    )
    equations = ["x' = v", "v' = -g", "s' = 1"]
    modes = [mode("throw", equations, *marks)]
    if any(follows == "other" for one in marks for _, follows in one["next"]):
        modes.append(mode("other", equations, watch("deep", f"x < -{n}")))
    start = {"mode": "throw", "x": 0, "v": "v0", "s": 0}
    return Draft(["x", "v", "s"], modes, start, c.horizon(c.between(0.6, 2.5) * 2 * v / g), parameters)

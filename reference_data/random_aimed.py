"""Random systems aimed at what is hard to decide: ties, grazes, starts on guards."""

import math

from mpmath import mp, mpf

from system_text import Chance, Draft, event, mode, watch

CREST_DIGITS = 80
SCANNED = 400  # steps in which a scan looks for zeros


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
    """x'' = -w^2 x - 2 z x' + F cos(omega t), underdamped, from x0, v0 at `began`."""

    def __init__(self, p: dict, x0, v0, began=0):
        w, z, force, self.omega = (mpf(p[key]) for key in ("w", "z", "F", "omega"))
        self.z, self.turn, self.began = z, mp.sqrt(w * w - z * z), mpf(began)
        stiffness, drag = w * w - self.omega**2, 2 * z * self.omega
        size = stiffness**2 + drag**2
        self.cosine, self.sine = force * stiffness / size, force * drag / size
        forced, rate = self.forced(mpf(0))
        self.a = mpf(x0) - forced
        self.b = (mpf(v0) - rate + z * self.a) / self.turn

    def forced(self, t) -> tuple:
        """The steady motion and its rate."""
        cosine, sine = mp.cos_sin(self.omega * (self.began + t))
        value = self.cosine * cosine + self.sine * sine
        return value, self.omega * (self.sine * cosine - self.cosine * sine)

    def x(self, t):
        cosine, sine = mp.cos_sin(self.turn * t)
        return mp.exp(-self.z * t) * (self.a * cosine + self.b * sine) + self.forced(t)[0]

    def v(self, t):
        cosine, sine = mp.cos_sin(self.turn * t)
        along, across = self.b * self.turn - self.z * self.a, self.a * self.turn + self.z * self.b
        return mp.exp(-self.z * t) * (along * cosine - across * sine) + self.forced(t)[1]

    def reaches(self, height, horizon):
        """The first instant at which a scan up to the horizon sees it rise through a height."""
        return next(zeros(lambda t: self.x(t) - mpf(height), horizon), None)

    def crests(self, horizon, sign: int = 1) -> list:
        """Heights of the maxima, or with -1 the minima, that a scan up to the horizon sees."""
        return [self.x(t) for t in zeros(lambda t: -sign * self.v(t), horizon)]


def zeros(function, horizon):
    """The instants at which a function rises through zero, as far as a scan sees them."""
    times = [mpf(horizon) * i / SCANNED for i in range(SCANNED + 1)]
    with mp.workdps(20):
        values = [function(t) for t in times]
    for left, right, before, after in zip(times, times[1:], values, values[1:], strict=False):
        if before < 0 < after:
            yield mp.findroot(function, (left, right), solver="anderson", tol=mpf(10) ** -150)


def grazes(c: Chance) -> Draft:
    """A guard at the height of a crest, but for 1e-6 to 1e-36 above or below."""
    with mp.workdps(CREST_DIGITS):
        while True:
            p = {"w": c.number(0.5, 3), "z": c.one_of(0, 0.05, c.between(0.001, 0.2))}
            p |= {"F": c.one_of(0, 1, c.between(0.1, 2)), "omega": c.number(0.4, 3)}
            start = {"mode": "free", "x": c.one_of(-1, -0.5, 0), "v": c.one_of(0, 0.5, 1)}
            span = c.between(2, 5) * 2 * math.pi / p["w"]
            if abs(p["omega"] - p["w"]) < 0.05:
                continue
            made = (struck if c.happens(0.4) else grazing)(c, p, start, span)
            if made is not None:
                return made


def near(c: Chance, height, scale: int = 1) -> list:
    """A height times a scale, a little missed, as three numbers to add up."""
    gap = mpf(10) ** -c.between(6, c.one_of(30, 30, 36)) * c.one_of(1, -1)
    return split((height + gap * max(abs(height), mpf("0.1"))) * scale)


def grazing(c: Chance, p: dict, start: dict, span: float) -> Draft | None:
    """A crest of the motion from the start, watched or against a stop."""
    crests = Oscillation(p, start["x"], start["v"]).crests(span)
    if not crests:
        return None
    height = c.one_of(crests[0], max(crests), c.one_of(*crests))
    scale = c.one_of(1, 1, 2, 3)
    level = near(c, height, scale)
    p = p | dict(zip(("top", "more", "rest"), level, strict=True)) | {"s": scale}
    guard = f"{'x' if scale == 1 else 's*x'} > top + more + rest"
    touching = event("hit", guard, c.one_of(["v = -v/2"], ["v = -v", "x = x/2"], ["x = x - 1"]))
    marks = c.one_of(
        [watch("crest", guard)],
        [watch("crest", guard, "rising"), watch("middle", "x > 0")],
        [touching],
        [touching, watch("turn", "v < 0", "rising")],
    )
    return oscillator(c, p, start, span, marks)


def struck(c: Chance, p: dict, start: dict, span: float) -> Draft | None:
    """A trough of the motion after one to six impacts."""
    p = p | {"stop": c.between(0.05, 0.4), "r": c.one_of(0.5, 0.7, 0.9)}
    x, v, began = start["x"], start["v"], mpf(0)
    for _ in range(c.count(1, 6)):
        motion = Oscillation(p, x, v, began)
        instant = motion.reaches(p["stop"], span)
        if instant is None:
            return None
        x, v, began = p["stop"], -mpf(p["r"]) * motion.v(instant), began + instant
    troughs = Oscillation(p, x, v, began).crests(span / 2, -1)
    if not troughs:
        return None
    p = p | dict(zip(("low", "more", "rest"), near(c, troughs[0]), strict=True))
    hit = event("hit", "x > stop", ["x = stop", "v = -r*v"])
    marks = [hit, watch("trough", "x < low + more + rest")]
    return oscillator(c, p, start, float(began) + span / 2, marks)


def oscillator(c: Chance, p: dict, start: dict, span: float, marks: list) -> Draft:
    omega, push = (p["omega"], " + F*cos") if p["F"] else (None, "")
    equations = ["x' = v", f"v' = -w^2*x - 2*z*v{push}"]
    kept = {key: value for key, value in p.items() if key != "omega" and (key != "F" or push)}
    modes = [mode("free", equations, *marks)]
    return Draft(["x", "v"], modes, start, c.horizon(span), kept, omega=omega)


def on_guards(c: Chance) -> Draft:
    """Starts on one or two guards, moving in, moving out, or with rates that are zero."""
    parameters = {
        "d": c.one_of(0.3, 0.1, 1, 0, c.between(0.05, 2)),
        "w": c.number(0.5, 3),
        "z": 0.05,
    }
    parameters |= {"r": c.one_of(0.5, 0.8, 0.9), "A": c.between(0.1, 2), "g": c.one_of(0, 1, 0.5)}
    form = c.count(1, 4)
    states, omega = ["x", "v"], None
    start = {
        "mode": "free",
        "x": c.one_of("d", "d", parameters["d"]),
        "v": c.one_of(0, 0, -1, 1, -0.25),
    }
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
    return Draft(
        states, [mode("free", equations, *marks)], start, until, parameters, omega=omega, phi=phi
    )

"""Random systems whose guards touch or tie exactly, by the model and not by numbers."""

import math

from system_text import Chance, Draft, event, mode, watch

TRIPLES = ((3, 4, 5), (5, 12, 13), (8, 15, 17), (7, 24, 25), (20, 21, 29))


def exact(c: Chance) -> Draft:
    """Guards that the model makes touch or tie exactly."""
    return c.one_of(
        sine_and_cosine, sine_and_cosine, exact_touch, free_circle, scaled_rows, parabola
    )(c)


def sine_and_cosine(c: Chance) -> Draft:
    """A sine and a cosine of one angle pass a rational point of the circle together."""
    a, b, h = c.one_of(*TRIPLES)
    parameters = {"amp": h, "a": a, "b": b, "w": c.one_of(1, 2, 2 * math.pi, c.number(0.3, 5))}
    marks = c.one_of(
        [
            watch("sine", "amp*sin > a"),
            watch("cosine", f"amp*cos {c.one_of('<', '>')} {c.one_of('-b', 'b')}"),
        ],
        [watch("sine", "amp*sin > a"), watch("mixed", "amp*sin + amp*cos > a + b")],
        [watch("sine", "amp*sin > -a"), watch("cosine", "3*amp*cos < -3*b"), watch("x", "x > 1")],
        [event("sine", "amp*sin > a", follows="after"), watch("cosine", "amp*cos > b")],
    )
    equations = [c.one_of("x' = 0", "x' = 1", "x' = -x + cos")]
    modes = [mode("first", equations, *marks)]
    if any(one["next"] for one in marks):
        modes.append(mode("after", equations, event("back", "amp*sin < a", follows="first")))
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    return Draft(
        ["x"],
        modes,
        {"mode": "first", "x": 0},
        until,
        parameters,
        omega="w",
        phi=c.one_of(None, None, 0.5),
    )


def exact_touch(c: Chance) -> Draft:
    """A sum of sine and cosine whose amplitude is the level exactly."""
    a, b, h = c.one_of(*TRIPLES)
    parameters = {"a": a, "b": b, "h": h, "w": c.one_of(1, 2 * math.pi, c.number(0.3, 5))}
    guard = c.one_of(
        "a*cos + b*sin > h", "a*cos - b*sin < -h", "h*sin > h", "cos > 1", "-b*cos > b"
    )
    touching = event("touch", guard, ["x = x + 1"])
    marks = c.one_of(
        [touching], [watch("touch", guard)], [touching, watch("middle", "b*sin > a*cos")]
    )
    equations = [c.one_of("x' = 0", "x' = 1", "x' = sin - x")]
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    phi = c.one_of(None, 0.5)
    return Draft(
        ["x"],
        [mode("only", equations, *marks)],
        {"mode": "only", "x": 0},
        until,
        parameters,
        omega="w",
        phi=phi,
    )


def free_circle(c: Chance) -> Draft:
    """An undamped oscillator from a rational start: its crest, or a point of its circle."""
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
    return Draft(
        ["x", "v"], [mode("free", ["x' = v", "v' = -w^2*x"], *marks)], start, until, parameters
    )


def scaled_rows(c: Chance) -> Draft:
    """One guard and a multiple of it, watched or ending the mode, on any motion."""
    parameters = {
        "w": c.number(0.5, 3),
        "z": c.between(0.01, 0.2),
        "level": c.between(0.1, 0.6),
        "r": 0.7,
    }
    hit = event("hit", "x > level", ["x = level", "v = -r*v"])
    marks = c.one_of(
        [watch("one", "x > level"), watch("three", "3*x > 3*level")],
        [hit, watch("three", "3*x > 3*level")],
        [
            watch("one", "x > level", "rising"),
            watch("minus", "-x < -level"),
            watch("turn", "v > 0"),
        ],
        [hit, event("again", "w*x > w*level", ["v = v/2"])],
        [hit, watch("under", "x < level", "falling")],
    )
    omega, push = c.one_of((None, ""), (c.number(0.4, 3), " + cos"))
    start = {"mode": "free", "x": c.one_of(-1, 0), "v": c.one_of(1, 0.5)}
    until = c.horizon(c.between(1, 4) * 2 * math.pi / parameters["w"])
    equations = ["x' = v", f"v' = -w^2*x - 2*z*v{push}"]
    return Draft(
        ["x", "v"], [mode("free", equations, *marks)], start, until, parameters, omega=omega
    )


def parabola(c: Chance) -> Draft:
    """Throws whose heights and instants are rational: touches and ties that are decided exactly."""
    g, v, n = c.one_of(2, 1, 4, 8), c.one_of(1, 2, 3, 4), c.count(1, 3)
    parameters = {
        "g": g,
        "v0": v,
        "top": v * v / (2 * g),
        "instant": v / g * c.one_of(1, 2, 1, 0.5),
    }
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
    return Draft(
        ["x", "v", "s"], modes, start, c.horizon(c.between(0.6, 2.5) * 2 * v / g), parameters
    )

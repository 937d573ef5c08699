"""A system file put together and written down, for systems that a program makes."""

import math
from dataclasses import dataclass, field


def event(
    name: str, guard: str, reset=(), follows=(), direction: str | None = None, limit=None
) -> dict:
    """An `until`, or with a direction a `watch`.

    `follows` is the name of a mode, or pairs (condition or None, mode). `limit` is the pair (reset,
    follows) where the event accumulates.
    """
    pairs = [(None, follows)] if isinstance(follows, str) else list(follows)
    return {
        "name": name,
        "guard": guard,
        "reset": list(reset),
        "next": pairs,
        "direction": direction,
        "limit": limit,
    }


def watch(name: str, guard: str, direction: str = "both") -> dict:
    return event(name, guard, direction=direction)


def mode(name: str, equations: list, *events: dict) -> dict:
    return {"name": name, "equations": equations, "events": events}


@dataclass
class Draft:
    """What stands in a system file, and the time up to which it is to be run."""

    states: list
    modes: list
    start: dict
    until: float
    parameters: dict = field(default_factory=dict)
    lets: dict = field(default_factory=dict)
    omega: object = None
    phi: object = None
    scales: list | None = None
    time_scale: object = None

    def text(self, name: str) -> str:
        lines = ["schema = 1", f"name = {quoted(name)}", f"states = {listed(self.states)}"]
        if self.scales is not None:
            lines.append(f"scales = {listed(self.scales)}")
        if self.time_scale is not None:
            lines.append(f"time_scale = {value(self.time_scale)}")
        if self.omega is not None:
            phi = 0 if self.phi is None else self.phi
            lines.append(f"forcing = {{ omega = {value(self.omega)}, phi = {value(phi)} }}")
        lines += table("parameters", self.parameters) + table("let", self.lets)
        for one in self.modes:
            lines += ["[[mode]]", f"name = {quoted(one['name'])}"]
            lines.append(f"equations = {listed(one['equations'])}")
            for happening in one["events"]:
                lines += event_lines(happening)
        return "\n".join([*lines, *table("start", self.start), ""])


def event_lines(happening: dict) -> list:
    watched = happening["direction"] is not None
    lines = ["[[mode.watch]]" if watched else "[[mode.until]]"]
    lines += [f"name = {quoted(happening['name'])}", f"guard = {quoted(happening['guard'])}"]
    if watched:
        lines.append(f"direction = {quoted(happening['direction'])}")
    if happening["reset"]:
        lines.append(f"reset = {listed(happening['reset'])}")
    if happening["next"]:
        lines.append(f"next = {successors(happening['next'])}")
    if happening["limit"] is not None:
        reset, follows = happening["limit"]
        next_modes = quoted(follows) if isinstance(follows, str) else successors(follows)
        short = not reset and isinstance(follows, str)
        given = next_modes if short else f"{{ reset = {listed(reset)}, next = {next_modes} }}"
        lines.append(f"accumulates_to = {given}")
    return lines


def successors(pairs: list) -> str:
    return f"[{', '.join(successor(*pair) for pair in pairs)}]"


def successor(condition: str | None, follows: str) -> str:
    when = "" if condition is None else f"when = {quoted(condition)}, "
    return f"{{ {when}mode = {quoted(follows)} }}"


def table(name: str, entries: dict) -> list:
    lines = [f"{key} = {value(entry)}" for key, entry in entries.items()]
    return [f"[{name}]", *lines] if lines else []


def quoted(text: str) -> str:
    return f'"{text}"'


def value(entry) -> str:
    """A number as shortest decimal, or an expression in quotation marks."""
    return quoted(entry) if isinstance(entry, str) else repr(entry)


def listed(entries: list) -> str:
    return f"[{', '.join(map(value, entries))}]"


def rounded(number: float, digits: int) -> float:
    """A number to so many significant digits, as people write numbers down."""
    return float(f"{number:.{digits - 1}e}")


class Chance:
    """Random numbers as people write them down."""

    def __init__(self, rng):
        self.rng = rng

    def one_of(self, *choices):
        return self.rng.choice(choices)

    def happens(self, probability: float) -> bool:
        return self.rng.random() < probability

    def number(self, least: float, most: float) -> float:
        """A positive number, its logarithm uniform; with few digits, or with all of them."""
        drawn = math.exp(self.rng.uniform(math.log(least), math.log(most)))
        digits = self.one_of(1, 2, 2, 3, 4, 17)
        return min(max(rounded(drawn, digits), least), most)

    def signed(self, least: float, most: float) -> float:
        return self.number(least, most) * self.one_of(-1, 1)

    def between(self, least: float, most: float) -> float:
        """A number, uniform, with few digits or with all of them."""
        drawn = self.rng.uniform(least, most)
        return rounded(drawn, self.one_of(2, 3, 4, 17)) if drawn else drawn

    def count(self, least: int, most: int) -> int:
        return self.rng.randint(least, most)

    def horizon(self, about: float) -> float:
        """A horizon that no round number of anything meets."""
        return rounded(about * self.rng.uniform(0.9, 1.1), 7)

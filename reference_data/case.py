"""A case file, and the start rules of `CONTRACT.md` applied to it in exact arithmetic."""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path

from flint import arb

from crossing import Undecided
from motion import (
    CONTACT,
    NO_CONTACT,
    PROGRESSION,
    Contact,
    NoContact,
    Parameters,
    Progression,
    State,
    on_surface,
    trial_force,
)

ULPS = 4


@dataclass
class Case:
    """What the generators read of a case file; other tables belong to the harness."""

    name: str
    parameters: dict
    start: dict
    horizon: dict

    @classmethod
    def read(cls, path: Path):
        table = tomllib.loads(path.read_text())
        name = table["case"]["name"]
        if name != path.stem:
            raise ValueError(f"{path}: the case calls itself {name!r}")
        parameters = {key: float(table["parameters"][key]) for key in Parameters._fields}
        start = {key: float(table["start"].get(key, 0)) for key in ("tau", "p", "y", "v")}
        start["q"] = slider_top(table["start"].get("q"), start["p"], parameters["g"])
        start["cycle"] = table["start"].get("cycle", 0)
        if "phase" in table["start"]:
            raise ValueError(f"{path}: a start by phase projects the state; give the state itself")
        return cls(name, parameters, start, table["horizon"])

    def model(self) -> Parameters:
        return Parameters(*(arb(self.parameters[key]) for key in Parameters._fields))

    def period(self) -> arb:
        """One forcing period."""
        return 2 * arb.pi() / arb(self.parameters["omega"])

    def start_tau(self) -> arb:
        return arb(self.start["tau"]) + self.start["cycle"] * self.period()

    def start_angle(self) -> arb:
        """omega tau + phi; the whole cycles drop out exactly."""
        return arb(self.parameters["omega"]) * arb(self.start["tau"]) + arb(self.parameters["phi"])

    def span(self) -> arb:
        """From start to horizon."""
        if "periods" in self.horizon:
            return self.horizon["periods"] * self.period()
        return arb(float(self.horizon["until"])) - self.start_tau()


def slider_top(q, p: float, g: float) -> float:
    """q as given; where it is not given, the relaxed slider, or the one the mass touches."""
    if q is not None:
        return float(q)
    return p - g if p >= g else 0.0


def within_ulps(distance: arb, scale: float) -> bool:
    """Is |distance| within four units in the last place of `scale`?"""
    limit = arb(ULPS * math.ulp(scale))
    if abs(distance) <= limit:
        return True
    if abs(distance) > limit:
        return False
    raise Undecided("start")


def start_motion(case: Case):
    """The phase the start is in, as `CONTRACT.md` decides it."""
    m, angle, s = case.model(), case.start_angle(), case.start
    state = State(*(arb(s[key]) for key in State._fields))
    gap = state.p - state.q - m.g
    if not within_ulps(gap, max(abs(s["p"]), abs(s["q"]), case.parameters["g"])):
        if not gap < 0:
            raise ValueError(f"{case.name}: the start lies beyond the contact surface")
        return NoContact(m, angle, state, zeros=0)
    return surface_motion(case, m, angle, on_surface(m, state))


def surface_motion(case: Case, m, angle, state):
    """The phase of a start on the contact surface, chosen by its trial force."""
    force = trial_force(m, state)
    scale = max(abs(2 * case.parameters["xi"] * case.start["y"]), abs(case.start["q"]))
    for level, below, above in ((0, NO_CONTACT, CONTACT), (1, CONTACT, PROGRESSION)):
        if within_ulps(force - level, scale):
            state = on_surface(m, state._replace(q=level - 2 * m.xi * state.y))
            acceleration = m.a * angle.cos() + m.b - level
            rate = 2 * m.xi * acceleration + state.y
            return enter(m, angle, state, above if certain(rate > 0, rate < 0) else below, level)
    if force < 0:
        return NoContact(m, angle, state, zeros=1)
    return enter(m, angle, state, CONTACT if certain(force < 1, force > 1) else PROGRESSION, None)


def enter(m, angle, state, phase, force):
    """The motion of phase `phase` entered on the surface with the trial force known, or None."""
    if phase == NO_CONTACT:
        return NoContact(m, angle, state, zeros=2)
    if phase == CONTACT:
        return Contact(m, angle, state, force)
    return Progression(m, angle, state, zeros=int(force == 1))


def certain(yes: bool, no: bool) -> bool:
    if not (yes or no):
        raise Undecided("phase")
    return yes

"""Periodic orbits and their bifurcations in 40 digits, by Taylor series and differences alone.

    python orbits.py [--check]

Writes `orbits.csv` and `bifurcations.csv`; with `--check` holds the files to what it finds instead.
Motions are summed from Taylor series, guards are looked at SAMPLES times in each step, and a return
map is differentiated by differences: there is no closed form and no saltation in it.
"""

import argparse
import csv
import io
import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from flint import fmpq
from mpmath import eig, eye, lu_solve, matrix, mp, mpf, norm, nstr, pi, polyval

import manifest
from check_gradients import MovedBuilder

HERE = Path(__file__).parent
SYSTEMS = HERE.parent / "validation" / "systems"
DIGITS = 40
TERMS = 40  # of a Taylor series, in steps of at most half a unit over the matrix's norm
SAMPLES = 16  # of each guard in a step
ZERO = mpf("1e-30")  # a Taylor term below this share of the largest one is taken for 0
STEP = mpf("1e-12")  # of central differences
CLOSED = mpf("1e-26")  # the last step of Newton's method for an orbit
LOCATED = mpf("1e-17")  # and for a bifurcation, whose condition is a difference itself
VANISHING = mpf("1e-20")  # what differences leave of 0
PRINTED = 18
MOST_STEPS = 60
BISECTIONS = 140
MADE = {
    "digits": 18,
    "precision_bits": 133,
    "generator": "orbits.py",
    "command": "python orbits.py",
}
PARAMETER_BITS = 200


@dataclass
class Orbit:
    """A return map, a guess of a periodic point, and the states that its section leaves free."""

    system: str
    mode: str
    guess: dict
    free: tuple
    section: str = "strobe"
    period: int = 1
    parameters: dict = field(default_factory=dict)
    on_guard: str = ""  # a state that the guard of the section's event, zero there, gives


@dataclass
class Bifurcation:
    """The parameter at which an orbit has a multiplier, +1 or -1, and a guess of it."""

    orbit: Orbit
    parameter: str
    guess: float
    kind: str


MULTIPLIERS = {"fold": 1, "flip": -1}


def buck(period: int, supply: float, v: float, i: float) -> Orbit:
    guess = {"v": v, "i": i, "r": 0}
    return Orbit("buck-converter", "off", guess, ("v", "i"), "clock", period, {"Vin": supply})


def relay(k: float, *guess: float) -> Orbit:
    states = ("x1", "x2", "x3")
    guess = dict(zip(states, guess, strict=True))
    section, values = ("switch-down", 1), {"k": k}
    return Orbit("relay-feedback", "down", guess, ("x2", "x3"), *section, values, "x1")


def rig(system: str, frequency: float, x: float, v: float) -> Orbit:
    guess = {"x": x, "v": v}
    return Orbit(system, "free", guess, ("x", "v"), parameters={"frequency": frequency})


WATCHED = "watched-impact-oscillator"
BELT = {"x1": 1.2251491, "v1": 0.1009756, "x2": 1.25, "v2": -0.1595022}

ORBITS = [
    rig("rigid-impact-oscillator", 2.0, -2.5173, 1.69961),
    rig(WATCHED, 2.75, -0.217415, 0.0207169),
    rig(WATCHED, 2.4, -0.5283, 0.05867),
    buck(1, 24.0, 12.022165, 0.606481),
    buck(2, 25.0, 12.0290857, 0.5895012),
    Orbit("dry-friction-oscillator", "right", {"x": 1.6471321, "v": 0.6077155}, ("x", "v")),
    Orbit("plastic-ball-on-table", "flight", {"x": 1.5866451, "v": 0.2769653}, ("x", "v")),
    relay(0.0, 0.01, 0.31581, 0.7441),
    relay(0.0625, -0.01237, 0.0314, 0.3579),
    Orbit("two-masses-on-a-belt", "back-back", BELT, ("x1", "v1", "v2"), "stop"),
    Orbit(
        "percussive-oscillator",
        "no-contact",
        {"p": -0.0423481, "y": 0.418927, "q": 0, "v": 0},
        ("p", "y", "q"),
        parameters={"frequency": 1.1},
    ),
]

BIFURCATIONS = [
    Bifurcation(buck(1, 24.0, 12.022165, 0.606481), "Vin", 24.5, "flip"),
    Bifurcation(rig(WATCHED, 2.4, -0.5283, 0.05867), "frequency", 2.41, "flip"),
    Bifurcation(buck(2, 25.0, 12.1458, 0.5207), "Vin", 31.1, "flip"),
    Bifurcation(relay(0.07, -0.0259, 0.0938, 0.51), "k", 0.0703, "fold"),
    Bifurcation(relay(0.059, -0.00566, 0.0128, 0.2665), "k", 0.05877, "fold"),
]


def exact(value: mpf) -> fmpq:
    return fmpq(int(mp.nint(value * 2**PARAMETER_BITS)), 2**PARAMETER_BITS)


def real(value: fmpq) -> mpf:
    return mpf(int(value.p)) / int(value.q)


def reals(row: list) -> list:
    return [real(value) for value in row]


class Motion:
    """A system with its parameters put in, one of which may be a real number."""

    def __init__(self, orbit: Orbit, name: str = "", value: mpf | None = None):
        path = SYSTEMS / f"{orbit.system}.system.toml"
        base = orbit.parameters.get(name, 0)
        by = exact(value - mpf(base)) if value is not None else fmpq(0)
        table = tomllib.loads(path.read_text())
        self.system = MovedBuilder(table, orbit.parameters, None, name, by).system()
        self.states = self.system.states
        self.matrices = {n: self.rows(mode.matrix) for n, mode in self.system.modes.items()}
        self.norms = {n: max(sum(map(abs, row)) for row in m) for n, m in self.matrices.items()}

    def rows(self, it) -> list:
        return [[real(it[i, j]) for j in range(it.ncols())] for i in range(it.nrows())]

    def appended(self, state: list, angle: mpf) -> list:
        """The state with the cosine and the sine of the forcing, and 1."""
        forcing = [mp.cos(angle), mp.sin(angle)] if self.system.forced else []
        return [*state, *forcing, mpf(1)]

    def series(self, mode: str, z: list, step: mpf) -> list:
        """The Taylor terms of z over a step, from the order 0 on."""
        rows, terms = self.matrices[mode], [z]
        for k in range(1, TERMS):
            last, share = terms[-1], step / k
            terms.append([share * dot(row, last) for row in rows])
        return terms

    def leading(self, row: list, mode: str, z: list) -> tuple:
        """(order, sign) of the first Taylor term of a row that is not zero."""
        terms = [dot(row, it) for it in self.series(mode, z, 1 / self.norms[mode])]
        size = max(map(abs, terms))
        for order, term in enumerate(terms):
            if abs(term) > ZERO * size:
                return order, mp.sign(term)
        return TERMS, 0

    def after(self, event, z: list) -> tuple:
        """The mode and the state after an event."""
        z = [dot(row, z) for row in self.rows(event.reset)]
        for row, mode in event.successors:
            if row is None or self.leading(self.rows(row)[0], mode, z)[1] > 0:
                return mode, z
        raise ValueError("the last successor has no condition")

    def guard(self, name: str) -> list:
        """The guard of an event."""
        events = (pair for mode in self.system.modes for pair in self.until(mode))
        return next(row for event, row in events if event.name == name)

    def until(self, mode: str) -> list:
        return [(it, self.rows(it.guard)[0]) for it in self.system.modes[mode].until]


def dot(row: list, z: list) -> mpf:
    return mp.fdot(row, z)


def first_root(terms: list, zeros: int) -> mpf | None:
    """The first upward crossing of a guard in a step, from 0 to 1, beyond its zeros at 0."""
    high_first = terms[zeros:][::-1]
    before = mpf(0)
    for k in range(1, SAMPLES + 1):
        after = mpf(k) / SAMPLES
        if polyval(high_first, after) > 0:
            if k == 1 and high_first[-1] > 0:
                raise ValueError("a guard is positive at the entry")
            for _ in range(BISECTIONS):
                middle = (before + after) / 2
                if polyval(high_first, middle) > 0:
                    after = middle
                else:
                    before = middle
            return after
        before = after
    return None


def returned(motion: Motion, orbit: Orbit, point: list) -> tuple:
    """(state, time) after the orbit's returns to its section."""
    system = motion.system
    whole = orbit.section == "strobe"
    span = 2 * pi * orbit.period / real(system.omega) if whole else mp.inf
    mode, time, left, is_entry = orbit.mode, mpf(0), orbit.period, True
    # A strobe is at the time 0, and nothing of an autonomous system depends on that.
    z = motion.appended(point, real(system.phi))
    while True:
        guards, zeros = motion.until(mode), [0] * len(system.modes[mode].until)
        if is_entry:
            found = [motion.leading(row, mode, z) for _, row in guards]
            zeros = [order for order, _ in found]
            firing = [event for (event, _), (_, sign) in zip(guards, found) if sign > 0]
            if firing and time > 0:
                mode, z = motion.after(firing[0], z)
                continue
        step = min(mpf(1) / (2 * motion.norms[mode]), span - time)
        terms = motion.series(mode, z, step)
        crossing = None
        for (event, row), zero in zip(guards, zeros):
            root = first_root([dot(row, it) for it in terms], zero)
            if root is not None and (crossing is None or root < crossing[0]):
                crossing = root, event
        share = mpf(1) if crossing is None else crossing[0]
        time += share * step
        z = [polyval([it[n] for it in terms][::-1], share) for n in range(len(z))]
        is_entry = crossing is not None
        if is_entry:
            mode, z = motion.after(crossing[1], z)
            left -= crossing[1].name == orbit.section
        elif time == span:
            left = 0
        if left == 0:
            return z[: len(point)], time


def start(motion: Motion, orbit: Orbit, free: list) -> list:
    """The point with these free states."""
    own = dict(orbit.guess) | dict(zip(orbit.free, free, strict=True))
    point = [mpf(own[name]) for name in motion.states]
    if orbit.on_guard:
        n = motion.states.index(orbit.on_guard)
        row = motion.guard(orbit.section)
        point[n] = mpf(0)
        point[n] = -dot(row, motion.appended(point, real(motion.system.phi))) / row[n]
    return point


def closing(motion: Motion, orbit: Orbit, free: list) -> list:
    """By how much the free states do not come back."""
    state, _ = returned(motion, orbit, start(motion, orbit, free))
    at = [motion.states.index(name) for name in orbit.free]
    return [state[n] - own for n, own in zip(at, free)]


def derivative(of, at: list) -> matrix:
    """The matrix of central differences of a list-valued function."""
    columns = []
    for n, value in enumerate(at):
        step = STEP * max(abs(value), mpf(1) / 16)
        more, less = (of([*at[:n], value + way * step, *at[n + 1 :]]) for way in (1, -1))
        columns.append([(a - b) / (2 * step) for a, b in zip(more, less)])
    return matrix(columns).T


def solved(of, at: list, last: mpf = CLOSED) -> list:
    """The zero of a list-valued function near a guess, by Newton's method."""
    for _ in range(MOST_STEPS):
        value = of(at)
        by = lu_solve(derivative(of, at), -matrix(value))
        at = [a + b for a, b in zip(at, by)]
        if norm(by) < last * (1 + norm(matrix(at))):
            return at
    raise ValueError("Newton's method does not converge")


def multiplying(motion: Motion, orbit: Orbit, free: list) -> matrix:
    """The derivative of the return map in the free states."""
    return derivative(lambda at: closing(motion, orbit, at), free) + eye(len(free))


def found_orbit(orbit: Orbit) -> dict:
    """A row of `orbits.csv`."""
    motion = Motion(orbit)
    free, point = closed(motion, orbit)
    _, time = returned(motion, orbit, point)
    values = eig(multiplying(motion, orbit, free), left=False, right=False)
    values = sorted(values, key=lambda it: (-abs(it), -mp.im(it)))
    parts = [f"{printed(mp.re(it))} {printed(mp.im(it))}" for it in values]
    return named(orbit, point) | {"time": printed(time), "multipliers": "; ".join(parts)}


def closed(motion: Motion, orbit: Orbit) -> tuple:
    """(free states, state) of the periodic point next to the guess."""
    free = solved(lambda at: closing(motion, orbit, at), guessed(orbit))
    return free, start(motion, orbit, free)


def found_bifurcation(it: Bifurcation) -> dict:
    """A row of `bifurcations.csv`: where the orbit closes and det(J - m) is zero. The state is that
    of the orbit at the parameters of the row."""

    def conditions(at: list) -> list:
        motion, free = Motion(it.orbit, it.parameter, at[-1]), at[:-1]
        own = multiplying(motion, it.orbit, free) - MULTIPLIERS[it.kind] * eye(len(free))
        return [*closing(motion, it.orbit, free), mp.det(own)]

    at = solved(conditions, [*guessed(it.orbit), mpf(it.guess)], LOCATED)
    _, point = closed(Motion(it.orbit), it.orbit)
    found = {"parameter": it.parameter, "type": it.kind, "value": printed(at[-1])}
    return named(it.orbit, point) | found


def guessed(orbit: Orbit) -> list:
    return [mpf(orbit.guess[name]) for name in orbit.free]


def named(orbit: Orbit, point: list) -> dict:
    values = " ".join(f"{name}={value!r}" for name, value in orbit.parameters.items())
    return {
        "system": orbit.system,
        "set": values,
        "section": orbit.section,
        "period": orbit.period,
        "mode": orbit.mode,
        "state": " ".join(map(printed, point)),
    }


def printed(value: mpf) -> str:
    return "0" if abs(value) < VANISHING else nstr(value, PRINTED)


def written(rows: list) -> str:
    out = io.StringIO()
    table = csv.DictWriter(out, rows[0], lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    return out.getvalue()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compares the files")
    checks = parser.parse_args().check
    mp.dps = DIGITS
    files = {
        "orbits.csv": written([found_orbit(it) for it in ORBITS]),
        "bifurcations.csv": written([found_bifurcation(it) for it in BIFURCATIONS]),
    }
    for name, text in files.items():
        if not checks:
            (HERE / name).write_text(text)
            manifest.record(HERE, {name: MADE})
        elif (HERE / name).read_text() != text:
            sys.exit(f"{name} is not what this program finds")


if __name__ == "__main__":
    main()

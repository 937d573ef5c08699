"""Short pieces of motion from the differential equations alone: Eqs. (1)-(9), no closed form.

    python generate_pieces.py [--case NAME]... [--cases DIR] [--out DIR]
    python generate_pieces.py --check [--out DIR]

A wrong closed form would confirm itself in every table made from it. Here the mass x, its
velocity y, the slider's top z and bottom v are integrated in their original, unbounded
co-ordinates by a Taylor series method in multiple precision. The forcing is an oscillator of its
own, so that not even cos(omega tau + phi) is evaluated after the start. `--check` compares every
row with the event table of the same case.
"""

import argparse
import csv
import sys
import time
from pathlib import Path

from mpmath import mp, mpf

import manifest
from case import Case
from generate_events import HERE, select
from motion import CONTACT, NO_CONTACT, PROGRESSION

DIGITS, WORKING_DIGITS = 25, 55
ORDER = 48
TRUNCATION = mpf(10) ** -46  # last Taylor terms of a step, relative to 1 + |state|
GRID = 16  # guard values looked at inside a step; the event tables carry the proof, not these
ENTRY_ZERO = mpf(10) ** -35  # a guard this small at the start of a step is the switch just passed
AGREEMENT = mpf(10) ** -(DIGITS - 1)  # one unit of the last printed digit, relative to 1 + |value|
COLUMNS = ("index", "phase", "elapsed", "tau", "p", "y", "q", "v", "x", "z")
NUMBERS = COLUMNS[2:8]

# Every phase, every kind of switch, damping on both sides of critical and at it.
PIECES = {
    "table1-first-row": 6,
    "chaos-from-rest": 8,
    "chaos-mid-flight": 8,
    "fig7a-period-4": 8,
    "fig7c-red": 8,
    "fig7e-period-5": 8,
    "stiff-xi-0-003": 5,
    "critical-xi-1": 10,
    "near-critical": 10,
    "over-damped-xi-1-5": 10,
    "over-damped-xi-20": 10,
    "impact-into-progression": 10,
    "fast-forcing": 8,
    "cycle-1e8": 6,
    "resonance-below": 6,
    "graze-overlap-1e-12": 4,
    "graze-overlap-1e-3": 4,
    "graze-miss-1e-12": 3,
}


def rates(m, phase, state, forcing, one):
    """Right-hand sides of (x, y, z, v), linear in `state`, `forcing` = F_ext and the constant `one`.

    Linear, so that the same lines serve for values and for Taylor coefficients, whose constant
    term alone sees `one` = 1.
    """
    x, y, z, v = state
    if phase == NO_CONTACT:  # Eqs. (1)-(3)
        return y, forcing, -(z - v) / (2 * m["xi"]), mpf(0)
    if phase == CONTACT:  # Eqs. (5), (6)
        return y, -2 * m["xi"] * y - (z - v) + forcing, y, mpf(0)
    return y, forcing - one, y, y + (z - v - one) / (2 * m["xi"])  # Eqs. (8), (6), (9)


def guards(m, phase, state, one):
    """(what it leads to, value) of each guard, negative inside the phase; linear as `rates` is."""
    x, y, z, v = state
    force = 2 * m["xi"] * y + z - v  # Eqs. (4), (7) with z' = x' = y
    if phase == NO_CONTACT:
        return (("impact", x - z - m["g"] * one),)
    if phase == CONTACT:
        return ((PROGRESSION, force - one), (NO_CONTACT, -force))
    return ((CONTACT, one - force),)


def series(m, phase, state, oscillator):
    """Taylor coefficients of the state and of the forcing oscillator (cos, sin)."""
    states, oscillators = [state], [oscillator]
    for k in range(ORDER):
        cosine, sine = oscillators[k]
        one = mpf(k == 0)
        change = rates(m, phase, states[k], m["a"] * cosine + m["b"] * one, one)
        states.append(tuple(c / (k + 1) for c in change))
        oscillators.append((-m["omega"] * sine / (k + 1), m["omega"] * cosine / (k + 1)))
    return states, oscillators


def at(coefficients, d):
    """The vector polynomial at `d`."""
    return tuple(mp.polyval(component[::-1], d) for component in zip(*coefficients, strict=True))


def step_length(states) -> mpf:
    """The step whose last two Taylor terms are as small as TRUNCATION asks, at most 1/2."""
    scale = 1 + max(abs(s) for s in states[0])
    length = mpf(1) / 2
    for k in (ORDER - 1, ORDER):
        last = max(abs(s) for s in states[k]) / scale
        if last > 0:
            length = min(length, (TRUNCATION / last) ** (mpf(1) / k))
    return length


def first_rise(m, phase, states, length):
    """(what it leads to, when) of the first guard seen to rise through zero on this step, or None."""
    polynomials = [guards(m, phase, s, mpf(k == 0)) for k, s in enumerate(states)]
    rises = []
    for i, (leads_to, _) in enumerate(polynomials[0]):
        coefficients = [p[i][1] for p in polynomials][::-1]
        times = evaluation_times(coefficients, length)
        values = [mp.polyval(coefficients, d) for d in times]
        if values[0] >= 0:
            raise ArithmeticError(f"the guard to {leads_to} is above zero and was not seen to rise")
        above = next((j for j, value in enumerate(values) if value >= 0), None)
        if above is not None:
            rises.append((root(coefficients, times[above - 1], times[above]), leads_to))
    return min(rises)[::-1] if rises else None


def evaluation_times(coefficients, length) -> list:
    """Times at which a guard is evaluated: an even grid and, because of light touches, its maxima."""
    just_passed = abs(coefficients[-1]) < ENTRY_ZERO
    grid = [length * j / GRID for j in range(int(just_passed), GRID + 1)]
    order = len(coefficients) - 1
    falling = [-(order - k) * c for k, c in enumerate(coefficients[:-1])]
    slopes = [mp.polyval(falling, d) for d in grid]
    turns = [j for j in range(len(grid) - 1) if slopes[j] < 0 <= slopes[j + 1]]
    peaks = [root(falling, grid[j], grid[j + 1]) for j in turns]
    return sorted(grid + peaks)


def root(coefficients, low, high):
    """Bisection until Newton cannot leave, then Newton on the Taylor polynomial."""
    for _ in range(24):
        middle = (low + high) / 2
        low, high = (middle, high) if mp.polyval(coefficients, middle) < 0 else (low, middle)
    d = (low + high) / 2
    for _ in range(6):
        value, slope = mp.polyval(coefficients, d, derivative=True)
        d -= value / slope
    return d


def start(case: Case):
    """Phase and state (x, y, z, v) of the start; these pieces begin well inside a phase."""
    s, m = ({k: mpf(v) for k, v in d.items()} for d in (case.start, case.parameters))
    state = (s["p"] + s["v"], s["y"], s["q"] + s["v"], s["v"])
    if s["p"] - s["q"] - m["g"] < -(mpf(10) ** -12):
        return NO_CONTACT, state
    return impact(m, (s["q"] + m["g"] + s["v"], *state[1:])), (s["q"] + m["g"] + s["v"], *state[1:])


def impact(m, state) -> str:
    """The phase, contact or progression, that the mass enters when it meets the slider."""
    x, y, z, v = state
    return CONTACT if 2 * m["xi"] * y + z - v < 1 else PROGRESSION


def integrate(case: Case, switches: int):
    """Yield (phase, elapsed, state) at the start and at each of the first `switches` switches."""
    m = {k: mpf(v) for k, v in case.parameters.items()}
    angle = m["omega"] * mpf(case.start["tau"]) + m["phi"]
    (phase, state), oscillator, elapsed = start(case), (mp.cos(angle), mp.sin(angle)), mpf(0)
    yield phase, elapsed, state
    while switches:
        states, oscillators = series(m, phase, state, oscillator)
        length = step_length(states)
        event = first_rise(m, phase, states, length)
        d = event[1] if event else length
        state, oscillator, elapsed = at(states, d), at(oscillators, d), elapsed + d
        if event:
            phase = impact(m, state) if event[0] == "impact" else event[0]
            switches -= 1
            yield phase, elapsed, state


def rows(case: Case, switches: int):
    start_tau = mpf(case.start["tau"]) + case.start["cycle"] * 2 * mp.pi / mpf(case.parameters["omega"])
    for index, (phase, elapsed, (x, y, z, v)) in enumerate(integrate(case, switches)):
        numbers = (elapsed, start_tau + elapsed, x - v, y, z - v, v, x, z)
        yield ",".join([str(index), phase, *(mp.nstr(n, DIGITS, strip_zeros=False) for n in numbers)])


def generate(case: Case, out: Path) -> None:
    started = time.perf_counter()
    comments = [f"# case = {case.name}", f"# method = Taylor series of order {ORDER}, {WORKING_DIGITS} digits"]
    name = f"pieces/{case.name}.csv"
    manifest.write(out / name, comments + [",".join(COLUMNS)] + list(rows(case, PIECES[case.name])))
    entry = {
        "digits": DIGITS,
        "precision_bits": mp.prec,
        "generator": Path(__file__).name,
        "command": f"python {Path(__file__).name} --case {case.name}",
    }
    manifest.record(out, {name: entry})
    print(f"{case.name}: {PIECES[case.name]} switches, {time.perf_counter() - started:.1f} s", file=sys.stderr)


def read(path: Path) -> list:
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def check(out: Path) -> bool:
    """Does every row of every piece agree with the event table to the last digit but rounding?"""
    agreed = True
    for path in sorted((out / "pieces").glob("*.csv")):
        piece, table = read(path), read(out / "events" / path.name)
        same_phases = [r["phase"] for r in piece] == [r["phase"] for r in table[: len(piece)]]
        worst = max(distance(a, b) for a, b in zip(piece, table, strict=False))
        good = same_phases and worst <= AGREEMENT
        agreed = agreed and good
        verdict = "" if good else "  FAILS"
        print(f"{path.stem}: {len(piece) - 1} switches, worst difference {mp.nstr(worst, 2)}{verdict}")
    return agreed


def distance(row: dict, truth: dict) -> mpf:
    """The largest difference of two rows, relative to 1 + |value|."""
    return max(abs(mpf(row[key]) - mpf(truth[key])) / (1 + abs(mpf(truth[key]))) for key in NUMBERS)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", default=[], choices=PIECES, metavar="NAME")
    parser.add_argument("--cases", type=Path, default=HERE.parent / "validation" / "cases", metavar="DIR")
    parser.add_argument("--out", type=Path, default=HERE, metavar="DIR")
    parser.add_argument("--check", action="store_true", help="compare the pieces in --out with the event tables there")
    arguments = parser.parse_args()
    mp.dps = WORKING_DIGITS
    if arguments.check:
        sys.exit(0 if check(arguments.out) else 1)
    for path in select(arguments.cases, arguments.case or list(PIECES)):
        generate(Case.read(path), arguments.out)


if __name__ == "__main__":
    main()

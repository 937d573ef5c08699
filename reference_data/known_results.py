"""Do the tables of the systems meet what is known without them?

    python known_results.py [--out DIR] [--oscillator NAME]...

Instants that are rational, published or given by a formula of their own, derivatives alike
(`known_gradients.py`), and the oscillator's own tables, made again from
`percussive-oscillator.system.toml` by the general prover.
"""

import argparse
import sys
from decimal import ROUND_HALF_UP, Context, Decimal
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

from flint import fmpq
from mpmath import mp, mpf

import generate_systems
import known_gradients
import system_file
from affine_expression import number
from case import Case
from generate_events import HERE
from generate_pieces import read
from generate_systems import SYSTEMS
from system_case import SystemCase
from tables import DIGITS

# The instants of switching that ARGESIM comparison C5 was solved with, to twelve decimals.
C5_INSTANTS = """1.108306167771 2.129685355155 3.054152906996 4.075532094379 4.999999646220"""
HALF_PERIODS = {"relay-1e-2": "1.919201", "relay-1e-4": "1.840734", "relay-1e-6": "1.839883"}
OSCILLATOR_NAMES = {"omega": "frequency", "phi": "phase"}
# One case for each: forcing phase, damping on every side of critical, grazes, deep chaos.
OSCILLATOR_CASES = [
    "chaos-from-rest",
    "critical-xi-1",
    "fig7e-period-5",
    "graze-miss-1e-12",
    "graze-overlap-1e-12",
    "impact-into-progression",
    "near-critical",
    "stiff-xi-0-001",
]
LAST_PLACE = mpf("1e-6")  # of the half periods above, which are cut after it
BEFORE_HORIZON = Fraction(1, 1000)  # of it: the horizon of a system's case is a rational number
WORKING_DIGITS = 40


def events(out: Path, name: str) -> list:
    return read(out / "events" / f"{name}.csv")


def header(out: Path, name: str) -> dict:
    lines = (out / "events" / f"{name}.csv").read_text().splitlines()
    return dict(line[2:].split(" = ", 1) for line in lines if line.startswith("#"))


def printed(value: Fraction) -> Decimal:
    """The value as a table prints it."""
    context = Context(prec=DIGITS, rounding=ROUND_HALF_UP)
    return context.divide(Decimal(value.numerator), Decimal(value.denominator))


def ball(out: Path) -> list:
    """The ball's impacts: t_n = (2 v/g) (1 + e + ... + e^(n - 1)), and their limit."""
    rows, given = events(out, "ball-geometric"), header(out, "ball-geometric")
    g, e = (Fraction(float(given[f"parameters.{key}"])) for key in "ge")
    v, instant, wrong = Fraction(float(given["start.v"])), Fraction(0), []
    limit = 2 * v / g / (1 - e)
    for row in rows[1:-1]:
        instant, v = instant + 2 * v / g, e * v
        if Decimal(row["time"]) != printed(instant) or Decimal(row["v"]) != printed(v):
            wrong.append(f"impact {row['index']}")
    earliest, latest = (Fraction(given[f"accumulation.{end}"]) for end in ("earliest", "latest"))
    return wrong if earliest <= limit <= latest else [*wrong, "accumulation"]


def spheres(out: Path) -> list:
    """Three spheres meet at the instant 1; elastic ones exchange all that they have."""
    row = events(out, "spheres-meet")[-2]
    velocities = [Decimal(row[f"v{i}"]) for i in (1, 2, 3)]
    good = Decimal(row["time"]) == 1 and velocities == [-1, 0, 1]
    return [] if good else ["spheres-meet"]


def c5(out: Path) -> list:
    """The published instants of the two-state model."""
    place = Decimal("1e-12")
    ours = [Decimal(row["time"]).quantize(place) for row in events(out, "c5-published")[1:-1]]
    return [] if ours == [Decimal(t) for t in C5_INSTANTS.split()] else ["c5-published"]


def relays(out: Path) -> list:
    """Half the period of the limit cycle: C (I + e^AT)^-1 A^-1 (e^AT - I) B = delta."""
    wrong = []
    a = mp.matrix([[-1, 1, 0], [0, -1, 1], [0, 0, -1]])
    b, c, one = mp.matrix([0, 0, 1]), mp.matrix([[1, 0, 0]]), mp.eye(3)
    for name, known in HALF_PERIODS.items():
        delta = mpf(float(header(out, name)["parameters.delta"]))

        def excess(half, delta=delta):
            e = mp.expm(a * half)
            return (c * mp.inverse(one + e) * mp.inverse(a) * (e - one) * b)[0] - delta

        expected = mp.findroot(excess, mpf(known))
        last = [mpf(row["time"]) for row in events(out, name)[-3:-1]]
        distance = abs(last[1] - last[0] - expected)
        if abs(expected - mpf(known)) > LAST_PLACE or distance > LAST_PLACE / 10:
            wrong.append(f"{name}: {mp.nstr(last[1] - last[0], 12)} for {mp.nstr(expected, 12)}")
    return wrong


def flights(out: Path) -> list:
    """With Gamma = sqrt(1 + pi^2) the plastic ball flies for exactly one period of the table."""
    rows = events(out, "plastic-one-period")[:-1]
    flown = [
        mpf(after["time"]) - mpf(before["time"])
        for before, after in pairwise(rows)
        if before["mode"] == "flight"
    ]
    far = max(abs(time - 2 * mp.pi) for time in flown)
    return [] if far < mpf(2) ** -50 else [f"plastic-one-period by {mp.nstr(far, 2)}"]


def as_system(case: Case) -> SystemCase:
    """A case of the oscillator, with a start inside no-contact, as a case of the system file."""
    given = {OSCILLATOR_NAMES.get(k, k): value for k, value in case.parameters.items()}
    start = {"mode": "no-contact", "t": case.start["tau"]}
    start |= {key: case.start[key] for key in ("p", "y", "q", "v")}
    system = system_file.read(SYSTEMS / "percussive-oscillator.system.toml", given, start)
    span = fmpq(*float((case.span() * (1 - float(BEFORE_HORIZON))).mid()).as_integer_ratio())
    return SystemCase(case.name, system, start, number(case.start["tau"]) + span, 0.0, 1, False)


def oscillator(names: list) -> list:
    """The oscillator's event tables, to every digit printed."""
    wrong = []
    for name in names:
        case = as_system(Case.read(HERE.parent / "validation" / "cases" / f"{name}.toml"))
        made = [row.split(",") for row in generate_systems.tables(case)[2]]
        known = read(HERE / "events" / f"{name}.csv")
        pairs = list(zip(made[:-1], known[:-1], strict=False))
        late = float(known[len(pairs)]["elapsed"]) < float(case.span())
        keys = ("phase", "elapsed", "tau", "p", "y", "q", "v")
        if late or any(row[2:9] != [other[key] for key in keys] for row, other in pairs):
            wrong.append(name)
    return wrong


def unmet(out: Path, names: list) -> list:
    """What is known and not met by the tables in `out`."""
    mp.dps = WORKING_DIGITS
    found = [*ball(out), *spheres(out), *c5(out), *relays(out), *flights(out)]
    found += known_gradients.unmet(out)
    return found + [f"oscillator: {name}" for name in oscillator(names)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=HERE, metavar="DIR")
    parser.add_argument("--oscillator", action="append", default=[], metavar="NAME")
    arguments = parser.parse_args()
    found = unmet(arguments.out, arguments.oscillator or OSCILLATOR_CASES)
    print(f"known and not met: {', '.join(found) or 'nothing'}")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()

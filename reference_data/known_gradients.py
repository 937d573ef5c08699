"""Derivatives through events that are known without their tables: by closed forms, or published."""

from decimal import Decimal
from fractions import Fraction
from pathlib import Path

from generate_pieces import read

# Of SciML and diffrax threads, in which the answer is a whole number: case, event, name, column.
WHOLE = {
    ("diffrax-729", "end", "event_time", "dy"): 1,
    ("ordinarydiffeq-4388", "reached", "q", "dtime"): 1,
    ("diffeqgpu-533", "end", "p", "du"): -1,
}
# ferx-core issue 1129 gives differences of central/V by eta, where CL and the lag go as exp(eta).
FERX = {"CL": Decimal("-2.07188"), "lag": Decimal("7.14133")}
IMPACTS = 2
BALL = {"g": Fraction(2), "e": Fraction(1, 2), "v": Fraction(3, 2)}


def cells(out: Path, case: str, event: str, name: str) -> list:
    """The rows of a table that are of one event and one name."""
    rows = read(out / "gradients" / f"{case}.csv")
    return [row for row in rows if row["event"] == event and row["wrt"] == name]


def whole(out: Path) -> list:
    wrong = []
    for (case, event, name, column), value in WHOLE.items():
        rows = cells(out, case, event, name)
        if len(rows) != 1 or Decimal(rows[0][column]) != value:
            wrong.append(case)
    return wrong


def ball(out: Path) -> list:
    """Impact n of a ball is at 2 v/g (1 + e + ... + e^(n-1)), and leaves with v e^n."""
    g, e, v = BALL["g"], BALL["e"], BALL["v"]
    wrong = []
    for name in ("g", "e", "start.v"):
        rows = cells(out, "ball-first-impacts", "impact", name)
        wrong += [] if len(rows) == IMPACTS else ["ball-first-impacts"]
        for n, row in enumerate(rows, 1):
            series = sum(e**k for k in range(n))
            slope = sum(k * e ** (k - 1) for k in range(n))
            known = {
                "g": (-2 * v / g**2 * series, Fraction(0)),
                "e": (2 * v / g * slope, v * n * e ** (n - 1)),
                "start.v": (2 / g * series, e**n),
            }[name]
            if (Fraction(row["dtime"]), Fraction(row["dv"])) != known or row["dx"] != "0":
                wrong.append(f"ball-first-impacts: impact {n} by {name}")
    return wrong


def ferx(out: Path) -> list:
    """The differences that the thread gives, to their last decimal."""
    lines = (out / "gradients" / "ferx-1078.csv").read_text().splitlines()
    heading = dict(line[2:].split(" = ", 1) for line in lines if line.startswith("#"))
    wrong = []
    for name, published in FERX.items():
        (row,) = cells(out, "ferx-1078", "end", name)
        scale = Decimal(heading[f"parameters.{name}"]) / Decimal(heading["parameters.V"])
        if abs(Decimal(row["dcentral"]) * scale - published) > Decimal("1e-5"):
            wrong.append(f"ferx-1078 by {name}")
    return wrong


def unmet(out: Path) -> list:
    """What is known and not met by the tables of derivatives in `out`."""
    return [*whole(out), *ball(out), *ferx(out)]

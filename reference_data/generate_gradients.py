"""Tables of the derivatives of events by parameters and starts, in ball arithmetic.

    python generate_gradients.py [--case NAME]... [--out DIR]

Writes gradients/NAME.csv for the cases of gradients/cases.toml: for each row of the run, and each
name, the derivative of the event's time and of the states after it. A decision or a digit that the
precision cannot prove doubles it and starts the case again.
"""

import argparse
import math
import sys
import time
from decimal import Context, Decimal
from pathlib import Path

from flint import arb, ctx, fmpq

import gradient_case
import manifest
from affine_expression import Refused
from crossing import Undecided
from generate_events import FIRST_BITS, HERE, LAST_BITS
from gradient_case import GradientCase
from gradient_run import Gradient, GradientRun
from proved_events import EventRun
from tables import DIGITS, rounded

FOLDER = "gradients"
LARGEST_ZERO = arb(10) ** -DIGITS  # a ball that holds 0 and is smaller may be 0: more bits tell
EXACT = Context(prec=2 * DIGITS)


def cell(x: arb | fmpq, is_zero: bool) -> str:
    """A derivative to DIGITS significant digits, or 0 where the model makes it zero."""
    if isinstance(x, fmpq):
        is_zero, x = x == 0, arb(x)
    if is_zero:
        if not x.contains(0):
            raise Refused("a derivative that is zero by the model is not zero")
        return "0" if x.rad() < LARGEST_ZERO else undecided("zero")
    if not (x > 0 or x < 0):
        raise Undecided("digit")
    place = math.floor(float((abs(x).log() / arb(10).log()).mid()))
    places = DIGITS - 1 - place
    integer = rounded(x, places)
    if abs(integer) < 10 ** (DIGITS - 1) or abs(integer) >= 10**DIGITS:
        places += 1 if abs(integer) < 10 ** (DIGITS - 1) else -1
        integer = rounded(x, places)
    return f"{Decimal(integer).scaleb(-places, EXACT)}".lower()


def undecided(what: str):
    raise Undecided(what)


def cells(gradient: Gradient) -> list:
    numbers = [gradient.time, *gradient.states]
    return [cell(x, is_zero) for x, is_zero in zip(numbers, gradient.zeros, strict=True)]


def attempted(case: GradientCase) -> list:
    """The rows of the table, in the present number of bits."""
    run = EventRun(case.system(), case.until)
    run.run()
    if run.rows[-1].event != "end":
        raise Refused(f"the run ends with {run.rows[-1].event!r}: a case runs up to its horizon")
    found = [list(GradientRun(run, case.derivatives(name)).gradients()) for name in case.names]
    lines = []
    for n, row in enumerate(run.rows):
        for name, gradients in zip(case.names, found, strict=True):
            start = [str(n), row.event, row.mode, name, ""]
            try:
                lines.append(",".join([*start, *cells(gradients[n])]))
            except Undecided as reason:
                raise Undecided(f"{reason} of row {n} by {name}") from None
    return lines


def table(case: GradientCase) -> tuple:
    """(bits, rows) at the first precision that proves all of them."""
    bits = FIRST_BITS
    while bits <= LAST_BITS:
        ctx.prec = bits
        try:
            return bits, attempted(case)
        except Undecided as undecided:
            reason, bits = undecided, 2 * bits
    raise Refused(f"undecided at {LAST_BITS} bits: {reason}")


def heading(case: GradientCase) -> list:
    """Comment lines: the case and its numbers as they are written; and the columns."""
    system = case.system()
    pairs = [("case", case.name), ("system", system.name), ("rows", "derivatives of events")]
    pairs += [(f"parameters.{key}", value) for key, value in system.parameters.items()]
    pairs += [(f"start.{key}", value) for key, value in case.file_start().items()]
    pairs += [("horizon.until", case.until), ("digits", DIGITS)]
    columns = ["n", "event", "mode", "wrt", "side", "dtime", *(f"d{s}" for s in system.states)]
    return [*(f"# {key} = {value}" for key, value in pairs), ",".join(columns)]


def generate(case: GradientCase, out: Path) -> None:
    started = time.perf_counter()
    bits, rows = table(case)
    name = f"{FOLDER}/{case.name}.csv"
    manifest.write(out / name, [*heading(case), *rows])
    entry = {
        "digits": DIGITS,
        "precision_bits": bits,
        "generator": Path(__file__).name,
        "command": f"python {Path(__file__).name} --case {case.name}",
    }
    manifest.record(out, {name: entry})
    seconds = time.perf_counter() - started
    print(f"{case.name}: {len(rows)} rows, {bits} bits, {seconds:.1f} s", file=sys.stderr)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", default=[], metavar="NAME")
    parser.add_argument("--out", type=Path, default=HERE, metavar="DIR")
    arguments = parser.parse_args()
    for case in gradient_case.read(arguments.case):
        try:
            generate(case, arguments.out)
        except Refused as refusal:
            raise SystemExit(f"{case.name}: {refusal}") from None


if __name__ == "__main__":
    main()

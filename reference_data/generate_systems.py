"""Event tables and samples of any piecewise-affine system, in ball arithmetic.

    python generate_systems.py [--case NAME]... [--cases DIR] [--systems DIR] [--out DIR]

Writes events/NAME.csv (the start, the state after each event, how the run ended) and
samples/NAME.csv (the state at the instants that the case asks for). A decision or a digit that the
precision cannot prove doubles it and starts the case again.
"""

import argparse
import sys
import time
import tomllib
from pathlib import Path

from flint import arb, arb_mat, ctx, fmpq

import manifest
from affine_expression import Refused
from crossing import Undecided
from generate_events import FIRST_BITS, HERE, LAST_BITS, select
from system_case import SystemCase
from system_run import Run
from tables import DECIMALS, DIGITS, proved_decimal

SYSTEMS = HERE.parent / "validation" / "systems"
CASES = HERE.parent / "validation" / "cases" / "systems"
GROWTH_ERROR = 1e-6  # relative radius of a growth that is printed with four digits
ENCLOSURE_DIGITS = 30


def cells(numbers: list) -> list:
    return [proved_decimal(number) for number in numbers]


def growth_cell(growth: arb) -> str:
    if not growth.rad() < GROWTH_ERROR * growth:
        raise Undecided("growth")
    return f"{float(growth.mid()):.4g}"


def entries(case: SystemCase, z: arb_mat) -> list:
    """The states, without what was appended to them."""
    return [z[i, 0] for i in range(len(case.system.states))]


def event_rows(case: SystemCase, run: Run):
    """Row 0 is the start; the last one says how the run ended."""
    for index, row in enumerate(run.rows):
        elapsed = row.elapsed.ball
        numbers = cells([elapsed, case.clock(elapsed), *entries(case, row.z)])
        growth = map(growth_cell, row.growth)
        yield ",".join([str(index), row.event, row.mode, *numbers, *growth])


def sample_rows(case: SystemCase, run: Run):
    """The instants of the case before its horizon, as far as the run goes."""
    spacing, current = case.span() / case.samples, 0
    check_sample_margins(case, run, spacing)
    for index in range(case.samples):
        elapsed = arb(spacing * index)
        if not elapsed < run.elapsed.ball:
            return
        while current + 1 < len(run.segments) and run.segments[current + 1].begins.ball < elapsed:
            current += 1
        segment = run.segments[current]
        exponential = run.flow(segment.state.mode).matrix_at(elapsed - segment.begins.ball)
        z = exponential * segment.state.z
        states = run.growth.of_states(exponential * run.growth.lift(segment.state.z))
        numbers = cells([elapsed, case.clock(elapsed), *entries(case, z)])
        growth = map(growth_cell, run.growth.measured(None, states, segment.sensitivities)[1:])
        yield ",".join([str(index), segment.state.mode, *numbers, *growth])


def check_sample_margins(case: SystemCase, run: Run, spacing: fmpq) -> None:
    """Refuses a case with an event, other than its start, within the margin of a sample."""
    for row in run.rows[1:]:
        nearest = round(float((row.elapsed.ball / arb(spacing)).mid()))
        distance = abs(row.elapsed.ball - arb(spacing * nearest))
        if 0 < nearest < case.samples and not distance > arb(run.margin):
            raise Refused(f"event at {row.elapsed.ball.str(10)} close to a sample")


def tables(case: SystemCase):
    """(bits, run, event rows, sample rows) at the first precision that proves all of them."""
    bits = FIRST_BITS
    while bits <= LAST_BITS:
        ctx.prec = bits
        try:
            run = Run(case)
            run.run()
            return bits, run, list(event_rows(case, run)), list(sample_rows(case, run))
        except Undecided as undecided:
            reason, bits = undecided, 2 * bits
    raise Refused(f"undecided at {LAST_BITS} bits: {reason}")


def heading(case: SystemCase, run: Run, what: str) -> list:
    """Comment lines: the case, its numbers as they are written, and how the run ended."""
    system = case.system
    pairs = [("case", case.name), ("system", system.name), ("rows", what)]
    pairs += [(f"parameters.{key}", value) for key, value in system.parameters.items()]
    start = case.written_start | {"mode": run.rows[0].mode}
    pairs += [(f"start.{key}", value) for key, value in start.items()]
    pairs += [("horizon.until", case.written_until), ("horizon.samples", case.samples)]
    pairs += [("horizon.backward", str(case.backward).lower())]
    if run.remaining is not None:
        begins, ends = run.elapsed.ball + run.remaining.least, run.elapsed.ball + run.remaining.most
        pairs.append(("accumulation.earliest", bound(case.clock(begins).lower())))
        pairs.append(("accumulation.latest", bound(case.clock(ends).upper())))
    if run.order_matters:
        pairs.append(("order_matters", " ".join(map(str, run.order_matters))))
    pairs += [("digits", DIGITS), ("decimals", DECIMALS)]
    return [f"# {key} = {value}" for key, value in pairs]


def bound(x: arb) -> str:
    """An end of an enclosure, which is itself good to all the digits printed."""
    return x.str(ENCLOSURE_DIGITS, radius=False)


def columns(case: SystemCase, sample: bool) -> str:
    states = case.system.states
    growth = [f"growth_{name}" for name in states]
    if sample:
        return ",".join(["index", "mode", "elapsed", "time", *states, *growth])
    return ",".join(["index", "event", "mode", "elapsed", "time", *states, "growth_time", *growth])


def generate(case: SystemCase, out: Path) -> None:
    started = time.perf_counter()
    bits, run, events, samples = tables(case)
    entry = {
        "digits": DIGITS,
        "precision_bits": bits,
        "generator": Path(__file__).name,
        "command": f"python {Path(__file__).name} --case {case.name}",
    }
    files = {
        f"events/{case.name}.csv": ("events", events, False),
        f"samples/{case.name}.csv": ("samples", samples, True),
    }
    for name, (what, rows, sample) in files.items():
        manifest.write(out / name, [*heading(case, run, what), columns(case, sample), *rows])
    manifest.record(out, dict.fromkeys(files, entry))
    seconds = time.perf_counter() - started
    ending = run.rows[-1].event
    print(
        f"{case.name}: {len(events) - 2} events, {ending}, {bits} bits, {seconds:.1f} s",
        file=sys.stderr,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", default=[], metavar="NAME")
    parser.add_argument("--cases", type=Path, default=CASES, metavar="DIR")
    parser.add_argument("--systems", type=Path, default=SYSTEMS, metavar="DIR")
    parser.add_argument("--out", type=Path, default=HERE, metavar="DIR")
    arguments = parser.parse_args()
    for path in select(arguments.cases, arguments.case):
        if not path.name.endswith(".system.toml"):
            try:
                generate(SystemCase.read(path, arguments.systems), arguments.out)
            except (Refused, tomllib.TOMLDecodeError) as refusal:
                raise SystemExit(f"{path.stem}: {refusal}") from None


if __name__ == "__main__":
    main()

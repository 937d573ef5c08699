"""Holds the tables of derivatives to differences of runs, which know of no derivative at an event.

    python check_gradients.py [--case NAME]...

Each case is run with each of its names a little more and a little less: the runs are those of the
prover, of the rational number that is the value more or less 2^-STEP of its size. Central
differences over one step and over two tell what they leave out; where they cannot tell a digit the
precision is doubled. Exit 1 if a cell of a table is not the difference rounded.
"""

import argparse
import csv
import sys
import time
import tomllib

from flint import arb, ctx, fmpq

import gradient_case
from affine_expression import Refused, number
from coefficient_derivatives import START
from crossing import Undecided
from generate_events import HERE, LAST_BITS
from generate_gradients import FOLDER
from gradient_case import GradientCase
from printed_cells import agrees
from proved_events import EventRun
from system_file import Builder, System

STEP = 192
FIRST_BITS = 512


class MovedBuilder(Builder):
    """Builds a system one parameter of which is changed by a rational number."""

    def __init__(self, table: dict, overriding: dict, start: dict | None, moved: str, by: fmpq):
        self.moved, self.by = moved, by
        super().__init__(table, overriding, start)

    def parameter(self, name: str) -> fmpq:
        return number(self.parameters[name]) + (self.by if name == self.moved else 0)


def size_of(case: GradientCase, name: str) -> fmpq:
    """The power of two next below the size of what is changed; 1 where that is 0."""
    system = case.system()
    if name.startswith(START):
        value = system.start["state"][system.states.index(name.removeprefix(START))][-1]
    else:
        value = number(system.parameters[name])
    if value == 0:
        return fmpq(1)
    return fmpq(2) ** (abs(value.p).bit_length() - value.q.bit_length())


def moved(case: GradientCase, name: str, by: fmpq) -> System:
    """The system of a case with a parameter, or a state at the start, changed."""
    table = tomllib.loads(case.path.read_text())
    system = MovedBuilder(table, case.parameters, case.start, name, by).system()
    if name.startswith(START):
        system.start["state"][system.states.index(name.removeprefix(START))][-1] += by
    return system


def cells(case: GradientCase, name: str, by: fmpq) -> tuple:
    """(events and modes, cells) of a run: of each row the time and the states."""
    system = moved(case, name, by)
    run = EventRun(system, case.until)
    run.run()
    states = range(len(system.states))
    balls = [
        [system.start["t"] + row.elapsed.ball, *(row.z[i, 0] for i in states)] for row in run.rows
    ]
    return [(row.event, row.mode) for row in run.rows], balls


def differences(case: GradientCase, name: str) -> tuple:
    """(events and modes, differences) by a name, each ball as wide as what it may leave out."""
    step = size_of(case, name) * fmpq(2) ** -STEP
    runs = [cells(case, name, step * k) for k in (1, -1, 2, -2)]
    if any(run[0] != runs[0][0] for run in runs):
        raise Refused(f"{name}: the events on both sides differ")
    rows = zip(*(run[1] for run in runs), strict=True)
    return runs[0][0], [
        [difference(*four, arb(step)) for four in zip(*row, strict=True)] for row in rows
    ]


def difference(more: arb, less: arb, twice_more: arb, twice_less: arb, step: arb) -> arb:
    """The central difference over one step; that over two is off by four times as much."""
    one, two = (more - less) / (2 * step), (twice_more - twice_less) / (4 * step)
    return one + arb(0, abs(two - one).upper())


def table_of(case: GradientCase) -> dict:
    """{name: [(event, mode, cells)..]} of a table."""
    path = HERE / FOLDER / f"{case.name}.csv"
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    found = {name: [] for name in case.names}
    for n, event, mode, name, side, *numbers in list(csv.reader(lines))[1:]:
        if side or int(n) != len(found[name]):
            raise Refused(f"{path}: row {n} of {name} is out of place")
        found[name].append((event, mode, numbers))
    return found


def unlike(case: GradientCase, name: str, rows: list) -> list:
    """Cells of a table that are not the differences rounded."""
    events, found = differences(case, name)
    if events != [(event, mode) for event, mode, _ in rows]:
        return [f"{name}: other events"]
    wrong = []
    for n, ((_, _, numbers), balls) in enumerate(zip(rows, found, strict=True)):
        for k, (cell, ball) in enumerate(zip(numbers, balls, strict=True)):
            if not agrees(cell, ball):
                wrong.append(f"row {n}, {name}, column {k}: {cell}, by differences {ball.str(30)}")
    return wrong


def check(case: GradientCase) -> list:
    """Cells of a case's table that its differences do not confirm."""
    started, wrong, most = time.perf_counter(), [], 0
    tables = table_of(case)
    for name, rows in tables.items():
        bits = FIRST_BITS
        while True:
            ctx.prec = bits
            try:
                wrong += unlike(case, name, rows)
                break
            except Undecided as undecided:
                bits *= 2
                if bits > LAST_BITS:
                    wrong.append(f"{name}: undecided at {LAST_BITS} bits: {undecided}")
                    break
        most = max(most, bits)
    seconds = time.perf_counter() - started
    count = sum(len(numbers) for rows in tables.values() for _, _, numbers in rows)
    print(f"{case.name}: {count} cells, {len(wrong)} differ, {most} bits, {seconds:.1f} s")
    return [f"{case.name}: {what}" for what in wrong]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", default=[], metavar="NAME")
    wrong = [line for case in gradient_case.read(parser.parse_args().case) for line in check(case)]
    for line in wrong:
        print(line, file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

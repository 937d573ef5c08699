"""Proved events of the systems in `limits`, which go on after accumulations.

    python generate_limits.py [--check]

Writes NAME.csv for each NAME.system.toml, whose first line is `# until = TIME`: the rows of `percuss
events --digits 25`. With `--check` holds the files to them instead.
"""

import argparse
import re
import sys

from flint import arb

import manifest
import system_file
from crossing import Undecided
from generate_events import HERE, LAST_BITS
from generate_gradients import cell
from printed_cells import NOTHING_BUT_ZERO
from proved_events import attempted, clock, states

FOLDER = HERE / "limits"
FIRST_BITS = 256
UNTIL = re.compile(r"# until = (\S+)")


def printed(ball: arb) -> str:
    return cell(ball, ball.contains(0) and bool(abs(ball) < NOTHING_BUT_ZERO))


def systems() -> list:
    """Paths of the systems that go on after accumulations."""
    return sorted(FOLDER.glob("*.system.toml"))


def table(path) -> tuple:
    """(rows of a system, bits), in as many bits as its digits need."""
    system, until = system_file.read(path), float(UNTIL.match(path.read_text())[1])
    bits = FIRST_BITS
    while bits <= LAST_BITS:
        run, reason = attempted(system, until, bits)
        try:
            if reason is None:
                return "".join(f"{line}\n" for line in lines(system, run)), bits
        except Undecided:
            pass
        bits *= 2
    sys.exit(f"{path.name} is undecided in {LAST_BITS} bits: {reason}")


def table_path(path):
    return path.with_name(path.name.replace(".system.toml", ".csv"))


def lines(system, run):
    yield ",".join(["n", "time", "event", "mode", *system.states])
    for n, row in enumerate(run.rows):
        cells = [printed(it) for it in [clock(system, row), *states(system, row.z)]]
        yield ",".join([str(n), cells[0], row.event, row.mode, *cells[1:]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compares the files")
    checks = parser.parse_args().check
    entry = {"digits": 25, "generator": "generate_limits.py", "command": "python generate_limits.py"}
    for path in systems():
        (text, bits), out = table(path), table_path(path)
        if not checks:
            out.write_text(text)
            manifest.record(HERE, {f"limits/{out.name}": entry | {"precision_bits": bits}})
        elif out.read_text() != text:
            sys.exit(f"{out.name} is not what this program finds")


if __name__ == "__main__":
    main()

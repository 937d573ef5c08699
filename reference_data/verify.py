"""Is the reference data whole, unaltered, reproducible, and right where the paper says what is right?

    python verify.py [NAME]... [--cases DIR]

Checks every hash, that each case has its files and each file its case, that the cases NAMEd
(two small ones by default, two of the systems, and two of derivatives) and the runs that go on
after accumulations come out the same byte for byte, that the pieces integrated from the differential equations agree with the event tables, that
differences of runs agree with the derivatives of the same cases, that Table 1 does, that each kind
of trouble has two cases of the systems, and that what is known of the systems without their tables
is met. Exit 1 if any fails.
"""

import argparse
import hashlib
import json
import sys
import tempfile
import tomllib
from decimal import Decimal
from pathlib import Path

from mpmath import mp

import check_gradients
import generate_events
import generate_gradients
import generate_limits
import generate_pieces
import generate_system_pieces
import generate_systems
import gradient_case
import known_results
import manifest
from case import Case
from generate_events import HERE, select
from generate_pieces import PIECES, read
from system_case import SystemCase
from system_file import TROUBLE

SMALL = ["table1-first-row", "graze-overlap-1e-12"]
SMALL_SYSTEMS = ["plastic-lands-late", "spheres-meet-inelastic"]
SMALL_GRADIENTS = ["diffeqgpu-533", "relay-cycle"]
CASES_EACH = 2  # of every kind of trouble
LAST_PRINTED_DIGIT = Decimal("1e-5")


def altered() -> list:
    """Files whose hash is not the manifest's, and files that it does not list."""
    files = json.loads((HERE / manifest.NAME).read_text())["files"]
    hashes = {name: hashlib.sha256((HERE / name).read_bytes()).hexdigest() for name in files}
    found = {path.relative_to(HERE).as_posix() for path in HERE.glob("**/*.csv")}
    return sorted({n for n in files if hashes[n] != files[n]["sha256"]} | found ^ files.keys())


def unpaired(cases: Path) -> list:
    """Files missing for a case, and files whose case is gone."""
    names = {path.stem for path in [*select(cases, []), *system_cases([])]}
    wanted = {f"{folder}/{name}.csv" for folder in ("events", "samples") for name in names}
    wanted |= {f"pieces/{name}.csv" for name in PIECES}
    folder = generate_system_pieces.FOLDER
    wanted |= {f"{folder}/{name}.csv" for name in generate_system_pieces.PIECES}
    folder = generate_gradients.FOLDER
    wanted |= {f"{folder}/{case.name}.csv" for case in gradient_case.read([])}
    tables = map(generate_limits.table_path, generate_limits.systems())
    wanted |= {f"limits/{path.name}" for path in tables}
    present = {p.relative_to(HERE).as_posix() for p in HERE.glob("*/*.csv")}
    return sorted(wanted ^ present)


def system_cases(names: list) -> list:
    """Paths of the systems' cases wanted, all of them where no name is given."""
    return select(generate_systems.CASES, names)


def gradient_cases(names: list) -> list:
    """Cases of derivatives wanted, two small ones where no name is one of theirs."""
    known = {case.name for case in gradient_case.read([])}
    return gradient_case.read([name for name in names if name in known] or SMALL_GRADIENTS)


def rare_trouble() -> list:
    """Kinds of trouble that too few of the systems' cases are for."""
    tables = [tomllib.loads(path.read_text()) for path in system_cases([])]
    words = [word for table in tables for word in table["case"]["trouble"]]
    return [word for word in TROUBLE if words.count(word) < CASES_EACH]


def irreproducible(cases: Path, names: list) -> list:
    """Files of the cases `names` that do not come out the same byte for byte."""
    different = []
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        known = {path.stem for path in system_cases([])}
        others = known | {case.name for case in gradient_case.read([])}
        for path in select(cases, [name for name in names if name not in others] or SMALL):
            generate_events.generate(Case.read(path), out)
            if path.stem in PIECES:
                generate_pieces.generate(Case.read(path), out)
        systems = generate_systems.SYSTEMS
        for path in system_cases([name for name in names if name in known] or SMALL_SYSTEMS):
            generate_systems.generate(SystemCase.read(path, systems), out)
            if path.stem in generate_system_pieces.PIECES:
                generate_system_pieces.generate(path, systems, out)
        for case in gradient_cases(names):
            generate_gradients.generate(case, out)
        for made in sorted(out.glob("*/*.csv")):
            name = made.relative_to(out).as_posix()
            if made.read_bytes() != (HERE / name).read_bytes():
                different.append(name)
    for path in generate_limits.systems():
        made = generate_limits.table_path(path)
        if generate_limits.table(path)[0] != made.read_text():
            different.append(made.relative_to(HERE).as_posix())
    return different


def unlike_table1() -> list:
    """Rows of the printed Table 1 that the motion from rest misses by more than its last digit."""
    printed, computed = read(HERE / "table1.csv"), read(HERE / "events" / "table1-from-rest.csv")[:-1]
    far = []
    for row, ours in zip(printed, computed[-len(printed) :], strict=True):
        distance = max(abs(Decimal(row[key]) - Decimal(ours[key])) for key in ("tau", "p", "y", "q"))
        if distance > LAST_PRINTED_DIGIT or row["phase"] != ours["phase"]:
            far.append(f"point {row['point']} by {distance:.2e}")
    return far


def agreement() -> bool:
    """Do all pieces agree with the event tables?"""
    return all([generate_pieces.check(HERE), generate_system_pieces.check(HERE)])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--cases", type=Path, default=HERE.parent / "validation" / "cases", metavar="DIR")
    arguments = parser.parse_args()
    mp.dps = generate_pieces.WORKING_DIGITS
    findings = {
        "altered or unlisted": altered(),
        "without its case, or missing": unpaired(arguments.cases),
        "not reproduced": irreproducible(arguments.cases, arguments.names),
        "unlike Table 1": unlike_table1(),
        "unlike the differential equations": [] if agreement() else ["see above"],
        "unlike differences of runs": [
            line for case in gradient_cases(arguments.names) for line in check_gradients.check(case)
        ],
        "trouble with too few cases": rare_trouble(),
        "known and not met": known_results.unmet(HERE, known_results.OSCILLATOR_CASES),
    }
    for what, names in findings.items():
        print(f"{what}: {', '.join(names) or 'none'}")
    sys.exit(1 if any(findings.values()) else 0)


if __name__ == "__main__":
    main()

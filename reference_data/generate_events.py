"""Event tables and samples of every case, in ball arithmetic, from the closed forms.

    python generate_events.py [--case NAME]... [--cases DIR] [--out DIR]

Writes events/NAME.csv (the start, the state at which each phase begins, the horizon) and
samples/NAME.csv (eight instants a forcing period). A decision or a digit that the precision
cannot prove doubles it and starts the case again.
"""

import argparse
import sys
import time
from pathlib import Path

from flint import ctx

import manifest
from case import Case
from crossing import Undecided
from tables import DIGITS, heading, row
from trajectory import segments_of

HERE = Path(__file__).resolve().parent
SAMPLES_PER_PERIOD = 8
FIRST_BITS, LAST_BITS = 256, 1 << 14


def event_rows(case: Case, segments: list):
    """Row 0 is the start, the last one the horizon, whose phase is `end`."""
    tau = case.start_tau()
    for index, segment in enumerate(segments):
        yield row(index, segment.motion.phase, segment.begins, tau + segment.begins, segment.motion.entry)
    elapsed = segment.begins + segment.lasts
    yield row(len(segments), "end", elapsed, tau + elapsed, segment.motion.state(segment.lasts))


def sample_rows(case: Case, segments: list):
    """Rows at start + k periods / 8, up to and including the horizon."""
    tau, span, spacing = case.start_tau(), case.span(), case.period() / SAMPLES_PER_PERIOD
    periods, index, current = case.horizon.get("periods"), 0, 0
    while index <= SAMPLES_PER_PERIOD * periods if periods is not None else index * spacing <= span:
        elapsed = index * spacing
        while current + 1 < len(segments) and not elapsed < segments[current + 1].begins:
            if not elapsed > segments[current + 1].begins:
                raise Undecided("sample at a switch")
            current += 1
        segment = segments[current]
        yield row(index, segment.motion.phase, elapsed, tau + elapsed, segment.motion.state(elapsed - segment.begins))
        index += 1


def tables(case: Case):
    """(bits, event rows, sample rows) at the first precision that proves all of them."""
    bits = FIRST_BITS
    while bits <= LAST_BITS:
        ctx.prec = bits
        try:
            segments = list(segments_of(case))
            return bits, list(event_rows(case, segments)), list(sample_rows(case, segments))
        except Undecided:
            bits *= 2
    raise RuntimeError(f"{case.name}: undecided at {LAST_BITS} bits")


def generate(case: Case, out: Path) -> None:
    started = time.perf_counter()
    bits, events, samples = tables(case)
    entry = {
        "digits": DIGITS,
        "precision_bits": bits,
        "generator": Path(__file__).name,
        "command": f"python {Path(__file__).name} --case {case.name}",
    }
    files = {f"events/{case.name}.csv": ("phases", events), f"samples/{case.name}.csv": ("samples", samples)}
    for name, (what, rows) in files.items():
        manifest.write(out / name, heading(case, what) + rows)
    manifest.record(out, dict.fromkeys(files, entry))
    seconds = time.perf_counter() - started
    print(f"{case.name}: {len(events) - 2} switches, {bits} bits, {seconds:.1f} s", file=sys.stderr)


def select(directory: Path, names: list) -> list:
    """Paths of the case files wanted, all of them where no name is given."""
    paths = sorted(directory.glob("**/*.toml"))
    unknown = set(names) - {path.stem for path in paths}
    if unknown:
        raise SystemExit(f"no such case in {directory}: {', '.join(sorted(unknown))}")
    return [path for path in paths if not names or path.stem in names]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", default=[], metavar="NAME")
    parser.add_argument("--cases", type=Path, default=HERE.parent / "validation" / "cases", metavar="DIR")
    parser.add_argument("--out", type=Path, default=HERE, metavar="DIR")
    arguments = parser.parse_args()
    for path in select(arguments.cases, arguments.case):
        generate(Case.read(path), arguments.out)


if __name__ == "__main__":
    main()

"""`percuss events` beside the prover, on random systems: every event and every printed digit.

    python compare_systems.py [--percuss PATH] [--kind KIND]... [--each N] [--first N]
                              [--processes N] [--max-bits B] [--seconds S] [--out DIR] [--power]
                              [FILE]...

The program is asked for 25 digits of every row. A cell is right if the proved number rounds to it.
Prints a table by kind and keeps in DIR every system that was not right, with both answers. FILEs
are system files whose first line is `# until = TIME`, as those kept are: they are compared instead.
Exit 1 if anything is wrong, or undecided though the prover decides it in so many bits. --power
spoils one thing in each answer: then exit 1 if that is not noticed in one of them.
"""

import argparse
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from multiprocessing import Pool
from pathlib import Path
from typing import NamedTuple

from flint import arb

import system_file
from affine_expression import Refused
from altered_answers import altered
from crossing import Undecided
from printed_cells import agrees, digits, exactly
from proved_events import attempted, clock, states
from random_systems import KINDS, written
from verdicts import WRONG, failures, summary

FIRST_BITS, LAST_BITS = 256, 1 << 14
GIVEN_UP = ("undecided", "stopped")
HERE = Path(__file__).resolve().parent
UNTIL = re.compile(r"# until = (\S+)")
ENCLOSURE = re.compile(r"accumulate between (\S+) and (\S+)")


class Slow(Exception):
    """The prover takes too long."""


@dataclass
class Answer:
    """What the program printed: rows of cells, its last words and how it left."""

    rows: list
    words: str
    code: int


class Task(NamedTuple):
    """A system to compare."""

    kind: str
    name: str
    text: str
    until: float


@dataclass
class Result:
    """One system's verdict."""

    task: Task
    verdict: str
    why: str = ""
    events: int = 0
    bits: int = 0
    seconds: tuple = (0.0, 0.0)
    fewest: int = 25
    answer: Answer | None = None
    proved: list = field(default_factory=list)


def ask(percuss: str, path: Path, until: float, flags: list, seconds: float) -> Answer:
    """The program's rows for a system file."""
    command = [percuss, "events", str(path), "--until", repr(until), "--digits", "25", *flags]
    done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    rows = [line.split(",") for line in done.stdout.splitlines()[1:]]
    return Answer(rows, done.stderr.strip(), done.returncode)


class Comparison:
    """The rows of the program beside those of the prover."""

    def __init__(self, system, answer: Answer):
        self.system, self.answer = system, answer
        self.ending = answer.rows[-1][2] if answer.rows else ""
        self.given_up = self.ending in GIVEN_UP or self.ending not in system_file.ENDINGS
        self.rows = answer.rows[:-1] if self.ending in GIVEN_UP else answer.rows

    def verdict(self, run, complete: bool) -> tuple:
        """(verdict, why), given the run of the prover as far as it came."""
        for index, (row, ours) in enumerate(zip(self.rows, run.rows, strict=False)):
            if row[2] != ours.event or row[3] != ours.mode:
                word = "accumulation" if "accumulation" in (row[2], ours.event) else "wrong event"
                here = f"{row[2]} -> {row[3]} at {row[1]}"
                there = f"{ours.event} -> {ours.mode} at {clock(self.system, ours).str(20)}"
                return word, f"row {index} is {here}, proved {there}"
            balls = [clock(self.system, ours), *states(self.system, ours.z)]
            for cell, ball in zip([row[1], *row[4:]], balls, strict=True):
                if not agrees(cell, ball):
                    return "wrong digit", f"row {index} has {cell}, proved {ball.str(32)}"
        if len(self.rows) > len(run.rows):
            if complete:
                return "wrong event", f"row {len(run.rows)} is beyond the proved end"
            raise Undecided("rows")
        if self.given_up and len(run.rows) > len(self.rows):
            word = "undecided" if self.ending in GIVEN_UP else "digits gone"
            return word, f"after row {len(self.rows) - 1}: {last_line(self.answer.words)}"
        if complete and len(run.rows) > len(self.rows):
            return (
                "wrong event",
                f"row {len(self.rows)}, {run.rows[len(self.rows)].event}, is missing",
            )
        if not complete:
            raise Undecided("rows")
        return self.enclosure(run)

    def enclosure(self, run) -> tuple:
        """Do both enclosures of an accumulation hold an instant in common?"""
        found = ENCLOSURE.search(self.answer.words)
        if run.remaining is None or self.ending != "accumulation":
            return "right", ""
        if not found:
            return "accumulation", f"no enclosure in {self.answer.words!r}"
        last = clock(self.system, run.rows[-1])
        ours = (last + run.remaining.least).union(last + run.remaining.most)
        theirs = arb(exactly(found[1])).union(arb(exactly(found[2])))
        if ours.overlaps(theirs):
            return "right", ""
        return "accumulation", f"between {found[1]} and {found[2]}, proved {ours.str(30)}"


def last_line(words: str) -> str:
    return words.splitlines()[-1] if words else ""


def judged(system, until: float, answer: Answer, most: int | None) -> tuple:
    """(verdict, why, bits, run): the precision doubles until everything is decided."""
    comparison, bits, run, reason = Comparison(system, answer), FIRST_BITS, None, ""
    if comparison.given_up and most is not None:
        run, reason = attempted(system, until, most)
        if reason and len(run.rows) <= len(comparison.rows):
            return "excused", f"the prover, too, has {reason!r} in {most} bits", most, run
    while bits <= LAST_BITS:
        run, reason = attempted(system, until, bits)
        try:
            return *comparison.verdict(run, reason is None), bits, run
        except Undecided as undecided:
            reason, bits = reason or str(undecided), 2 * bits
    return "both undecided" if comparison.given_up else "prover slow", str(reason), bits // 2, run


def alarmed(*_):
    raise Slow


def limited(seconds: float, function, *arguments):
    signal.signal(signal.SIGALRM, alarmed)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        return function(*arguments)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def tasks(arguments: argparse.Namespace):
    """The systems that are asked for, the kinds in turn."""
    for path in arguments.files:
        text = path.read_text()
        name = path.name.removesuffix(".system.toml")
        yield Task("files", name, text, float(UNTIL.match(text)[1])), arguments
    if not arguments.files:
        for number in range(arguments.first, arguments.first + arguments.each):
            for kind in arguments.kind or KINDS:
                yield Task(kind, f"{kind}-{number}", *written(kind, number)), arguments


def compared(asked_for: tuple) -> Result:
    """The verdict on one system."""
    task, arguments = asked_for
    result = Result(task, "right")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{task.name}.system.toml"
        path.write_text(task.text)
        started = time.perf_counter()
        flags = [] if arguments.max_bits is None else ["--max-bits", str(arguments.max_bits)]
        try:
            answer = ask(arguments.percuss, path, task.until, flags, arguments.seconds)
        except subprocess.TimeoutExpired:
            result.verdict = "slow"
            return result
        asked = time.perf_counter() - started
        if arguments.power:
            return spoiled(result, answer, path, arguments)
        return hold(result, answer, path, asked, arguments)


def spoiled(result: Result, answer: Answer, path: Path, arguments) -> Result:
    """The verdict on an answer in which one thing is wrong."""
    rows = altered(answer.rows, result.task.name)
    if rows is None:
        result.verdict = "not spoiled"
        return result
    return hold(result, Answer(rows, answer.words, answer.code), path, 0.0, arguments)


def hold(result: Result, answer: Answer, path: Path, asked: float, arguments) -> Result:
    """Holds an answer against the prover's, within the time that it has."""
    result.answer, result.events = answer, max(len(answer.rows) - 2, 0)
    if not answer.rows or answer.code != expected_code(answer.rows[-1][2]):
        result.verdict, result.why = (
            "crash",
            f"exit {answer.code}: {' '.join(answer.words.split())[:160]}",
        )
    result.fewest = min((digits(row[1]) for row in answer.rows), default=0)
    started = time.perf_counter()
    try:
        system = system_file.read(path)
        judge = (system, result.task.until, answer, arguments.max_bits)
        verdict, why, result.bits, run = limited(arguments.seconds, judged, *judge)
        result.proved = [proved_row(system, row) for row in run.rows]
    except Slow:
        verdict, why = "prover slow", f"more than {arguments.seconds} s; {answer.rows[-1:]}"
    except Refused as refusal:
        verdict, why = "prover refuses", str(refusal)
    if result.verdict != "crash":
        result.verdict, result.why = verdict, why
    result.seconds = (asked, time.perf_counter() - started)
    return result


def proved_row(system, row) -> str:
    balls = [clock(system, row), *states(system, row.z)]
    return ",".join([row.event, row.mode, *(ball.str(32) for ball in balls)])


def expected_code(ending: str) -> int:
    return int(ending in ("undecided", "no-progress", "beyond-guard"))


def keep(result: Result, out: Path) -> None:
    """Writes a system that was not right down, with both answers."""
    folder = out / result.verdict.replace(" ", "-")
    folder.mkdir(parents=True, exist_ok=True)
    name = result.task.name
    (folder / f"{name}.system.toml").write_text(result.task.text)
    rows = [",".join(row) for row in result.answer.rows] if result.answer else []
    words = [result.answer.words] if result.answer else []
    lines = [
        f"{result.verdict}: {result.why}",
        f"{result.bits} bits",
        "",
        "percuss:",
        *rows,
        *words,
    ]
    (folder / f"{name}.txt").write_text("\n".join([*lines, "", "proved:", *result.proved, ""]))


def arguments_of() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default = HERE.parent / "target" / "release" / "percuss"
    parser.add_argument("--percuss", default=str(default), metavar="PATH")
    parser.add_argument("--kind", action="append", choices=KINDS, metavar="KIND")
    parser.add_argument("--each", type=int, default=400, metavar="N", help="systems of a kind")
    parser.add_argument("--first", type=int, default=0, metavar="N", help="number of the first")
    parser.add_argument("--processes", type=int, default=None, metavar="N")
    parser.add_argument("--max-bits", type=int, default=None, metavar="B", help="handed to percuss")
    parser.add_argument("--seconds", type=float, default=20.0, metavar="S", help="for each answer")
    parser.add_argument(
        "--out", type=Path, default=HERE.parent / "target" / "random-systems", metavar="DIR"
    )
    parser.add_argument("--power", action="store_true", help="spoil each answer")
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    return parser.parse_args()


def main() -> None:
    arguments = arguments_of()
    results, count = [], len(arguments.files) or arguments.each * len(arguments.kind or KINDS)
    with Pool(arguments.processes) as pool:
        for result in pool.imap_unordered(compared, tasks(arguments)):
            results.append(result)
            if result.verdict != "right":
                keep(result, arguments.out)
            if len(results) % 100 == 0:
                poor = sum(r.verdict in WRONG for r in results)
                print(f"{len(results)} of {count} systems, {poor} failures", file=sys.stderr)
    arguments.out.mkdir(parents=True, exist_ok=True)
    report = f"{summary(results)}\n\n{failures(results)}\n"
    (arguments.out / "summary.md").write_text(report)
    print(report)
    bad = ("right", "undecided", "crash") if arguments.power else WRONG
    sys.exit(1 if any(r.verdict in bad for r in results) else 0)


if __name__ == "__main__":
    main()

"""First pieces of the systems' cases from their equations alone: no closed form, no exact algebra.

    python generate_system_pieces.py [--case NAME]... [--cases DIR] [--systems DIR] [--out DIR]

The reader, the closed forms, the structural zeros and the proofs of `generate_systems.py` would
confirm themselves in every table made from them. Here the file is read a second time, its
expressions are evaluated as numbers, and x' = A x + c + B (cos, sin) is integrated by Taylor series
in multiple precision, the forcing as an oscillator of its own. What the model makes zero shows as
numbers that are smaller than any that matter. `--check` compares every row with the event table.
"""

import argparse
import re
import sys
import time
import tomllib
from itertools import islice
from pathlib import Path

from mpmath import mp, mpf

import manifest
from generate_events import HERE, select
from generate_pieces import (
    AGREEMENT,
    DIGITS,
    TRUNCATION,
    WORKING_DIGITS,
    evaluation_times,
    read,
    root,
)
from generate_systems import CASES, SYSTEMS

ORDER = 48
ZERO = mpf(10) ** -30  # of the size of the state: smaller values are zero by the model
SAME_INSTANT = mpf(10) ** -30  # of a step
ALLOWED = re.compile(r"[A-Za-z0-9_+\-*/^() ]*")
FOLDER = "system-pieces"

# Every system that is not too stiff for a Taylor series, every kind of event, tie and entry.
PIECES = {
    "ball-backward": 4,
    "ball-forty-impacts": 12,
    "ball-moving-in": 8,
    "belt-opposed": 6,
    "belt-pressed-to-stop": 12,
    "belt-side-by-side": 12,
    "belt-symmetric": 12,
    "belt-two-masses": 10,
    "buck-chaos": 14,
    "buck-start-at-tick": 8,
    "c5-fast": 10,
    "cradle-inelastic": 8,
    "cradle-three-guards": 9,
    "friction-edge-out": 6,
    "friction-equal": 8,
    "friction-just-slips-1e-9": 8,
    "friction-unequal": 8,
    "height-crossed-twice": 8,
    "heights-every-direction": 12,
    "latched-chaos": 10,
    "level-double-crossing": 10,
    "percussive-chaos": 10,
    "percussive-on-slider": 8,
    "percussive-progression": 8,
    "plastic-lands-early": 8,
    "plastic-lands-late": 6,
    "plastic-sticks-and-flies": 6,
    "relay-1e-2": 6,
    "relay-1e-6": 6,
    "relay-chatter": 12,
    "relay-start-outward": 4,
    "rigid-chaos": 8,
    "rigid-forty-impacts": 14,
    "rigid-start-inward": 5,
    "spheres-chain": 3,
    "spheres-meet-inelastic": 3,
    "spheres-no-progress": 20,
    "stop-graze-hit-1e-9": 4,
    "stop-graze-miss-1e-9": 3,
    "watched-backward-to-stop": 10,
    "watched-every-direction": 14,
    "watched-start-falling": 8,
}


class Model:
    """A system file and a case, read as numbers. z is the states, cos and sin if forced, and 1."""

    def __init__(self, case: dict, table: dict):
        self.table, self.backward = table, case["horizon"].get("backward", False)
        self.states = table["states"]
        values = table.get("parameters", {}) | case.get("parameters", {})
        self.names = {name: mpf(value) for name, value in values.items()}
        self.size = len(self.states) + 1
        if forcing := table.get("forcing"):
            self.size += 2
            self.names["omega"] = self.evaluate(forcing["omega"], self.names)
            self.names["phi"] = self.evaluate(forcing.get("phi", 0), self.names)
        self.modes = {mode["name"]: mode for mode in table["mode"]}
        self.first = case.get("start") or table["start"]

    def evaluate(self, text, names: dict):
        """The value of an expression, by the rules of Python, which are the same."""
        if not isinstance(text, str):
            return mpf(text)
        if not ALLOWED.fullmatch(text):
            raise ValueError(text)
        python = re.sub(r"(?<!\w)(\d+)", r"mpf(\1)", text).replace("^", "**")
        return eval(python, {"__builtins__": {}, "mpf": mpf}, names)

    def at(self, text: str, z: list):
        """The value of an expression in a state."""
        names = dict(self.names) | dict(zip(self.states, z, strict=False))
        if "forcing" in self.table:
            names |= {"cos": z[-3], "sin": z[-2]}
        return self.evaluate(text, self.defined(self.table.get("let", {}), names))

    def defined(self, definitions: dict, names: dict) -> dict:
        """The names with those of definitions, which may use each other."""
        names, waiting = dict(names), dict(definitions)
        while waiting:
            for name, inner in list(waiting.items()):
                used = re.findall(r"[A-Za-z]\w*", inner) if isinstance(inner, str) else []
                if not set(used) & waiting.keys():
                    names[name] = self.evaluate(waiting.pop(name), names)
        return names

    def row(self, text: str) -> list:
        """The coefficients of an affine expression, from its values at the unit vectors."""
        zero = [mpf(0)] * self.size
        constant = self.at(text, zero)
        units = ([mpf(i == j) for j in range(self.size)] for i in range(self.size - 1))
        return [*(self.at(text, unit) - constant for unit in units), constant]

    def guard(self, text: str) -> list:
        """The coefficients of a row that is positive where a condition holds."""
        sides = re.fullmatch(r"(.*)([<>])(.*)", text)
        left, right = self.row(sides[1]), self.row(sides[3])
        sign = 1 if sides[2] == ">" else -1
        return [sign * (a - b) for a, b in zip(left, right, strict=True)]

    def matrix(self, mode: str) -> list:
        """The rows of M, of -M back in time."""
        rows = {}
        for text in self.modes[mode]["equations"]:
            name, expression = text.split("'", 1)
            rows[name.strip()] = self.row(expression.split("=", 1)[1])
        matrix = [rows[name] for name in self.states]
        if "forcing" in self.table:
            place = len(self.states)
            turn = [[mpf(0)] * self.size for _ in range(2)]
            turn[0][place + 1], turn[1][place] = -self.names["omega"], self.names["omega"]
            matrix += turn
        matrix.append([mpf(0)] * self.size)
        return [[-c for c in row] for row in matrix] if self.backward else matrix

    def reset(self, event: dict, z: list) -> list:
        after = list(z)
        for text in event.get("reset", []):
            name, expression = text.split("=", 1)
            after[self.states.index(name.strip())] = self.at(expression, z)
        return after

    def start(self) -> tuple:
        """(mode, clock, z)"""
        clock = self.evaluate(self.first.get("t", 0), self.names)
        names, appended = dict(self.names), [mpf(1)]
        if "forcing" in self.table:
            angle = self.names["omega"] * clock + self.names["phi"]
            names |= {"cos": mp.cos(angle), "sin": mp.sin(angle)}
            appended = [names["cos"], names["sin"], mpf(1)]
        names = self.defined({name: self.first[name] for name in self.states}, names)
        z = [names[name] for name in self.states] + appended
        given = self.first["mode"]
        choices = given if isinstance(given, list) else [{"mode": given}]
        return self.following(choices, z), clock, z

    def following(self, successors: list, z: list) -> str:
        """The mode of the first successor whose condition holds."""
        for successor in successors:
            if "when" not in successor:
                return successor["mode"]
            coefficients = series(self.matrix(successor["mode"]), z)
            if Guard(self.guard(successor["when"]), coefficients).sign > 0:
                return successor["mode"]
        raise ArithmeticError("no mode follows")


def dot(row: list, z: list):
    return sum((a * b for a, b in zip(row, z, strict=True) if a and b), mpf(0))


def series(matrix: list, z: list) -> list:
    """Taylor coefficients of z, lowest first."""
    found = [z]
    for k in range(ORDER):
        found.append([dot(row, found[k]) / (k + 1) for row in matrix])
    return found


def step_length(coefficients: list):
    """The step whose last Taylor terms are as small as TRUNCATION asks, at most 1/e.

    A rational bound would let steps end on events at rational instants.
    """
    scale, length = 1 + max(map(abs, coefficients[0])), mp.exp(-1)
    for k in (ORDER - 1, ORDER):
        last = max(map(abs, coefficients[k])) / scale
        if last > 0:
            length = min(length, (TRUNCATION / last) ** (mpf(1) / k))
    return length


class Guard:
    """The Taylor polynomial of a guard, without the zeros that it has at the step's start."""

    def __init__(self, row: list, coefficients: list):
        values, scale = [dot(row, z) for z in coefficients], 1 + max(map(abs, coefficients[0]))
        self.zeros = next((k for k, c in enumerate(values) if abs(c) > ZERO * scale), None)
        self.sign = 0 if self.zeros is None else mp.sign(values[self.zeros])
        self.rest = None if self.zeros is None else values[self.zeros :][::-1]

    def crossings(self, length) -> list:
        """(when, rising) of each change of sign seen within the step."""
        if self.rest is None or len(self.rest) < 2:
            return []
        turned = [-c for c in self.rest]
        both = [evaluation_times(guard, length) for guard in (self.rest, turned)]
        times = sorted({mpf(0), *both[0], *both[1]})
        values, found = [mp.polyval(self.rest, d) for d in times], []
        for a, b, low, high in zip(values, values[1:], times, times[1:], strict=False):
            if a < 0 <= b:
                found.append((root(self.rest, low, high), True))
            elif a > 0 >= b:
                found.append((root(turned, low, high), False))
        return sorted(found)


class Integration:
    """The run of a model, integrated step by step."""

    def __init__(self, model: Model):
        self.model, self.elapsed = model, mpf(0)
        self.mode, self.clock, self.z = model.start()

    def rows(self, count: int):
        """(event, mode, elapsed, z) of the start and of the first `count` events."""
        yield "", self.mode, self.elapsed, self.z
        yield from islice(self.events(), count)

    def events(self):
        yield from self.fire_at_once()
        while True:
            coefficients = series(self.model.matrix(self.mode), self.z)
            length = step_length(coefficients)
            watches, until, first = self.crossings_on_step(coefficients, length)
            elapsed = self.elapsed
            for when, name in watches:
                self.move(coefficients, elapsed, when)
                yield name, self.mode, self.elapsed, self.z
            self.move(coefficients, elapsed, length if until is None else first)
            if until is not None:
                yield self.fire(until)
                if self.mode is None:
                    return
                yield from self.fire_at_once()

    def move(self, coefficients: list, elapsed, d) -> None:
        self.z = [mp.polyval(c[::-1], d) for c in zip(*coefficients, strict=True)]
        self.elapsed = elapsed + d

    def crossings_on_step(self, coefficients: list, length) -> tuple:
        """(watched crossings up to the first until, that until, its time) on one step."""
        mode, untils, watches = self.model.modes[self.mode], [], []
        for event in mode.get("until", []):
            guard = Guard(self.model.guard(event["guard"]), coefficients)
            untils += [(when, event) for when, rising in guard.crossings(length) if rising][:1]
        for event in mode.get("watch", []):
            guard = Guard(self.model.guard(event["guard"]), coefficients)
            wanted = event.get("direction", "rising")
            for when, rising in guard.crossings(length):
                if wanted in ("both", "rising" if rising else "falling"):
                    watches.append((when, event["name"]))
        first = min((when for when, _ in untils), default=length)
        near = first + SAME_INSTANT * length
        until = next((event for when, event in untils if when <= near), None)
        watches = [(when, name) for when, name in watches if when <= near or until is None]
        return sorted(watches, key=lambda pair: pair[0]), until, first

    def fire(self, event: dict) -> tuple:
        """The row of an event of `until`, whose reset and successor are carried out."""
        if self.model.backward:
            self.mode, left = None, self.mode
            return "leaves-domain", left, self.elapsed, self.z
        self.z = self.model.reset(event, self.z)
        self.mode = self.model.following(event.get("next", [{"mode": self.mode}]), self.z)
        return event["name"], self.mode, self.elapsed, self.z

    def fire_at_once(self):
        """Rows of the events whose guards rise from zero where a mode begins."""
        while True:
            coefficients = series(self.model.matrix(self.mode), self.z)
            for event in self.model.modes[self.mode].get("until", []):
                guard = Guard(self.model.guard(event["guard"]), coefficients)
                if guard.sign > 0:
                    if guard.zeros == 0:
                        raise ArithmeticError(f"{event['name']} is above zero and was not seen")
                    yield self.fire(event)
                    break
            else:
                return


def table_rows(model: Model, count: int):
    """The rows in the columns of the event table, without growth."""
    integration = Integration(model)
    for index, (event, mode, elapsed, z) in enumerate(integration.rows(count)):
        clock = integration.clock - elapsed if model.backward else integration.clock + elapsed
        numbers = [elapsed, clock, *z[: len(model.states)]]
        yield ",".join([str(index), event, mode, *map(cell, numbers)])


def cell(value) -> str:
    return mp.nstr(value if abs(value) > ZERO else mpf(0), DIGITS, strip_zeros=False)


def model_of(path: Path, systems: Path) -> Model:
    case = tomllib.loads(path.read_text())
    system = systems / f"{case['case']['system']}.system.toml"
    return Model(case, tomllib.loads(system.read_text()))


def generate(path: Path, systems: Path, out: Path) -> None:
    started, count = time.perf_counter(), PIECES[path.stem]
    model = model_of(path, systems)
    lines = [f"# case = {path.stem}"]
    lines.append(f"# method = Taylor series of order {ORDER}, {WORKING_DIGITS} digits")
    lines.append(",".join(["index", "event", "mode", "elapsed", "time", *model.states]))
    name = f"{FOLDER}/{path.stem}.csv"
    manifest.write(out / name, lines + list(table_rows(model, count)))
    entry = {
        "digits": DIGITS,
        "precision_bits": mp.prec,
        "generator": Path(__file__).name,
        "command": f"python {Path(__file__).name} --case {path.stem}",
    }
    manifest.record(out, {name: entry})
    seconds = time.perf_counter() - started
    print(f"{path.stem}: {count} events, {seconds:.1f} s", file=sys.stderr)


def check(out: Path) -> bool:
    """Does every row of every piece agree with the event table to the last digit but rounding?"""
    agreed = True
    for path in sorted((out / FOLDER).glob("*.csv")):
        piece, table = read(path), read(out / "events" / path.name)
        names = [(r["event"], r["mode"]) for r in piece]
        same = names == [(r["event"], r["mode"]) for r in table[: len(piece)]]
        worst = max(distance(a, b) for a, b in zip(piece, table, strict=False))
        good = same and worst <= AGREEMENT
        agreed = agreed and good
        verdict = "" if good else "  FAILS"
        far = mp.nstr(worst, 2)
        print(f"{path.stem}: {len(piece) - 1} events, worst difference {far}{verdict}")
    return agreed


def distance(row: dict, truth: dict) -> mpf:
    """The largest difference of two rows, relative to 1 + |value|."""
    numbers = [key for key in row if key not in ("index", "event", "mode")]
    return max(abs(mpf(row[k]) - mpf(truth[k])) / (1 + abs(mpf(truth[k]))) for k in numbers)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", action="append", default=[], choices=PIECES, metavar="NAME")
    parser.add_argument("--cases", type=Path, default=CASES, metavar="DIR")
    parser.add_argument("--systems", type=Path, default=SYSTEMS, metavar="DIR")
    parser.add_argument("--out", type=Path, default=HERE, metavar="DIR")
    parser.add_argument("--check", action="store_true", help="compare with the tables in --out")
    arguments = parser.parse_args()
    mp.dps = WORKING_DIGITS
    if arguments.check:
        sys.exit(0 if check(arguments.out) else 1)
    for path in select(arguments.cases, arguments.case or list(PIECES)):
        generate(path, arguments.systems, arguments.out)


if __name__ == "__main__":
    main()

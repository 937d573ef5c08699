"""A system file read into exact rational matrices: `docs/SYSTEM_FORMAT.md` says what it means.

With cos and sin (where the system is forced) and 1 appended the state is z, and z' = M z. A guard
is a row w with value w z, a reset a matrix R with z+ = R z.
"""

import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from flint import fmpq, fmpq_mat

from affine_expression import Reader, Refused, constant, number

LARGEST_SIZE = 12
LARGEST_COUNT = 64
LARGEST_POWER = 1000
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
SYMBOL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
RESERVED = ("cos", "sin", "omega", "phi")
ENDINGS = "end accumulation leaves-domain no-progress beyond-guard undecided".split()
DIRECTIONS = ("rising", "falling", "both")
FILE_KEYS = (
    "schema name why trouble source states drift scales time_scale forcing parameters let mode start"
)
TROUBLE = """jump accumulation simultaneous sliding chatter clock start-on-guard many-guards
    stiffness graze double-crossing multiple-zero restart-on-zero side-of-root output-at-events
    backward direction hysteresis chaos""".split()


@dataclass
class Event:
    """An `until` or a `watch`: its guard, and what an `until` does where it becomes positive.

    `successors` are pairs (row of the condition, mode), the last with None for its row.
    """

    name: str
    guard: fmpq_mat
    watched: bool
    direction: str = "rising"
    reset: fmpq_mat | None = None
    successors: list = field(default_factory=list)
    limit: "Event | None" = None  # its reset and successors, where a run goes on after it


@dataclass
class Mode:
    """z' = M z, and the events in the order of the file, those of `until` first."""

    name: str
    matrix: fmpq_mat
    until: list
    watch: list

    @property
    def exits(self) -> list:
        """All that has a reset and successors: the events of `until` and their limits."""
        return self.until + [event.limit for event in self.until if event.limit is not None]


@dataclass
class System:
    """A system file's content with its parameters put in."""

    name: str
    states: list
    forced: bool
    omega: fmpq
    phi: fmpq
    parameters: dict
    scales: list
    time_scale: fmpq
    modes: dict
    start: dict

    @property
    def size(self) -> int:
        """Entries of z."""
        return len(self.states) + (3 if self.forced else 1)


def read(path: Path, parameters: dict | None = None, start: dict | None = None) -> System:
    """The system of a file, with parameters overridden and its start replaced, if given."""
    try:
        return Builder(tomllib.loads(path.read_text()), parameters or {}, start).system()
    except Refused as refusal:
        raise Refused(f"{path}: {refusal}") from None
    except KeyError as missing:
        raise Refused(f"{path}: {missing} is missing") from None


def only(table: dict, keys: str, what: str) -> None:
    """Refuses a key that the format does not know."""
    unknown = [key for key in table if key not in keys.split()]
    if unknown:
        raise Refused(f"{what}: {unknown[0]!r} is not one of {', '.join(keys.split())}")


def named(table: dict, what: str) -> str:
    name = table.get("name")
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise Refused(f"{what}: {name!r} is not lower-case words joined by hyphens")
    return name


def event_name(table: dict, what: str) -> str:
    """The name of an event, which no way of ending a run has."""
    if table.get("name") in ENDINGS:
        raise Refused(f"{what}: {table['name']!r} is the name of an ending")
    return named(table, what)


def check_trouble(table: dict, what: str) -> None:
    unknown = [word for word in table.get("trouble", []) if word not in TROUBLE]
    if unknown:
        raise Refused(f"{what}: trouble {unknown[0]!r} is not one of {', '.join(TROUBLE)}")


def in_range(row: list) -> list:
    """The row, whose coefficients other than 0 have sizes that f64 holds."""
    for c in row:
        if c != 0 and abs(abs(c.p).bit_length() - c.q.bit_length()) > LARGEST_POWER:
            raise Refused(f"a coefficient is beyond 2^-{LARGEST_POWER} to 2^{LARGEST_POWER}")
    return row


class Builder:
    """Turns the tables of a system file into a `System`."""

    def __init__(self, table: dict, overriding: dict, start: dict | None):
        only(table, FILE_KEYS, "the file")
        if type(table.get("schema")) is not int or table["schema"] != 1:
            raise Refused("schema is 1")
        check_trouble(table, "the file")
        self.table, self.forced = table, "forcing" in table
        self.states = table["states"]
        self.parameters = dict(table.get("parameters", {}))
        only(overriding, " ".join(self.parameters), "parameters of the case")
        self.parameters |= overriding
        self.start = table["start"] if start is None else start
        self.lets = table.get("let", {})
        self.size = len(self.states) + (3 if self.forced else 1)
        self.check_names()
        self.known = {name: self.constant(self.parameter(name)) for name in self.parameters}
        forcing = table.get("forcing", {})
        only(forcing, "omega phi", "forcing")
        self.omega = self.amount(forcing["omega"]) if self.forced else fmpq(0)
        self.phi = self.amount(forcing.get("phi", 0)) if self.forced else fmpq(0)
        if self.forced and not self.omega > 0:
            raise Refused("omega is positive")
        units = {name: self.unit(index) for index, name in enumerate(self.states)}
        self.known = {key: self.known[key] for key in self.parameters} | units
        if self.forced:
            self.known |= {"omega": self.constant(self.omega), "phi": self.constant(self.phi)}
            self.known |= {"cos": self.unit(-3), "sin": self.unit(-2)}

    def check_names(self) -> None:
        names = [*self.states, *self.parameters, *self.lets]
        wrong = [n for n in names if not SYMBOL.fullmatch(n) or n in RESERVED or names.count(n) > 1]
        wrong += [n for n in self.states if n in ("t", "mode")]
        if wrong:
            raise Refused(f"{wrong[0]!r} is reserved, used twice, or not letters, digits and _")
        if not 1 <= len(self.states) or self.size > LARGEST_SIZE:
            raise Refused(f"the state with cos, sin and 1 appended has 2 to {LARGEST_SIZE} entries")

    def parameter(self, name: str) -> fmpq:
        return number(self.parameters[name])

    def matrix_of(self, rows: list) -> fmpq_mat:
        return fmpq_mat(rows)

    def constant(self, value: fmpq) -> list:
        return [fmpq(0)] * (self.size - 1) + [value]

    def unit(self, index: int) -> list:
        row = [fmpq(0)] * self.size
        row[index] = fmpq(1)
        return row

    def amount(self, value) -> fmpq:
        """A number, or an expression of parameters."""
        if not isinstance(value, str):
            return number(value)
        row = Reader(value, self.value_of, self.size).whole()
        return row[-1] if constant(row) else self.refuse(f"{value!r} is no constant")

    def value_of(self, name: str, within: tuple = ()) -> list:
        """The coefficients of a state, a parameter, a reserved word or a `let`."""
        if name not in self.lets:
            known = name in self.known
            return self.known[name] if known else self.refuse(f"{name!r} means nothing here")
        if name in within:
            raise Refused(f"{name!r} is defined by itself")
        if name not in self.known:
            inner = Reader(self.lets[name], lambda n: self.value_of(n, (*within, name)), self.size)
            self.known[name] = inner.whole()
        return self.known[name]

    def row(self, text: str) -> list:
        return in_range(Reader(text, self.value_of, self.size).whole())

    def condition(self, text: str) -> fmpq_mat:
        row = in_range(Reader(text, self.value_of, self.size).condition())
        return self.matrix_of([row])

    def guard(self, text: str) -> fmpq_mat:
        row = self.condition(text)
        return row if self.may_change(text) else self.refuse(f"guard {text!r} never changes")

    def may_change(self, text: str) -> bool:
        """Whether a text names a state, cos or sin, or a `let` that does."""
        names, met = SYMBOL.findall(text), set()
        while names:
            name = names.pop()
            if name in (*self.states, "cos", "sin"):
                return True
            if name not in met:
                met.add(name)
                names += SYMBOL.findall(self.lets.get(name, ""))
        return False

    def assignments(self, texts: list, pattern: str, what: str) -> dict:
        """{index of a state: coefficients} of texts such as `x' = v`."""
        found = {}
        for text in texts:
            match = re.fullmatch(rf"\s*([A-Za-z]\w*)\s*{pattern}\s*=(.*)", text, re.DOTALL)
            if not match or match[1] not in self.states:
                raise Refused(f"{what} {text!r}: it is `state{pattern} = expression`")
            index = self.states.index(match[1])
            if index in found:
                raise Refused(f"{what} {text!r}: {match[1]} has one already")
            found[index] = self.row(match[2])
        return found

    def matrix(self, texts: list) -> fmpq_mat:
        """M of a mode, from its equations."""
        rows = self.assignments(texts, "'", "equation")
        if len(rows) != len(self.states):
            raise Refused("a mode has one equation for each state")
        matrix = [rows[i] for i in range(len(self.states))]
        if self.forced:
            matrix.append([-self.omega * c for c in self.unit(-2)])
            matrix.append([self.omega * c for c in self.unit(-3)])
        return self.matrix_of([*matrix, [fmpq(0)] * self.size])

    def reset(self, texts: list) -> fmpq_mat:
        rows = self.assignments(texts, "", "reset")
        return self.matrix_of([rows.get(i, self.unit(i)) for i in range(self.size)])

    def until(self, table: dict, mode: str) -> Event:
        only(table, "name guard reset next accumulates_to", f"until of {mode}")
        successors = self.successors(table.get("next", mode))
        name, guard = event_name(table, f"until of {mode}"), self.guard(table["guard"])
        reset, limit = self.reset(table.get("reset", [])), self.limit(table, guard)
        return Event(name, guard, False, "rising", reset, successors, limit)

    def limit(self, table: dict, guard: fmpq_mat) -> Event | None:
        """What happens where the event accumulates; none where a run ends there."""
        if "accumulates_to" not in table:
            return None
        given = table["accumulates_to"]
        given = {"next": given} if isinstance(given, str) else given
        only(given, "reset next", "accumulates_to")
        successors, reset = self.successors(given["next"]), self.reset(given.get("reset", []))
        return Event("accumulation", guard, False, "rising", reset, successors)

    def successors(self, following: list | str) -> list:
        tables, found = [{"mode": following}] if isinstance(following, str) else following, []
        for position, table in enumerate(tables):
            only(table, "when mode", "next")
            if ("when" in table) == (position == len(tables) - 1):
                raise Refused("every entry of a list of modes has a `when`, but not the last")
            when = self.condition(table["when"]) if "when" in table else None
            found.append((when, table["mode"]))
        if not 1 <= len(found) <= LARGEST_COUNT:
            raise Refused(f"a list of modes has 1 to {LARGEST_COUNT} entries")
        return found

    def watch(self, table: dict, mode: str) -> Event:
        only(table, "name guard direction", f"watch of {mode}")
        direction = table.get("direction", "rising")
        if direction not in DIRECTIONS:
            raise Refused(f"direction {direction!r} is not one of {', '.join(DIRECTIONS)}")
        name = event_name(table, f"watch of {mode}")
        return Event(name, self.guard(table["guard"]), True, direction)

    def check_drift(self, modes: list, start: list) -> None:
        """Refuses a drift on which something depends; a run's events ask nothing more of it."""
        drift = self.table.get("drift", [])
        rows = [row for row, _ in start]
        for mode in modes:
            rows += [mode.matrix] + [event.guard for event in mode.until + mode.watch]
            rows += [row for event in mode.exits for row, _ in event.successors]
            rows += [event.reset - self.identity() for event in mode.exits]
        for name in drift:
            if name not in self.states or drift.count(name) > 1:
                raise Refused(f"drift: {name!r} is no state, or there twice")
            n = self.states.index(name)
            for row in rows:
                if row is not None and any(row[i, n] != 0 for i in range(row.nrows())):
                    raise Refused(f"drift: something depends on {name}")

    def identity(self) -> fmpq_mat:
        return self.matrix_of([self.unit(i) for i in range(self.size)])

    def mode(self, table: dict) -> Mode:
        only(table, "name equations until watch", "mode")
        name = named(table, "mode")
        until = [self.until(t, name) for t in table.get("until", [])]
        watch = [self.watch(t, name) for t in table.get("watch", [])]
        events = [event.name for event in until + watch]
        if len(set(events)) < len(events) or len(events) > LARGEST_COUNT:
            raise Refused(f"mode {name}: at most {LARGEST_COUNT} events, with different names")
        return Mode(name, self.matrix(table["equations"]), until, watch)

    def scales(self) -> list:
        scales = [self.amount(s) for s in self.table.get("scales", [1] * len(self.states))]
        if len(scales) != len(self.states) or not all(s > 0 for s in scales):
            raise Refused("scales are positive, one for each state")
        return scales

    def time_scale(self) -> fmpq:
        if "time_scale" in self.table:
            scale = self.amount(self.table["time_scale"])
            return scale if scale > 0 else self.refuse("time_scale is positive")
        return 1 / self.omega if self.forced else fmpq(1)

    def refuse(self, why: str):
        raise Refused(why)

    def start_values(self, modes: dict) -> dict:
        """{modes, t, state}: conditions and modes, the clock, a row of coefficients a state."""
        only(self.start, " ".join(["mode", "t", *self.states]), "start")
        given = self.start.get("mode")
        choices = self.successors(given if isinstance(given, list) else [{"mode": given}])
        for _, mode in choices:
            if mode not in modes:
                raise Refused(f"start: {mode!r} is not a mode")
        time = self.start_row(self.start.get("t", 0))
        if not constant(time):
            raise Refused("start: t is an expression of parameters")
        state = self.resolved([self.start_state(name) for name in self.states])
        return {"modes": choices, "t": time[-1], "state": state}

    def start_row(self, value) -> list:
        return self.row(value) if isinstance(value, str) else self.constant(number(value))

    def start_state(self, name: str) -> list:
        """The row of a state at the start, which may hang on other states."""
        return self.start_row(self.start[name])

    def resolved(self, rows: list) -> list:
        """Rows in which the rows of the states that they hang on take the place of these."""
        known = {}
        while open_states := [n for n in range(len(rows)) if n not in known]:
            others = {n: [k for k in range(len(rows)) if rows[n][k] != 0] for n in open_states}
            ready = [n for n in open_states if all(k in known for k in others[n])]
            if not ready:
                raise Refused(f"start: {self.states[open_states[0]]} hangs on itself")
            for n in ready:
                row = [fmpq(0)] * len(rows) + rows[n][len(rows) :]
                for k in others[n]:
                    pairs = zip(row, known[k], strict=True)
                    row = [own + rows[n][k] * other for own, other in pairs]
                known[n] = row
        return [known[n] for n in range(len(rows))]

    def system(self) -> System:
        modes = [self.mode(table) for table in self.table["mode"]]
        by_name = {mode.name: mode for mode in modes}
        if len(by_name) < len(modes) or len(modes) > LARGEST_COUNT:
            raise Refused(f"at most {LARGEST_COUNT} modes, each with a name of its own")
        for mode in modes:
            for _, name in (s for event in mode.exits for s in event.successors):
                if name not in by_name:
                    raise Refused(f"mode {mode.name}: {name!r} is not a mode")
        start = self.start_values(by_name)
        self.check_drift(modes, start["modes"])
        return System(
            named(self.table, "the file"), self.states, self.forced, self.omega, self.phi,
            self.parameters, self.scales(), self.time_scale(), by_name, start,
        )  # fmt: skip

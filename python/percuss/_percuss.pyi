"""The native part of the package, in the names of Rust; `percuss` gives it its face."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

class System:
    @staticmethod
    def parse(place: str, text: str) -> System: ...
    @staticmethod
    def named(name: str) -> System | None: ...
    def with_parameters(self, values: dict[str, float]) -> System: ...
    def with_start(self, text: str) -> System: ...
    @property
    def origin(self) -> tuple[str, dict[str, float], str | None]: ...
    @property
    def name(self) -> str: ...
    @property
    def why(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def trouble(self) -> list[str]: ...
    @property
    def states(self) -> list[str]: ...
    @property
    def modes(self) -> list[str]: ...
    @property
    def parameters(self) -> dict[str, float]: ...
    @property
    def time_scale(self) -> float: ...
    @property
    def omega(self) -> float | None: ...
    @property
    def event_names(self) -> list[str]: ...
    @property
    def start_time(self) -> float | None: ...
    def events(
        self,
        until: float | None,
        count: int | None,
        digits: int,
        max_bits: int | None,
        max_events: int | None,
        backward: bool,
    ) -> Rows: ...
    def simulate(
        self,
        until: float | None,
        count: int | None,
        max_events: int | None,
        backward: bool,
        returns: tuple[int | None, int, Section] | None,
    ) -> Rows: ...
    def stream(
        self,
        until: float | None,
        count: int | None,
        digits: int,
        max_bits: int | None,
        backward: bool,
    ) -> Stream: ...

class Rows:
    def __len__(self) -> int: ...
    def times(self) -> Floats: ...
    def states(self) -> Floats: ...
    def modes(self) -> NDArray[np.int64]: ...
    def names(self) -> list[str]: ...
    def digits(self, most: int) -> tuple[list[str], list[list[str]]] | None: ...
    def errors(self) -> tuple[Floats, Floats] | None: ...
    def at(self, times: Floats) -> Floats: ...
    def differentiated(self, names: list[str]) -> Rows: ...
    def derivatives(self, names: int, side: int | None) -> FoundDerivatives: ...
    def derivative_digits(self, side: int | None, most: int) -> DerivativeDigits | None: ...
    @property
    def ending(self) -> str | None: ...
    @property
    def is_decided(self) -> bool: ...
    @property
    def cause(self) -> str | None: ...
    @property
    def accumulation(self) -> tuple[str, str] | None: ...
    @property
    def bits(self) -> int: ...
    @property
    def undecidable(self) -> int: ...

class FoundDerivatives(TypedDict):
    time: Floats
    state: Floats
    reason: list[list[str]]
    differs: list[list[bool]]

class DerivativeDigits(TypedDict):
    time: list[list[str]]
    state: list[list[list[str]]]

class Row:
    @property
    def time(self) -> float: ...
    @property
    def state(self) -> Floats: ...
    @property
    def mode(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def digits(self) -> tuple[str, list[str]]: ...

class Stream(Iterator[Row]):
    def __iter__(self) -> Stream: ...
    def __next__(self) -> Row: ...
    @property
    def ending(self) -> str | None: ...
    @property
    def cause(self) -> str | None: ...

class Simulated(TypedDict):
    phases: list[str]
    times: Floats
    states: Floats
    undecidable: int
    endless: str | None

class Exponents(TypedDict):
    exponents_per_period: list[float]
    standard_error: list[float]
    stationary: bool | None
    contraction_per_period: float
    drift_per_period: float
    drift_standard_error: float
    undecidable: bool

class FoundOrbit(TypedDict):
    points: Floats
    multipliers: list[tuple[float, float]]
    phases: list[str]
    stable: bool
    residual: float
    drift_per_period: float

class Diagrammed(TypedDict):
    values: Floats
    steps: NDArray[np.int64]
    points: Floats
    drift_per_period: Floats
    drift_standard_error: Floats
    escapes: NDArray[np.bool_]
    undecidable: NDArray[np.bool_]

class Found(TypedDict):
    kind: str
    period: int | None
    fraction: float
    fraction_error: float
    points: Floats
    drift_per_period: float
    drift_standard_error: float
    lyapunov_per_period: float
    lyapunov_error: float

class Surveyed(TypedDict):
    p: Floats
    y: Floats
    labels: NDArray[np.int32]
    attractors: list[Found]
    escaping: float
    unresolved: float

class Oscillator:
    def __new__(
        cls,
        parameters: list[float],
        tau: float,
        cycle: int,
        p: float,
        y: float,
        q: float | None,
        v: float,
        phase: str | None,
    ) -> Oscillator: ...
    @property
    def period(self) -> float: ...
    @property
    def started(self) -> tuple[str, float, list[float]]: ...
    def simulate(
        self,
        until: float | None,
        count: int | None,
        periods: int | None,
        max_periods: int | None,
    ) -> Simulated: ...

Told = Callable[[int, int], object] | None
Pairs = list[tuple[float, float]]

def poincare(
    oscillator: Oscillator, transient: int, periods: int, section: float, told: Told, /
) -> Floats: ...
def lyapunov(oscillator: Oscillator, transient: int, periods: int, told: Told, /) -> Exponents: ...
def orbits(
    oscillator: Oscillator, period: int, from_start: bool, told: Told, /
) -> list[FoundOrbit]: ...
def bifurcation(
    oscillator: Oscillator,
    parameter: str,
    from_: float,
    to: float,
    steps: int,
    transient: int,
    periods: int,
    reset: bool,
    told: Told,
    /,
) -> Diagrammed: ...
def basins(
    oscillator: Oscillator,
    window: tuple[tuple[float, float], tuple[float, float]],
    grid: tuple[int, int],
    transient: int,
    max_period: int,
    told: Told,
    /,
) -> Surveyed: ...

class FoundBifurcation(TypedDict):
    kind: str
    value: float
    error: float
    event: str | None
    period: int
    turns: bool

class FollowedBranch(TypedDict):
    values: Floats
    points: Floats
    multipliers: list[Pairs]
    stable: list[bool]
    modes: list[str]
    times: list[float]
    events: list[list[str]]
    drift: list[float]
    bifurcations: list[FoundBifurcation]
    period: int
    complete: bool
    ending: str

def follow(
    oscillator: Oscillator,
    parameter: str,
    ends: tuple[float, float],
    period: int,
    from_start: bool,
    told: Told,
    /,
) -> FollowedBranch: ...

class Section:
    def __new__(cls, text: str | None, every: int, max_time: float | None) -> Section: ...

class Points(TypedDict):
    time: Floats
    mode: NDArray[np.int64]
    state: Floats

class Returned(TypedDict):
    points: Points
    cause: str | None
    undecidable: int

class ReturnExponents(TypedDict):
    exponents_per_return: list[float]
    exponents_per_time: list[float]
    standard_error: list[float]
    mean_return_time: float
    batches: int
    stationary: bool | None
    drift_per_return: dict[str, float]
    drift_standard_error: dict[str, float]
    undecidable: int

class ReturnOrbit(TypedDict):
    points: Points
    time: float
    events: list[str]
    multipliers: Pairs
    stable: bool
    residual: float
    is_decided: bool
    drift_per_return: dict[str, float]

class ReturnsDiagrammed(TypedDict):
    values: Floats
    steps: NDArray[np.int64]
    points: Points
    left_out: list[str]
    undecidable: NDArray[np.int64]

class Reached(TypedDict):
    kind: str
    period: int | None
    fraction: float
    fraction_error: float
    points: Points
    multipliers: Pairs
    lyapunov_per_return: float
    lyapunov_error: float
    drift_per_return: dict[str, float]
    drift_standard_error: dict[str, float]

class ReturnsSurveyed(TypedDict):
    across: Floats
    up: Floats
    labels: NDArray[np.int32]
    attractors: list[Reached]
    escaping: float
    unresolved: float
    inadmissible: float
    ended: float

def system_poincare(
    system: System, section: Section, transient: int, returns: int, told: Told, /
) -> Returned: ...
def system_lyapunov(
    system: System, section: Section, transient: int, returns: int, told: Told, /
) -> ReturnExponents: ...
def system_orbit(
    system: System, section: Section, transient: int, period: int, /
) -> ReturnOrbit: ...
def system_follow(
    system: System,
    section: Section,
    parameter: str,
    ends: tuple[float, float],
    transient: int,
    period: int,
    told: Told,
    /,
) -> FollowedBranch: ...
def system_bifurcation(
    system: System,
    section: Section,
    parameter: str,
    ends: tuple[float, float],
    steps: int,
    transient: int,
    returns: int,
    reset: bool,
    told: Told,
    /,
) -> ReturnsDiagrammed: ...
def system_orbits(
    system: System,
    section: Section,
    axes: tuple[int, int],
    window: tuple[tuple[float, float], tuple[float, float]],
    grid: tuple[int, int],
    period: int,
    told: Told,
    /,
) -> list[ReturnOrbit]: ...
def system_basins(
    system: System,
    section: Section,
    axes: tuple[int, int],
    window: tuple[tuple[float, float], tuple[float, float]],
    grid: tuple[int, int],
    transient: int,
    max_period: int,
    told: Told,
    /,
) -> ReturnsSurveyed: ...

class Cases:
    def __new__(cls, names: set[str]) -> Cases: ...
    @property
    def names(self) -> list[str]: ...
    def ask(self, name: str) -> str: ...
    def beyond_budget(self, method: dict[str, Any]) -> list[str]: ...
    def judge(
        self, answers: Sequence[dict[str, Any]], out: str, baselines: Sequence[str]
    ) -> list[str]: ...

class GradientCases:
    def __new__(cls, names: set[str]) -> GradientCases: ...
    @property
    def names(self) -> list[str]: ...
    def ask(self, name: str) -> str: ...
    def judge(
        self, answers: Sequence[dict[str, Any]]
    ) -> list[tuple[str, str, str, float, str, str | None, str]]: ...

def case_names() -> list[str]: ...
def ending_names() -> list[str]: ...
def gradient_case_names() -> list[str]: ...
def system_names() -> list[str]: ...
def command(words: list[str]) -> int: ...

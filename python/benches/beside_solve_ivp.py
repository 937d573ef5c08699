"""A bilinear oscillator by percuss in f64 and by SciPy's `solve_ivp` with events.

    python python/benches/beside_solve_ivp.py [--basin]

Printed are processor seconds per forcing period, medians of rounds in which the engines take turns,
with the leads of percuss, and the largest errors of event times and of the state once a period,
beside the events that percuss proves. `solve_ivp` is called as an expert calls it: mode by mode,
with a terminal event that has a direction, and steps of at most an eighth of a forcing period;
`free` is without that bound. Then a diagram and, with --basin, the motions from a grid of starts,
both with bounded steps. Needs the package and SciPy. For exploration, no test.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import percuss

RIG = Path(__file__).resolve().parents[2] / "benches" / "bilinear.system.toml"
METHOD, TOLERANCES = "DOP853", (1e-6, 1e-9, 1e-12)
PERIODS, ROUNDS = 100, 5
# Errors are compared before they have grown.
SHORT = 10
# The longest step of an expert, in forcing periods.
LONGEST = 0.125
FREQUENCIES, LEFT_OUT, KEPT = np.linspace(0.5, 1.5, 10), 50, 20
WINDOW, SIDE, FOLLOWED = ((-3.0, 1.5), (-3.0, 3.0)), 20, 50

VALUES = percuss.System(RIG).parameters

# The times of the events, and the states at the ends of the forcing periods.
Answer = tuple[list[float], np.ndarray]


def mode(omega: float, stiffness: float, direction: float) -> tuple[Any, Any]:
    """The rates of a mode, and the event that ends it."""
    size, damping, gap = VALUES["A"], VALUES["zeta"], VALUES["gap"]

    def rates(t: float, z: Any) -> tuple[float, float]:
        x, v = z
        return v, size * math.cos(omega * t) - 2 * damping * v - x - stiffness * (x - gap)

    def event(t: float, z: Any) -> float:
        return z[0] - gap

    event.terminal, event.direction = True, direction
    return rates, event


def expert(
    omega: float,
    start: tuple[float, float],
    periods: int,
    tolerance: float,
    longest: float = LONGEST,
) -> Answer:
    """The motion by `solve_ivp`, with steps of at most so many forcing periods."""
    modes = [mode(omega, 0.0, 1.0), mode(omega, VALUES["k"], -1.0)]
    period = 2 * math.pi / omega
    strobes = period * np.arange(1, periods + 1)
    options = {"rtol": tolerance, "atol": tolerance, "max_step": longest * period}
    t, z, place, events, states = 0.0, np.array(start), int(start[0] > VALUES["gap"]), [], []
    while t < strobes[-1]:
        rates, event = modes[place]
        times = strobes[strobes > t]
        solved = solve_ivp(rates, (t, strobes[-1]), z, METHOD, times, events=event, **options)
        # Without a time to report the array has no rows.
        states.extend(solved.y.T if len(solved.t) else ())
        if solved.status != 1:
            break
        t, z, place = solved.t_events[0][0], solved.y_events[0][0], 1 - place
        events.append(t)
    return events, np.array(states)


def exact(rig: percuss.System, periods: int) -> Answer:
    """The same by percuss in f64: a run to the events, and another to the section."""
    period = 2 * math.pi / VALUES["frequency"]
    run = rig.simulate(until=periods * period)
    return list(run.time[1:-1]), rig.poincare(returns=periods + 1).state[1:]


def interleaved(works: dict[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """The median processor seconds of each work."""
    taken: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(rounds):
        for name, work in works.items():
            begun = time.process_time()
            work()
            taken[name].append(time.process_time() - begun)
    return {name: statistics.median(times) for name, times in taken.items()}


def errors(found: Answer, proved: Answer) -> tuple[float, float]:
    """The largest error of an event's time and of a state; NaN where the events are others."""
    if len(found[0]) != len(proved[0]):
        return math.nan, math.nan
    of_times = np.max(np.abs(np.array(found[0]) - proved[0]))
    return float(of_times), float(np.max(np.abs(found[1] - proved[1])))


def motions(rig: percuss.System) -> None:
    omega = VALUES["frequency"]
    works: dict[str, Callable[[int], Answer]] = {"percuss, f64": lambda n: exact(rig, n)}
    for name, longest in [("", LONGEST), (" free", math.inf)]:
        for tolerance in TOLERANCES:
            works[f"{METHOD} {tolerance:g}{name}"] = partial(
                expert, omega, (0.0, 0.0), tolerance=tolerance, longest=longest
            )
    run = rig.events(until=SHORT * 2 * math.pi / omega)
    proved = list(run.time[1:-1]), run.sol(2 * math.pi / omega * np.arange(1, SHORT + 1)).T
    times = interleaved({name: lambda it=it: it(PERIODS) for name, it in works.items()}, ROUNDS)
    print(f"{PERIODS} forcing periods, {ROUNDS} rounds; errors over {SHORT} periods")
    heads = f"{'us/period':>10}{'lead':>6}{'events':>8}{'time err':>10}{'state err':>10}"
    print(f"{'engine':<18}{heads}")
    for name, work in works.items():
        found = work(SHORT)
        of_times, of_states = errors(found, proved)
        each, lead = 1e6 * times[name] / PERIODS, times[name] / times["percuss, f64"]
        columns = f"{each:>10.1f}{lead:>6.0f}{len(found[0]):>8}{of_times:>10.1e}{of_states:>10.1e}"
        print(f"{name:<18}{columns}")


def diagram(rig: percuss.System) -> None:
    def by_percuss() -> Any:
        return rig.bifurcation(
            "frequency", FREQUENCIES, returns=KEPT, transient=LEFT_OUT, reset=True
        )

    def by_scipy() -> Any:
        periods = LEFT_OUT + KEPT
        return [expert(omega, (0.0, 0.0), periods, TOLERANCES[0]) for omega in FREQUENCIES]

    told(f"diagram, {len(FREQUENCIES)} values, {LEFT_OUT} + {KEPT} periods", by_percuss, by_scipy)


def basin(rig: percuss.System) -> None:
    def by_percuss() -> Any:
        return rig.basins(*WINDOW, grid=SIDE, transient=FOLLOWED)

    def by_scipy() -> Any:
        centres = [low + (high - low) * (np.arange(SIDE) + 0.5) / SIDE for low, high in WINDOW]
        omega = VALUES["frequency"]
        starts = [(float(x), float(v)) for x in centres[0] for v in centres[1]]
        return [expert(omega, it, FOLLOWED, TOLERANCES[0]) for it in starts]

    told(f"{SIDE} x {SIDE} starts, {FOLLOWED} periods", by_percuss, by_scipy)


def told(what: str, by_percuss: Callable[[], Any], by_scipy: Callable[[], Any]) -> None:
    own = interleaved({"own": by_percuss}, ROUNDS)["own"]
    theirs = interleaved({"theirs": by_scipy}, 1)["theirs"]
    name = f"{METHOD} {TOLERANCES[0]:g}"
    print(f"{what}: percuss {own:.4f} s, {name} {theirs:.2f} s, lead {theirs / own:.0f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--basin", action="store_true", help="follow a grid of starts too")
    is_asked = parser.parse_args().basin
    rig = percuss.System(RIG)
    motions(rig)
    diagram(rig)
    if is_asked:
        basin(rig)


if __name__ == "__main__":
    main()

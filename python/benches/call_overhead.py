"""The time of a call from Python, beside what the library itself takes for the same work.

    python python/benches/call_overhead.py

Printed are microseconds a call: least means of batches, which other work on the machine raises
least, over passes in which library and package take turns. The library's own times are those of
`cargo run --release -p percuss-python --example library_times`, which this runs; NATIVE is the
call of the native part alone, and OVERHEAD what the call of the package takes beyond the library.
Needs the package and a Rust toolchain. For exploration, no test.
"""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import percuss

ROOT = Path(__file__).resolve().parents[2]
COMMAND = "cargo run --release --quiet --locked -p percuss-python --example library_times"
PASSES, ROUNDS, ROUND_S = 5, 5, 0.02


def least(call: Callable[[], Any]) -> float:
    """The least mean time of a call over the batches, in microseconds."""
    call()
    begun = time.perf_counter()
    call()
    calls = max(1, int(ROUND_S / (time.perf_counter() - begun)))
    means = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        for _ in range(calls):
            call()
        means.append((time.perf_counter() - begun) / calls)
    return min(means) * 1e6


def library() -> dict[str, float]:
    """The library's own times, by the names of the calls."""
    done = subprocess.run(COMMAND.split(), cwd=ROOT, check=True, capture_output=True, text=True)
    pairs = (line.split("\t") for line in done.stdout.splitlines())
    return {name: float(taken) for name, taken in pairs}


def calls() -> dict[str, tuple[Callable[[], Any], Callable[[], Any] | None]]:
    """The calls of the package, each with that of the native part where there is one."""
    ball = percuss.systems["bouncing-ball"]
    rig = percuss.System(ROOT / "benches" / "bilinear.system.toml")
    native, events, oscillator = ball._native, ball.events(count=1), percuss.Oscillator()

    def digits() -> Any:
        vars(events).pop("digits", None)
        return events.digits

    def arrays(run: percuss.Run) -> Any:
        return run.time, run.state

    def proved() -> Any:
        return native.events(None, 1, 17, None, None, False)

    def plain() -> Any:
        return native.simulate(None, 1, None, False, None)

    return {
        "ball.events(count=1)": (lambda: ball.events(count=1), proved),
        "its time and state": (lambda: arrays(ball.events(count=1)), None),
        "its digits": (digits, lambda: events._rows.digits(17)),
        "its sol(t)": (lambda: events.sol(0.75), None),
        "ball.simulate(count=1)": (lambda: ball.simulate(count=1), plain),
        "ball.simulate(until=2)": (lambda: ball.simulate(until=2.0), None),
        "ball(e=0.6)": (lambda: ball(e=0.6), None),
        "rig.events(count=1)": (lambda: rig.events(count=1), None),
        "rig.simulate(count=1)": (lambda: rig.simulate(count=1), None),
        "rig.poincare(returns=1)": (lambda: rig.poincare(returns=1), None),
        "rig.lyapunov(returns=10)": (lambda: rig.lyapunov(returns=10), None),
        "rig.orbit(1, transient=10)": (lambda: rig.orbit(1, transient=10), None),
        "Oscillator()": (percuss.Oscillator, None),
        "Oscillator.simulate(count=1)": (lambda: oscillator.simulate(count=1), None),
    }


def lowered(least_yet: dict[str, float], times: dict[str, float]) -> None:
    """Keep the smaller of two times of each call."""
    for name, taken in times.items():
        least_yet[name] = min(taken, least_yet.get(name, taken))


def main() -> None:
    own: dict[str, float] = {}
    inner: dict[str, float] = {}
    taken: dict[str, float] = {}
    made = calls()
    for _ in range(PASSES):
        lowered(own, library())
        lowered(inner, {name: least(it) for name, (_, it) in made.items() if it is not None})
        lowered(taken, {name: least(it) for name, (it, _) in made.items()})
    print(f"{'call':<30}{'library':>9}{'native':>9}{'package':>9}{'overhead':>9}  us")
    for name, package in taken.items():
        native = f"{inner[name]:.2f}" if name in inner else "-"
        print(f"{name:<30}{own[name]:>9.2f}{native:>9}{package:>9.2f}{package - own[name]:>9.2f}")


if __name__ == "__main__":
    main()

"""Draw the derivative of a falling ball through its impact, as docs/GRADIENTS.md shows it.

pip install ./python matplotlib
python examples/event_derivative.py docs/event-derivative.svg
"""

import sys

import matplotlib
import numpy as np
import percuss

matplotlib.use("svg")
import matplotlib.pyplot as plt

# The ball of docs/GRADIENTS.md.
DROP = """
schema = 1
name = "drop"
states = ["x", "v"]
parameters = { g = 9.8125, e = 0.75, h = 2 }

[[mode]]
name = "air"
equations = ["x' = v", "v' = -g"]
until = [{ name = "ground", guard = "x < 0", reset = ["x = 0", "v = -e*v"] }]

[start]
mode = "air"
x = "h"
v = 0
"""
# How much higher the neighbour starts, in metres.
STEP = 0.3
UNTIL = 1.0
BLUE, ORANGE = "#0072b2", "#d55e00"


def motions(axes, ball, neighbour, times):
    """Draw both heights, and how far the impact moves."""
    impact, later = ball.time[1], neighbour.time[1]
    for run, color, label in (
        (ball, BLUE, "from h = 2"),
        (neighbour, ORANGE, f"from h = {2 + STEP:g}"),
    ):
        axes.plot(times, run.sol(times)[0], color=color, label=label)
        axes.plot(run.time[1], 0, "o", color=color)
    by_height = ball.gradient("h").time[1, 0]
    axes.annotate("", (later, -0.18), (impact, -0.18), arrowprops={"arrowstyle": "->"})
    moves = f"the impact moves: dT/dh = {by_height:.3f}"
    axes.text(impact - 0.015, -0.18, moves, ha="right", va="center")
    axes.set(ylabel="height x", ylim=(-0.45, 2.5))
    axes.legend(frameon=False, loc="upper right")


def derivatives(axes, ball, neighbour, times):
    """Draw the derivative of the height at a fixed time, and the quotient of differences."""
    found, impact = ball.gradient("h"), ball.time[1]
    rate, moved = ball.state[1, 1], found.time[1, 0]
    after = found.state[1, 0, 0] - rate * moved
    end = found.state[2, 0, 0]
    axes.plot([0, impact], [1, 1], color=BLUE, label="derivative, t fixed")
    axes.plot([impact, UNTIL], [after, end], color=BLUE)
    axes.plot([impact, impact], [1, after], ":", color=BLUE)
    quotient = (neighbour.sol(times)[0] - ball.sol(times)[0]) / STEP
    axes.plot(times, quotient, "--", color="k", linewidth=1, label=f"difference of both / {STEP:g}")
    axes.text(impact - 0.015, (1 + after) / 2, "the jump:\nthe saltation", ha="right", va="center")
    axes.set(xlabel="time t", ylabel="dx/dh", xlim=(0, UNTIL))
    axes.legend(frameon=False, loc="lower left")


def main(path):
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "percuss", "font.size": 11})
    system = percuss.System(DROP)
    ball, neighbour = (system(h=h).events(until=UNTIL) for h in (2, 2 + STEP))
    times = np.linspace(0, UNTIL, 401)
    figure, (upper, lower) = plt.subplots(2, sharex=True, figsize=(7.5, 6), layout="constrained")
    motions(upper, ball, neighbour, times)
    derivatives(lower, ball, neighbour, times)
    figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "event-derivative.svg")

"""Pictures of sections, diagrams, branches and basins, in the look of the command's."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Okabe and Ito's colours, which the colour-blind tell apart.
_HUES = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"]


def axes_or_new(ax: Any) -> Any:
    """The axes to draw on: those given, or new ones."""
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.figure(layout="constrained").add_subplot()


def named(ax: Any, across: str, up: str) -> Any:
    """The axes with names."""
    ax.set_xlabel(across)
    ax.set_ylabel(up)
    return ax


def cloud(ax: Any, across: Floats, up: Floats) -> None:
    """Draw points, each smaller the more there are."""
    size = 3.0 if len(across) < 2000 else 1.0 if len(across) < 50_000 else 0.3
    ax.plot(across, up, ".", color="k", markersize=size, markeredgewidth=0, rasterized=True)


def cells(ax: Any, across: Floats, up: Floats, labels: NDArray[np.int32], names: list[str]) -> None:
    """Draw a label a cell: one colour an attractor, in a key; the others white and greys."""
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    others = {-4: ("run ends", "0.35"), -3: ("no start", "0.85")}
    others |= {-2: ("escapes", "white"), -1: ("not resolved", "0.6")}
    hues = [_HUES[n % len(_HUES)] for n in range(max(len(names), 1))]
    colours = [colour for _, colour in others.values()] + hues
    norm = BoundaryNorm(np.arange(-4.5, len(hues)), len(colours))
    ax.pcolormesh(across, up, labels, cmap=ListedColormap(colours), norm=norm)
    shown = [Patch(facecolor=hue, label=name) for hue, name in zip(hues, names, strict=False)]
    shown += [
        Patch(facecolor=colour, edgecolor="k", linewidth=0.5, label=name)
        for label, (name, colour) in others.items()
        if (labels == label).any()
    ]
    if shown:
        ax.legend(handles=shown, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False)


def curve(ax: Any, values: Floats, points: Floats, stable: NDArray[np.bool_]) -> None:
    """Draw a branch: a full line where it is stable, a broken one elsewhere."""
    # A stretch between two orbits is stable where its first one is.
    for is_stable, style in ((True, "-"), (False, "--")):
        here = stable == is_stable
        drawn = np.where(here | np.append(False, here[:-1]), points, np.nan)
        ax.plot(values, drawn, style, color="k" if is_stable else "0.5", linewidth=1)

"""Verdicts on random systems, counted and listed."""

from collections import Counter

from random_systems import KINDS

NEITHER = ("excused", "both undecided", "prover slow", "prover refuses", "not spoiled")
WRONG = ("wrong event", "wrong digit", "undecided", "digits gone", "accumulation", "crash", "slow")
VERDICTS = ("right", *WRONG, *NEITHER)
ORDER = [*KINDS, "files"]


def summary(results: list) -> str:
    """A line a kind: how many of each verdict, events, times."""
    seen = [verdict for verdict in VERDICTS if any(r.verdict == verdict for r in results)]
    lines = [
        "| kind | systems | events | "
        + " | ".join(seen)
        + " | s, percuss | s, prover | fewest digits of a time |"
    ]
    lines.append("|---|" + "--:|" * (len(seen) + 5))
    for kind in [*ORDER, "all"]:
        own = [r for r in results if kind in (r.task.kind, "all")]
        if own:
            counts = Counter(r.verdict for r in own)
            cells = [kind, len(own), sum(r.events for r in own), *(counts[v] for v in seen)]
            cells += [f"{max(r.seconds[i] for r in own):.1f}" for i in (0, 1)]
            cells.append(min(r.fewest for r in own))
            lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


def failures(results: list) -> str:
    """A line for each system that was not right."""
    poor = [r for r in results if r.verdict != "right"]
    poor.sort(key=lambda r: (VERDICTS.index(r.verdict), ORDER.index(r.task.kind), r.task.name))
    return "\n".join(
        f"- {r.verdict}: {r.task.name} ({r.events} events, {r.bits} bits): {r.why}" for r in poor
    )

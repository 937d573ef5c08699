"""heyoka: with a direction, the crossing that counts is missed in a step that begins on an exact zero
at which the guard crosses in the other direction."""

import heyoka as hy

x, v = hy.make_vars("x", "v")
print("heyoka", hy.__version__, "- a ball is thrown up from the ground and lands at t = 2")
for name, direction in (
    ("any", hy.event_direction.any),
    ("negative", hy.event_direction.negative),
):
    found = []
    event = hy.nt_event(x, lambda _, t, sign: found.append((round(t, 6), sign)), direction=direction)
    run = hy.taylor_adaptive([(x, v), (v, hy.expression(-1.0))], [0.0, 1.0], nt_events=[event])
    run.propagate_until(3.0)
    print(f"direction {name}: {found}")

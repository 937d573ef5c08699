"""heyoka: an event that is exactly zero where a step begins is found twice there, and its next root in
that step is missed."""

import heyoka as hy

x, v = hy.make_vars("x", "v")
print("heyoka", hy.__version__, "- a ball is thrown up from the ground and lands at t = 2")
for start in (0.0, 1e-300):
    for direction in (hy.event_direction.any, hy.event_direction.negative):
        found = []
        note = lambda integrator, t, sign: found.append((round(t, 6), sign))
        event = hy.nt_event(x, note, direction=direction)
        ball = [(x, v), (v, hy.expression(-1.0))]
        run = hy.taylor_adaptive(ball, [start, 1.0], nt_events=[event])
        run.propagate_until(3.0)
        print(f"from {start:g}, direction {direction.name}: {found}")

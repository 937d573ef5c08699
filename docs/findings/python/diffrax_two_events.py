"""diffrax: of two events in one step the one that is first in the list wins, not the first in time
(patrick-kidger/diffrax issue 639)."""

import diffrax
import optimistix


def level(value):
    return lambda t, y, args, **_: y - value


print("diffrax", diffrax.__version__, "- y = t; expected in either order: t = 0.5")
for values in ((0.5, 1.0), (1.0, 0.5)):
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: 1.0),
        diffrax.Euler(),
        0.0,
        10.0,
        2.0,
        0.0,
        event=diffrax.Event(
            [level(value) for value in values], optimistix.Newton(1e-5, 1e-5, optimistix.rms_norm)
        ),
    )
    print(f"levels {values}: the run ends at t = {float(found.ts[-1]):.6f}")

"""The first crossing of a guard, proved.

The elapsed time is swept in steps. On each step every guard is shown to be negative, by Taylor
forms with an enclosed remainder; or exactly one of them is shown to rise strictly from below to
above zero, and that is the crossing: the only one on its step, the first one of the phase, and
simple. A step that shows neither is halved. Nothing is sampled and nothing is assumed about how
many crossings there are.
"""

from flint import arb, arb_series, ctx

TAYLOR_ORDER = 8

CLEAR, RISES, UNCLEAR = "clear", "rises", "unclear"


class Undecided(Exception):
    """A comparison or a digit that the present precision cannot settle."""


def taylor(function, d: arb, order: int) -> list:
    """Taylor coefficients 0..order of `function` at `d`; enclosures of them over `d` if it is wide."""
    ctx.cap = order + 1
    series = function(arb_series([d, 1]))
    return [series[k] for k in range(order + 1)]


def horner(coefficients, x):
    value = arb(0)
    for coefficient in reversed(coefficients):
        value = value * x + coefficient
    return value


def derivatives(function, left: arb, right: arb, count: int = 3) -> list:
    """Enclosures over [left, right] of `function` and its derivatives, `count` in all.

    Taylor form about the midpoint; the coefficient of highest order is enclosed over the whole
    interval, which makes the form a mean value theorem, not an approximation.
    """
    interval = left.union(right)
    centre = interval.mid()
    coefficients = taylor(function, centre, TAYLOR_ORDER - 1)
    coefficients.append(taylor(function, interval, TAYLOR_ORDER)[TAYLOR_ORDER])
    enclosures = []
    for _ in range(count):
        enclosures.append(horner(coefficients, interval - centre))
        coefficients = [k * c for k, c in enumerate(coefficients)][1:]
    return enclosures


def clear_on_entry(guard, right: arb) -> bool:
    """Negative on (0, right]: the first derivative not known to vanish at 0 is negative throughout.

    This is what keeps a separation, where the gap and its velocity are both exactly zero, from
    being taken for an impact.
    """
    return derivatives(guard.value, arb(0), right)[guard.zeros] < 0


def verdict(guard, left: arb, right: arb) -> str:
    """What `guard`, known to be negative at `left`, provably does on (left, right]."""
    value, slope, _ = derivatives(guard.value, left, right)
    if value < 0 or slope < 0:
        return CLEAR
    if slope > 0:
        at_right = guard.value(right)
        if at_right < 0:
            return CLEAR
        if at_right > 0:
            return RISES
    envelope = derivatives(guard.slow_part, left, right)[0] + guard.amplitude
    return CLEAR if envelope < 0 else UNCLEAR


def refine(guard, left: arb, right: arb) -> arb:
    """Interval Newton from a bracket on which the guard rises strictly, until it gains no more."""
    root = left.union(right)
    while True:
        middle = root.mid()
        slope = derivatives(guard.value, root.lower(), root.upper())[1]
        newton = root.intersection(middle - guard.value(middle) / slope)
        if not newton.rad() < root.rad() / 2:
            return newton
        root = newton


def first_crossing(guards, horizon: arb, first_step: arb):
    """(guard, elapsed time) of the first crossing before `horizon`, or None where there is none.

    Proved for every guard from entry on. Raises `Undecided` where this precision is not enough.
    """
    smallest = arb(2) ** -(ctx.prec // 2)
    left, end, step, entering = arb(0), horizon.upper(), first_step, True
    while left < end:
        right = (left + step).mid()
        right = right if right < end else end
        if entering:
            found = [CLEAR if clear_on_entry(g, right) else UNCLEAR for g in guards]
        else:
            found = [verdict(g, left, right) for g in guards]
        if UNCLEAR in found or found.count(RISES) > 1:
            step = (right - left) / 2
            if step < smallest:
                raise Undecided("crossing")
        elif RISES in found:
            guard = guards[found.index(RISES)]
            root = refine(guard, left, right)
            if root < horizon:
                return guard, root
            if root > horizon:
                return None
            raise Undecided("crossing at the horizon")
        else:
            left, step, entering = right, 2 * step, False
    return None

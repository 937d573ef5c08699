"""CSV tables whose every printed digit is proved."""

import math
from decimal import Context, Decimal

from flint import arb

from case import Case
from crossing import Undecided

DIGITS = 25
DECIMALS = 60  # no digit beyond this place is printed: far below the least f64 that matters here
COLUMNS = "index,phase,elapsed,tau,p,y,q,v"

_EXACT = Context(prec=DIGITS + DECIMALS)


def proved_decimal(x: arb) -> str:
    """`x` rounded to DIGITS significant digits and at most DECIMALS decimals.

    Every number in the ball rounds to the string returned; otherwise `Undecided`.
    """
    places = min(DIGITS - 1 - leading_place(x), DECIMALS)
    integer = rounded(x, places)
    if abs(integer) >= 10**DIGITS:  # 0.999... that rounds up to 1
        places -= 1
        integer = rounded(x, places)
    return "0" if integer == 0 else f"{Decimal(integer).scaleb(-places, _EXACT)}".lower()


def rounded(x: arb, places: int) -> int:
    """The integer nearest to x 10^places, the same for every number in the ball."""
    ten = arb(10) ** abs(places)
    scaled = x * ten if places >= 0 else x / ten
    integer = (scaled + arb(1) / 2).floor().unique_fmpz()
    if integer is None:
        raise Undecided("digit")
    return int(integer)


def leading_place(x: arb) -> int:
    """The power of ten of the first significant digit, at most one too low; far down where `x` may be zero."""
    size = abs(x).upper()
    if not abs(x) > 0 or size < arb(10) ** -DECIMALS:
        return -DECIMALS
    place = math.floor(float(size.log() / arb(10).log()))
    return place - 1 if size < arb(10) ** place else place


def row(index: int, phase: str, elapsed: arb, tau: arb, state) -> str:
    numbers = (elapsed, tau, state.p, state.y, state.q, state.v)
    return ",".join([str(index), phase, *map(proved_decimal, numbers)])


def heading(case: Case, what: str) -> list:
    """Comment lines: the case, its f64 parameters and start as shortest decimals, and the digits."""
    pairs = [("case", case.name), ("rows", what), *case.parameters.items()]
    pairs += [(f"start.{key}", value) for key, value in case.start.items()]
    pairs += [(f"horizon.{key}", value) for key, value in case.horizon.items()]
    pairs += [("digits", DIGITS), ("decimals", DECIMALS)]
    return [f"# {key} = {value}" for key, value in pairs] + [COLUMNS]

"""Proved decimals as numbers of other libraries."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from typing import Any

# Bits of a decimal digit, rounded up, and some more.
_BITS_OF_A_DIGIT = 3.33
_MORE_BITS = 16


def number_maker(kind: str) -> Callable[[str], Any]:
    """Make the function that makes a number of a decimal.

    Raises
    ------
    ValueError
        An unknown kind.
    """
    makers: dict[str, Callable[[str], Any]] = {"decimal": Decimal, "mpmath": _mpf, "flint": _arb}
    if kind not in makers:
        accepted = ", ".join(makers)
        raise ValueError(f"kind = {kind!r} is not accepted: one of {accepted} is")
    return makers[kind]


def _bits(text: str) -> int:
    return int(_BITS_OF_A_DIGIT * len(text)) + _MORE_BITS


def _mpf(text: str) -> Any:
    import mpmath

    with mpmath.workprec(_bits(text)):
        return mpmath.mpf(text)


def _arb(text: str) -> Any:
    import flint

    before = flint.ctx.prec
    flint.ctx.prec = _bits(text)
    try:
        if not Decimal(text):
            # A zero with an exponent is only known to be smaller than that power of ten.
            exponent = int(Decimal(text).as_tuple().exponent)
            return flint.arb(0, 0 if text == "0" else flint.arb(10) ** exponent)
        # The last digit is rounded: the number lies within one of its units.
        unit = flint.arb(10) ** int(Decimal(text).as_tuple().exponent)
        return flint.arb(flint.arb(text).mid(), unit.abs_upper())
    finally:
        flint.ctx.prec = before

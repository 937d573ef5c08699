"""Cells of a program that prints only digits that are proved, held against balls."""

from decimal import Decimal

from flint import arb, fmpq

from crossing import Undecided

CLEAR = fmpq(1, 1000)  # of a printed unit: the radius of the ball that a cell is held against
NOTHING_BUT_ZERO = arb(10) ** -100  # a ball about zero of less than this is one
MOST_DIGITS = 25


def agrees(cell: str, ball: arb) -> bool:
    """Does every number of the ball round to the cell? Raises `Undecided` where one may not."""
    if cell == "0":
        return is_zero(ball)
    reach, value = meaning(cell)
    if abs(ball - arb(value)) > arb(reach):
        return False
    if not ball.rad() < arb(reach * CLEAR):
        raise Undecided("digit")
    return True


def is_zero(ball: arb) -> bool:
    if ball > 0 or ball < 0:
        return False
    if not abs(ball) < NOTHING_BUT_ZERO:
        raise Undecided("zero")
    return True


def meaning(cell: str) -> tuple:
    """(how far the number may be from the printed one, the printed one)."""
    if cell.startswith("0e"):
        return ten(int(cell[2:])), fmpq(0)
    return ten(Decimal(cell).as_tuple().exponent) / 2, exactly(cell)


def exactly(cell: str) -> fmpq:
    return fmpq(*Decimal(cell).as_integer_ratio())


def ten(power: int) -> fmpq:
    return fmpq(10) ** power if power >= 0 else 1 / fmpq(10) ** -power


def digits(cell: str) -> int:
    """The significant digits of a cell; an exact zero has them all."""
    if cell == "0":
        return MOST_DIGITS
    return 0 if cell.startswith("0e") else len(Decimal(cell).as_tuple().digits)

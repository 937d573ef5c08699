"""The coefficients of a system with their derivatives by one name, exactly.

A name is a parameter, or `start.STATE`: a state at the start. The file is read as `system_file.py`
does, with dual numbers in the place of rational ones.
"""

import tomllib
from pathlib import Path
from typing import NamedTuple

from flint import fmpq, fmpq_mat

from affine_expression import Refused, number
from system_file import Builder, System

START = "start."


class Dual:
    """A rational number with its derivative."""

    def __init__(self, value: fmpq, rate: fmpq):
        self.value, self.rate = value, rate

    @property
    def p(self):
        return self.value.p

    @property
    def q(self):
        return self.value.q

    def __add__(self, other):
        value, rate = parts(other)
        return Dual(self.value + value, self.rate + rate)

    def __mul__(self, other):
        value, rate = parts(other)
        return Dual(self.value * value, self.rate * value + self.value * rate)

    __radd__, __rmul__ = __add__, __mul__

    def __neg__(self):
        return self * -1

    def __sub__(self, other):
        return self + other * fmpq(-1)

    def __rsub__(self, other):
        return -self + other

    def __rtruediv__(self, other):
        return Dual(1 / self.value, -self.rate / (self.value * self.value)) * other

    def __pow__(self, exponent: int):
        power = Dual(fmpq(1), fmpq(0))
        for _ in range(exponent):
            power = power * self
        return power

    def __eq__(self, other):
        return parts(self) == parts(other)

    def __bool__(self):
        return self != 0

    def __gt__(self, other):
        return self.value > parts(other)[0]


def parts(number) -> tuple:
    """(value, derivative) of a dual number or of one that is constant."""
    if isinstance(number, Dual):
        return number.value, number.rate
    return fmpq(number), fmpq(0)


class Matrix(NamedTuple):
    """A matrix, or a row, with its derivative."""

    value: fmpq_mat
    rate: fmpq_mat

    def doubled(self) -> fmpq_mat:
        """What it makes of (s, z), where s is the derivative of z: (rate z + value s, value z)."""
        value, rate = self.value.tolist(), self.rate.tolist()
        none = [fmpq(0)] * self.value.ncols()
        upper = [[*row, *slope] for row, slope in zip(value, rate, strict=True)]
        return fmpq_mat([*upper, *([*none, *row] for row in value)])

    def of_derivative(self) -> fmpq_mat:
        """A row that takes (s, z) to the derivative of the row's value."""
        return fmpq_mat([[*self.value.entries(), *self.rate.entries()]])

    def of_value(self) -> fmpq_mat:
        """A row that takes (s, z) to the row's value."""
        return fmpq_mat([[fmpq(0)] * self.value.ncols() + self.value.entries()])


class DualBuilder(Builder):
    """Builds a system of dual numbers: its matrices and rows are `Matrix`."""

    def __init__(self, table: dict, overriding: dict, start: dict | None, name: str):
        self.name = name
        super().__init__(table, overriding, start)
        known = [*self.parameters, *(f"{START}{state}" for state in self.states)]
        if name not in known:
            raise Refused(f"a derivative by {name!r}: names are {', '.join(known)}")

    def parameter(self, name: str):
        value = number(self.parameters[name])
        return Dual(value, fmpq(1)) if name == self.name else value

    def matrix_of(self, rows: list) -> Matrix:
        split = [[parts(entry) for entry in row] for row in rows]
        return Matrix(*(fmpq_mat([[e[k] for e in row] for row in split]) for k in (0, 1)))

    def check_drift(self, modes: list, start: list) -> None:
        """A drift is checked where the file is read without derivatives."""

    def start_state(self, name: str) -> list:
        row = super().start_state(name)
        moved = Dual(fmpq(0), fmpq(1)) if self.name == f"{START}{name}" else fmpq(0)
        return [*row[:-1], row[-1] + moved]


def read(path: Path, name: str, parameters: dict, start: dict | None) -> System:
    """The system of a file in dual numbers, with parameters overridden and its start replaced."""
    try:
        return DualBuilder(tomllib.loads(path.read_text()), parameters, start, name).system()
    except Refused as refusal:
        raise Refused(f"{path}: {refusal}") from None

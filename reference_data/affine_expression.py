"""Expressions of a system file: exact rational combinations of states, cos, sin and 1."""

import re

from flint import fmpq

LARGEST_EXPONENT = 64
LARGEST_INTEGER = 2**63
LARGEST_BITS = 16384
TOKEN = re.compile(
    r"\s*(?:(?P<integer>\d+(?![\d.eE]))|(?P<name>[A-Za-z]\w*)|(?P<sign>[-+*/^()<>]))"
)


class Refused(Exception):
    """What the format does not accept, said in one sentence."""


def number(value) -> fmpq:
    """A TOML integer or float, taken exactly."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Refused(f"{value!r} is not a number")
    if isinstance(value, float):
        if value - value != 0:
            raise Refused(f"{value} is not finite")
        return fmpq(*value.as_integer_ratio())
    if not -LARGEST_INTEGER <= value < LARGEST_INTEGER:
        raise Refused(f"{value} is not an integer of 64 bits")
    return fmpq(value)


def tokens(text: str) -> list:
    """The integers, names and signs of `text`, each as (kind, characters)."""
    found, position = [], 0
    while text[position:].strip():
        match = TOKEN.match(text, position)
        if match is None:
            raise Refused(f"{text!r}: {text[position:].strip()[0]!r} fits nowhere")
        found.append((match.lastgroup, match.group(match.lastgroup)))
        position = match.end()
    return found


class Reader:
    """Recursive descent over one expression. `value_of` gives the coefficients of a name.

    A value is the list of its coefficients, that of 1 last; it is constant where all others are 0.
    """

    def __init__(self, text: str, value_of, size: int):
        self.text, self.value_of, self.size = text, value_of, size
        self.tokens, self.position = tokens(text), 0

    def take(self, *signs):
        """The next token if it is one of `signs`, which is then passed."""
        if self.position < len(self.tokens):
            kind, characters = self.tokens[self.position]
            if kind == "sign" and characters in signs:
                self.position += 1
                return characters
        return None

    def refuse(self, why: str):
        raise Refused(f"{self.text!r}: {why}")

    def whole(self) -> list:
        """The value of the text, which must be one expression and nothing else."""
        value = self.sum()
        if self.position < len(self.tokens):
            self.refuse(f"{self.tokens[self.position][1]!r} follows a complete expression")
        return value

    def condition(self) -> list:
        """The guard of `left > right` or `left < right`: positive where the condition holds."""
        left = self.sum()
        sign = self.take(">", "<") or self.refuse("a condition is `left > right` or `left < right`")
        right = self.whole()
        return combined(left, right, -1) if sign == ">" else combined(right, left, -1)

    def sum(self) -> list:
        value = self.product()
        while sign := self.take("+", "-"):
            value = combined(value, self.product(), 1 if sign == "+" else -1)
        return self.limited(value)

    def product(self) -> list:
        value = self.factor()
        while sign := self.take("*", "/"):
            other = self.factor()
            if sign == "/":
                value = scaled(value, 1 / self.divisor(other))
            elif constant(other):
                value = scaled(value, other[-1])
            elif constant(value):
                value = scaled(other, value[-1])
            else:
                self.refuse("of two factors at least one is constant")
            self.limited(value)
        return value

    def divisor(self, value: list) -> fmpq:
        if not constant(value) or value[-1] == 0:
            self.refuse("a divisor is a constant other than 0")
        return value[-1]

    def factor(self) -> list:
        if self.take("-"):
            return scaled(self.factor(), fmpq(-1))
        base = self.atom()
        if not self.take("^"):
            return base
        kind, characters = self.next_token()
        if kind == "integer" and int(characters) == 1:
            return base
        if kind != "integer" or int(characters) > LARGEST_EXPONENT or not constant(base):
            self.refuse("an exponent is an integer from 0 to 64, and its base has no state in it")
        return self.limited([*base[:-1], base[-1] ** int(characters)])

    def atom(self) -> list:
        if self.take("("):
            value = self.sum()
            return value if self.take(")") else self.refuse("a parenthesis is not closed")
        kind, characters = self.next_token()
        if kind == "integer":
            return [fmpq(0)] * (self.size - 1) + [number(int(characters))]
        if kind == "name":
            return self.value_of(characters)
        return self.refuse(f"{characters!r} stands where a number or a name is wanted")

    def next_token(self):
        if self.position == len(self.tokens):
            self.refuse("it ends too early")
        self.position += 1
        return self.tokens[self.position - 1]

    def limited(self, value: list) -> list:
        if any(max(abs(c.p), c.q).bit_length() > LARGEST_BITS for c in value):
            self.refuse(f"a coefficient has more than {LARGEST_BITS} bits")
        return value


def constant(value: list) -> bool:
    return all(c == 0 for c in value[:-1])


def combined(a: list, b: list, factor: int) -> list:
    return [x + factor * y for x, y in zip(a, b, strict=True)]


def scaled(a: list, factor: fmpq) -> list:
    return [x * factor for x in a]

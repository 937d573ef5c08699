"""Answers with one thing wrong, to see that a comparison notices it."""

import random


def altered(rows: list, seed: str) -> list | None:
    """Rows with a digit, a name or a mode changed, or a row missing; None if there is no room.

    What a run that gave up says last stays: its end is no claim.
    """
    rng, rows = random.Random(seed), [list(row) for row in rows]
    last = len(rows) - 1 if rows[-1][2] == "end" else len(rows) - 2
    if last < 1:
        return None
    index = rng.randint(1, last)
    row = rows[index]
    how = rng.choice(["digit", "digit", "event", "mode", "missing"])
    numbers = [j for j in (1, *range(4, len(row))) if row[j] != "0" and row[j][:2] != "0e"]
    if how == "missing" and index < last:
        del rows[index]
    elif how == "digit" and numbers:
        column = rng.choice(numbers)
        row[column] = with_last_digit_changed(row[column], rng.randint(1, 9))
    else:
        row[3 if how == "mode" else 2] += "-not"
    return rows


def with_last_digit_changed(cell: str, by: int) -> str:
    digits, mark, exponent = cell.partition("e")
    return f"{digits[:-1]}{(int(digits[-1]) + by) % 10}{mark}{exponent}"

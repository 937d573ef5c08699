"""A state with its errors as columns, so that a long run does not wrap them in boxes.

A state and its elapsed time lie in `centre` + `columns` times numbers from -1 to 1. A map with
derivative S takes them to its value at the centre, and S `columns`: by the mean value theorem, if S
encloses the derivative over the hull. Of S `columns` only the midpoints are kept as columns; their
radii, errors of second order, become a box of new columns.
"""

from flint import arb, arb_mat

MOST_COLUMNS = 48


class Spread:
    """All that a state, with the elapsed time below it, may be."""

    def __init__(self, centre: arb_mat, columns: arb_mat):
        self.centre, self.columns, self.size = centre, columns, centre.nrows()

    @classmethod
    def of(cls, z: arb_mat, elapsed: arb):
        """The balls of a state and a time, taken as a box."""
        balls = arb_mat([[entry] for entry in [*z.entries(), elapsed]])
        return cls(balls.mid(), diagonal([entry.rad() for entry in balls.entries()]))

    def hull(self) -> arb_mat:
        """The box of states, without the time."""
        return arb_mat([[self.entry(i)] for i in range(self.size - 1)])

    def elapsed(self) -> arb:
        return self.entry(self.size - 1)

    def entry(self, i: int) -> arb:
        reach = sum((abs(self.columns[i, j]) for j in range(self.columns.ncols())), arb(0))
        return self.centre[i, 0] + arb(0, reach.upper())

    def mapped(self, derivative: arb_mat, image: arb_mat) -> "Spread":
        """What a map makes of it that takes the centre into `image`."""
        columns = derivative * self.columns
        radii = [image[i, 0].rad() + radius(columns, i) for i in range(self.size)]
        joined = beside(columns.mid(), diagonal([r.upper() for r in radii]))
        return Spread(image.mid(), fewer(joined))


def radius(matrix: arb_mat, i: int) -> arb:
    return sum((matrix[i, j].rad() for j in range(matrix.ncols())), arb(0))


def diagonal(entries: list) -> arb_mat:
    size = len(entries)
    return arb_mat([[entries[i] if i == j else 0 for j in range(size)] for i in range(size)])


def beside(left: arb_mat, right: arb_mat) -> arb_mat:
    return arb_mat([a + b for a, b in zip(left.tolist(), right.tolist(), strict=True)])


def fewer(columns: arb_mat) -> arb_mat:
    """The columns, the smallest of them replaced by the box that holds them, if they are many."""
    size, count = columns.nrows(), columns.ncols()
    if count <= MOST_COLUMNS:
        return columns
    lists = columns.transpose().tolist()
    lists.sort(key=lambda column: max(abs(x) for x in column), reverse=True)
    kept, boxed = lists[: MOST_COLUMNS // 2], lists[MOST_COLUMNS // 2 :]
    box = [sum((abs(column[i]) for column in boxed), arb(0)).upper() for i in range(size)]
    return beside(arb_mat(kept).transpose(), diagonal(box))

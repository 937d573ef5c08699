"""Structural zeros: what is zero by the model, kept as a space of rows r with r z = 0.

Everything here is exact. A space is kept in reduced row echelon form.
"""

from flint import fmpq, fmpq_mat


def stacked(upper: fmpq_mat, lower: fmpq_mat) -> fmpq_mat:
    """The rows of both."""
    return fmpq_mat(upper.nrows() + lower.nrows(), upper.ncols(), upper.entries() + lower.entries())


def left_kernel(matrix: fmpq_mat) -> fmpq_mat:
    """A basis of the rows r with r `matrix` = 0."""
    size = matrix.nrows()
    reduced, rank = matrix.transpose().rref()
    pivots = [next(j for j in range(size) if reduced[i, j] != 0) for i in range(rank)]
    basis = []
    for free in (j for j in range(size) if j not in pivots):
        row = [fmpq(0)] * size
        row[free] = fmpq(1)
        for i, pivot in enumerate(pivots):
            row[pivot] = -reduced[i, free]
        basis += row
    return fmpq_mat(size - rank, size, basis)


class Space:
    """A space of rows."""

    def __init__(self, rows: fmpq_mat):
        reduced, rank = rows.rref()
        self.size, self.rank = rows.ncols(), rank
        self.basis = fmpq_mat(rank, self.size, reduced.entries()[: rank * self.size])
        self.pivots = [
            next(j for j in range(self.size) if self.basis[i, j] != 0) for i in range(rank)
        ]

    def rest(self, rows: fmpq_mat) -> fmpq_mat:
        """`rows` less what lies in the space: 0 exactly where a row does."""
        if self.rank == 0 or rows.nrows() == 0:
            return rows
        weights = [rows[i, pivot] for i in range(rows.nrows()) for pivot in self.pivots]
        return rows - fmpq_mat(rows.nrows(), self.rank, weights) * self.basis

    def holds(self, row: fmpq_mat) -> bool:
        return all(entry == 0 for entry in self.rest(row).entries())

    def with_rows(self, rows: list) -> "Space":
        """The space enlarged by `rows`."""
        joined = self.basis
        for row in rows:
            joined = stacked(joined, row)
        return Space(joined)

    def before(self, matrix: fmpq_mat) -> "Space":
        """The rows r for which r `matrix` lies in the space."""
        return Space(left_kernel(self.rest(matrix)))

    def carried(self, matrix: fmpq_mat) -> "Space":
        """The largest part that r -> r `matrix` maps into itself: it stays zero along a segment."""
        space = self
        while True:
            kept = left_kernel(space.rest(space.basis * matrix))
            smaller = Space(kept * space.basis)
            if smaller.rank == space.rank:
                return smaller
            space = smaller


def multiplicity(row: fmpq_mat, matrix: fmpq_mat, space: Space) -> int | None:
    """The least k with `row` `matrix`^k outside the space; None if `row` z stays zero for ever."""
    for k in range(matrix.nrows()):
        if not space.holds(row):
            return k
        row = row * matrix
    return None

"""Linear invariants of an integer matrix: semi-positive ones of minimal support, covers, a basis of all.

A matrix is a sequence of rows (places), each a sparse dict from column (transition) to entry. An invariant is a sparse
vector y over the rows with y * matrix = 0. For invariants over the columns, hand in `transposed(rows)`.

    rows = [{0: -1, 1: 1}, {0: 1, 1: -1}]     # two places, two transitions: a ring
    semiflows(rows).vectors                   # ({0: 1, 1: 1},)

All arithmetic that a result rests on is exact: what floating point proposes is solved again in integers, and every
vector is multiplied out before it is given (`is_invariant`). Limits count work, not seconds, so that results can be
repeated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from heapq import heapify, heappop, heappush
from math import gcd
from typing import Any

from pn2code.base.frozen import frozen, record
from pn2code.base.how_far import beginning, counted, counting

Row = Mapping[int, int]
Vector = dict[int, int]


@frozen
class Limits:
    """Where the search for invariants stops.

    Args:
        rows: most vectors kept at a time while columns are eliminated.
        work: most pairs of vectors compared.
        programs: most linear programs solved to cover rows when `semiflows` was cut (fewer for a large matrix).
        cells: largest dense matrix (rows times columns) for a basis.
    """

    rows: int = 4_000
    work: int = 100_000
    programs: int = 150
    cells: int = 6_000_000


@frozen
class Flows:
    """Semi-positive invariants.

    Args:
        vectors: of minimal support, each with greatest common divisor 1; sorted.
        complete: whether these are all. If not, they still cover every row that an invariant can cover, as far as
            `Limits.programs` reached.
    """

    vectors: tuple[Vector, ...]
    complete: bool


def is_invariant(rows: Sequence[Row], vector: Mapping[int, int]) -> bool:
    """Whether the vector times the matrix is zero."""
    product: dict[int, int] = {}
    for row, weight in vector.items():
        for column, entry in rows[row].items():
            product[column] = product.get(column, 0) + weight * entry
    return not any(product.values())


def transposed(rows: Sequence[Row], columns: int) -> list[dict[int, int]]:
    """The matrix with rows and columns exchanged."""
    found: list[dict[int, int]] = [{} for _ in range(columns)]
    for index, row in enumerate(rows):
        for column, entry in row.items():
            if entry:
                found[column][index] = entry
    return found


# --- semi-positive invariants --------------------------------------------------------------------


def semiflows(rows: Sequence[Row], limits: Limits | None = None) -> Flows:
    """The semi-positive invariants of minimal support, by Fourier-Motzkin (Farkas) elimination.

    Of a matrix for which that takes too long, a cover: linear programs find an invariant for each row that has one.
    """
    limits = limits or Limits()
    found, complete = _eliminated(rows, limits)
    if not complete and limits.programs:
        found = [*found, *_covering(rows, found, limits)]
    unique = {tuple(sorted(v.items())): v for v in found}
    vectors = tuple(dict(key) for key in sorted(unique, key=lambda k: (len(k), k)))
    for v in vectors:
        assert is_invariant(rows, v)
    return Flows(vectors, complete)


def _eliminated(rows: Sequence[Row], limits: Limits) -> tuple[list[Vector], bool]:
    """Vectors whose products with all columns are zero; and whether the elimination came to its end."""
    working = {
        i: _Line({i: 1}, {c: n for c, n in row.items() if n}, 1 << i) for i, row in enumerate(rows)
    }
    fresh = len(working)
    columns: dict[int, set[int]] = {}
    for i, line in working.items():
        for c in line.rest:
            columns.setdefault(c, set()).add(i)
    if columns and len(working) > limits.rows:
        return [x.vector for x in working.values() if not x.rest], False
    _same_columns(working, columns)
    supports = _Supports()
    for line in working.values():
        supports.add(line.support)
    work = 0
    growth = {c: _growth(working, members, c) for c, members in columns.items()}
    queue = [(n, c) for c, n in growth.items()]
    heapify(queue)
    more = counting("invariants", total=len(columns))
    while queue:
        expected, column = heappop(queue)
        if column not in columns or growth[column] != expected:
            continue
        more()
        involved = columns.pop(column)
        plus = sorted(i for i in involved if working[i].rest[column] > 0)
        minus = sorted(i for i in involved if working[i].rest[column] < 0)
        work += len(plus) * len(minus)
        if work > limits.work or len(working) > limits.rows:
            return [x.vector for x in working.values() if not x.rest], False
        # A combination is of minimal support if no third vector lies within the two.
        made = [
            _combined(working[i], working[j], column)
            for i in plus
            for j in minus
            if not supports.has_third(working[i].support, working[j].support)
        ]
        touched = {c for i in involved for c in working[i].rest if c != column}
        for i in involved:
            for c in working[i].rest:
                if c != column:
                    columns[c].discard(i)
            supports.remove(working.pop(i).support)
        for line in made:
            working[fresh] = line
            supports.add(line.support)
            for c in line.rest:
                columns[c].add(fresh)
            fresh += 1
        for c in touched:
            if columns[c]:
                growth[c] = _growth(working, columns[c], c)
                heappush(queue, (growth[c], c))
            else:
                del columns[c]
    return [x.vector for x in working.values()], True


@record
class _Line:
    """A vector, its products with the columns that are left, its support as a bit set."""

    vector: Vector
    rest: Vector
    support: int


class _Supports:
    """The supports of the vectors, each found by its lowest row.

    Attributes:
        looked: how many rows were gone through.
    """

    def __init__(self) -> None:
        self._by_row: dict[int, list[int]] = {}
        self._lowest = 0
        self.looked = 0

    def add(self, support: int) -> None:
        """One more; several may be equal."""
        lowest = support & -support
        self._by_row.setdefault(lowest, []).append(support)
        self._lowest |= lowest

    def remove(self, support: int) -> None:
        """One that was added."""
        lowest = support & -support
        beginning = self._by_row[lowest]
        beginning.remove(support)
        if not beginning:
            del self._by_row[lowest]
            self._lowest ^= lowest

    def has_third(self, one: int, other: int) -> bool:
        """Whether a support that is neither of the two lies within both together."""
        union = one | other
        rest = union & self._lowest
        while rest:
            lowest = rest & -rest
            self.looked += 1
            for support in self._by_row[lowest]:
                if support | union == union and support not in (one, other):
                    return True
            rest ^= lowest
        return False


def _growth(working: Mapping[int, _Line], members: Iterable[int], column: int) -> int:
    """How many vectors more there will be when the column is eliminated, at most."""
    plus = minus = 0
    for i in members:
        if working[i].rest[column] > 0:
            plus += 1
        else:
            minus += 1
    return plus * minus - plus - minus


def _same_columns(working: Mapping[int, _Line], columns: dict[int, set[int]]) -> None:
    """Leaves out columns that are multiples of others."""
    seen: set[tuple[tuple[int, int], ...]] = set()
    for c in sorted(columns):
        members = sorted(columns[c])
        entries = [working[i].rest[c] for i in members]
        divisor = gcd(*entries) * (1 if entries[0] > 0 else -1)
        key = tuple((i, n // divisor) for i, n in zip(members, entries, strict=True))
        if key in seen:
            for i in members:
                del working[i].rest[c]
            del columns[c]
        seen.add(key)


def _combined(one: _Line, other: _Line, column: int) -> _Line:
    """The smallest positive combination in which the column is zero."""
    a, b = one.rest[column], -other.rest[column]
    divisor = gcd(a, b)
    f, g = b // divisor, a // divisor
    vector = {i: f * n for i, n in one.vector.items()}
    for i, n in other.vector.items():
        vector[i] = vector.get(i, 0) + g * n
    rest = {c: f * n for c, n in one.rest.items()}
    for c, n in other.rest.items():
        rest[c] = rest.get(c, 0) + g * n
    rest = {c: n for c, n in rest.items() if n}
    common = gcd(*vector.values())
    if common > 1:
        vector = {i: n // common for i, n in vector.items()}
        rest = {c: n // common for c, n in rest.items()}
    return _Line(vector, rest, one.support | other.support)


# --- covers by linear programs -------------------------------------------------------------------


def _covering(rows: Sequence[Row], known: Iterable[Vector], limits: Limits) -> list[Vector]:
    """Invariants for the rows that the known ones do not cover."""
    covered = {i for v in known for i in v}
    program = Program(rows)
    possible = program.support()
    found: list[Vector] = []
    budget = min(limits.programs, max(20, 300_000 // max(1, sum(map(len, rows)))))
    for i in counted(range(len(rows)), "invariants that cover places"):
        if program.solved > budget:
            break
        if i not in covered and i in possible:
            vector = program.invariant(i)
            if vector is not None:
                found.append(vector)
                covered |= vector.keys()
    return found


class Program:
    """Linear programs over the invariants of a matrix, made exact.

    Args:
        rows: the matrix; its columns may have any numbers.
        at_most: invariants y with y * matrix <= 0 instead of = 0 (sub-invariants: their sums never grow).

    Attributes:
        solved: how many programs were solved.
    """

    def __init__(self, rows: Sequence[Row], *, at_most: bool = False) -> None:
        from scipy.sparse import csr_matrix  # takes a third of a second to load

        self._rows = rows
        self._at_most = at_most
        entries = [(c, i, n) for i, row in enumerate(rows) for c, n in row.items() if n]
        place = {c: k for k, c in enumerate(sorted({c for c, _, _ in entries}))}
        data = (
            [n for _, _, n in entries],
            ([place[c] for c, _, _ in entries], [i for _, i, _ in entries]),
        )
        self._matrix: Any = csr_matrix(data, shape=(len(place), len(rows)), dtype=float)
        self._width = len(place)
        self.solved = 0

    def support(self) -> frozenset[int]:
        """The rows that some invariant covers, as floating point sees it."""
        from scipy.optimize import linprog
        from scipy.sparse import hstack, identity

        n = len(self._rows)
        if not n:
            return frozenset()
        # maximise the sum of z, 0 <= z <= 1, z <= y
        self.solved += 1
        constraint = hstack([self._matrix, 0 * self._matrix]).tocsr()
        below = hstack([-identity(n), identity(n)]).tocsr()
        cost = [0.0] * n + [-1.0] * n
        bounds = [(0, None)] * n + [(0, 1)] * n
        kinds = self._constraints(constraint, below)
        result = linprog(cost, **kinds, bounds=bounds, method="highs")
        if result.x is None:
            return frozenset()
        return frozenset(i for i in range(n) if result.x[n + i] > 0.5)

    def _constraints(self, matrix: Any, below: Any = None) -> dict[str, Any]:
        from scipy.sparse import vstack

        height = self._width
        if not self._at_most:
            kinds: dict[str, Any] = {"A_eq": matrix, "b_eq": [0.0] * height} if height else {}
            if below is not None:
                kinds |= {"A_ub": below, "b_ub": [0.0] * below.shape[0]}
            return kinds
        if below is not None:
            matrix = vstack([matrix, below]).tocsr() if height else below
        return {"A_ub": matrix, "b_ub": [0.0] * matrix.shape[0]} if matrix.shape[0] else {}

    def invariant(self, row: int, costs: Sequence[float] | None = None) -> Vector | None:
        """A (sub-)invariant with a positive weight of the row; the cheapest for weight 1; None if none was found."""
        from scipy.optimize import linprog

        n = len(self._rows)
        self.solved += 1
        bounds: list[tuple[float, float | None]] = [(0, None)] * n
        bounds[row] = (1, 1)
        # Among equally cheap ones a small one is read more easily.
        cost = [c + 1e-6 for c in costs] if costs is not None else [1.0] * n
        result = linprog(cost, **self._constraints(self._matrix), bounds=bounds, method="highs")
        if result.x is None or result.status != 0:
            return None
        return self._exact([i for i in range(n) if result.x[i] > 1e-9], row, costs)

    def _exact(
        self, support: list[int], row: int, costs: Sequence[float] | None = None
    ) -> Vector | None:
        """The exact vector with that support (or a part of it) and the row; the cheapest for weight 1 of the row."""
        rows: list[dict[int, int]] = [dict(self._rows[i]) for i in support]
        if self._at_most:
            # y * matrix + slack = 0: a slack row for each column that is touched.
            rows += [{c: 1} for c in sorted({c for r in rows for c in r})]
        small, complete = _eliminated(rows, Limits(rows=600, work=60_000))
        del complete  # any of them will do
        position = support.index(row)
        chosen = [v for v in small if position in v]
        if not chosen:
            return None

        def cost(vector: Vector) -> float:
            if costs is None:
                return 0.0
            known = [(i, w) for i, w in vector.items() if i < len(support)]
            return sum(costs[support[i]] * w for i, w in known) / vector[position]

        best = min(chosen, key=lambda v: (cost(v), len(v), sorted(v.items())))
        vector = {support[i]: w for i, w in best.items() if i < len(support)}
        assert self._holds(vector)
        return vector

    def _holds(self, vector: Vector) -> bool:
        if not self._at_most:
            return is_invariant(self._rows, vector)
        return is_sub_invariant(self._rows, vector)


def is_sub_invariant(rows: Sequence[Row], vector: Mapping[int, int]) -> bool:
    """Whether no column makes the weighted sum larger, and no weight is negative."""
    product: dict[int, int] = {}
    for row, weight in vector.items():
        for column, entry in rows[row].items():
            product[column] = product.get(column, 0) + weight * entry
    return all(n <= 0 for n in product.values()) and all(w >= 0 for w in vector.values())


# --- all integer invariants ----------------------------------------------------------------------

_LONG = 200_000
"""Entries of a dense matrix from which on the library takes long enough to be announced: no thread runs meanwhile."""


def basis(rows: Sequence[Row], limits: Limits | None = None) -> tuple[Vector, ...] | None:
    """A basis of all integer invariants: each is an integer combination of these. None: the matrix is too large."""
    import flint

    limits = limits or Limits()
    zero = [i for i, row in enumerate(rows) if not any(row.values())]
    others = [i for i, row in enumerate(rows) if any(row.values())]
    names = sorted({c for i in others for c, n in rows[i].items() if n})
    found: list[Vector] = [{i: 1} for i in zero]
    if not others:
        return tuple(found)
    if len(others) * len(names) > limits.cells:
        return None
    position = {c: k for k, c in enumerate(names)}
    dense = [[0] * len(others) for _ in names]
    for k, i in enumerate(others):
        for c, n in rows[i].items():
            if n:
                dense[position[c]][k] = n
    if len(others) * len(names) >= _LONG:
        beginning(f"solving for all invariants at once: {len(names):,} by {len(others):,}")
    kernel, dimension = flint.fmpz_mat(dense).nullspace()
    if dimension:
        columns = [[int(kernel[r, c]) for r in range(len(others))] for c in range(dimension)]
        for vector in _lattice([_primitive(v) for v in columns]):
            found.append({others[k]: n for k, n in enumerate(vector) if n})
    for v in found:
        assert is_invariant(rows, v)
    return tuple(sorted(found, key=lambda v: (len(v), sorted(v.items()))))


def _primitive(vector: list[int]) -> list[int]:
    divisor = gcd(*vector)
    first = next(n for n in vector if n)
    return [n // divisor * (1 if first > 0 else -1) for n in vector]


def _lattice(vectors: list[list[int]]) -> list[list[int]]:
    """A basis of all integer vectors in the rational span, with short members."""
    import flint

    if not _has_unit_columns(vectors):
        # B^T = W R (Hermite form, R square): the integer vectors of the span are spanned by R^-T B.
        b = flint.fmpz_mat(vectors)
        k = len(vectors)
        if k * b.ncols() >= _LONG:
            beginning(f"solving for whole numbers: {k:,} by {b.ncols():,}")
        hermite = b.transpose().hnf()
        square = flint.fmpz_mat([[int(hermite[i, j]) for j in range(k)] for i in range(k)])
        solved = flint.fmpq_mat(square.transpose()).solve(flint.fmpq_mat(b))
        vectors = [[int(solved[i, j].p) for j in range(b.ncols())] for i in range(k)]
    if 1 < len(vectors) <= 60:
        reduced = flint.fmpz_mat(vectors).lll()
        vectors = [_primitive([int(n) for n in row]) for row in reduced.tolist()]
    return vectors


def _has_unit_columns(vectors: list[list[int]]) -> bool:
    """Whether each vector has a place where it is 1 or -1 and all others are 0: then they span all integer vectors."""
    owners = [0] * len(vectors)
    for column in zip(*vectors, strict=True):
        users = [k for k, n in enumerate(column) if n]
        if len(users) == 1 and abs(column[users[0]]) == 1:
            owners[users[0]] = 1
    return all(owners)


def outside_span(vectors: Sequence[Vector], known: Sequence[Vector]) -> list[Vector]:
    """Those of the vectors that are not rational combinations of the known ones and of those before."""
    rows: dict[int, dict[int, int]] = {}  # leading index -> reduced vector

    def reduced(vector: Vector) -> Vector:
        v = dict(vector)
        while v:
            lead = min(v)
            if lead not in rows:
                return v
            pivot = rows[lead]
            a, b = pivot[lead], v[lead]
            v = {i: a * v.get(i, 0) - b * pivot.get(i, 0) for i in v.keys() | pivot.keys()}
            v = {i: n for i, n in v.items() if n}
            common = gcd(*v.values()) if v else 1
            if common > 1:
                v = {i: n // common for i, n in v.items()}
        return v

    left = []
    for vector, is_new in [*((v, False) for v in known), *((v, True) for v in vectors)]:
        v = reduced(vector)
        if v:
            rows[min(v)] = v
            if is_new:
                left.append(vector)
    return left

"""Normal forms of formulas: negations before what is looked at alone, and of the operators of time `X`, `U`, `R`."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.properties.meaning import Atom, Formula, Op, looks_at_steps

TRUE, FALSE = 0, 1
_TEMPORAL = frozenset("XFGURW")


def is_temporal(f: Formula) -> bool:
    """Whether an operator of time is in it."""
    return isinstance(f, Op) and (f.operator in _TEMPORAL or any(map(is_temporal, f.parts)))


class Forms:
    """Formulas in normal form, by number; equal ones have one number.

    A form is ("lit", positive, what), ("and", a, b), ("or", a, b), ("X", a), ("U", a, b) or ("R", a, b).
    """

    def __init__(self) -> None:
        self.forms: list[tuple[object, ...]] = [("true",), ("false",)]
        self._numbers: dict[tuple[object, ...], int] = {("true",): TRUE, ("false",): FALSE}

    def of(self, f: Formula, positive: bool) -> int:
        """The normal form of a formula, or of its negation."""
        if isinstance(f, Op) and f.operator == "not":
            return self.of(f.parts[0], not positive)
        if not is_temporal(f) and (not looks_at_steps(f) or isinstance(f, Atom)):
            if f == Atom("true"):
                return TRUE if positive else FALSE
            return self._number("lit", positive, f)
        assert isinstance(f, Op)
        match f.operator:
            case "and" | "or":
                parts = [self.of(x, positive) for x in f.parts]
                return self._both(parts, (f.operator == "and") == positive)
            case "implies":
                parts = [self.of(f.parts[0], not positive), self.of(f.parts[1], positive)]
                return self._both(parts, not positive)
            case "iff":
                x, y = f.parts
                same = self._and(self.of(x, True), self.of(y, positive))
                other = self._and(self.of(x, False), self.of(y, not positive))
                return self._or(same, other)
            case "X":
                return self._next(self.of(f.parts[0], positive))
            case "F" | "G":
                inner = self.of(f.parts[0], positive)
                eventually = (f.operator == "F") == positive
                return self._until(TRUE, inner) if eventually else self._release(FALSE, inner)
            case "U" | "R":
                a, b = (self.of(x, positive) for x in f.parts)
                return self._until(a, b) if (f.operator == "U") == positive else self._release(a, b)
            case "W":  # p W q is q R (p or q)
                p, q = (self.of(x, positive) for x in f.parts)
                if positive:
                    return self._release(q, self._or(p, q))
                return self._until(q, self._and(p, q))
            case other:
                raise AssertionError(other)

    def _number(self, *form: object) -> int:
        number = self._numbers.setdefault(form, len(self.forms))
        if number == len(self.forms):
            self.forms.append(form)
        return number

    def _both(self, parts: Sequence[int], conjunction: bool) -> int:
        a, b = parts
        return self._and(a, b) if conjunction else self._or(a, b)

    def _opposite(self, a: int, b: int) -> bool:
        x, y = self.forms[a], self.forms[b]
        return x[0] == y[0] == "lit" and x[2] == y[2] and x[1] != y[1]

    def _parts(self, number: int, *wanted: object) -> tuple[int, int] | None:
        """The parts of a form of this operator (and, if given, first part)."""
        form = self.forms[number]
        if form[: len(wanted)] != wanted:
            return None
        return form[1], form[2]  # type: ignore[return-value]  # operators with two operands

    def _and(self, a: int, b: int) -> int:
        if a == b or b == TRUE:
            return a
        if a == TRUE:
            return b
        if FALSE in (a, b) or self._opposite(a, b):
            return FALSE
        left, right = self._parts(a, "R", FALSE), self._parts(b, "R", FALSE)
        if left and right and not (self._lasts(a) or self._lasts(b)):
            return self._release(FALSE, self._and(left[1], right[1]))
        return self._number("and", *sorted((a, b)))

    def _or(self, a: int, b: int) -> int:
        if a == b or b == FALSE:
            return a
        if a == FALSE:
            return b
        if TRUE in (a, b) or self._opposite(a, b):
            return TRUE
        left, right = self._parts(a, "U", TRUE), self._parts(b, "U", TRUE)
        if left and right:
            return self._until(TRUE, self._or(left[1], right[1]))
        return self._number("or", *sorted((a, b)))

    def _next(self, a: int) -> int:
        return a if a in (TRUE, FALSE) or self._lasts(a) else self._number("X", a)

    def _until(self, a: int, b: int) -> int:
        if b in (TRUE, FALSE) or a in (FALSE, b) or self._lasts(b):
            return b
        inner = self._parts(b, "U")
        if inner is not None and (a in (TRUE, inner[0])):
            return self._until(a, inner[1])
        return self._number("U", a, b)

    def _release(self, a: int, b: int) -> int:
        if b in (TRUE, FALSE) or a in (TRUE, b) or self._lasts(b):
            return b
        inner = self._parts(b, "R")
        if inner is not None and (a in (FALSE, inner[0])):
            return self._release(a, inner[1])
        return self._number("R", a, b)

    def _lasts(self, number: int) -> bool:
        """Whether it holds at all nodes of a path or at none: `G F p`, `F G p`, and what is made of these."""
        form = self.forms[number]
        if form[0] in ("and", "or"):
            return all(self._lasts(x) for x in form[1:])  # type: ignore[arg-type]  # the others are numbers of forms
        always, finally_ = self._parts(number, "R", FALSE), self._parts(number, "U", TRUE)
        if always is not None:
            return self.forms[always[1]][:2] == ("U", TRUE)
        return finally_ is not None and self.forms[finally_[1]][:2] == ("R", FALSE)

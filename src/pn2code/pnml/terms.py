"""Terms of PNML as texts of CPN ML that know which element each piece came from.

Example: `<numberof><subterm><numberconstant value="2"/></subterm><subterm><variable refvariable="x"/></subterm>
</numberof>` becomes ``2`x``.

Where a multi-set is wanted, a value stands for one of it. In a tuple, a component may be a multi-set (`all`): the tuple
is then the multi-set of all combinations. An element of a partition stands for all values in it, where such are wanted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.pnml.codes import PNML_ELEMENT, PNML_SORT, UNSUPPORTED_PNML
from pn2code.pnml.declarations import Declarations, number
from pn2code.pnml.sorts import BOOL, DOT, INTEGER, Sort, SortKind
from pn2code.pnml.term import Code, Term, TermError, closed, joined, operand, summand, text_of_term
from pn2code.reading.xml import Node

_COMPARISONS = {
    "equality": "=", "inequality": "<>", "lessthan": "<", "lessthanorequal": "<=", "greaterthan": ">",
    "greaterthanorequal": ">=", "lt": "<", "leq": "<=", "gt": ">", "geq": ">=", "ltp": "<", "gtp": ">",
    "lteq": "<=", "gteq": ">=",
}  # fmt: skip
_ARITHMETIC = {"addition": "+", "subtraction": "-", "mult": "*", "div": "div", "mod": "mod"}
_MOST_CALLS = 40
_MOST_DEEP = 100
"""Operators inside one another; a chain of `and`, `or` or `add` counts once."""


class Terms:
    """Translates the terms of one inscription.

    Args:
        declarations: of the net.
        origin: of the inscription.
    """

    def __init__(self, declarations: Declarations, origin: Origin, d: Diagnostics) -> None:
        self.declarations = declarations
        self.origin = origin
        self.d = d
        self._given: Mapping[str, Term] = {}
        self._calls = 0
        self._depth = 0

    # --- whole inscriptions ----------------------------------------------------------------------

    def multiset(self, node: Node, sort: Sort) -> SourceText | None:
        """A term on an arc or an initial marking of a place of that sort; None after an error."""
        try:
            return self._source(self._many(self._term(node, sort), node, sort).code)
        except TermError:
            return None

    def condition(self, node: Node) -> SourceText | None:
        """The condition of a transition, its conjuncts separated by commas; None after an error."""
        try:
            parts = self._operands(node) if node.tag == "and" else [node]
            found = [self._bool(part) for part in parts]
        except TermError:
            return None
        return self._source(joined(", ", [t.code for t in found], node))

    def _source(self, code: Code) -> SourceText:
        """The text with the position of each piece."""
        marks, text, at = [], [], 0
        for piece, node in code:
            marks.append((at, node.line, node.column))
            text.append(piece)
            at += len(piece)
        first = code[0][1]
        o = self.origin
        origin = Origin(o.file, first.line, first.column, o.page, o.element, o.element_id, o.part)
        return SourceText("".join(text), origin, tuple(marks))

    # --- errors ----------------------------------------------------------------------------------

    def at(self, node: Node) -> Origin:
        """Origin of an element of the term."""
        return node.at(self.origin)

    def fail(self, code: str, message: str, node: Node, hint: str) -> TermError:
        """Report an error at an element."""
        self.d.error(code, message, self.at(node), hint=hint)
        return TermError()

    def _wanted(self, what: str, term: Term, node: Node, hint: str) -> TermError:
        found = f"a term of sort `{term.sort.shown}`" if term.sort else "a term without sort"
        if term.many:
            found = f"a multi-set over `{term.sort.shown}`" if term.sort else "an empty multi-set"
        return self.fail(PNML_SORT, f"{what} is wanted, but `{node.tag}` is {found}", node, hint)

    # --- parts -----------------------------------------------------------------------------------

    def _arguments(self, node: Node, least: int, most: int | None = None) -> list[Node]:
        """The elements inside the `subterm`s of an operator."""
        found = [c.children[0] if c.tag == "subterm" and c.children else c for c in node.children]
        if any(c.tag == "subterm" for c in found) or not least <= len(found) <= (most or 1 << 30):
            wanted = f"{least}" if most == least else f"at least {least}"
            raise self.fail(
                PNML_ELEMENT,
                f"`{node.tag}` has {len(found)} subterms instead of {wanted}",
                node,
                "write each operand in a `subterm`",
            )
        return found

    def _many(self, term: Term, node: Node, sort: Sort | None) -> Term:
        """The term as a multi-set over a sort."""
        if sort is not None and term.sort is not None and not sort.fits(term.sort):
            raise self._wanted(
                f"a multi-set over `{sort.shown}`", term, node, "use terms of this sort"
            )
        if term.many:
            return term
        return Term((("1`", node), *closed(term, node)), term.sort, True, False, count=1)

    def _one(self, node: Node, sort: Sort | None = None) -> Term:
        """A term that is one value, of a sort if one is given."""
        term = self._term(node, sort)
        if term.many or (sort is not None and term.sort is not None and not sort.fits(term.sort)):
            what = f"one value of sort `{sort.shown}`" if sort else "one value"
            raise self._wanted(what, term, node, "use a variable, a constant or a tuple")
        return term

    def _bool(self, node: Node) -> Term:
        term = self._term(node, None)
        if term.many or term.sort is None or term.sort.kind is not SortKind.BOOL:
            raise self._wanted("a condition", term, node, "compare values, e.g. by `equality`")
        return term

    def _number(self, node: Node) -> Term:
        term = self._term(node, None)
        if term.many or (term.sort is not None and not term.sort.is_number):
            raise self._wanted("a number", term, node, "write a `numberconstant`")
        return term

    # --- terms -----------------------------------------------------------------------------------

    def _term(self, node: Node, sort: Sort | None) -> Term:
        """Any term; `sort` is what the context expects, which decides what tuples of multi-sets are."""
        translate = _OPERATORS.get(node.tag)
        if translate is None:
            raise self.fail(
                UNSUPPORTED_PNML,
                f"the operator `{node.tag}` is not supported",
                node,
                "it belongs to no place/transition or symmetric net",
            )
        if self._depth >= _MOST_DEEP:
            raise self.fail(
                UNSUPPORTED_PNML,
                f"operators are nested more than {_MOST_DEEP} levels deep",
                node,
                "no net needs that: the file is damaged or hostile",
            )
        self._depth += 1
        try:
            return translate(self, node, sort)
        finally:
            self._depth -= 1

    def _operands(self, node: Node) -> list[Node]:
        """Of a chain of one operator, however it is nested."""
        todo, found = [node], []
        while todo:
            at = todo.pop()
            if at.tag == node.tag:
                todo += reversed(self._arguments(at, 1))
            else:
                found.append(at)
        return found

    def _variable(self, node: Node, sort: Sort | None) -> Term:
        given = self._given.get(node.get("refvariable"))
        if given is not None:
            return given
        found = self.declarations.variable(node.get("refvariable"), node, self.at(node))
        if found is None:
            raise TermError
        return Term(((found[0], node),), found[1])

    def _user(self, node: Node, sort: Sort | None) -> Term:
        identity = node.get("declaration")
        constant = self.declarations.constant(identity)
        if constant is not None:
            whole = self._whole_part(node, constant[1], sort)
            return whole if whole is not None else Term(((constant[0], node),), constant[1])
        operator = self.declarations.operator(identity)
        if operator is None:
            if not self.declarations.is_broken(identity):
                self.declarations.unknown(
                    "constant or operator", identity, self.at(node), ("feconstant", "namedoperator")
                )
            raise TermError
        parameters = [v for p in operator.all("parameter") for v in p.all("variabledecl")]
        arguments = self._arguments(node, len(parameters), len(parameters))
        body = operator.child("def")
        self._calls += 1
        if body is None or not body.children or self._calls > _MOST_CALLS:
            why = (
                "has no definition" if body is None or not body.children else "is defined by itself"
            )
            raise self.fail(PNML_ELEMENT, f"the operator `{identity}` {why}", node, "define it")
        inner = body.children[0]
        if inner.tag == "subterm" and inner.children:
            inner = inner.children[0]
        values = {
            v.get("id"): self._term(a, None) for v, a in zip(parameters, arguments, strict=True)
        }
        before, self._given = self._given, values
        try:
            return self._term(inner, sort)
        finally:
            self._given = before
            self._calls -= 1

    def _whole_part(self, node: Node, of: Sort, wanted: Sort | None) -> Term | None:
        """An element of a partition where a value of the divided sort is wanted: all values in it, once each."""
        if of.kind is not SortKind.PARTITION or wanted is None or not wanted.fits(of.parts[0]):
            return None
        members = self.declarations.members(node.get("declaration"))
        if not members:
            return None
        return Term(
            joined(" ++ ", [((f"1`{m}", node),) for m in members], node), wanted, True, False
        )

    def _dot(self, node: Node, sort: Sort | None) -> Term:
        found = sort if sort is not None and sort.kind is SortKind.DOT else DOT
        return Term((("()", node),), found)

    def _constant(self, node: Node, sort: Sort | None) -> Term:
        """`numberconstant` and `finiteintrangeconstant`."""
        try:
            value = int(node.get("value"))
        except ValueError:
            raise self.fail(
                PNML_ELEMENT, f"`{node.get('value')}` is no whole number", node, "write digits"
            ) from None
        of: Sort | None = None
        if node.tag == "finiteintrangeconstant" and node.children:
            of = self.declarations.sort(node.children[0], self.at(node))
            if of is None:
                raise TermError
        of = of if of is not None else sort if sort is not None and sort.is_number else None
        if of is not None and of.kind is SortKind.RANGE and not of.low <= value <= of.high:
            raise self.fail(
                PNML_SORT,
                f"{value} is not in the range `{of.shown}`",
                node,
                f"use {of.low} to {of.high}",
            )
        text = number(value) if value >= 0 else f"({number(value)})"  # 1`~5 would be two operators
        return Term(((text, node),), of if of is not None else INTEGER)

    def _boolean(self, node: Node, sort: Sort | None) -> Term:
        value = "true" if node.get("value").lower() == "true" else "false"
        return Term(((value, node),), BOOL)

    def _step(self, node: Node, sort: Sort | None) -> Term:
        (argument,) = self._arguments(node, 1, 1)
        term = self._one(argument)
        if term.sort is None or not (term.sort.is_listed or term.sort.kind is SortKind.RANGE):
            raise self._wanted("an element of an enumeration", term, argument, "it needs an order")
        name = self.declarations.step(term.sort, 1 if node.tag == "successor" else -1, node)
        return Term(((name + " ", node), *closed(term, argument)), term.sort, atomic=False)

    def _tuple(self, node: Node, sort: Sort | None) -> Term:
        arguments = self._arguments(node, 1)
        parts = sort.parts if sort is not None and sort.kind is SortKind.PRODUCT else ()
        if len(arguments) == 1:
            return self._term(arguments[0], sort)
        if sort is not None and len(parts) != len(arguments):
            raise self.fail(
                PNML_SORT,
                f"a value of sort `{sort.shown}` is wanted, but this is a tuple of {len(arguments)}",
                node,
                f"`{sort.shown}` has {len(parts) or 'no'} components",
            )
        wanted = parts or [None] * len(arguments)
        terms = [self._term(a, w) for a, w in zip(arguments, wanted, strict=True)]
        for term, argument, part in zip(terms, arguments, wanted, strict=True):
            if part is not None and term.sort is not None and not part.fits(term.sort):
                raise self._wanted(
                    f"a component of sort `{part.shown}`", term, argument, "use terms of this sort"
                )
        if any(t.many for t in terms):
            if sort is None:
                raise self.fail(PNML_SORT, "a multi-set is not allowed here", node, "use one value")
            # The product of the components' multi-sets.
            many = [self._many(t, a, None).code for t, a in zip(terms, arguments, strict=True)]
            code = ((f"{sort.name}.mult (", node), *joined(", ", many, node), (")", node))
            return Term(code, sort, True, False)
        made = sort
        if made is None:
            known = tuple(t.sort for t in terms if t.sort is not None)
            shown = " * ".join(s.shown for s in known)
            made = Sort("", shown, SortKind.PRODUCT, parts=known)
        code = (("(", node), *joined(", ", [t.code for t in terms], node), (")", node))
        return Term(code, made)

    def _comparison(self, node: Node, sort: Sort | None) -> Term:
        left, right = self._arguments(node, 2, 2)
        a = self._one(left)
        b = self._one(right)
        # A bare number takes the sort of the other side.
        if a.sort is not None and b.sort is not None and not a.sort.fits(b.sort):
            raise self.fail(
                PNML_SORT,
                f"`{node.tag}` compares a value of `{a.sort.shown}` with one of `{b.sort.shown}`",
                node,
                "compare values of the same sort",
            )
        sign = _COMPARISONS[node.tag]
        codes = [closed(a, left), closed(b, right)]
        if sign not in ("=", "<>") and a.sort is not None and not a.sort.is_number:
            if not a.sort.is_listed:
                raise self._wanted(
                    "a value of an ordered sort",
                    a,
                    left,
                    "only numbers and enumerations are ordered",
                )
            name = a.sort.name
            codes = [((f"{name}.ord ", node), *c) for c in codes]
        return Term(joined(f" {sign} ", codes, node), BOOL, atomic=False)

    def _logic(self, node: Node, sort: Sort | None) -> Term:
        parts = [closed(self._bool(a), a) for a in self._operands(node)]
        word = " andalso " if node.tag == "and" else " orelse "
        return Term(joined(word, parts, node), BOOL, atomic=False)

    def _imply(self, node: Node, sort: Sort | None) -> Term:
        a, b = (self._bool(x) for x in self._arguments(node, 2, 2))
        code = (("not ", node), *closed(a, node), (" orelse ", node), *closed(b, node))
        return Term(code, BOOL, atomic=False)

    def _not(self, node: Node, sort: Sort | None) -> Term:
        (argument,) = self._arguments(node, 1, 1)
        code = (("not ", node), *closed(self._bool(argument), argument))
        return Term(code, BOOL, atomic=False)

    def _arithmetic(self, node: Node, sort: Sort | None) -> Term:
        arguments = self._arguments(node, 1 if node.tag in ("addition", "subtraction") else 2)
        parts = [closed(self._number(a), a) for a in arguments]
        code = joined(f" {_ARITHMETIC[node.tag]} ", parts, node)
        return Term(code, INTEGER, atomic=False)

    def _part(self, node: Node, sort: Sort | None) -> Term:
        (argument,) = self._arguments(node, 1, 1)
        found = self.declarations.part_of(node.get("refpartition"), node, self.at(node))
        if found is None:
            raise TermError
        term = self._one(argument, found[1].parts[0])
        return Term(((found[0] + " ", node), *closed(term, argument)), found[1], atomic=False)

    # --- multi-sets ------------------------------------------------------------------------------

    def _numberof(self, node: Node, sort: Sort | None) -> Term:
        arguments = self._arguments(node, 1, 2)
        counted = arguments[-1]
        term = self._term(counted, sort)
        count = self._number(arguments[0]) if len(arguments) == 2 else Term((("1", node),), None)
        if not text_of_term(count).strip(
            "0"
        ):  # CPN Tools would want a token, to bind what is in it
            return self._times(count, arguments[0], self._many(term, counted, None), counted, node)
        if not term.many:
            code = (*closed(count, arguments[0]), ("`", node), *closed(term, counted))
            digits = text_of_term(count)
            written = int(digits) if digits.isdigit() else 0
            return Term(code, term.sort, True, False, count=written)
        return self._times(count, arguments[0], term, counted, node)

    def _times(self, count: Term, at: Node, term: Term, counted: Node, node: Node) -> Term:
        """A multi-set several times."""
        digits = text_of_term(count)
        if digits == "1":
            return term
        most = term.most * int(digits) if digits.isdigit() else 0
        code = (*closed(count, at), (" ** ", node), *operand(term, counted))
        return Term(code, term.sort, True, False, most)

    def _scalar(self, node: Node, sort: Sort | None) -> Term:
        count, counted = self._arguments(node, 2, 2)
        term = self._many(self._term(counted, sort), counted, None)
        return self._times(self._number(count), count, term, counted, node)

    def _all(self, node: Node, sort: Sort | None) -> Term:
        if not node.children:
            raise self.fail(PNML_ELEMENT, "`all` names no sort", node, "put a `usersort` inside")
        of = self.declarations.sort(node.children[0], self.at(node))
        if of is None:
            raise TermError
        if of.kind is SortKind.INTEGER:
            raise self.fail(
                PNML_SORT, f"`{of.shown}` has infinitely many values", node, "use a finite sort"
            )
        if of.kind is SortKind.DOT:
            return Term((("1`()", node),), of, True, False)
        return Term(((f"{of.name}.all()", node),), of, True, False, 1)

    def _empty(self, node: Node, sort: Sort | None) -> Term:
        of = self.declarations.sort(node.children[0], self.at(node)) if node.children else sort
        return Term((("empty", node),), of, True)

    def _add(self, node: Node, sort: Sort | None) -> Term:
        arguments = self._operands(node)
        terms = [self._many(self._term(a, sort), a, sort) for a in arguments]
        if len(terms) == 1:
            return terms[0]
        code = joined(" ++ ", [summand(t, a) for t, a in zip(terms, arguments, strict=True)], node)
        return Term(code, next((t.sort for t in terms if t.sort is not None), sort), True, False)

    def _subtract(self, node: Node, sort: Sort | None) -> Term:
        first, *others = self._arguments(node, 1)
        result = self._many(self._term(first, sort), first, sort)
        for other in others:
            term = self._many(self._term(other, sort), other, sort)
            if 0 < term.count <= result.most:  # one value is taken from all of them: it is there
                code = (*result.code, (" -- ", node), *operand(term, other))
                result = Term(code, result.sort, True, False)
            else:
                name = self.declarations.minus(node)
                code = ((f"{name} (", node), *result.code, (", ", node), *term.code, (")", node))
                result = Term(code, result.sort, True, False)
        return result

    def _cardinality(self, node: Node, sort: Sort | None) -> Term:
        (argument,) = self._arguments(node, 1, 1)
        term = self._many(self._term(argument, None), argument, None)
        return Term((("size ", node), *closed(term, argument)), INTEGER, atomic=False)

    def _cardinality_of(self, node: Node, sort: Sort | None) -> Term:
        whole, value = self._arguments(node, 2, 2)
        term = self._many(self._term(whole, None), whole, None)
        code = (("cf (", node), *self._one(value).code, (", ", node), *term.code, (")", node))
        return Term(code, INTEGER, atomic=False)

    def _contains(self, node: Node, sort: Sort | None) -> Term:
        left, right = self._arguments(node, 2, 2)
        a, b = (self._many(self._term(x, None), x, None) for x in (left, right))
        code = (*closed(a, left), (" >>= ", node), *closed(b, right))
        return Term(code, BOOL, atomic=False)


_OPERATORS: dict[str, Callable[[Terms, Node, Sort | None], Term]] = {
    "variable": Terms._variable,
    "useroperator": Terms._user,
    "dotconstant": Terms._dot,
    "numberconstant": Terms._constant,
    "finiteintrangeconstant": Terms._constant,
    "booleanconstant": Terms._boolean,
    "successor": Terms._step,
    "predecessor": Terms._step,
    "tuple": Terms._tuple,
    **dict.fromkeys(_COMPARISONS, Terms._comparison),
    "and": Terms._logic,
    "or": Terms._logic,
    "imply": Terms._imply,
    "not": Terms._not,
    **dict.fromkeys(_ARITHMETIC, Terms._arithmetic),
    "partitionelementof": Terms._part,
    "numberof": Terms._numberof,
    "scalarproduct": Terms._scalar,
    "all": Terms._all,
    "empty": Terms._empty,
    "add": Terms._add,
    "subtract": Terms._subtract,
    "cardinality": Terms._cardinality,
    "cardinalityof": Terms._cardinality_of,
    "contains": Terms._contains,
}

"""Declarations of a PNML net, as declarations of a `.cpn` file: sorts, constants, variables, operators.

PNML fixes no order, so a sort is declared when something first needs it. Functions for `successor`, partitions and the
like are declared when a term uses them.

Example: a cyclic enumeration `id="p" name="Phil"` of `p1`, `p2` gives `colset Phil = with p1 | p2;` and, if `successor`
is used, `fun succ_Phil x = Phil.col ((Phil.ord x + 1) mod 2)`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

from pn2code.diagnostics import Diagnostics, Note, Origin, SourceText
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.pnml.codes import PNML_ELEMENT, PNML_REFERENCE, UNSUPPORTED_PNML
from pn2code.pnml.names import Names
from pn2code.pnml.nodes import Strangers
from pn2code.pnml.sorts import Sort, SortKind
from pn2code.reading.codes import DUPLICATE_ID
from pn2code.reading.document import RawColset, RawDeclaration, RawMl, RawVar
from pn2code.reading.xml import Node

_BUILT_IN = {
    "dot": SortKind.DOT,
    "bool": SortKind.BOOL,
    "integer": SortKind.INTEGER,
    "natural": SortKind.INTEGER,
    "positive": SortKind.INTEGER,
}
_NAMES = {
    "dot": "Dot", "bool": "BOOL", "integer": "INT", "natural": "NAT", "positive": "POS",
}  # fmt: skip
_ENUMS = {"finiteenumeration": SortKind.ENUM, "cyclicenumeration": SortKind.CYCLIC}
_LARGEST = 2**30 - 1
_MOST_DEEP = 50
_KNOWN = frozenset(
    {
        "namedsort", "partition", "variabledecl", "namedoperator", "arbitrarysort", "arbitraryoperator", "unparsed",
        "feconstant", "declarations",
    }
)  # fmt: skip


class Declarations:
    """All declarations of a net, found by id.

    Args:
        nodes: the `declaration` elements of the net and its pages.
        base: origin of the file.
    """

    def __init__(self, nodes: Iterable[Node], base: Origin, d: Diagnostics) -> None:
        self.base = base
        self.d = d
        self.items: list[RawDeclaration] = []
        self.names = Names()
        self.sorts_names = Names()
        self._nodes: dict[str, Node] = {}
        self._owner: dict[str, Node] = {}
        self._sorts: dict[str, Sort | None] = {}
        self._plain: dict[str, Sort] = {}
        self._variables: dict[str, tuple[str, Sort] | None] = {}
        self._constants: dict[str, str] = {}
        self._functions: dict[str, str] = {}
        self._open: list[str] = []
        self._broken = ""
        strangers = Strangers(base, d)
        for node in nodes:
            self._collect(node, strangers)
        # Names that mean several things are given to none of them.
        told = [
            n
            for n in self._nodes.values()
            if n.tag in ("feconstant", "partitionelement", "variabledecl")
        ]
        self._shared = {
            name for name, count in Counter(n.get("name") for n in told).items() if count > 1
        }
        for node in [n for n in self._nodes.values() if n.tag in ("namedsort", "partition")]:
            self.user_sort(node.get("id"), node)
        for node in [n for n in self._nodes.values() if n.tag == "variabledecl"]:
            self.variable(node.get("id"), node)

    def _collect(self, node: Node, strangers: Strangers) -> None:
        for structure in node.all("structure"):
            for group in structure.all("declarations") or [structure]:
                strangers.check(group, _KNOWN)
                for item in group.children:
                    if item.tag in _KNOWN:
                        self._enter(item, item)
                        self._enter_below(item, item)

    def _enter_below(self, node: Node, owner: Node) -> None:
        """The constants inside a sort."""
        for child in node.children:
            if child.tag in ("feconstant", "partitionelement"):
                self._enter(child, owner)
            elif child.tag in (*_ENUMS, "partition", "productsort"):
                self._enter_below(child, owner)
            elif child.tag == "parameter":
                for variable in child.all("variabledecl"):
                    self._enter(variable, owner)

    def _enter(self, node: Node, owner: Node) -> None:
        identity = node.get("id")
        if not identity:
            self.error(PNML_ELEMENT, f"a declaration `{node.tag}` has no id", node, "give it an id")
        elif identity in self._nodes:
            self.d.error(
                DUPLICATE_ID,
                f"`{node.tag}` has the id `{identity}`, which is already used",
                self.at(node),
                notes=[Note(f"`{identity}` is first used here", self.at(self._nodes[identity]))],
                hint="give one of them another id",
            )
        else:
            self._nodes[identity] = node
            self._owner[identity] = owner

    # --- origins and errors ----------------------------------------------------------------------

    def at(self, node: Node) -> Origin:
        """Origin of a declaration or a part of one."""
        shown = node.get("name") or node.get("id")
        element = f"{_WORDS[node.tag]} `{shown}`" if node.tag in _WORDS and shown else ""
        return Origin(
            self.base.file, node.line, node.column, "", element, node.get("id"), "declaration"
        )

    def error(self, code: str, message: str, node: Node, hint: str) -> None:
        """Report an error at an element of the declarations."""
        self.d.error(code, message, self.at(node), hint=hint)

    def unknown(self, what: str, identity: str, origin: Origin, tags: tuple[str, ...]) -> None:
        """Report a reference that leads nowhere."""
        found = self._nodes.get(identity)
        if found is not None:
            said = f"`{identity}` is declared as `{found.tag}`, but a {what} is needed here"
            self.d.error(
                PNML_REFERENCE, said, origin, notes=[Note("it is declared here", self.at(found))]
            )
            return
        known = [i for i, n in self._nodes.items() if n.tag in tags]
        said = (
            f"there is no {what} with the id `{identity}`"
            if identity
            else f"the id of a {what} is missing"
        )
        self.d.error(
            PNML_REFERENCE,
            said,
            origin,
            hint=did_you_mean(identity, known, "declare it, or correct the reference"),
        )

    # --- sorts -----------------------------------------------------------------------------------

    def sort(self, node: Node, origin: Origin) -> Sort | None:
        """The sort that an element stands for: `usersort`, a built-in one, or one without a name."""
        match node.tag:
            case "usersort":
                return self.user_sort(node.get("declaration"), node, origin)
            case "multisetsort" if node.children:
                return self.sort(node.children[0], origin)
            case tag if tag in _BUILT_IN:
                return self._built_in(tag, origin)
            case "productsort" | "finiteintrange" | "finiteenumeration" | "cyclicenumeration":
                key = _key(node)
                if key not in self._sorts:
                    self._sorts[key] = self._define(node, node, origin)
                return self._sorts[key]
        self.d.error(
            UNSUPPORTED_PNML,
            f"the sort `{node.tag}` is not supported",
            origin,
            hint="sorts are dot, bool, integers, enumerations, integer ranges, products and partitions",
        )
        return None

    def user_sort(self, identity: str, at: Node, origin: Origin | None = None) -> Sort | None:
        """The sort with an id."""
        origin = origin or self.at(at)
        if identity in self._sorts:
            return self._sorts[identity]
        node = self._nodes.get(identity)
        if node is None and identity in _BUILT_IN:  # `dot` is often used without a declaration
            return self._built_in(identity, origin)
        if node is None or node.tag not in ("namedsort", "partition", "arbitrarysort"):
            self.unknown("sort", identity, origin, ("namedsort", "partition"))
            return None
        if identity in self._open or len(self._open) > _MOST_DEEP:
            self.error(
                PNML_ELEMENT,
                f"the sort `{identity}` contains itself",
                node,
                "name other components",
            )
            return None
        self._open.append(identity)
        sort: Sort | None = None
        if node.tag == "partition":
            sort = self._partition(node)
        elif node.tag == "namedsort" and node.children:
            sort = self._define(node.children[0], node, self.at(node))
        else:
            self.error(
                UNSUPPORTED_PNML, f"the sort `{identity}` has no definition", node, "define it"
            )
        self._open.pop()
        self._sorts[identity] = sort
        return sort

    def broken(self) -> str:
        """A colour set for places whose sort has an error: nothing more is said of them."""
        if not self._broken:
            self._broken = self.sorts_names.make(["Unknown"], "Unknown")
            self._declare(self._broken, "", self.base)
        return self._broken

    def _built_in(self, tag: str, origin: Origin) -> Sort:
        if tag not in self._plain:
            name = self.sorts_names.make([_NAMES[tag]], _NAMES[tag])
            self._plain[tag] = self._plain_sort(tag, name, tag, origin)
        return self._plain[tag]

    def _plain_sort(self, tag: str, name: str, shown: str, origin: Origin) -> Sort:
        kind = _BUILT_IN[tag]
        if kind is SortKind.INTEGER:
            lowest = {"natural": "0", "positive": "1"}.get(tag)
            bounds = (lowest, str(_LARGEST)) if lowest else ()
            self._declare(name, "int", origin, texts=bounds)
        else:
            self._declare(name, "unit" if kind is SortKind.DOT else "bool", origin)
        return Sort(name, shown, kind)

    def _define(self, node: Node, named: Node, origin: Origin) -> Sort | None:
        """A sort from its definition; `named` is what has its name."""
        shown = named.get("name") or named.get("id")
        match node.tag:
            case tag if tag in _BUILT_IN:
                name = self._sort_name(named, _NAMES[tag])
                return self._plain_sort(tag, name, shown, origin)
            case "finiteenumeration" | "cyclicenumeration":
                values = self._values(node, "feconstant")
                if not values:
                    self.error(
                        PNML_ELEMENT,
                        f"the enumeration `{shown}` has no constants",
                        named,
                        "give it some",
                    )
                    return None
                name = self._sort_name(named, "Enum")
                self._declare(name, "enum", origin, ids=values)
                return Sort(name, shown, _ENUMS[node.tag], values)
            case "finiteintrange":
                return self._range(node, named, origin)
            case "productsort":
                parts = [self.sort(child, origin) for child in node.children]
                if None in parts or not parts:
                    if not parts:
                        self.error(
                            PNML_ELEMENT, "a product has no components", named, "name some sorts"
                        )
                    return None
                known = tuple(p for p in parts if p is not None)
                if len(known) == 1:
                    return known[0]
                name = self._sort_name(named, "Product")
                self._declare(name, "product", origin, ids=tuple(p.name for p in known))
                return Sort(
                    name, shown or " * ".join(p.shown for p in known), SortKind.PRODUCT, parts=known
                )
            case "partition":
                return self._partition(node)
            case _:
                return self.sort(node, origin)

    def _range(self, node: Node, named: Node, origin: Origin) -> Sort | None:
        try:
            low, high = int(node.get("start")), int(node.get("end"))
        except ValueError:
            self.error(
                PNML_ELEMENT, "a range needs whole numbers as `start` and `end`", node, "write them"
            )
            return None
        if low > high or max(abs(low), abs(high)) > _LARGEST:
            self.error(
                PNML_ELEMENT,
                f"the range {low}..{high} " + ("is empty" if low > high else "is too large"),
                node,
                f"`start` is at most `end`, and both are at most {_LARGEST}",
            )
            return None
        name = self._sort_name(named, f"Range_{low}_{high}".replace("-", "m"))
        self._declare(name, "int", origin, texts=(number(low), number(high)))
        return Sort(name, named.get("name") or f"{low}..{high}", SortKind.RANGE, low=low, high=high)

    def _partition(self, node: Node) -> Sort | None:
        of = next((c for c in node.children if c.tag not in ("partitionelement",)), None)
        base = self.sort(of, self.at(node)) if of is not None else None
        if base is None:
            if of is None:
                self.error(
                    PNML_ELEMENT, "a partition does not say what it divides", node, "name a sort"
                )
            return None
        values = self._values(node, "partitionelement")
        if not values:
            self.error(PNML_ELEMENT, "a partition has no elements", node, "give it some")
            return None
        name = self._sort_name(node, "Partition")
        self._declare(name, "enum", self.at(node), ids=values)
        return Sort(
            name, node.get("name") or node.get("id"), SortKind.PARTITION, values, parts=(base,)
        )

    def _values(self, node: Node, tag: str) -> tuple[str, ...]:
        found = []
        for child in node.all(tag):
            identity = child.get("id")
            if identity in self._constants:
                continue  # reported as a duplicate
            plain = [child.get("name")] if child.get("name") not in self._shared else []
            name = self.names.make([*plain, identity], "c")
            self._constants[identity] = name
            found.append(name)
        return tuple(found)

    def _sort_name(self, node: Node, stem: str) -> str:
        return self.sorts_names.make([node.get("name"), node.get("id")], stem)

    def _declare(
        self,
        name: str,
        kind: str,
        origin: Origin,
        *,
        ids: tuple[str, ...] = (),
        texts: tuple[str, ...] = (),
    ) -> None:
        self.items.append(
            RawColset(
                # Ids were told apart before; a sort without one may be inside a place or another sort.
                id="",
                name=name,
                kind=kind,
                ids=ids,
                fields=(),
                texts=tuple(SourceText(t, origin) for t in texts),
                timed=False,
                declare=("all",),  # variables that nothing binds are enumerated, whatever the size
                by_predicate=False,
                layout_text="",
                origin=origin,
            )
        )

    # --- variables, constants, operators ---------------------------------------------------------

    def variable(
        self, identity: str, at: Node, origin: Origin | None = None
    ) -> tuple[str, Sort] | None:
        """Name and sort of a variable."""
        if identity in self._variables:
            return self._variables[identity]
        node = self._nodes.get(identity)
        found: tuple[str, Sort] | None = None
        if node is None or node.tag != "variabledecl":
            self.unknown("variable", identity, origin or self.at(at), ("variabledecl",))
            return None
        if not node.children:
            self.error(
                PNML_ELEMENT, f"the variable `{identity}` has no sort", node, "name its sort"
            )
        elif (sort := self.sort(node.children[0], self.at(node))) is not None:
            plain = [node.get("name")] if node.get("name") not in self._shared else []
            name = self.names.make([*plain, identity], "v")
            self.items.append(RawVar(identity, (name,), sort.name, self.at(node)))
            found = (name, sort)
        self._variables[identity] = found
        return found

    def constant(self, identity: str) -> tuple[str, Sort] | None:
        """Name and sort of a constant of an enumeration or of an element of a partition; None if it is none."""
        owner = self._owner.get(identity)
        if owner is None or identity not in self._constants:
            return None
        sort = self._sorts.get(owner.get("id"))
        return None if sort is None else (self._constants[identity], sort)

    def members(self, identity: str) -> tuple[str, ...]:
        """The constants in an element of a partition, as CPN ML; () if it is none, or one of them is not known."""
        element = self._nodes.get(identity)
        found = self.constant(identity)
        if element is None or element.tag != "partitionelement" or found is None:
            return ()
        texts = [self.literal(member, found[1].parts[0]) for member in element.children]
        return () if None in texts else tuple(t for t in texts if t is not None)

    def operator(self, identity: str) -> Node | None:
        """The declaration of an operator of the net's own."""
        node = self._nodes.get(identity)
        return node if node is not None and node.tag == "namedoperator" else None

    def is_broken(self, identity: str) -> bool:
        """Whether a constant is declared in a sort that has an error."""
        node = self._nodes.get(identity)
        return node is not None and node.tag in ("feconstant", "partitionelement")

    # --- generated functions ---------------------------------------------------------------------

    # Parameters have a prime, which no name of the net has: `x` may be a constant.

    def step(self, sort: Sort, by: int, at: Node) -> str:
        """The function that gives the next (by = 1) or previous (-1) value, around the end."""
        stem = "succ" if by > 0 else "pred"

        def text(name: str) -> str:
            first, last = number(sort.low), number(sort.high)
            if sort.is_number:
                end, start = (last, first) if by > 0 else (first, last)
                return (
                    f"fun {name} x' = if x' = {end} then {start} else x' {'+' if by > 0 else '-'} 1"
                )
            ends = (len(sort.values) - 1, 0) if by > 0 else (0, len(sort.values) - 1)
            n = f"{sort.name}.ord x'"
            sign = "+" if by > 0 else "-"
            return f"fun {name} x' = {sort.name}.col (if {n} = {ends[0]} then {ends[1]} else {n} {sign} 1)"

        return self._function(f"{stem}_{sort.name}", text, at)

    def minus(self, at: Node) -> str:
        """The function that takes a multi-set from another, as far as it is there."""
        return self._function("minus_ms", minus_text, at)

    def part_of(self, identity: str, at: Node, origin: Origin) -> tuple[str, Sort] | None:
        """The function from a sort to the element of a partition that a value is in, and the partition."""
        sort = self.user_sort(identity, at, origin)
        if sort is None:
            return None
        if sort.kind is not SortKind.PARTITION:
            self.unknown("partition", identity, origin, ("partition",))
            return None
        node = self._nodes[identity]
        node = node if node.tag == "partition" else node.children[0]
        base = sort.parts[0]
        rules = []
        for part, element in zip(sort.values, node.all("partitionelement"), strict=False):
            for member in element.children:
                value = self.literal(member, base)
                if value is None:
                    self.unknown(
                        "constant", member.get("declaration"), self.at(element), ("feconstant",)
                    )
                    return None
                rules.append(f"{value} => {part}")
        rules = list(dict.fromkeys(rules))
        # Values that no element names belong to the last one.
        total = len(base.values) if base.is_listed else base.high - base.low + 1
        if len(rules) < total:
            rules.append(f"_ => {sort.values[-1]}")
        text = " | ".join(rules)
        return self._function(
            f"part_{sort.name}", lambda name: f"val {name} = fn {text}", node
        ), sort

    def literal(self, node: Node, sort: Sort) -> str | None:
        """A constant term as CPN ML; None if it is none."""
        if node.tag == "useroperator":
            found = self.constant(node.get("declaration"))
            return found[0] if found else None
        if node.tag in ("finiteintrangeconstant", "numberconstant") and sort.is_number:
            try:
                return number(int(node.get("value")))
            except ValueError:
                return None
        return None

    def _function(self, key: str, text: Callable[[str], str], at: Node) -> str:
        if key not in self._functions:
            name = self.names.make([key], key)
            self._functions[key] = name
            origin = Origin(
                self.base.file, at.line, at.column, "", f"function `{name}`", "", "declaration"
            )
            self.items.append(RawMl("", SourceText(text(name), origin), origin))
        return self._functions[key]


def minus_text(name: str) -> str:
    """The declaration of the function that subtracts multi-sets as far as they are there."""
    return f"fun {name} (a', b') = List.foldl (fn (x', m') => rm x' m') a' b'"


_WORDS = {
    "namedsort": "sort", "partition": "partition", "variabledecl": "variable", "namedoperator": "operator",
    "feconstant": "constant", "partitionelement": "partition element", "arbitrarysort": "sort",
}  # fmt: skip


def number(value: int) -> str:
    """A whole number in CPN ML."""
    return str(value) if value >= 0 else f"~{-value}"


def _key(node: Node) -> str:
    """Sorts without name that are written the same are the same."""
    inner = ",".join(_key(c) for c in node.children)
    return f"{node.tag}{sorted(node.attributes.items())}({inner})"

"""Exceptions declared in functions that may be raised in one call and handled in another.

In SML each call of a function makes its exceptions anew, so that a handler in one call does not handle what another
call raised:

    fun f n = let exception E in if n = 0 then raise E else (f (n - 1) handle E => 7) end

`f 1` raises E, since it is the E of `f 0`. Here there is one E for all calls, so that it would be 7. Nobody can tell
the difference as long as no call of the function meets the exception of another one. It cannot if

* nothing that may raise or handle the exception leaves the declaration: its value has no function and no exception in
  it, and no such thing is put into a reference; and
* the function is not called again from within the declaration, neither by its name nor by a function that it was given;
  or it may be, but whatever raises the exception has a handler of it around it that is in the same declaration, and no
  function that raises or handles it is given to other functions of the net.

Everything else is refused, if a run can come to it, or a text beside the net (`refuse_beside`: functions of monitors,
conditions of properties, what is typed while one plays, bounds of colour sets). Texts of the library see to it
themselves that their exceptions are told apart (`PropList`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Case,
    Con,
    DatatypeDec,
    Dec,
    ExceptionDec,
    Exp,
    Handle,
    Lambda,
    Let,
    Pat,
    PCon,
    PVar,
    PWild,
    RecBind,
    Rule,
    Symbol,
    ValBind,
    Var,
)
from pn2code.ml.core.types import TCon, TFun, TRecord, Type
from pn2code.ml.library import declaration
from pn2code.ml.library import names as library_names
from pn2code.net.codes import UNSUPPORTED_EXCEPTION
from pn2code.net.flat import FlatNet
from pn2code.net.reached import inscriptions, reached, reached_from
from pn2code.net.uses import children, pattern_variables, walk, walk_pattern

_STORING = frozenset({"Ref.:=", "Ref.ref", "Array.update", "Array.array", "Array.modify"})


@frozen
class _Local:
    """A declaration of exceptions in a function: its `let`, and the functions around it."""

    let: Let
    exceptions: tuple[ExceptionDec, ...]
    around: frozenset[Symbol]


def refuse(net: FlatNet, d: Diagnostics) -> bool:
    """Whether any was found; each is an error."""
    texts = [e for t in net.transitions for e in inscriptions(t)]
    texts += [p.initial[0] for p in net.places if p.initial is not None]
    return _refuse(net.program.declarations, texts, lambda: reached(net), d)


def refuse_beside(declarations: Sequence[Dec], texts: Sequence[Exp], d: Diagnostics) -> bool:
    """Whether any was found in what is evaluated beside a net; each is an error.

    Args:
        declarations: those of the net, and what was declared after them; values among them are evaluated.
        texts: expressions that use them.
        d: where errors go.
    """
    return _refuse(declarations, texts, lambda: reached_from(declarations, texts), d)


def _refuse(
    declarations: Sequence[Dec],
    texts: Iterable[Exp],
    run: Callable[[], Iterable[Exp]],
    d: Diagnostics,
) -> bool:
    roots: list[tuple[frozenset[Symbol], Exp]] = []
    bodies: dict[Symbol, Exp] = {}
    for dec in declarations:
        roots += _functions(dec)
    roots += [(frozenset(), e) for e in texts]
    local = [x for around, e in roots for x in _declared(e, around, bool(around))]
    if not local:
        return False
    inner = [
        dec for _, root in roots for e in walk(root) if isinstance(e, Let) for dec in e.declarations
    ]
    for dec in (*inner, *declarations):
        bodies.update(_bodies(dec))
    open_types = _open_types([*declarations, *inner])
    errors = len(d.errors)
    can_run = {id(e) for e in run()}
    own = {f"library/{name}.sml" for name in library_names()}
    seen: set[int] = set()
    for x in local:
        if id(x.let) not in can_run or id(x.let) in seen:
            continue
        seen.add(id(x.let))
        for dec in x.exceptions:
            source = dec.span.source
            file = source.origin.file
            if file in own and source.text == declaration(Path(file).stem):
                continue
            if _Look(x, dec.constructor.tag, bodies, open_types).is_met_elsewhere():
                d.error(
                    UNSUPPORTED_EXCEPTION,
                    f"exception `{dec.constructor.name}` may be raised in one call of the function that declares it, "
                    "and met in another one: CPN Tools tells them apart, pn2code cannot",
                    dec.span,
                    hint="declare the exception outside the function, or handle it in the `let` that declares it",
                )
    return len(d.errors) > errors


def _functions(dec: Dec) -> Iterator[tuple[frozenset[Symbol], Exp]]:
    """What a declaration evaluates or makes a function of, with the names of the function."""
    match dec:
        case RecBind(bindings):
            group = frozenset(symbol for symbol, _ in bindings)
            for _, body in bindings:
                yield group, body
        case ValBind(pattern, value):
            names = frozenset(pattern_variables(pattern))
            yield (names if isinstance(value, Lambda) else frozenset()), value
        case _:
            pass


def _bodies(dec: Dec) -> Iterator[tuple[Symbol, Exp]]:
    match dec:
        case RecBind(bindings):
            yield from bindings
        case ValBind(pattern, value):
            for symbol in pattern_variables(pattern):
                yield symbol, value
        case _:
            pass


def _declared(root: Exp, around: frozenset[Symbol], inside: bool) -> Iterator[_Local]:
    """The declarations of exceptions in an expression that may be evaluated several times."""
    stack = [(root, around, inside)]
    while stack:
        e, names, within = stack.pop()
        if isinstance(e, Let):
            found = tuple(dec for dec in e.declarations if isinstance(dec, ExceptionDec))
            if found and within:
                yield _Local(e, found, names)
            for dec in e.declarations:
                stack += [(body, names | own, within) for own, body in _functions(dec)]
            stack.append((e.body, names, within))
        else:
            deeper = within or isinstance(e, Lambda)
            stack += [(x, names, deeper) for x in children(e)]


def _open_types(declarations: Iterable[Dec]) -> frozenset[str]:
    """The declared data types that may have functions or exceptions in them."""
    declared: dict[str, list[Type]] = {}
    for dec in declarations:
        if isinstance(dec, DatatypeDec):
            declared[dec.name] = [t for _, t in dec.constructors if t is not None]
    found: set[str] = {"exn"}
    while True:
        more = {n for n, parts in declared.items() if any(_is_open(t, found) for t in parts)}
        if more <= found:
            return frozenset(found)
        found |= more


def _is_open(t: Type, names: set[str] | frozenset[str]) -> bool:
    """Whether values of a type may have a function or an exception in them."""
    match t:
        case TFun():
            return True
        case TCon(name, args):
            return name in names or any(_is_open(x, names) for x in args)
        case TRecord(fields):
            return any(_is_open(x, names) for _, x in fields)
        case _:
            return False


class _Look:
    """One exception of one `let`."""

    def __init__(
        self, local: _Local, tag: int, bodies: Mapping[Symbol, Exp], open_types: frozenset[str]
    ) -> None:
        self._let = local.let
        self._around = local.around
        self._tag = tag
        self._bodies = bodies
        self._open = open_types
        self._carriers: set[Symbol] = set()
        self._inside = dict(
            pair
            for e in walk(local.let)
            if isinstance(e, Let)
            for dec in e.declarations
            for pair in _bodies(dec)
        )
        while True:
            more = {
                s
                for s, body in self._inside.items()
                if self._is_open(s.type) and self._mentions(body)
            }
            if more <= self._carriers:
                break
            self._carriers |= more

    def is_met_elsewhere(self) -> bool:
        """Whether one call may meet the exception of another."""
        if self._leaves():
            return True
        return self._comes_again() and (self._goes_out(self._let) or self._is_given())

    def _is_open(self, t: Type) -> bool:
        return _is_open(t, self._open)

    def _names(self, pattern: Pat) -> bool:
        return any(
            isinstance(p, PCon)
            and p.constructor.data_type == "exn"
            and p.constructor.tag == self._tag
            for p in walk_pattern(pattern)
        )

    def _is_made(self, e: Exp) -> bool:
        return (
            isinstance(e, Con)
            and e.constructor.data_type == "exn"
            and e.constructor.tag == self._tag
        )

    def _mentions(self, root: Exp) -> bool:
        """Whether an expression raises or handles the exception, or uses what does."""
        for e in walk(root):
            if self._is_made(e) or (isinstance(e, Var) and e.symbol in self._carriers):
                return True
            rules = e.rules if isinstance(e, Lambda | Case | Handle) else ()
            if any(self._names(r.pattern) for r in rules):
                return True
        return False

    def _leaves(self) -> bool:
        """Whether something that raises or handles it leaves the `let`, by its value or a reference."""
        if self._is_open(self._let.type):
            return True
        return any(
            isinstance(e, Builtin)
            and e.name in _STORING
            and isinstance(e.type, TFun)
            and self._is_open(e.type.argument)
            for e in walk(self._let)
        )

    def _comes_again(self) -> bool:
        """Whether the function may be called again while its `let` is evaluated."""
        seen: set[Symbol] = set()
        todo: list[Exp] = [self._let]
        while todo:
            for e in walk(todo.pop()):
                if isinstance(e, Builtin) and e.name == "Ref.!" and self._is_open(e.type):
                    return True
                if not isinstance(e, Var) or e.symbol in seen:
                    continue
                seen.add(e.symbol)
                if e.symbol in self._around:
                    return True
                if e.symbol in self._bodies:
                    todo.append(self._bodies[e.symbol])
                elif self._is_open(e.symbol.type):
                    return True
        return False

    def _goes_out(self, root: Exp) -> bool:
        """Whether the exception is raised with no handler around it. Functions count where they are used."""
        stack = [root]
        while stack:
            e = stack.pop()
            if self._is_made(e) or (isinstance(e, Var) and e.symbol in self._carriers):
                return True
            if isinstance(e, Handle) and any(self._is_caught_by(r) for r in e.rules):
                stack += [r.body for r in e.rules]
            elif isinstance(e, Let):
                stack.append(e.body)
                for dec in e.declarations:
                    if isinstance(dec, ValBind) and not isinstance(dec.value, Lambda):
                        stack.append(dec.value)
            else:
                stack += children(e)
        return False

    def _is_caught_by(self, rule: Rule) -> bool:
        match rule.pattern:
            case PWild() | PVar():
                return True
            case PCon(constructor=c, argument=None | PWild() | PVar()):
                return c.data_type == "exn" and c.tag == self._tag
            case _:
                return False

    def _is_given(self) -> bool:
        """Whether a function that raises or handles it is given to one that is not of the library."""
        for e in walk(self._let):
            if not isinstance(e, Apply):
                continue
            head: Exp = e
            while isinstance(head, Apply):
                head = head.function
            if isinstance(head, Builtin | Con):
                continue
            if self._is_open(e.argument.type) and self._mentions(e.argument):
                return True
        return False

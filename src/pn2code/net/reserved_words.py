"""What Standard ML lets a net declare, and CPN Tools refuses: reserved words, and kinds of declarations.

    refuse_names(declaration, d)    # a colour set or a variable
    refuse(dec, d)                  # a declaration in CPN ML

The words were found by asking the engine about each name that occurs in its program. It looks at what a declaration
declares for the whole net: not at references (`globref`), nor at what is declared inside expressions and structures.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.diagnostics import Diagnostics, Origin, SourceText, Span
from pn2code.ml.parsing import syntax as s
from pn2code.ml.parsing.lexer import tokenize
from pn2code.ml.typing.declared import declared_by, types_declared_by
from pn2code.net.codes import NOT_IN_CPN_ML, RESERVED_WORD
from pn2code.reading.document import RawColset, RawDeclaration, RawVar

_WORDS = """
Arc EntireGraph Fair Impartial Just NONE NoLimit No_Fairness Node SOME Scc action all bool by color colorset colset
declare empty false globref index input int list ms not output print product real record ref size step string subset
time tms true unit var
"""
WORDS = frozenset(_WORDS.split())
"""Besides the keywords of Standard ML, which nothing lets one declare."""
_CONSTRUCTORS = frozenset({"NONE", "SOME", "true", "false", "ref"})
"""In a pattern they are not declared, but compared."""

_OF_COLSETS = frozenset({"base", "cmp", "col", "legal", "lt", "mkstr", "mkstr_ms", "ord", "timed"})
"""As constants of an enumeration: they hide the functions that the engine makes for its colour set."""


def refuse_names(declaration: RawDeclaration, d: Diagnostics) -> None:
    """Reports the reserved words that a colour set or variables declare."""
    match declaration:
        case RawVar():
            names: Iterable[str] = declaration.names
        case RawColset(kind="unit" | "bool" | "enum"):
            names = (declaration.name, *declaration.ids)
            if declaration.kind == "enum":
                for name in sorted(_OF_COLSETS.intersection(declaration.ids)):
                    d.error(
                        RESERVED_WORD,
                        f"`{name}` cannot be a constant of colour set `{declaration.name}`: "
                        "CPN Tools has a function of that name for each colour set",
                        declaration.origin,
                        hint="give it another name",
                    )
        case RawColset(kind="index"):
            names = (declaration.name, *declaration.ids[:1])
        case RawColset():
            names = (declaration.name, *(label for label, _ in declaration.fields))
        case _:
            return
    _report(names, declaration.origin, d)


def refuse(dec: s.Dec, d: Diagnostics) -> None:
    """Reports what CPN Tools refuses in a declaration; the operators in it have been resolved."""
    what = _kind(dec)
    if what:
        d.error(NOT_IN_CPN_ML, f"CPN Tools refuses {what}", dec.span)
        return
    inside = _opening(dec)
    if inside is not None:
        d.error(
            NOT_IN_CPN_ML,
            "CPN Tools refuses `open` in a declaration",
            inside,
            hint="write the names of the structure in full: `Int.abs`",
        )
    _report(_declared(dec), dec.span, d)


def says_nothing(text: SourceText) -> bool:
    """Whether a text is empty, or has comments only."""
    bare = not text.text.strip()
    return bare or (text.text.lstrip().startswith("(*") and tokenize(text, Diagnostics()) == [])


def _kind(dec: s.Dec) -> str:
    match dec:
        case s.SignatureDec():
            return "the declaration of a signature"
        case s.DatatypeCopyDec():
            return "a datatype that is declared as another one"
        case s.ExpDec():
            return "an expression where a declaration is expected"
        case _:
            return ""


def _opening(dec: s.Dec) -> Span | None:
    """Where something is opened, however deep inside."""
    todo: list[object] = [dec]
    while todo:
        node = todo.pop()
        if isinstance(node, s.OpenDec):
            return node.span
        if isinstance(node, tuple):
            todo.extend(node)
        elif s.is_node(node):
            slots = getattr(type(node), "__slots__", ())
            todo.extend(getattr(node, name) for name in slots if name != "span")
    return None


def _declared(dec: s.Dec) -> set[str]:
    """The names that the engine looks at."""
    match dec:
        case s.ValDec():
            return declared_by(dec) - _CONSTRUCTORS
        case s.DatatypeDec():
            return declared_by(dec) | {b.name for b in dec.bindings}
        case s.AbstypeDec():
            return set()
        case s.LocalDec():
            return {name for x in dec.visible for name in _declared(x)}
        case s.StructureDec() | s.FunctorDec():
            return {b.name for b in dec.bindings}
        case _:
            return declared_by(dec) | types_declared_by(dec)


def _report(names: Iterable[str], at: Origin | Span, d: Diagnostics) -> None:
    for name in sorted(WORDS.intersection(names)):
        d.error(
            RESERVED_WORD,
            f"`{name}` cannot be declared: it is a reserved word of CPN Tools",
            at,
            hint="give it another name",
        )

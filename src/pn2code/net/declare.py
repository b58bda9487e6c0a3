"""Hands the declarations of a net to the elaborator, with what CPN Tools forgets, refuses or passes over of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

from pn2code.diagnostics import Diagnostics, Note
from pn2code.ml.elaborate import ColsetSpec, Elaborator
from pn2code.ml.parsing.parser import declared_names
from pn2code.ml.parsing.plain_text import plain_names
from pn2code.net import (
    infix_names,
    reserved_words,
)
from pn2code.net.codes import (
    DECLARATION_EMPTY,
    DECLARATION_UNREAD,
    UNSUPPORTED_CHANNEL,
    UNSUPPORTED_DECLARATION,
)
from pn2code.net.linked import Net
from pn2code.reading.codes import DUPLICATE_ID
from pn2code.reading.document import (
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawMl,
    RawOther,
    RawUse,
    RawVar,
)


class Declaring:
    """Declarations, one after the other.

    Attributes:
        broken: names of colour sets that are wrong, which is reported already.
    """

    def __init__(self, elaborator: Elaborator, d: Diagnostics, is_pnml: bool) -> None:
        self._elaborator = elaborator
        self._d = d
        self._is_pnml = is_pnml
        self.broken: set[str] = set()

    def declare_all(self, declarations: Sequence[RawDeclaration]) -> None:
        """In order. Of two declarations of one id CPN Tools forgets the first when it comes to the second."""
        ids = Counter(declaration.id for declaration in declarations)
        forget: dict[str, list[Callable[[], None]]] = {}
        first: dict[str, RawDeclaration] = {}
        for declaration in declarations:
            identity = declaration.id
            if not identity or ids[identity] == 1:
                self._declare(declaration)
                continue
            for undo in forget.pop(identity, ()):
                self._d.warning(
                    DUPLICATE_ID,
                    f"two declarations have the id `{identity}`: CPN Tools forgets the first, and so does pn2code",
                    declaration.origin,
                    notes=[Note("this one is forgotten", first[identity].origin)],
                    hint="give one of them another id",
                )
                undo()
            first[identity] = declaration
            with self._elaborator.noting(forget.setdefault(identity, [])):
                self._declare(declaration)

    def _declare(self, declaration: RawDeclaration) -> None:
        """Hand one declaration to the elaborator."""
        e = self._elaborator
        if not self._is_pnml:
            reserved_words.refuse_names(declaration, self._d)
        match declaration:
            case RawColset(kind="") | RawColset(name=""):
                self.broken.add(declaration.name)  # reported when the file was read
                e.unreadable((), (declaration.name,))
            case RawVar(type=""):
                e.unreadable(declaration.names, ())
            case RawColset():
                spec = ColsetSpec(
                    name=declaration.name,
                    kind=declaration.kind,
                    ids=declaration.ids,
                    fields=declaration.fields,
                    texts=declaration.texts,
                    timed=declaration.timed,
                    by_predicate=declaration.by_predicate,
                    declare=declaration.declare,
                    origin=declaration.origin,
                )
                if not self._is_pnml:
                    infix_names.refuse(spec.kind, spec.name, e.infix, spec.origin, self._d)
                if e.colset(spec) is None:
                    self.broken.add(declaration.name)
                else:
                    self.broken.discard(declaration.name)
            case RawVar():
                e.variables(declaration.names, declaration.type, declaration.origin)
            case RawMl() if self._is_pnml:
                e.declarations(declaration.text)
            case RawMl():
                before = e.infix
                errors = len(self._d.errors)
                e.declarations(declaration.text, reserved_words.refuse)
                if len(self._d.errors) > errors:
                    self.broken.update(plain_names(declaration.text.text)[0])
                infix_names.warn(e.infix - before, declaration.origin, self._d)
                if reserved_words.says_nothing(declaration.text):
                    self._d.warning(
                        DECLARATION_EMPTY,
                        "a declaration is empty: CPN Tools refuses it (Not a declaration)",
                        declaration.origin,
                        hint="remove it, or put the comment before another declaration",
                    )
            case RawGlobref():
                e.globref(declaration.name, declaration.text)
            case RawUse():
                e.use(declaration.text)
            case RawOther() if declaration.tag == "globref":
                self._d.warning(
                    DECLARATION_EMPTY,
                    f"reference `{declaration.text.text}` has no value and is not declared",
                    declaration.origin,
                    hint="give it a value, or remove the declaration",
                )
            case RawOther() if declaration.tag == "errordecl":
                shown = " ".join(declaration.text.text.split())[:60]
                self._d.error(
                    DECLARATION_UNREAD,
                    f"CPN Tools could not read this declaration and kept its text: `{shown}`",
                    declaration.origin,
                    hint="enter it again in the syntax of the present CPN Tools, or remove it",
                )
            case RawOther() if declaration.tag == "channel":
                self._d.warning(
                    UNSUPPORTED_CHANNEL,
                    f"synchronous channels are not supported: channel `{declaration.text.text}` has no effect",
                    declaration.origin,
                    hint="use a place between the transitions, or merge them",
                )
            case RawOther():
                shown = " ".join(declaration.text.text.split())[:60]
                self._d.error(
                    UNSUPPORTED_DECLARATION,
                    f"a declaration of kind `{declaration.tag}` is not supported: `{shown}`",
                    declaration.origin,
                    hint="write it as a colour set, variable, reference or CPN ML declaration",
                )


def declared_in(net: Net) -> frozenset[str]:
    """All names that the net declares; texts with errors count as far as they can be read."""
    names: set[str] = set()
    for declaration in net.declarations:
        match declaration:
            case RawColset(name=name) | RawGlobref(name=name):
                names.add(name)
            case RawVar(names=several):
                names.update(several)
            case RawMl(text=text):
                names.update(declared_names(text))
            case _:
                pass
    return frozenset(names)

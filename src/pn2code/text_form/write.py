"""Writing a `Document` as text (`.cpnt`), to be compared line by line, or changed without a drawing program.

Left out are layout, monitors, free texts, and what stands at substitution transitions besides their ports.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.reading.document import (
    Document,
    Inscription,
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawMl,
    RawPage,
    RawPlace,
    RawTransition,
    RawUse,
    RawVar,
)
from pn2code.text_form.codes import UNSUPPORTED_IN_TEXT
from pn2code.text_form.colsets import SIMPLE
from pn2code.text_form.names import written
from pn2code.text_form.pages import ARCS, PORTS
from pn2code.text_form.read import PRIORITIES
from pn2code.text_form.scan import Open, after

_INDENT = "  "
_DEEPEST = 200
"""Columns that a line of a text stands deeper than its first one, at most."""

_STANDARD = [
    *(f"colset {kind.upper()} = {kind};" for kind in SIMPLE),
    *(f"val {name} = {value};" for name, value in PRIORITIES.items()),
]
_WORDS_OF_ARCS = {orientation: word for word, orientation in ARCS.items()}
_WORDS_OF_PORTS = {port: word for word, port in PORTS.items()}
_NOTE = re.compile(r"^#(\s+|$)")
_LONELY = re.compile(r"^[ ]*#\s*\n\s*", re.MULTILINE)
"""A selector whose label stands on the next line; alone on its line it would be a note."""

_DECLARES = re.compile(
    r"(val|fun|exception|datatype|abstype|type|eqtype|local|structure|signature|functor|infix|infixr|nonfix|open)\b(?!')|\(\*"
)


def emit(document: Document, d: Diagnostics) -> str:
    """The text; what cannot be written is reported."""
    writer = _Writer(document, d)
    return "\n".join(writer.lines()) + "\n"


class _Writer:
    def __init__(self, document: Document, d: Diagnostics) -> None:
        self.of = document
        self.d = d
        self.pages = {p.id: p for p in document.pages}
        self.places = {p.id: p for page in document.pages for p in page.places}
        self.fused = {
            member: f.name
            for f in document.fusions
            for member in f.members
            if member in self.places
        }

    def lines(self) -> Iterator[str]:
        options = {k.lower(): v for k, v in self.of.options.items()}
        if options.get("realtimestamp", "").lower() == "true":
            yield "option realtimestamp true"
        yield from self.items(self.of.globbox, "")
        if self.of.monitors:
            self.d.warning(
                UNSUPPORTED_IN_TEXT,
                f"the net's {len(self.of.monitors)} monitors are left out",
                Origin(self.of.file),
                hint="keep the .cpn file for them",
            )
        self.unique([(p.name, p.origin) for p in self.of.pages], "page")
        self.unique([(f.name, f.origin) for f in self.of.fusions if f.members], "fusion set")
        for fusion in self.of.fusions:
            if not fusion.name and fusion.members:
                self.cannot("a fusion set has no name", fusion.origin, "give it one")
        for page in self.of.pages:
            yield ""
            yield from self.page(page)

    def cannot(self, what: str, origin: Origin, hint: str) -> None:
        self.d.error(UNSUPPORTED_IN_TEXT, what, origin, hint=hint)

    def unique(self, named: list[tuple[str, Origin]], what: str) -> None:
        """Names belong to one thing each."""
        counts = Counter(name for name, _ in named)
        for name, origin in named:
            if counts[name] > 1:
                self.cannot(
                    f"{counts[name]} things have the name of {what} `{name}`",
                    origin,
                    "give them different names",
                )
                counts[name] = 0

    # --- declarations ----------------------------------------------------------------------------

    def items(self, block: RawBlock, indent: str) -> Iterator[str]:
        left = list(block.items)[::-1]
        while left:
            if _are_standard(left[: -len(_STANDARD) - 1 : -1]):
                del left[-len(_STANDARD) :]
                yield f"{indent}standard"
                continue
            item = left.pop()
            if isinstance(item, RawBlock):
                name = " ".join(item.name.split()).replace("(*", "( *")
                yield f"{indent}block {name or '-'}"
                yield from self.items(item, indent + _INDENT)
            else:
                yield from self.declaration(item, indent)

    def declaration(self, item: RawDeclaration, indent: str) -> Iterator[str]:
        match item:
            case RawColset():
                yield f"{indent}{colset(item)};"
            case RawVar():
                yield f"{indent}var {', '.join(item.names)} : {item.type};"
            case RawGlobref():
                yield from _text(indent, f"globref {item.name} = ", f"{item.text.text.strip()};")
            case RawUse():
                yield from _text(indent, "use ", item.text.text)
            case RawMl():
                text = item.text.text.strip()
                head = "" if _DECLARES.match(text) else "ml "
                if text:
                    yield from _text(indent, head, text)
            case _:
                self.cannot(
                    f"a declaration of the kind `{item.tag}` cannot be written as text",
                    item.origin,
                    "CPN Tools does not execute it: remove it",
                )

    # --- pages -----------------------------------------------------------------------------------

    def page(self, page: RawPage) -> Iterator[str]:
        self.unique([(p.name, p.origin) for p in page.places], "place")
        yield f"page {written(page.name)}"
        for place in page.places:
            yield from self.place(place)
        for transition in page.transitions:
            if transition.substitution is not None:
                yield self.substitution(transition)
            else:
                yield from self.transition(page, transition)

    def place(self, p: RawPlace) -> Iterator[str]:
        head = f"place {written(p.name)}"
        if p.port:
            head += f" port {_WORDS_OF_PORTS.get(p.port, 'io')}"
        if p.id in self.fused:
            head += f" fusion {written(self.fused[p.id])}"
        if p.type is not None:
            head += f" : {' '.join(p.type.text.text.split())}"
        if p.initial is None:
            yield f"{_INDENT}{head}"
        else:
            yield from _text(_INDENT, f"{head} = ", p.initial.text.text)

    def transition(self, page: RawPage, t: RawTransition) -> Iterator[str]:
        inside = _INDENT * 2
        yield f"{_INDENT}trans {written(t.name)}"
        if t.channel is not None:
            self.cannot(
                f"transition `{t.name}` has a channel",
                t.origin,
                "channels are not executed: remove it",
            )
        clauses: tuple[tuple[str, Inscription | None], ...] = (
            ("guard", t.guard),
            ("delay", t.delay),
            ("priority", t.priority),
        )
        for word, clause in clauses:
            if clause is not None:
                yield from _text(inside, f"{word} ", clause.text.text)
        for arc in page.arcs:
            if arc.transition != t.id:
                continue
            head = f"{_WORDS_OF_ARCS[arc.orientation]} {written(self.places[arc.place].name)}"
            if arc.inscription is None:
                yield f"{inside}{head}"
            else:
                yield from _text(inside, f"{head} : ", arc.inscription.text.text)
        if t.code is not None:
            yield from _text(inside, "code ", t.code.text.text)

    def substitution(self, t: RawTransition) -> str:
        assert t.substitution is not None
        sub = self.pages.get(t.substitution.subpage)
        target = t.substitution.subpage if sub is None else sub.name
        if sub is None:
            self.cannot(
                f"transition `{t.name}` stands for a page that is not in the file",
                t.origin,
                "assign a page to it",
            )
        pairs = []
        for port, socket in t.substitution.portsock:
            if port in self.places and socket in self.places:
                pairs.append(
                    f"{written(self.places[port].name)} -> {written(self.places[socket].name)}"
                )
            else:
                self.cannot(
                    f"transition `{t.name}` assigns a port or socket that is not in the file",
                    t.origin,
                    "assign the ports again",
                )
        assigned = f" ({', '.join(pairs)})" if pairs else ""
        return f"{_INDENT}subst {written(t.name)} = {written(target)}{assigned}"


def _are_standard(items: list[RawBlock | RawDeclaration]) -> bool:
    """Whether these are what `standard` declares."""
    written = []
    for item in items:
        if isinstance(item, RawColset):
            written.append(f"{colset(item)};")
        elif isinstance(item, RawMl):
            written.append(item.text.text.strip())
    return written == _STANDARD


def _text(indent: str, head: str, text: str) -> Iterator[str]:
    """A head and a text, whose further lines are deeper. Blanks at the beginning of lines mean nothing in CPN ML."""
    joined = _LONELY.sub("#", text.strip().expandtabs(8))
    first, *more = (x for x in joined.split("\n") if x.strip())
    if not more:
        yield f"{indent}{head}{first}"
        return
    own = (
        len(head) == 0
    )  # a declaration without a word before it: its first line is where it begins
    lines = more if own else [first, *more]
    yield f"{indent}{head.rstrip()}" if not own else f"{indent}{first}"
    state = after(first.strip(), Open()) if own else Open()
    least = min((len(x) - len(x.lstrip()) for x in lines), default=0)
    if not own:  # the first line stands where its text did, which is not known any more
        least = min((len(x) - len(x.lstrip()) for x in more), default=0)
        lines = [first, *(x[least:] for x in more)]
        least = 0
    for line in lines:
        text = line.lstrip()
        blanks = min(len(line) - len(text) - least, _DEEPEST)
        shown = text if state.comments else " " * max(0, blanks) + text
        shown = _NOTE.sub("#", shown.lstrip(), count=1) if shown.lstrip().startswith("#") else shown
        yield f"{indent}{_INDENT}{shown}".rstrip()
        state = after(line.strip(), state)


def colset(item: RawColset) -> str:
    """`colset NAME = DEFINITION`."""
    texts = [" ".join(x.strip() for x in t.text.split("\n")) for t in item.texts]
    ids = ", ".join(item.ids)
    body: str = item.kind
    match item.kind:
        case "unit" | "bool":
            if item.ids:
                body += f" with {ids}" if item.kind == "unit" else f" with ({ids})"
        case kind if kind in SIMPLE:
            body += _with(texts)
        case "enum":
            body = f"with {' | '.join(item.ids)}"
        case "index" | "list":
            body = f"{item.kind} {ids}{_with(texts)}"
        case "product":
            body = f"product {' * '.join(item.ids)}"
        case "record":
            body = f"record {' * '.join(f'{label} : {of}' for label, of in item.fields)}"
        case "union":
            parts = (f"{label} : {of}" if of else label for label, of in item.fields)
            body = f"union {' + '.join(parts)}"
        case "subset":
            body = (
                f"subset {ids} {'by' if item.by_predicate else 'with'} {texts[0] if texts else ''}"
            )
        case _:
            body = ids
    timed = " timed" if item.timed else ""
    declared = f" declare {', '.join(item.declare)}" if item.declare else ""
    return f"colset {item.name} = {body}{timed}{declared}"


def _with(texts: list[str]) -> str:
    if not texts:
        return ""
    pairs = [f"{a}..{b}" for a, b in zip(texts[::2], texts[1::2], strict=False)]
    return f" with {' and '.join(pairs)}"

"""Readable dumps of the stages from `Document` to `FlatNet`: what people and tests look at.

Example (flat):

    place 2 Top.Buffer : PART = 1`screw   (ID1407)
    transition 4 Top.Robot1.Pick   (ID1412) priority 100
      variables n, p
      in    Top.Buffer : 1`p ++ 1`n     terms p | n
      guard n > 0
      bind  arc 0 term 0: p
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.ml.core.terms import Exp
from pn2code.net.flat import (
    BindAll,
    BindEquation,
    BindRandom,
    BindStep,
    BindTerm,
    FlatArc,
    FlatNet,
    FlatTransition,
)
from pn2code.net.linked import Net
from pn2code.net.uses import pattern_variables
from pn2code.reading.document import (
    Document,
    Inscription,
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawVar,
)


def dump_document(document: Document) -> str:
    """The document as the file says it."""
    return "\n".join(_document(document)) + "\n"


def dump_net(net: Net) -> str:
    """Pages with ports, sockets and fusion sets resolved."""
    return "\n".join(_net(net)) + "\n"


def dump_flat(net: FlatNet, only: str = "") -> str:
    """The flat net with binding plans; `only` restricts it to names that contain it."""
    return "\n".join(_flat(net, only)) + "\n"


def text_of(e: Exp) -> str:
    """The user's text of an expression, on one line.

    Spans of operators reach from the first operand to the last, without parentheses around these,
    so a span may lack parentheses that its own text opens or closes; they are added.
    """
    span = e.span
    text, start, end = span.source.text, span.start, span.end
    while _open(text[start:end]) > 0 and end < len(text):
        end += 1
    while _open(text[start:end]) < 0 and start > 0:
        start -= 1
    return " ".join(text[start:end].split())


def _open(text: str) -> int:
    """Parentheses opened and not closed (or, below zero, the other way round)."""
    return text.count("(") - text.count(")")


def _inline(inscription: Inscription | None) -> str:
    return " ".join(inscription.text.text.split()) if inscription else ""


def _document(document: Document) -> Iterator[str]:
    yield f"document {document.tool} {document.version} format {document.format}".rstrip()
    yield from _block(document.globbox, "  ")
    for page in document.pages:
        yield f"  page {page.name}   ({page.id})"
        for p in page.places:
            extra = (f" port {p.port}" if p.port else "") + (
                f" fusion {p.fusion}" if p.fusion else ""
            )
            yield f"    place {p.name}{extra} : {_inline(p.type)} = {_inline(p.initial)}   ({p.id})"
        for t in page.transitions:
            yield f"    trans {t.name}   ({t.id})"
            parts = (
                ("guard", t.guard),
                ("delay", t.delay),
                ("code", t.code),
                ("priority", t.priority),
            )
            for word, inscription in parts:
                if inscription:
                    yield f"      {word} {_inline(inscription)}"
            if t.substitution:
                pairs = ", ".join(f"{a} -> {b}" for a, b in t.substitution.portsock)
                yield f"      subst {t.substitution.subpage} ({pairs})"
        for a in page.arcs:
            yield f"    {a.origin.element} {a.orientation} : {_inline(a.inscription)}   ({a.id})"
    for fusion in document.fusions:
        yield f"  fusion {fusion.name} {', '.join(fusion.members)}"


def _block(block: RawBlock, indent: str) -> Iterator[str]:
    for item in block.items:
        if isinstance(item, RawBlock):
            yield f"{indent}block {item.name}"
            yield from _block(item, indent + "  ")
        else:
            yield indent + _declaration(item)


def _declaration(item: RawDeclaration) -> str:
    match item:
        case RawColset():
            fields = [f"{label}: {of}" if of else label for label, of in item.fields]
            texts = [t.text for t in item.texts]
            inside = " ".join([*item.ids, *fields, *texts])
            return f"colset {item.name} = {item.kind} {inside}".rstrip() + (
                " timed" if item.timed else ""
            )
        case RawVar():
            return f"var {', '.join(item.names)} : {item.type}"
        case RawGlobref():
            return f"globref {item.name} = {' '.join(item.text.text.split())}"
        case _:
            return " ".join(item.text.text.split())


def _net(net: Net) -> Iterator[str]:
    yield f"net {'real' if net.real_time else 'integer'} time, {len(net.declarations)} declarations"
    for page in net.pages:
        names = {p.id: p.name for p in page.places}
        prime = " prime" if page.id in net.prime_pages else ""
        yield f"  page {page.name}{prime}"
        for p in page.places:
            extra = (f" port {p.port}" if p.port else "") + (
                f" fusion {p.fusion}" if p.fusion else ""
            )
            yield f"    place {p.name}{extra} : {_inline(p.colset)}"
        for t in page.transitions:
            yield f"    trans {t.name}"
            for a in t.arcs:
                yield f"      {a.kind.value} {names[a.place]} : {_inline(a.inscription)}".rstrip(
                    " :"
                )
        for s in page.substitutions:
            sub = net.page(s.subpage)
            ports = {p.id: p.name for p in sub.places}
            pairs = ", ".join(f"{ports[q.port]} -> {names[q.socket]}" for q in s.ports)
            yield f"    subst {s.name} = {sub.name} ({pairs})"


def _flat(net: FlatNet, only: str) -> Iterator[str]:
    clock = ("real" if net.real_time else "integer") + " time" if net.timed else "untimed"
    yield f"flat net {net.name}, {clock}"
    for p in net.places:
        if only not in p.name:
            continue
        initial = f" = {text_of(p.initial[0])}" if p.initial else ""
        merged = f" +{len(p.member_ids) - 1}" if len(p.member_ids) > 1 else ""
        yield f"place {p.index} {p.name} : {p.colset.name}{initial}   ({p.id}{merged})"
    for t in net.transitions:
        if only in t.name:
            yield from _transition(net, t)


def _transition(net: FlatNet, t: FlatTransition) -> Iterator[str]:
    yield f"transition {t.index} {t.name}   ({t.id}) priority {t.priority}"
    if t.variables:
        yield "  variables " + ", ".join(v.name for v in t.variables)
    for arc in t.arcs:
        yield "  " + _arc(net, arc)
    for guard in t.guards:
        yield f"  guard {text_of(guard)}"
    for step in t.plan:
        yield f"  bind  {_step(t, step)}"
    if t.code is not None:
        inputs = ", ".join(s.name for s in t.code.inputs)
        outputs = ", ".join(s.name for s in t.code.outputs)
        yield f"  code  input ({inputs}) output ({outputs}) action {text_of(t.code.action)}"
    if t.delay is not None:
        yield f"  delay {text_of(t.delay)}"


def _arc(net: FlatNet, arc: FlatArc) -> str:
    line = f"{arc.kind.value} {net.places[arc.place].name}"
    if arc.inscription is None:
        return line
    line += f" : {text_of(arc.inscription.value)}   {arc.inscription.form.value}"
    tests = [text_of(term.value) for term in arc.inscription.terms if term.pattern is None]
    return line + (f", tests {' | '.join(tests)}" if tests else "")


def _step(t: FlatTransition, step: BindStep) -> str:
    match step:
        case BindTerm(arc, term):
            inscription = t.arcs[arc].inscription
            assert inscription is not None
            names = pattern_variables(inscription.terms[term].pattern)
            return f"arc {arc} term {term}: {', '.join(s.name for s in names)}"
        case BindEquation(guard, pattern, value):
            names = pattern_variables(pattern)
            return f"guard {guard}: {', '.join(s.name for s in names)} from {text_of(value)}"
        case BindAll(symbol):
            return f"all values of {symbol.name}"
        case BindRandom(symbol):
            return f"any value of {symbol.name}"

"""Pages of a net as text: places, transitions and their arcs, substitution transitions."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note, Origin, SourceText
from pn2code.diagnostics.suggestions import did_you_mean, nearest
from pn2code.reading.document import (
    Inscription,
    RawArc,
    RawFusion,
    RawPage,
    RawPlace,
    RawSubstitution,
    RawTransition,
)
from pn2code.text_form import names
from pn2code.text_form.codes import TEXT_NAME, TEXT_SYNTAX
from pn2code.text_form.lines import A_NOTE_INSIDE, Line, notes_in, text_of
from pn2code.text_form.scan import parts, stripped

PORTS = {"in": "In", "out": "Out", "io": "I/O"}
ARCS = {"in": "ptot", "out": "ttop", "both": "bothdir", "inhibit": "inhibitor", "reset": "reset"}
"""Words of arcs, as seen from the transition, and their orientations."""
CLAUSES = {"guard": "guard", "delay": "delay", "priority": "priority", "code": "code segment"}
_ELEMENTS = ("place", "trans", "subst")
_OF_CODE = ("input", "output", "action")
_MOST_SHOWN = 40
_BESIDE = re.compile(r"([A-Za-z][\w']*)(?:\s+(?=\d)|\s*(?=[(\[]))(.+)", re.DOTALL)
"""A colour set and something beside it that is none."""
_OF_A_SOCKET = {"In": "ptot", "Out": "ttop"}

Wrong = Callable[[Line, str, str], None]
"""Says that a line cannot be read, and what to write."""


@frozen
class _Substitution:
    """A substitution transition whose page is not known yet."""

    line: Line
    made: RawTransition
    subpage: str
    pairs: list[tuple[str, str, Origin]]


@frozen
class _Page:
    """What has been read of a page.

    Args:
        unread: names of places that may be there: their lines cannot be read, and it is said of these lines.
    """

    line: Line
    id: str
    name: str
    origin: Origin
    places: list[RawPlace]
    transitions: list[RawTransition | _Substitution]
    arcs: list[RawArc]
    unread: set[str]


class PageReader:
    """Reads the pages of a file.

    Args:
        new: gives ids.
        wrong: reports a line that cannot be read.
        notes: of the file, in its order.
    """

    def __init__(
        self, file: str, d: Diagnostics, new: Callable[[], str], wrong: Wrong, notes: list[Line]
    ) -> None:
        self.file = file
        self.d = d
        self.new = new
        self.wrong = wrong
        self.notes = notes
        self.by_name: dict[str, _Page] = {}
        self.named: dict[str, set[str]] = {}
        """What the places of each page are called."""
        self.unread: set[str] = set()
        """Pages that may be there: their lines cannot be read, and it is said of these lines."""

    def pages(self, lines: list[Line]) -> tuple[RawPage, ...]:
        """All pages; substitution transitions may name later ones."""
        for line in lines:
            called = names.take(line.text, len("page"))
            own = [names.take(x.text, len("place")) for x in line.below if x.word == "place"]
            found = self.named.setdefault(called[0] if called else "", set())
            found.update(x[0] for x in own if x)
        read = [page for line in lines if (page := self.page(line)) is not None]
        return tuple(self.whole(page) for page in read)

    def page(self, line: Line) -> _Page | None:
        """`page NAME` with all that stands below it but its substitution transitions, which may name later pages."""
        found = names.take(line.text, len("page"))
        if found is None or line.text[found[1] :].strip():
            self.wrong(line, "a page has a name, and nothing more on its line", _PAGE)
            return None
        name = found[0]
        origin = Origin(self.file, line.number, line.column, name)
        page = _Page(line, self.new(), name, origin, [], [], [], set())
        if (first := self.by_name.setdefault(name, page)) is not page:
            self.repeated(f"page `{name}`", origin, first.origin)
        below = [x for x in line.below if not x.is_note]
        for one in below:
            if one.word == "place":
                self.place(page, one)
            elif one.word not in _ELEMENTS and (taken := names.take(one.text, len(one.word))):
                page.unread.add(taken[0])
        before = ""
        for one in below:
            match one.word:
                case "place":
                    before = ""
                case "trans":
                    self.transition(page, one)
                    before = one.text
                case "subst":
                    self.substitution(page, one)
                    before = ""
                case _:
                    self.no_element(one, before)
        return page

    def no_element(self, line: Line, before: str) -> None:
        """A line that begins nothing on a page, below that of a transition or not."""
        word = line.word
        if word in (*ARCS, *CLAUSES):
            what = "an arc" if word in ARCS else f"`{word}`"
            below = f"`{before}`" if before else "its `trans`"
            self.wrong(
                line,
                f"`{word}` stands as deep as places and transitions do, but {what} belongs to a transition",
                f"indent the line so that it is deeper than {below}",
            )
            return
        hint = _other(line, _ELEMENTS, _PAGE)
        self.wrong(line, f"nothing on a page begins with `{word}`", hint)

    def repeated(self, what: str, origin: Origin, first: Origin) -> None:
        """Two things of one name."""
        self.d.error(
            TEXT_NAME,
            f"{what} is there twice",
            origin,
            notes=[Note("the first one is here", first)],
            hint="give one of them another name",
        )

    # --- places ----------------------------------------------------------------------------------

    def place(self, page: _Page, line: Line) -> None:
        """`place NAME [port in|out|io] [fusion NAME] [: COLSET] [= INITIAL MARKING]`."""
        found = names.take(line.text, len("place"))
        if found is None:
            self.wrong(line, "a place has a name", _PLACE)
            return
        name, at = found
        identity = self.new()
        what = f"place `{name}`"
        origin = Origin(self.file, line.number, line.column, page.name, what, identity)
        port = fusion = ""
        page.unread.add(name)  # until all of the line has been read
        while (word := names.take(line.text, at)) is not None:
            if word[0] not in ("port", "fusion"):
                rest = line.text[word[1] :].lstrip()
                self.wrong(
                    line,
                    f"`{word[0]}` is not expected after the name of a place",
                    _after_a_name(name, word[0], rest),
                )
                return
            value = names.take(line.text, word[1])
            if value is None or not value[0]:
                self.wrong(line, f"`{word[0]}` needs a word after it", _PLACE)
                return
            if word[0] == "port" and value[0] not in PORTS:
                self.wrong(
                    line,
                    f"`{value[0]}` is no kind of port",
                    did_you_mean(value[0], PORTS, "a port is `port in`, `port out` or `port io`"),
                )
                return
            if port if word[0] == "port" else fusion:
                self.wrong(line, f"place `{name}` has `{word[0]}` twice", "write one of them")
            if word[0] == "port":
                port = PORTS[value[0]]
            else:
                fusion = value[0]
            at = value[1]
        rest = line.text[at:].lstrip()
        at = len(line.text) - len(rest)
        kind = initial = None
        if rest.startswith(":"):
            end = at + parts(rest, "=")[0][1]
            start, stop = stripped(line.text, at + 1, end)
            where = replace(origin, column=line.column + start, part="colour set")
            if "#" in line.text[start:stop]:
                self.wrong(
                    line, "a note has a line of its own", "write it above the place: `# ...`"
                )
            elif ";" in line.text[start:stop]:
                self.wrong(line, "a place does not end with `;`", "leave it out")
            if (after := _BESIDE.fullmatch(line.text[start:stop])) is not None:
                self.wrong(
                    line,
                    f"`{after[2]}` is not expected after the colour set of a place",
                    f"an initial marking follows after `=`: `: {after[1]} = {_short(after[2])}`",
                )
                stop = start + len(after[1])
            if start < stop:
                kind = Inscription(SourceText(line.text[start:stop], where))
            at = end
            rest = line.text[at:]
        if rest.startswith("="):
            initial = self.inscription(line, at + 1, origin, "initial marking")
        elif not rest and line.goes_on:
            deeper = next(x for x in line.below if not x.is_note)
            self.wrong(
                deeper,
                f"the line stands deeper than that of place `{name}`, to which nothing below can belong",
                "write it as deep as the places and transitions of the page; an initial marking follows after `=`",
            )
            page.unread.update(x[0] for x in [names.take(deeper.text, len(deeper.word))] if x)
        elif rest:
            self.wrong(
                line, "a place is written on one line, its initial marking after `=`", _PLACE
            )
        made = RawPlace(identity, name, kind, initial, port, fusion, origin, caption=name)
        page.unread.discard(name)
        for first in page.places:
            if first.name == name:
                self.repeated(what, origin, first.origin)
                return
        page.places.append(made)

    def inscription(self, line: Line, start: int, base: Origin, part: str) -> Inscription | None:
        """The text from an offset on, with deeper lines; None if it is empty."""
        for note in notes_in(line, self.notes):
            self.wrong(note, *A_NOTE_INSIDE)
        text = text_of(line, start, replace(base, part=part))
        return Inscription(text) if text.text.strip() else None

    # --- transitions -----------------------------------------------------------------------------

    def transition(self, page: _Page, line: Line) -> None:
        """`trans NAME`, with clauses and arcs below it."""
        found = names.take(line.text, len("trans"))
        if found is None or line.text[found[1] :].strip():
            self.wrong(line, "a transition has a name, and nothing more on its line", _TRANS)
            return
        name, identity = found[0], self.new()
        what = f"transition `{name}`"
        origin = Origin(self.file, line.number, line.column, page.name, what, identity)
        clauses: dict[str, Inscription | None] = {}
        for one in (x for x in line.below if not x.is_note):
            word = one.word
            if word in CLAUSES:
                if word in clauses:
                    self.wrong(one, f"transition `{name}` has two of `{word}`", "write one of them")
                clauses[word] = self.inscription(one, len(word), origin, CLAUSES[word])
            elif word in ARCS:
                self.arc(page, one, word, name, identity)
            else:
                hint = _other(one, (*ARCS, *CLAUSES), _TRANS)
                if word in _OF_CODE:
                    hint = f"a code segment begins with `code`: `code {_short(one.text)}`"
                elif any(p.name == word for p in page.places):
                    hint = f"an arc begins with its direction: `in {_short(one.text)}` or `out {_short(one.text)}`"
                elif word in _ELEMENTS:
                    hint = f"write it as deep as `trans {names.written(name)}`, not deeper"
                    page.unread.update(x[0] for x in [names.take(one.text, len(word))] if x)
                self.wrong(one, f"no arc and no clause of a transition begins with `{word}`", hint)
        page.transitions.append(
            RawTransition(
                id=identity,
                name=name,
                guard=clauses.get("guard"),
                delay=clauses.get("delay"),
                code=clauses.get("code"),
                priority=clauses.get("priority"),
                channel=None,
                substitution=None,
                origin=origin,
                caption=name,
            ),
        )

    def arc(self, page: _Page, line: Line, word: str, transition: str, identity: str) -> None:
        """`in PLACE : INSCRIPTION`."""
        found = names.take(line.text, len(word))
        rest = line.text[found[1] :].lstrip() if found else ""
        if found is None or (rest and not rest.startswith(":")) or (line.goes_on and not rest):
            self.wrong(line, "an arc names a place, and its inscription follows after `:`", _ARC)
            return
        place = self.place_of(page, found[0], line)
        if place is None:
            return
        start = len(line.text) - len(rest) + 1
        self.draw(page, line, ARCS[word], (place, transition, identity), start if rest else None)

    def draw(
        self,
        page: _Page,
        line: Line,
        orientation: str,
        ends: tuple[RawPlace, str, str],
        start: int | None,
    ) -> None:
        """An arc between a place and a transition (its name and id); its inscription begins at an offset."""
        place, transition, identity = ends
        source, target = place.name, transition
        if orientation == "ttop":
            source, target = target, source
        what, arc = f"arc `{source}` -> `{target}`", self.new()
        origin = Origin(self.file, line.number, line.column, page.name, what, arc)
        text = None if start is None else self.inscription(line, start, origin, "inscription")
        page.arcs.append(RawArc(arc, orientation, identity, place.id, text, origin))

    def place_of(self, page: _Page, name: str, line: Line) -> RawPlace | None:
        """A place of a page by its name; without one, None after an error."""
        for place in page.places:
            if place.name == name:
                return place
        if name not in page.unread:
            known = [p.name for p in page.places]
            otherwise = "declare it, or correct the name"
            elsewhere = sorted(f"`{p}`" for p, found in self.named.items() if name in found)
            if elsewhere and nearest(name, known) == "":
                otherwise = (
                    f"arcs reach the places of their own page; there is one on page {', '.join(elsewhere)}: "
                    "draw a port place here and assign it to that one, or put both into one fusion set"
                )
            self.unknown(f"page `{page.name}` has no place `{name}`", line, known, otherwise)
        return None

    def unknown(self, message: str, line: Line, known: list[str], otherwise: str = "") -> None:
        """A message that ends in a name which is none of those that are known."""
        self.d.error(
            TEXT_NAME,
            message,
            Origin(self.file, line.number, line.column),
            hint=did_you_mean(
                message.rsplit("`", 2)[1], known, otherwise or "declare it, or correct the name"
            ),
        )

    # --- substitution transitions ----------------------------------------------------------------

    def substitution(self, page: _Page, line: Line) -> None:
        """`subst NAME = PAGE (PORT -> SOCKET, ...)`, the pairs also on deeper lines."""
        found = names.take(line.text, len("subst"))
        rest = line.text[found[1] :].lstrip() if found else ""
        target = names.take(rest, 1) if rest.startswith("=") else None
        if found is None or target is None:
            self.wrong(line, "a substitution transition has a name and a page", _SUBST)
            return
        identity = self.new()
        what = f"transition `{found[0]}`"
        origin = Origin(self.file, line.number, line.column, page.name, what, identity)
        pairs = list(self.pairs(line, len(line.text) - len(rest) + target[1], origin))
        made = RawTransition(
            id=identity,
            name=found[0],
            guard=None,
            delay=None,
            code=None,
            priority=None,
            channel=None,
            substitution=None,
            origin=origin,
            caption=found[0],
        )
        page.transitions.append(_Substitution(line, made, target[0], pairs))

    def pairs(self, line: Line, start: int, origin: Origin) -> Iterator[tuple[str, str, Origin]]:
        """Port, socket, and where the pair stands."""
        given = self.inscription(line, start, origin, "port assignment")
        if given is None:
            return
        text = given.text
        begin, end = stripped(text.text, 0, len(text.text))
        if text.text[begin] == "(" and text.text[end - 1] == ")":
            begin, end = begin + 1, end - 1
        for a, b in parts(text.text[begin:end], ","):
            at, stop = stripped(text.text, begin + a, begin + b)
            if at == stop:
                continue
            port = names.take(text.text, at)
            arrow = text.text[port[1] : stop].lstrip() if port else ""
            socket = names.take(arrow, 2) if arrow.startswith("->") else None
            if port is None or socket is None or arrow[socket[1] :].strip():
                self.d.error(
                    TEXT_SYNTAX,
                    f"`{text.text[at:stop]}` is no assignment of a port",
                    text.origin_at(at),
                    hint=_SUBST,
                )
                self.unread.update(text.text[at:stop].split())
                continue
            yield port[0], socket[0], text.origin_at(at)

    def whole(self, page: _Page) -> RawPage:
        """The page with its substitution transitions and their arcs."""
        made = []
        for one in page.transitions:
            made.append(one if isinstance(one, RawTransition) else self.assigned(page, one))
        return RawPage(
            id=page.id,
            name=page.name,
            places=tuple(page.places),
            transitions=tuple(made),
            arcs=tuple(page.arcs),
            auxiliaries=(),
            origin=page.origin,
        )

    def assigned(self, page: _Page, one: _Substitution) -> RawTransition:
        """A substitution transition with its ports, and an arc for each socket as its port has it."""
        sub = self.by_name.get(one.subpage)
        if sub is None and one.subpage in self.unread:
            return one.made
        if sub is None:
            self.unknown(f"the net has no page `{one.subpage}`", one.line, list(self.by_name))
            return one.made
        found = []
        for port_name, socket_name, _ in one.pairs:
            port = self.place_of(sub, port_name, one.line)
            socket = self.place_of(page, socket_name, one.line)
            if port is None or socket is None:
                continue
            found.append((port.id, socket.id))
            orientation = _OF_A_SOCKET.get(port.port, "bothdir")
            self.draw(page, one.line, orientation, (socket, one.made.name, one.made.id), None)
        origin = one.made.origin
        return replace(one.made, substitution=RawSubstitution(sub.id, tuple(found), origin))


def _after_a_name(name: str, word: str, rest: str) -> str:
    """What to write instead of a place whose name is followed by a word."""
    if word in PORTS:
        return f"a port is written `port {word}`"
    if not rest:
        return f"a colour set follows after a colon, `: {word}`; a name with blanks stands between quotes"
    if near := nearest(word, ("port", "fusion")):
        return f"did you mean `{near}`?"
    return f'a name with blanks stands between quotes: `place "{name} {word}" {_short(rest)}`; {_PLACE}'


def _short(text: str) -> str:
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."


def _other(line: Line, words: Sequence[str], otherwise: str) -> str:
    """What to write instead of a line that begins with none of these words."""
    if line.text.startswith(("(*", "#", "//", "--")):
        return "a note is a line that begins with `# `, a blank after it"
    return did_you_mean(line.word, words, otherwise)


def fusions_of(pages: tuple[RawPage, ...], new: Callable[[], str]) -> tuple[RawFusion, ...]:
    """The fusion sets that places name."""
    members: dict[str, list[RawPlace]] = {}
    for place in (p for page in pages for p in page.places if p.fusion):
        members.setdefault(place.fusion, []).append(place)
    return tuple(
        RawFusion(
            new(),
            name,
            tuple(p.id for p in of),
            replace(of[0].origin, page="", element=f"fusion set `{name}`", element_id=""),
        )
        for name, of in members.items()
    )


_PAGE = "a page is `page Top`; deeper below it stand `place A : INT = 1`1`, `trans T`, `subst S = Sub (Port -> Socket)`"
_PLACE = 'a place is written `place A : INT = 1`1`, also `place "In Flight" port in : INT` or `place A fusion F : INT`'
_TRANS = (
    "below `trans T` stand its arcs, `in A : n`, `out B : n + 1`, `both`, `inhibit`, `reset`, and `guard`, `delay`, "
    "`priority`, `code`, each on a line of its own and deeper than `trans`"
)
_ARC = 'an arc is written `in A : n` or `out "In Flight" : n + 1`'
_SUBST = 'a substitution transition is written `subst Left = Page (Port -> Socket, Other -> "Its Socket")`'

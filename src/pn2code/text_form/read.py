"""Reading nets as text (`.cpnt`) into a `Document`, like `.cpn` files.

In: bytes. Out: a `Document` whose texts know where they stand in the file, or None after errors. The form is described
in docs/text.md.

Example:

    standard
    var n : INT;
    page Top
      place Buffer : INT = 1`1
      trans Move
        in Buffer : n
        out Buffer : n + 1
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

from pn2code.diagnostics import Diagnostics, Origin, SourceText, TooManyDiagnosticsError
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.reading.cpn import give_up
from pn2code.reading.document import (
    Document,
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawMl,
    RawPage,
    RawUse,
)
from pn2code.text_form import colsets
from pn2code.text_form.codes import TEXT_SYNTAX
from pn2code.text_form.colsets import NotReadableError
from pn2code.text_form.lines import A_NOTE_INSIDE, Line, notes_in, text_of
from pn2code.text_form.lines import read as lines_of
from pn2code.text_form.pages import PageReader, fusions_of
from pn2code.text_form.scan import first, masked, parts, plain

PRIORITIES = {"P_HIGH": 100, "P_NORMAL": 1000, "P_LOW": 10000}
_ML = frozenset(
    """val fun exception datatype abstype type eqtype local structure signature functor infix infixr nonfix
    open""".split()  # noqa: SIM905 - a list of words
)
_ONE_LINE = ("colset", "var", "globref")
"""Several of these may stand on a line."""

_DEEPEST = 400
"""Columns: blocks may stand within one another, but not without an end."""
_HEADS = ("page", "colset", "var", "globref", "use", "block", "standard", "option", "ml")
_GOES_ON = re.compile(r"[|)\]};]|(and|in|end|withtype)(?![\w'])")
"""So begin lines that continue a declaration in CPN ML though they are not deeper."""

_NOTE = "a note is a line that begins with `# `, a blank after it"
_BLOCK_WORDS = re.compile(r"(?<![\w'])(let|local|struct|sig|end)(?![\w'])")
_UNPRINTED = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")
"""Characters that a file of CPN Tools cannot have."""

_WORD = re.compile(r"[A-Za-z][\w']*")
_OPTIONS = {"realtimestamp": ("true", "false")}


def read_data(data: bytes, file: str, d: Diagnostics, *, partial: bool = False) -> Document | None:
    """Read the bytes of a file; `file` is the name used in messages.

    Returns:
        The document, or None if there were errors (if `partial`: only if there was nothing to read).
    """
    before = len(d.errors)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as e:
        line = data[: e.start].count(b"\n") + 1
        d.error(
            TEXT_SYNTAX,
            "the file is not written in UTF-8",
            Origin(file, line),
            hint="save it in UTF-8; a net of CPN Tools has a name that ends in .cpn",
        )
        return None
    if text.lstrip().startswith("<"):
        d.error(
            TEXT_SYNTAX,
            "the file is XML, not a net as text",
            Origin(file, 1, 1),
            hint="let its name end in .cpn or .pnml",
        )
        return None
    if (found := _UNPRINTED.search(text)) is not None:
        start = text.rfind("\n", 0, found.start()) + 1
        d.error(
            TEXT_SYNTAX,
            f"the file has the character U+{ord(found.group()):04X}, which is not printed",
            Origin(file, text.count("\n", 0, start) + 1, found.start() - start + 1),
            hint="remove it; in a string of CPN ML it is written with its number, `\\127`",
        )
        return None
    try:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
        document = _Reader(file, d).document(text, hashlib.sha256(data).hexdigest())
    except TooManyDiagnosticsError:
        give_up(file, d)
        return None
    return None if len(d.errors) > before and not partial else document


class _Reader:
    """Reads one file."""

    def __init__(self, file: str, d: Diagnostics) -> None:
        self.file = file
        self.d = d
        self.count = 0
        self.options: dict[str, str] = {}
        self.notes: list[Line] = []
        self.unread: set[str] = set()
        """Words of lines that cannot be read: what is declared there may have these names."""

    def new(self) -> str:
        """An id, as CPN Tools has them."""
        self.count += 1
        return f"ID{self.count}"

    def wrong(self, line: Line, message: str, hint: str, column: int = 0) -> None:
        """A line that cannot be read."""
        origin = Origin(self.file, line.number, column or line.column)
        self.d.error(TEXT_SYNTAX, message, origin, hint=hint)
        for one in (line, *line.deeper()):
            self.unread.update(_WORD.findall(one.text))

    def document(self, text: str, sha256: str) -> Document:
        root, unclosed = lines_of(text)
        deep = next((x for x in root.deeper() if x.indent > _DEEPEST), None)
        if deep is not None:
            self.wrong(
                deep,
                f"the line stands {deep.indent} columns deep, more than {_DEEPEST}",
                "two columns are enough for each level",
            )
            root = Line(0, 0, -1, "")
        if unclosed is not None:
            self.wrong(
                unclosed,
                "a comment begins here that never ends",
                "close it with `*)` where it ends",
            )
        self.notes = [x for x in root.deeper() if x.is_note]
        lines = [x for x in root.below if not x.is_note]
        pages_of = [x for x in lines if x.word == "page"]
        items = self.items([x for x in lines if x.word != "page"], is_top=True)
        reader = PageReader(self.file, self.d, self.new, self.wrong, self.notes)
        reader.unread = self.unread
        pages = reader.pages(pages_of)
        if not pages:
            self.d.error(
                TEXT_SYNTAX,
                "the net has no page",
                Origin(self.file),
                hint="write `page Top`, and the places and transitions deeper below it",
            )
        return Document(
            file=self.file,
            sha256=sha256,
            tool="text",
            version="",
            format="",
            globbox=RawBlock("", tuple(items)),
            pages=pages,
            fusions=fusions_of(pages, self.new),
            options=self.options,
            elements=_counts(pages),
            unread=frozenset(self.unread),
        )

    # --- declarations ----------------------------------------------------------------------------

    def items(self, lines: Iterable[Line], is_top: bool) -> list[RawBlock | RawDeclaration]:
        """Declarations and blocks."""
        found: list[RawBlock | RawDeclaration] = []
        for line in _continued(lines):
            word = line.word.rstrip(";")
            rest = line.text[len(word) :]
            if word == "block":
                if "(*" in rest:
                    self.wrong(line, "a block has a name, and nothing more on its line", _NOTE)
                inside = self.items((x for x in line.below if not x.is_note), is_top=False)
                found.append(RawBlock(rest.strip().strip('"'), tuple(inside)))
            elif word == "standard":
                if rest.strip(" ;") or line.goes_on:
                    self.wrong(
                        line,
                        "`standard` stands on a line of its own, and nothing deeper below it",
                        "write further declarations on lines that are as deep as it",
                    )
                found += self.standard(line)
            elif word == "option" and is_top:
                self.option(line)
            elif word in _ONE_LINE:
                found += self.several(line)
            elif word == "use":
                source = self.text(line, len(word), "use")
                source = colsets.piece(source, 0, len(source.text.rstrip(" ;\n")))
                found.append(RawUse(self.new(), source, source.origin))
            elif word == "ml":
                found += self.ml(self.text(line, len(word), ""))
            elif word in _ML or line.text.startswith("(*"):
                found += self.ml(self.text(line, 0, ""))
            else:
                known = (*_HEADS, *sorted(_ML)) if is_top else (*_HEADS[1:], *sorted(_ML))
                near = "" if word in ("place", "trans", "subst") else did_you_mean(word, known)
                if word.startswith(("#", "//", "--")):
                    near = _NOTE
                self.wrong(
                    line,
                    f"no declaration and no page begins with `{line.word}`",
                    near
                    or "declarations begin with colset, var, val, fun, ...; what continues a line stands deeper than "
                    "it; places and transitions stand deeper than their `page`",
                )
        return found

    def text(self, line: Line, start: int, element: str) -> SourceText:
        """The text of a declaration, deeper lines included."""
        self.check_notes(line)
        return text_of(line, start, Origin(self.file, element=element, part="declaration"))

    def check_notes(self, line: Line) -> None:
        """Notes of the file cannot stand inside texts, where `#` is the selector of a record."""
        for note in notes_in(line, self.notes):
            self.wrong(note, *A_NOTE_INSIDE)

    def ml(self, source: SourceText) -> list[RawMl]:
        if not source.text.strip():
            return []
        return [RawMl(self.new(), source, source.origin)]

    def standard(self, line: Line) -> list[RawDeclaration]:
        """What each new net of CPN Tools declares: its colour sets and priorities."""
        found: list[RawDeclaration] = []
        for kind in colsets.SIMPLE:
            name = kind.upper()
            origin = Origin(
                self.file, line.number, line.column, "", f"colour set `{name}`", "", "declaration"
            )
            text = f"colset {name} = {kind};"
            found.append(
                RawColset(self.new(), name, kind, (), (), (), False, (), False, text, origin)
            )
        for name, value in PRIORITIES.items():
            origin = Origin(self.file, line.number, line.column, part="declaration")
            found.append(RawMl(self.new(), SourceText(f"val {name} = {value};", origin), origin))
        return found

    def option(self, line: Line) -> None:
        words = line.text.split()
        values = _OPTIONS.get(words[1].lower()) if len(words) == 3 else None
        if values is None or words[2].lower() not in values or line.below:
            self.wrong(
                line,
                f"`{line.text}` is no option that is known",
                "write `option realtimestamp true` where model times are reals",
            )
            return
        self.options[words[1].lower()] = words[2].lower()

    def several(self, line: Line) -> list[RawDeclaration]:
        """Colour sets, variables and references, several on a line after semicolons."""
        whole = self.text(line, 0, "")
        found: list[RawDeclaration] = []
        for start, end in _declared(whole.text):
            if not any(not c.isspace() for _, c, _ in plain(whole.text[start:end])):
                continue  # nothing but comments
            piece = colsets.piece(whole, start, end)
            try:
                found.append(self.one(piece))
            except NotReadableError as e:
                self.d.error(TEXT_SYNTAX, e.message, piece.origin_at(e.at), hint=e.hint)
                self.unread.update(_WORD.findall(piece.text))
        return found

    def one(self, text: SourceText) -> RawDeclaration:
        """A declaration without its semicolon."""
        word = text.text.split(None, 1)[0]
        if word == "colset":
            return colsets.colset(text, self.new())
        if word == "var":
            return colsets.variables(text, self.new())
        if word == "globref":
            return self.reference(text)
        return RawMl(self.new(), text, text.origin)

    def reference(self, text: SourceText) -> RawGlobref:
        """`globref NAME = EXPRESSION`."""
        equals = first(text.text, "=")
        name = text.text[len("globref") : equals].strip() if equals >= 0 else ""
        if not colsets.NAME.fullmatch(name) or not text.text[equals + 1 :].strip():
            raise NotReadableError(
                "a reference has a name and a first value", 0, "write `globref count = 0;`"
            )
        origin = replace(text.origin, element=f"reference `{name}`")
        value = colsets.piece(replace(text, origin=origin), equals + 1, len(text.text))
        return RawGlobref(self.new(), name, value, origin)


def _declared(text: str) -> Iterator[tuple[int, int]]:
    """Beginnings and ends of the declarations between semicolons, of which those in `let ... in ... end` are none."""
    begin = None
    for start, end in parts(text, ";"):
        begin = start if begin is None else begin
        words = _BLOCK_WORDS.findall(masked(text[begin:end]))
        opened = sum(w in ("let", "local", "struct", "sig") for w in words)
        if opened > words.count("end"):
            continue
        yield begin, end
        begin = None
    if begin is not None:
        yield begin, len(text)


def _continued(lines: Iterable[Line]) -> list[Line]:
    """The lines, each with those that go on with it though they are not deeper (`| f n = ...`, `end;`)."""
    found: list[Line] = []
    for line in lines:
        before = found[-1] if found else None
        if before is not None and _GOES_ON.match(line.text) and _is_open(before):
            before.below.append(line)
        else:
            found.append(line)
    return found


def _is_open(line: Line) -> bool:
    """Whether a line that is not deeper may go on with a declaration; colour sets and variables end with `;`."""
    if line.word in _ONE_LINE:
        return not [line, *line.deeper()][-1].text.endswith(";")
    return line.word in _ML or line.word == "ml"


def _counts(pages: tuple[RawPage, ...]) -> dict[str, int]:
    return {
        "pages": len(pages),
        "places": sum(len(p.places) for p in pages),
        "transitions": sum(len(p.transitions) for p in pages),
        "arcs": sum(len(p.arcs) for p in pages),
    }

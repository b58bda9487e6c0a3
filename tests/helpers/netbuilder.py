"""Nets for tests in a short text form, turned into real `.cpn` files (format 6), so that the reader is tested too.

    net Cell
      standard                 # UNIT BOOL INT INTINF TIME REAL STRING
      colset PART = with screw | nut timed;  var p: PART;  var n, m: INT;
      fun twice x = 2 * x
      globref count = 0;
      use "more.sml"
      option realtimestamp true
      page Top                                  # optional: without pages all is on the page "Top"
        place Buffer : INT = 1`1 ++ 1`5
        place "In Flight" fusion Shared : INT
        place Credits = 3                       # no colour set: UNIT by CPN Tools' rule
        trans Pick guard [n < m] delay @+3 priority P_HIGH code input (n); output (m); action n + 1
          guard [n < m]                         # clauses may also stand on lines of their own
          in Buffer : n                         # also: out, both, inhibit, reset
          out "In Flight" : if n > 0 then 1`n
                            else empty          # deeper lines continue a text
        subst Left = Sub (Inp -> Buffer, Outp -> "In Flight")
      page Sub
        place Inp port in : INT                 # port in | out | io
        place Outp port out : INT
        trans Move
          in Inp : n
          out Outp : n

Lines that begin with `# ` are comments. Indentation tells what belongs to what. In the text of a
colour set all of CPN Tools' kinds are possible. Elements get the ids ID1, ID2, ... in order of the
text; `place P id=ID7 ...` and `trans T id=ID8` choose one.

Use: `cpn(text)` for the bytes, `write(text, path)` for a file, `flat(text)` for the `FlatNet`
(fails on diagnostics), `diagnose(text)` for the diagnostics of all stages.
"""

from __future__ import annotations

import re
import tempfile
import textwrap
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from lxml import etree

if TYPE_CHECKING:
    from pn2code.diagnostics import Diagnostics
    from pn2code.net.flat import FlatNet

STANDARD = (
    "colset UNIT = unit;",
    "colset BOOL = bool;",
    "colset INT = int;",
    "colset INTINF = intinf;",
    "colset TIME = time;",
    "colset REAL = real;",
    "colset STRING = string;",
)
DOCTYPE = (
    '<!DOCTYPE workspaceElements PUBLIC "-//CPN//DTD CPNXML 1.0//EN" '
    '"http://cpntools.org/DTD/6/cpn.dtd">'
)
_ORIENTATION = {
    "in": "PtoT", "out": "TtoP", "both": "BOTHDIR", "inhibit": "Inhibitor", "reset": "Reset",
}  # fmt: skip
_NAME = re.compile(r'\s*(?:"([^"]*)"|([^\s:=(]+))')
_CLAUSE = re.compile(r"(?<![\w'])(guard|delay|priority|code)(?![\w'])")
_WORDS = {"unit", "bool", "int", "intinf", "time", "real", "string"}


def cpn(text: str) -> bytes:
    """The `.cpn` file of a net in the short form."""
    return _Builder().build(textwrap.dedent(text).strip("\n"))


def write(text: str, path: Path) -> Path:
    """Write the `.cpn` file; gives the path back."""
    path.write_bytes(cpn(text))
    return path


def flat(text: str, values: Mapping[str, str] | None = None) -> FlatNet:
    """The flat net; the test fails when there is any diagnostic that is an error."""
    net, d = load(text, values)
    messages = [f"{e.code}: {e.message} ({e.origin.describe()})" for e in d.errors]
    assert net is not None and not messages, "\n".join(messages)
    return net


def diagnose(text: str, values: Mapping[str, str] | None = None) -> Diagnostics:
    """The diagnostics of loading the net."""
    return load(text, values)[1]


def load(text: str, values: Mapping[str, str] | None = None) -> tuple[FlatNet | None, Diagnostics]:
    """Flat net or None, and the diagnostics. The file is `<net name>.cpn` in a temporary folder."""
    from pn2code.diagnostics import Diagnostics
    from pn2code.net.front import load as load_file
    from pn2code.semantics.evaluation.constants import compute

    d = Diagnostics()
    with tempfile.TemporaryDirectory() as folder:
        first = re.match(r"\s*net\s+(\w+)", text)
        path = write(text, Path(folder) / f"{first.group(1) if first else 'net'}.cpn")
        return load_file(path, d, values or {}, compute=compute), d


@dataclass
class _Line:
    """A line with the deeper ones that follow it."""

    indent: int
    text: str
    children: list[_Line] = field(default_factory=list)

    def whole(self) -> str:
        """The text with all deeper lines, their relative indentation kept."""
        lines = [self.text]
        self._add(self.children, lines)
        return "\n".join(lines)

    def _add(self, children: list[_Line], lines: list[str]) -> None:
        for c in children:
            lines.append(" " * max(0, c.indent - self.indent) + c.text)
            self._add(c.children, lines)


def _lines(text: str) -> list[_Line]:
    root = _Line(-1, "")
    stack = [root]
    for raw in text.split("\n"):
        stripped = raw.strip()
        if not stripped or stripped.startswith("# ") or stripped == "#":
            continue
        line = _Line(len(raw) - len(raw.lstrip()), stripped)
        while stack[-1].indent >= line.indent:
            stack.pop()
        stack[-1].children.append(line)
        stack.append(line)
    return root.children


def _name(text: str) -> tuple[str, str]:
    """A name (quoted or one word) and the rest."""
    match = _NAME.match(text)
    if match is None:
        raise ValueError(f"name expected: {text!r}")
    return match.group(1) if match.group(1) is not None else match.group(2), text[match.end() :]


def _split(text: str, separator: str) -> list[str]:
    """Split at separators outside parentheses, brackets and strings."""
    parts, depth, start, quoted = [], 0, 0, False
    for i, c in enumerate(text):
        if c == '"':
            quoted = not quoted
        if quoted:
            continue
        depth += (c in "([{") - (c in ")]}")
        if c == separator and depth == 0:
            parts.append(text[start:i])
            start = i + 1
    parts.append(text[start:])
    return [p.strip() for p in parts if p.strip()]


class _Builder:
    def __init__(self) -> None:
        self.count = 0
        self.fusions: dict[str, list[str]] = {}
        self.substitutions: list[tuple[etree._Element, etree._Element, str, str]] = []
        self.pages: dict[str, etree._Element] = {}
        self.places: dict[tuple[str, str], etree._Element] = {}
        self.rows: Counter[tuple[etree._Element, str]] = Counter()

    def id(self) -> str:
        self.count += 1
        return f"ID{self.count}"

    def build(self, text: str) -> bytes:
        root = etree.Element("workspaceElements")
        etree.SubElement(root, "generator", tool="CPN Tools", version="4.0.1", format="6")
        net = etree.SubElement(root, "cpnet")
        box = etree.SubElement(net, "globbox")
        options: dict[str, str] = {}
        statements: list[_Line] = []
        for line in _lines(text):
            if line.text.split()[0] == "net":
                statements += line.children
            else:
                statements.append(line)
        loose = None
        for line in statements:
            word, _, rest = line.text.partition(" ")
            if word == "page":
                name, _ = _name(rest)
                page = self.page(net, name)
                for child in line.children:
                    self.element(page, child)
            elif word in ("place", "trans", "subst"):
                loose = self.page(net, "Top") if loose is None else loose
                self.element(loose, line)
            elif word == "option":
                name, value = rest.split()
                options[name] = value
            else:
                self.declaration(box, line)
        if not self.pages:
            self.page(net, "Top")
        self.assign()
        for name, members in self.fusions.items():
            fusion = etree.SubElement(net, "fusion", id=self.id(), name=name)
            for member in members:
                etree.SubElement(fusion, "fusion_elm", idref=member)
        used = {s[2] for s in self.substitutions}
        instances = etree.SubElement(net, "instances")
        for name, page in self.pages.items():
            if name not in used:
                etree.SubElement(instances, "instance", id=self.id(), page=page.get("id", ""))
        block = etree.SubElement(net, "options")
        for name, value in options.items():
            option = etree.SubElement(block, "option", name=name)
            holder = etree.SubElement(option, "value")
            kind = "boolean" if value in ("true", "false") else "text"
            etree.SubElement(holder, kind).text = value
        etree.SubElement(net, "monitorblock", name="Monitors")
        return bytes(
            etree.tostring(root, encoding="iso-8859-1", xml_declaration=True, doctype=DOCTYPE)
        ).replace(b"><", b">\n<")

    # --- declarations ---

    def declaration(self, box: etree._Element, line: _Line) -> None:
        word, _, rest = line.text.partition(" ")
        if word == "standard":
            for text in STANDARD:
                self.colset(box, text.rstrip(";"))
        elif word == "block":
            block = etree.SubElement(box, "block", id=self.id())
            etree.SubElement(block, "id").text = rest.strip().strip('"')
            for child in line.children:
                self.declaration(block, child)
        elif word == "use":
            use = etree.SubElement(box, "use", id=self.id())
            etree.SubElement(use, "ml").text = rest.rstrip("; ")
        elif word in ("colset", "var", "globref"):
            for part in _split(line.whole(), ";"):
                kind = part.split()[0]
                if kind == "colset":
                    self.colset(box, part)
                elif kind == "var":
                    self.var(box, part)
                elif kind == "globref":
                    name, _, value = part[len("globref") :].partition("=")
                    node = etree.SubElement(box, "globref", id=self.id())
                    etree.SubElement(node, "id").text = name.strip()
                    etree.SubElement(node, "ml").text = value.strip()
                else:
                    self.ml(box, part + ";")
        else:
            self.ml(box, line.whole())

    def ml(self, box: etree._Element, text: str) -> None:
        node = etree.SubElement(box, "ml", id=self.id())
        node.text = text
        etree.SubElement(node, "layout").text = text

    def var(self, box: etree._Element, text: str) -> None:
        names, _, colset = text[len("var") :].partition(":")
        node = etree.SubElement(box, "var", id=self.id())
        etree.SubElement(etree.SubElement(node, "type"), "id").text = colset.strip()
        for name in names.split(","):
            etree.SubElement(node, "id").text = name.strip()
        etree.SubElement(node, "layout").text = text + ";"

    def colset(self, box: etree._Element, text: str) -> None:
        name, _, body = text[len("colset") :].partition("=")
        node = etree.SubElement(box, "color", id=self.id())
        etree.SubElement(node, "id").text = name.strip()
        body, _, declared = body.partition(" declare ")
        body = body.strip()
        if body == "timed" or body.endswith(" timed"):
            body = body[: -len("timed")].strip()
            etree.SubElement(node, "timed")
        if declared:
            declare = etree.SubElement(node, "declare")
            for item in declared.split(","):
                etree.SubElement(declare, "id").text = item.strip()
        _definition(node, body)
        etree.SubElement(node, "layout").text = " ".join(text.split()) + ";"

    # --- pages ---

    def page(self, net: etree._Element, name: str) -> etree._Element:
        page = etree.SubElement(net, "page", id=self.id())
        etree.SubElement(page, "pageattr", name=name)
        self.pages[name] = page
        return page

    def element(self, page: etree._Element, line: _Line) -> None:
        word, _, rest = line.text.partition(" ")
        if word == "place":
            self.place(page, line.whole()[len("place") :])
        elif word == "trans":
            self.transition(page, rest, line.children)
        elif word == "subst":
            self.subst(page, line.whole()[len("subst") :])
        else:
            raise ValueError(f"place, trans or subst expected: {line.text!r}")

    def node(self, page: etree._Element, tag: str, name: str, identity: str) -> etree._Element:
        node = etree.SubElement(page, tag, id=identity or self.id())
        self.rows[page, tag] += 1
        _drawing(node, 0.0 if tag == "place" else 200.0, -100.0 * self.rows[page, tag])
        etree.SubElement(node, "text").text = name
        shape = "ellipse" if tag == "place" else "box"
        etree.SubElement(node, shape, w="60.000000", h="40.000000")
        return node

    def inscribe(self, node: etree._Element, tag: str, text: str) -> None:
        inscription = etree.SubElement(node, tag, id=self.id())
        _drawing(inscription, 0.0, 0.0)
        etree.SubElement(inscription, "text", tool="CPN Tools", version="4.0.1").text = text

    def place(self, page: etree._Element, text: str) -> None:
        name, rest = _name(text)
        identity, port, fusion = "", "", ""
        while True:
            match = re.match(r"\s*(?:id=(\S+)|port\s+(in|out|io)\b|fusion\b)", rest)
            if match is None:
                break
            rest = rest[match.end() :]
            if match.group(1):
                identity = match.group(1)
            elif match.group(2):
                port = {"in": "In", "out": "Out", "io": "I/O"}[match.group(2)]
            else:
                fusion, rest = _name(rest)
        colset, initial = "", rest
        if rest.lstrip().startswith(":"):
            colset, _, initial = rest.lstrip()[1:].partition("=")
        elif rest.lstrip().startswith("="):
            initial = rest.lstrip()[1:]
        elif rest.strip():
            raise ValueError(f"cannot read place: {text!r}")
        node = self.node(page, "place", name, identity)
        self.places[(page.get("id", ""), name)] = node
        self.inscribe(node, "type", colset.strip())
        self.inscribe(node, "initmark", initial.strip())
        if port:
            inner = etree.SubElement(node, "port", id=self.id(), type=port)
            _drawing(inner, 0.0, 0.0)
        if fusion:
            etree.SubElement(node, "fusioninfo", id=self.id(), name=fusion)
            self.fusions.setdefault(fusion, []).append(node.get("id", ""))

    def transition(self, page: etree._Element, text: str, children: list[_Line]) -> None:
        name, rest = _name(text)
        identity = ""
        if match := re.match(r"\s*id=(\S+)", rest):
            identity, rest = match.group(1), rest[match.end() :]
        clauses = {"guard": "", "delay": "", "priority": "", "code": ""}
        _clauses(rest, clauses)
        arcs = []
        for child in children:
            word = child.text.split()[0]
            if word in clauses:
                clauses[word] = child.whole()[len(word) :].strip()
            elif word in _ORIENTATION:
                arcs.append((word, child.whole()[len(word) :]))
            else:
                raise ValueError(f"arc or clause expected: {child.text!r}")
        node = self.node(page, "trans", name, identity)
        node.set("explicit", "false")
        self.inscribe(node, "cond", clauses["guard"])
        self.inscribe(node, "time", clauses["delay"])
        self.inscribe(node, "code", clauses["code"])
        self.inscribe(node, "priority", clauses["priority"])
        for word, arc in arcs:
            place, inscription = _name(arc)
            inscription = inscription.strip()
            if inscription and not inscription.startswith(":"):
                raise ValueError(f"`:` expected after the place: {arc!r}")
            self.arc(page, word, node, place, inscription[1:].strip())

    def arc(
        self, page: etree._Element, word: str, transition: etree._Element, place: str, text: str
    ) -> None:
        target = self.places.get((page.get("id", ""), place))
        arc = etree.SubElement(page, "arc", id=self.id(), orientation=_ORIENTATION[word], order="1")
        _drawing(arc, 0.0, 0.0)
        etree.SubElement(arc, "transend", idref=transition.get("id", ""))
        # an unknown place gives a dangling arc: tests of bad input want that
        etree.SubElement(arc, "placeend", idref=place if target is None else target.get("id", ""))
        self.inscribe(arc, "annot", text)

    def subst(self, page: etree._Element, text: str) -> None:
        name, rest = _name(text)
        if not rest.strip().startswith("="):
            raise ValueError(f"`=` expected after the name: {text!r}")
        target, assignments = _name(rest.strip()[1:])
        node = self.node(page, "trans", name, "")
        node.set("explicit", "false")
        self.substitutions.append((page, node, target, assignments.strip().strip("()")))

    def assign(self) -> None:
        """Fill in the substitutions, now that all pages are known."""
        words = {"In": "in", "Out": "out", "I/O": "both"}
        for page, node, target, assignments in self.substitutions:
            sub = self.pages.get(target)
            pairs = []
            for assignment in _split(assignments, ","):
                port_name, _, socket_name = assignment.partition("->")
                port_key, socket_key = _name(port_name)[0], _name(socket_name)[0]
                port = self.places.get((sub.get("id", "") if sub is not None else "", port_key))
                socket = self.places.get((page.get("id", ""), socket_key))
                port_id = port_key if port is None else port.get("id", "")
                socket_id = socket_key if socket is None else socket.get("id", "")
                pairs.append(f"({port_id},{socket_id})")
                if port is not None and socket is not None:
                    kind = port.find("port")
                    word = words[kind.get("type", "I/O")] if kind is not None else "both"
                    self.arc(page, word, node, socket_key, "")
            subpage = sub.get("id", "") if sub is not None else target
            subst = etree.SubElement(node, "subst", subpage=subpage, portsock="".join(pairs))
            info = etree.SubElement(subst, "subpageinfo", id=self.id(), name=target)
            _drawing(info, 0.0, 0.0)


def _clauses(text: str, clauses: dict[str, str]) -> None:
    """`guard .. delay .. priority .. code ..` on one line; `code` takes all that follows."""
    match = _CLAUSE.search(text)
    if match is None:
        if text.strip():
            raise ValueError(f"guard, delay, priority or code expected: {text!r}")
        return
    word = match.group(1)
    following = None if word == "code" else _CLAUSE.search(text, match.end())
    end = following.start() if following else len(text)
    clauses[word] = text[match.end() : end].strip()
    if following:
        _clauses(text[end:], clauses)


def _drawing(node: etree._Element, x: float, y: float) -> None:
    etree.SubElement(node, "posattr", x=f"{x:.6f}", y=f"{y:.6f}")
    etree.SubElement(node, "fillattr", colour="White", pattern="", filled="false")
    etree.SubElement(node, "lineattr", colour="Black", thick="1", type="Solid")
    etree.SubElement(node, "textattr", colour="Black", bold="false")


def _range(parent: etree._Element, text: str) -> None:
    low, _, high = text.partition("..")
    etree.SubElement(parent, "ml").text = low.strip()
    etree.SubElement(parent, "ml").text = high.strip()


def _ids(parent: etree._Element, names: list[str]) -> None:
    for name in names:
        etree.SubElement(parent, "id").text = name.strip()


def _definition(node: etree._Element, body: str) -> None:
    """The element of a colour set's definition."""
    word, _, rest = body.partition(" ")
    rest = rest.strip()
    limit = rest[len("with ") :].strip() if rest.startswith("with ") else ""
    if word in _WORDS:
        kind = etree.SubElement(node, word)
        if not limit:
            return
        inner = etree.SubElement(kind, "with")
        if word in ("unit", "bool"):
            _ids(inner, limit.strip("()").split(","))
        elif word == "string":
            letters, _, lengths = limit.partition(" and ")
            _range(inner, letters)
            if lengths:
                _range(etree.SubElement(inner, "and"), lengths)
        else:
            _range(inner, limit)
    elif word == "with":
        _ids(etree.SubElement(node, "enum"), rest.split("|"))
    elif word == "index":
        stem, _, limits = rest.partition(" with ")
        kind = etree.SubElement(node, "index")
        _range(kind, limits)
        _ids(kind, [stem])
    elif word == "product":
        _ids(etree.SubElement(node, "product"), rest.split("*"))
    elif word == "record":
        kind = etree.SubElement(node, "record")
        for part in rest.split("*"):
            _ids(etree.SubElement(kind, "recordfield"), part.split(":"))
    elif word == "list":
        base, _, lengths = rest.partition(" with ")
        kind = etree.SubElement(node, "list")
        if lengths:
            _range(etree.SubElement(kind, "with"), lengths)
        _ids(kind, [base])
    elif word == "union":
        kind = etree.SubElement(node, "union")
        for part in rest.split("+"):
            label, _, of = part.partition(":")
            inner = etree.SubElement(kind, "unionfield")
            _ids(inner, [label])
            if of:
                _ids(etree.SubElement(inner, "type"), [of])
    elif word == "subset":
        base, how, what = re.split(r"\s+(by|with)\s+", rest, maxsplit=1)
        kind = etree.SubElement(node, "subset")
        _ids(kind, [base])
        etree.SubElement(etree.SubElement(kind, how), "ml").text = what
    else:
        _ids(etree.SubElement(node, "alias"), [body])

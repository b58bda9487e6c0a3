"""Emits robot scripts: `RobotIR` -> `robot1.tdl`, with the lines that implement each net element.

Declarations stand in aligned columns with the net element beside them; each transition begins with a
comment that names it. What was printed is parsed and checked again before it leaves: a script that the
checker refuses is a bug of ours, not a file.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.render import report
from pn2code.emission.environment import render
from pn2code.emission.output import Block, OutputFile
from pn2code.robot_scripts.ir import (
    Chain,
    Comment,
    Declared,
    Element,
    Line,
    Node,
    Region,
    Repeat,
    RobotIR,
)
from pn2code.robot_scripts.names import identifier
from pn2code.tdl import tree as t
from pn2code.tdl.check import check
from pn2code.tdl.parse import parse
from pn2code.tdl.pretty import INDENT, expression, held, quoted, simple, type_name

WIDTH = 100
"""Comments of the header are broken at this column."""


def emit(
    irs: Iterable[RobotIR], *, source: str, digest: str, version: str
) -> tuple[OutputFile, ...]:
    """One script a robot."""
    return tuple(_emit(ir, source, digest, version) for ir in irs)


def _emit(ir: RobotIR, source: str, digest: str, version: str) -> OutputFile:
    path = f"{ir.name}.tdl"
    sections = [
        _Section("shared files", *_files(ir.files)),
        _Section("values named in the net", *_constants(ir.constants)),
        _Section("variables", *_variables(ir.variables)),
    ]
    sections = [s for s in sections if s.lines]
    body = _Printer()
    body.nodes(ir.body, INDENT)
    procedures = []
    for name, nodes in ir.procedures:
        printer = _Printer()
        printer.nodes(nodes, INDENT)
        procedures.append(_Procedure(name, printer))
    text = render(
        "tdl/robot.tdl.j2",
        file=comment(path),
        version=version,
        source=comment(source),
        digest=digest,
        kind=ir.kind.capitalize(),
        name=comment(ir.name),
        page=comment(ir.page),
        instance=comment(ir.instance),
        notes=_notes(ir),
        program=identifier(ir.name),
        sections=sections,
        procedures=[{"name": p.name, "lines": p.printer.lines} for p in procedures],
        body=body.lines,
    )
    blocks = _blocks(text, ir, sections, procedures, body)
    _must_check(path, text)
    return OutputFile(path, text, tuple(blocks))


def comment(text: str) -> str:
    """Text for inside a comment: one line, nothing that a terminal would act on."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _notes(ir: RobotIR) -> list[str]:
    states = ", ".join(comment(s.phrase.removeprefix("place ")) for s in ir.states)
    notes = _wrapped("The program always stands at one of the places", f"{states}.")
    for x in ir.left_out:
        notes += _wrapped(
            "Left out: ", f"{comment(x.element.phrase)}, because {comment(x.reason)}."
        )
    return notes


def _wrapped(lead: str, text: str) -> list[str]:
    lines = [lead.rstrip()]
    for word in text.replace(" (ID", "\0(ID").split():
        word = word.replace("\0", " ")
        if len(lines[-1]) + len(word) + 4 > WIDTH:
            lines.append("  " + word)
        else:
            lines[-1] += " " + word
    return lines


# --- declarations ------------------------------------------------------------------------------


@frozen
class _Section:
    """Declarations of one kind: lines, and the net element of each."""

    title: str
    lines: list[str]
    elements: list[Element]


def _aligned(rows: Sequence[Sequence[str]], elements: Sequence[Element]) -> list[str]:
    """Rows as columns, each with its net element as a comment."""
    if not rows:
        return []
    widths = [max(len(r[i]) for r in rows) for i in range(len(rows[0]))]
    lines = [" ".join(c.ljust(w) for c, w in zip(r, widths, strict=True)).rstrip() for r in rows]
    longest = max(len(x) for x in lines)
    return [
        f"{x.ljust(longest)}  -- {comment(e.phrase)}" if e.phrase else x
        for x, e in zip(lines, elements, strict=True)
    ]


def _files(declared: Sequence[Declared]) -> tuple[list[str], list[Element]]:
    rows, elements = [], []
    for d in declared:
        x = d.declaration
        assert isinstance(x, t.File)
        rows.append((x.direction.value, x.name, quoted(x.path), ":", held(x.types)))
        elements.append(d.element)
    return _aligned(rows, elements), elements


def _constants(declared: Sequence[Declared]) -> tuple[list[str], list[Element]]:
    rows, elements = [], []
    for d in declared:
        x = d.declaration
        assert isinstance(x, t.Const)
        rows.append(("const", x.name, "=", expression(x.value)))
        elements.append(d.element)
    return _aligned(rows, elements), elements


def _variables(declared: Sequence[Declared]) -> tuple[list[str], list[Element]]:
    rows, elements = [], []
    for d in declared:
        x = d.declaration
        assert isinstance(x, t.Variable)
        initial = f":= {expression(x.initial)}" if x.initial is not None else ""
        rows.append(("var", x.name, ":", type_name(x.type), initial))
        elements.append(d.element)
    return _aligned(rows, elements), elements


# --- statements --------------------------------------------------------------------------------


@record
class _Printer:
    """Prints nodes and remembers which lines (from 0) belong to which region."""

    lines: list[str] = field(default_factory=list)
    regions: list[tuple[Region, int, int]] = field(default_factory=list)

    def nodes(self, nodes: Iterable[Node], indent: str) -> None:
        for node in nodes:
            match node:
                case Comment(text):
                    self.gap()
                    self.lines.append(f"{indent}-- {comment(text)}")
                case Line(statement):
                    if isinstance(statement, t.Label):
                        self.gap()
                    self.lines.append(indent + simple(statement))
                case Region(body=body):
                    before = len(self.lines)
                    self.nodes(body, indent)
                    first = (
                        before + (self.lines[before] == "") if before < len(self.lines) else before
                    )
                    if (
                        first > 0
                        and first == before
                        and self.lines[first - 1].lstrip().startswith(("if ", "elsif "))
                    ):
                        first -= 1  # the condition is the transition's guard
                    if first < len(self.lines):
                        self.regions.append((node, first, len(self.lines) - 1))
                case Chain(branches, otherwise):
                    self.gap()
                    for i, (condition, body) in enumerate(branches):
                        word = "elsif" if i else "if"
                        self.lines.append(f"{indent}{word} {expression(condition)} then")
                        self.nodes(body, indent + INDENT)
                    if otherwise:
                        self.lines.append(f"{indent}else")
                        self.nodes(otherwise, indent + INDENT)
                    self.lines.append(f"{indent}end if")
                case Repeat(condition, body):
                    self.gap()
                    head = (
                        f"while {expression(condition)} loop" if condition is not None else "loop"
                    )
                    self.lines.append(indent + head)
                    self.nodes(body, indent + INDENT)
                    self.lines.append(f"{indent}end loop")

    def gap(self) -> None:
        """An empty line, unless a block has just begun or there is one already."""
        if not self.lines or self.lines[-1] == "":
            return
        last = self.lines[-1].strip()
        opened = (
            last.endswith((" then", " loop")) or last in ("loop", "else") or last.startswith("--")
        )
        closed = last in ("end loop", "end if")
        if not opened or closed:
            self.lines.append("")


@frozen
class _Procedure:
    name: str
    printer: _Printer


def _blocks(
    text: str,
    ir: RobotIR,
    sections: Sequence[_Section],
    procedures: Sequence[_Procedure],
    body: _Printer,
) -> list[Block]:
    """Which lines implement which element. The template only puts the parts one after the other."""
    lines = text.split("\n")
    blocks = []
    at = 0
    for s in sections:
        at = lines.index(f"-- {s.title}", at) + 1
        for element in s.elements:
            at += 1
            blocks.append(Block(element.name, element.kind, element.origin, at, at))
    for p in procedures:
        at = lines.index(f"procedure {p.name}", at) + 1
        blocks += _regions(p.printer, at)
    at = lines.index("begin", at) + 1
    blocks += _regions(body, at)
    blocks.append(Block(ir.instance, "page", ir.origin, at, at + len(body.lines) + 1))
    return sorted(blocks, key=lambda b: (b.first, b.last, b.element))


def _regions(printer: _Printer, offset: int) -> list[Block]:
    return [
        Block(r.element, r.kind, r.origin, offset + first + 1, offset + last + 1)
        for r, first, last in printer.regions
    ]


def _must_check(path: str, text: str) -> None:
    d = Diagnostics()
    program = parse(SourceText(text, Origin(path, 1, 1)), d)
    if program is None or check(program, d, None) is None:
        raise RuntimeError(f"the script made for {path} is wrong:\n{report(d.errors)}\n\n{text}")

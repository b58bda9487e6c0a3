"""Golden cases of diagnostics: small wrong nets, each with the full text of what is said about it.

A file of cases begins with declarations that all its nets share; then come cases:

    [case misspelled variable on an arc]
    in INT : nn
    [out]
    error[unbound-identifier]: `nn` is not declared
    ...

What stands above `[out]` is a net in the short form of `helpers.netbuilder`, without its first line,
or one of these abbreviations, whose text may go on in the following lines:

    in COLSET : text        an input arc from a place `P`
    out COLSET : text       an output arc to a place `P`; `(n, s)` is bound by another arc
    initial COLSET = text   the initial marking of a place `P`
    guard text              also: delay, priority, code; `(n, s)` is bound by an arc, `m` goes out
    decl text               declarations (one a line as in netbuilder, `fun` and `val` may go on)

A section `[edit]` changes the bytes of the `.cpn` file: lines `old => new`, with Python's escapes
(`\\x00`, `\\n`), `keep N` to cut the file off after N bytes, and `file` to replace it as a whole by
the lines that follow.

`python -m helpers.diagnostic_cases` (in `tests`, or `./dev golden`) writes the `[out]` parts anew.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.render import report
from pn2code.net.front import load

FOLDER = Path(__file__).resolve().parent.parent / "golden" / "diagnostics"
_SHORT = re.compile(r"(in|out|initial|guard|delay|priority|code|decl)\b ?")
_START = """
  place Start : PACK
  place Done : INT
"""


@dataclass(frozen=True)
class Case:
    """One wrong net: `name` says what the user did, `net` and `edits` are as written, `out` is expected."""

    file: str
    name: str
    net: str
    edits: str
    out: str
    shared: str

    def data(self) -> bytes:
        """The `.cpn` file."""
        text = "net Net\n" + _indented(self.shared) + expand(self.net)
        return edited(cpn(text), self.edits)

    def actual(self) -> str:
        """What is said about it."""
        d = Diagnostics()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "net.cpn"
            path.write_bytes(self.data())
            load(path, d)
            return report(d.sorted()).replace(str(path), "net.cpn")


def _indented(text: str, by: str = "  ") -> str:
    return "".join(f"{by}{line}\n" for line in text.splitlines())


def expand(net: str) -> str:
    """The body of a net, abbreviations replaced."""
    match = _SHORT.match(net)
    if match is None:
        return _indented(net)
    word, rest = match.group(1), net[match.end() :]
    if word == "decl":
        return _indented(rest) + "  place P : INT\n"
    if word == "initial":
        return _indented(f"place P : {rest}")
    colset, _, text = rest.partition(" : ")
    text = text.replace("\n", "\n          ")
    if word == "in":
        return f"  place P : {colset}\n  trans T\n    in P : {text}\n"
    if word == "out":
        return (
            f"{_START}  place P : {colset}\n  trans T\n    in Start : (n, s)\n    out P : {text}\n"
        )
    rest = rest.replace("\n", "\n          ")
    outgoing = "    out Done : m\n" if word == "code" else ""
    return f"{_START}  trans T\n    {word} {rest}\n    in Start : (n, s)\n{outgoing}"


def edited(data: bytes, edits: str) -> bytes:
    """The file after the changes of an `[edit]` section."""
    lines = iter(edits.splitlines())
    for line in lines:
        if line == "file":
            return _bytes("\n".join(lines))
        if line.startswith("keep "):
            data = data[: int(line.removeprefix("keep "))]
            continue
        old, arrow, new = line.partition(" => ")
        if not arrow or _bytes(old) not in data:
            raise ValueError(f"cannot apply {line!r}")
        data = data.replace(_bytes(old), _bytes(new), 1)
    return data


def _bytes(text: str) -> bytes:
    """Python's escapes to bytes; other characters as UTF-8."""
    return re.sub(
        rb"\\(?:x([0-9a-f]{2})|(n|\\))",
        lambda m: bytes([int(m.group(1), 16)]) if m.group(1) else {b"n": b"\n", b"\\": b"\\"}[m.group(2)],
        text.encode(),
    )  # fmt: skip


def read(path: Path) -> tuple[str, list[Case]]:
    """The shared declarations of a file, and its cases."""
    head, *parts = re.split(r"^\[case (.*)\]\n", path.read_text(encoding="utf-8"), flags=re.M)
    cases = []
    for name, body in zip(parts[::2], parts[1::2], strict=True):
        net, _, out = body.partition("[out]\n")
        net, _, edits = net.partition("[edit]\n")
        cases.append(
            Case(path.stem, name, net.rstrip("\n"), edits.rstrip("\n"), out.rstrip("\n"), head)
        )
    return head, cases


def files() -> Iterator[Path]:
    """The files of cases."""
    yield from sorted(FOLDER.glob("*.cases"))


def renewed(path: Path) -> str:
    """The text of a file with what is said today."""
    head, cases = read(path)
    text = head
    for case in cases:
        text += f"[case {case.name}]\n{case.net}\n"
        if case.edits:
            text += f"[edit]\n{case.edits}\n"
        text += f"[out]\n{case.actual()}\n\n"
    return text.rstrip("\n") + "\n"


def main() -> None:
    """Renew all files, or those named on the command line."""
    for path in [FOLDER / f"{n}.cases" for n in sys.argv[1:]] or files():
        path.write_text(renewed(path), encoding="utf-8")


if __name__ == "__main__":
    main()

"""What the verbs share: options, printing diagnostics, exit codes."""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from pn2code.base.writable import why_file_unwritable
from pn2code.diagnostics import Diagnostic, Diagnostics, Note, Origin, Severity, render


class Exit:
    """Exit codes of every verb (docs/cli.md)."""

    OK = 0
    MODEL = 1
    """the net, the cell or a property is wrong"""
    USAGE = 2
    """wrong usage, or a file or tool that is missing"""
    INCONCLUSIVE = 3
    """a limit was hit"""
    INTERNAL = 70
    """a bug in pn2code"""
    INTERRUPTED = 130
    """Ctrl-C, or a signal to end"""
    UNREAD = 141
    """the reader of the output went before the end, as for a program that SIGPIPE ends"""


class BackendChoice(StrEnum):
    """What carries the arms."""

    BULLET = "bullet"
    FAKE = "fake"


class Format(StrEnum):
    """How diagnostics are printed."""

    FULL = "full"
    CONCISE = "concise"
    JSON = "json"


FormatOption = Annotated[
    Format,
    typer.Option("--format", help="The form in which diagnostics are printed.", show_default=True),
]

NetArgument = Annotated[
    Path, typer.Argument(help="A .cpn, .cpnt or .pnml file, a cell.toml, or a folder.")
]
CellArgument = Annotated[Path, typer.Argument(help="A cell.toml, or its folder.")]


def finite(number: float | None) -> float | None:
    """A number of the command line, checked: for Python `nan` and `inf` are numbers, and `nan` is in every range."""
    if number is not None and not math.isfinite(number):
        raise typer.BadParameter(f"{number} is not a finite number")
    return number


def seconds_option(help_text: str) -> Any:
    """The option that limits the time of a command, with what happens then."""
    return typer.Option(metavar="S", min=0.0, callback=finite, help=help_text)


MaxSecondsOption = Annotated[
    float | None, seconds_option("Stop after S seconds, without an answer (exit code 3).")
]
"""Of verbs that say nothing of what they have not done to the end."""
JobsOption = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        min=1,
        max=64,
        help="Explore and sweep with N processes; what is found does not depend on it.  (default: one for each core)",
    ),
]
"""Of verbs that sweep moves."""
MaxStatesOption = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        min=1,
        help="Look at N states of the cell at most.  (default: as many as memory holds; never more than 3,000,000)",
    ),
]
"""Of verbs that go through the states of a cell one by one."""


def port_option(help_text: str) -> Any:
    """The option `--port P` of a page on this machine."""
    return typer.Option("--port", metavar="P", min=0, max=65535, help=help_text)


PAGES = (".html", ".htm")
"""Endings of pages."""


def check_kind(path: Path | None, kinds: tuple[str, ...], option: str) -> None:
    """Refuses a file whose ending, which says the form of what is written, is none of these; None: there is none.

    Raises:
        typer.BadParameter: it has another one.
    """
    if path is not None and path.suffix.lower() not in kinds:
        *others, last = (kind for kind in kinds if kind)
        possible = f"{', '.join(others)} or {last}"
        raise typer.BadParameter(f"`{path}` does not end in {possible}", param_hint=option)


def check_writable(path: Path | None, option: str) -> None:
    """Refuses a file that could not be written in the end, before any work is done for it; None: there is none.

    Raises:
        typer.BadParameter: it is a folder, or its folder is missing or must not be written.
    """
    if path is None:
        return
    why = why_file_unwritable(path)
    if why:
        raise typer.BadParameter(f"cannot write `{path}`: {why}", param_hint=option)


def parse_values(settings: list[str]) -> dict[str, str]:
    """`NAME=VALUE` options as CPN ML texts; a value is CPN ML (`true`, `~3`, `"text"`)."""
    values = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        if (
            not equals
            or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_']*", name.strip())
            or not text.strip()
        ):
            raise typer.BadParameter(f"`{setting}`: NAME=VALUE is expected, e.g. limit=3")
        values[name.strip()] = text.strip()
    return values


SetOption = Annotated[
    list[str],
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Replace the value of a `val` of the net. This option may be given several times.",
    ),
]

OUTPUT_FLAGS = ("-o", "--out", "--output")
"""Where results go, in every verb that writes them."""

UncheckedOption = Annotated[
    bool,
    typer.Option(
        "--unchecked",
        help="Take the supervisor without checking it against its execution scheme (docs/execution.md).",
    ),
]

FilesOption = Annotated[
    Path | None,
    typer.Option(
        "--files",
        metavar="DIR",
        exists=True,
        file_okay=False,
        help="The folder below which the net may read and write files. Without this option it has no files.",
    ),
]

InputOption = Annotated[
    Path | None,
    typer.Option(
        "--input",
        metavar="PATH",
        help="Begin with the input files in this folder, or with this one file, instead of those beside cell.toml.",
    ),
]

INT_BITS = (31, 64)
DEFAULT_INT_BITS = 31


def _int_bits(text: str | int) -> int:
    if str(text) not in map(str, INT_BITS):
        raise typer.BadParameter(f"`{text}`: integers have 31 bits, as in CPN Tools, or 64")
    return int(text)


IntBitsOption = Annotated[
    int,
    typer.Option(
        "--int-bits",
        metavar="31|64",
        parser=_int_bits,
        help="The number of bits of an integer; larger numbers raise Overflow. [default: 31, as in CPN Tools]",
        show_default=False,
    ),
]
SeedOption = Annotated[
    int, typer.Option("--seed", metavar="K", help="The seed of all random numbers.", min=0)
]
DEFAULT_SEED = 1
"""What verbs with random numbers start from."""


class Engine(StrEnum):
    """Which of the two implementations of the semantics plays a net."""

    COMPILED = "compiled"
    REFERENCE = "reference"


EngineOption = Annotated[
    Engine,
    typer.Option(
        "--engine",
        help="Use the compiled net or the reference token game.",
        show_default=True,
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON object, for programs.")]


MOST_SHOWN = 60
"""More diagnostics than that are not for people."""


def _has_colours() -> bool:
    """Whether messages are coloured: on a terminal, unless NO_COLOR is set (https://no-color.org)."""
    return sys.stderr.isatty() and not os.environ.get("NO_COLOR")


def print_diagnostics(items: Iterable[Diagnostic], form: Format = Format.FULL) -> None:
    """Print them to stderr, in colour on a terminal.

    Notes are for programs, and for people when something is wrong on a page that they are about: they may be its
    cause. Of very many, people get the first, errors before warnings.
    """
    items = list(items)
    omitted = ""
    if form is Format.FULL:
        items = [i for i in items if not i.is_accepted]
        wrong = {p for i in items if i.severity is Severity.ERROR for p in _pages(i)}
        items = [i for i in items if i.severity is not Severity.NOTE or wrong & _pages(i)]
        items, omitted = _first(list(_folded(items)))
    text = render.report(items, form.value, render.coloured if _has_colours() else render.plain)
    if text:
        print(text + omitted, file=sys.stderr)


def print_but_known(d: Diagnostics, net: Path, form: Format = Format.FULL) -> None:
    """Print what a verb that was asked for something else has to say besides.

    People have seen the warnings about the net itself in `check`, and get their number. Programs get all.
    """
    items = d.sorted()
    known = [i for i in items if i.severity is Severity.WARNING and i.code in _of_nets()]
    if form is not Format.FULL or not known:
        print_diagnostics(items, form)
        return
    print_diagnostics((i for i in items if i not in known), form)
    count = "is a warning" if len(known) == 1 else f"are {len(known)} warnings"
    print(f"There {count} about the net itself: see `pn2code check {net}`.", file=sys.stderr)


def _of_nets() -> frozenset[str]:
    """The codes of what `check` says of any net; things that a run stops at are worth repeating."""
    # The list of verbs is printed without loading these.
    from pn2code.ml import codes as ml_codes
    from pn2code.net import codes as net_codes
    from pn2code.reading import codes as reading_codes

    named = (v for codes in (net_codes, ml_codes, reading_codes) for v in vars(codes).values())
    texts = frozenset(v for v in named if isinstance(v, str))
    return frozenset(c for c in texts if not c.startswith("unsupported-"))


_PLACES = 4
"""Further places of a message that are named."""


def _folded(items: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """What is said in the same words of several places is said once, of the first, with the others in a note."""
    groups: dict[tuple[object, ...], list[Diagnostic]] = {}
    for i in items:
        groups.setdefault((i.severity, i.code, i.message, i.hint), []).append(i)
    for first, *others in groups.values():
        places = [_place(i.origin) for i in others[:_PLACES]]
        rest = len(others) - len(places)
        also = f"the same {len(others)} times more: {'; '.join(places)}" + (
            f"; and {rest} more" if rest else ""
        )
        once = also.replace("1 times more", "once more", 1) if len(others) == 1 else also
        yield replace(first, notes=(*first.notes, Note(once))) if others else first


def _place(at: Origin) -> str:
    """Line and element."""
    words = at.describe()
    return at.location() + (f" ({words})" if words else "")


def _pages(item: Diagnostic) -> set[str]:
    """The pages that a diagnostic and its notes are about."""
    origins = (item.origin, *(n.origin for n in item.notes if n.origin is not None))
    return {o.page for o in origins} - {""}


def _first(items: list[Diagnostic]) -> tuple[list[Diagnostic], str]:
    """As many as people want to see, in their order, and what is said of the others."""
    if len(items) <= MOST_SHOWN:
        return items, ""
    order = list(Severity)
    urgent = sorted(range(len(items)), key=lambda n: (order.index(items[n].severity), n))
    shown = [items[n] for n in sorted(urgent[:MOST_SHOWN])]
    left = len(items) - MOST_SHOWN
    return shown, f"\n\nThere are {left} more; `--format concise` shows all of them, one line each."


def stop(d: Diagnostics, form: Format = Format.FULL) -> NoReturn:
    """Print what was found and leave with the exit code for a wrong model (or a missing file)."""
    print_diagnostics(d.sorted(), form)
    if form is Format.FULL:
        print(f"\n{render.count(d)}", file=sys.stderr)
    raise typer.Exit(code_of(d))


_OUTSIDE = frozenset(
    {
        "file-missing",
        "file-unreadable",
        "geometry-no-library",
        "input-file",
        "input-missing",
        "report-unwritable",
        "swarm-unavailable",
        "tool-missing",
    }
)
"""Codes about files that were given, and tools of the machine, rather than about the model."""


def code_of(d: Diagnostics) -> int:
    """The exit code for these errors: a file or tool is missing or a file wrong, or the model is."""
    return Exit.USAGE if any(e.code in _OUTSIDE for e in d.errors) else Exit.MODEL

"""The names of a cell's files: each has to work in the shared directory, in the generated folder and in the scripts.

check_files(config, d)      # reports names that are taken, too long, or that two channels share
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import PurePath
from unicodedata import normalize

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics, Origin

MOST_BYTES = 160
"""Of a channel's file. Its temporary file is `.FILE.PARTY.tmp`, and file systems take 255 bytes."""
MOST_NAME = 80
"""Characters of the name of a robot or device."""
GENERATED = ("Makefile", "cell_config.c", "manifest.json", "net.c", "net.h", "runtime")


def one_name(name: str) -> str:
    """The same for all names that some file systems (of Windows and macOS, USB sticks) take for one."""
    return normalize("NFC", name).casefold()


def check_files(config: CellConfig, d: Diagnostics) -> None:
    """Reports what is wrong with the names of channels' and input files, and of those who run programs."""
    parties = ("supervisor", *(p.name for p in config.programs))
    for p in config.programs:
        if len(p.name) > MOST_NAME:
            text = f"the name `{p.name}` has more than {MOST_NAME} characters"
            d.error(codes.CELL_VALUE, text, p.origin, hint="choose a shorter one")
    statuses = {one_name(f"{name}.status") for name in parties}
    seen: dict[str, str] = {}
    for i, channel in enumerate(config.channels):
        at = config.locator.origin("channel", i, "file")
        _one(channel.file, at, d)
        if one_name(channel.file) in statuses:
            d.error(
                codes.CELL_VALUE,
                f"the channel's file `{channel.file}` is the status file of a program",
                at,
                hint="docs/protocol.md lists the files of the shared directory: choose another name",
            )
        for name in dict.fromkeys((PurePath(channel.file).stem, channel.file)):
            other = seen.setdefault(name, channel.file)
            # Where they differ in the ending alone, that has been said in reading them.
            if other != channel.file and PurePath(other).stem != PurePath(channel.file).stem:
                d.error(
                    codes.CELL_VALUE,
                    f"the channels of the files `{other}` and `{channel.file}` would both be called `{name}`",
                    at,
                    hint="a channel is named by its file, with and without its ending: choose another name",
                )
                break
    taken = {one_name(name) for name in (*GENERATED, *(f"{name}.tdl" for name in parties))}
    for i, entry in enumerate(config.inputs):
        at = config.locator.origin("input", i, "file")
        _one(entry.file, at, d)
        if one_name(entry.file) in taken:
            d.error(
                codes.CELL_VALUE,
                f"the input file `{entry.file}` has the name of a generated file, beside which a copy of it lies",
                at,
                hint="choose another name",
            )


def _one(name: str, at: Origin, d: Diagnostics) -> None:
    for text, hint in faults(name):
        d.error(codes.CELL_VALUE, f"`{name}` cannot be the name of a file: {text}", at, hint=hint)


def faults(name: str) -> Iterator[tuple[str, str]]:
    """What is wrong with the name of a file, and what to do."""
    if not all(c.isprintable() for c in name):
        yield "it has characters that cannot be printed", "use letters, digits, `_`, `-` and `.`"
    if len(name.encode("utf-8", "surrogatepass")) > MOST_BYTES:
        yield f"it has more than {MOST_BYTES} bytes", "choose a shorter one"
    if name != name.strip():
        yield "it begins or ends with a blank", "leave the blank out"

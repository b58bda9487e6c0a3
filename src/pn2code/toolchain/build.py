"""Building a generated folder with `make`, and telling of a C compiler's error where it belongs: at the net element.

program = build(folder, files, d)       # folder/supervisor, or None and diagnostics
"""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.codes import register
from pn2code.emission.output import Block, OutputFile
from pn2code.toolchain.orphans import tools_of_ours

TOOL_MISSING = register(
    "tool-missing",
    "a C compiler or make is missing",
    "Generated C is built by `make` and a C11 compiler (gcc or clang). On Debian: apt-get install gcc libc6-dev make. "
    "Another compiler is chosen by the environment variable CC. Without any, that of the Python package `ziglang` is "
    "used: pip install 'pn2code[compiler]'.",
)
C_ERROR = register(
    "c-error",
    "the C compiler refused generated code",
    "This is a bug in pn2code, not in the net: generated code compiles without a warning. The message names the net "
    "element whose code is refused; the file build.log in the output folder has everything the compiler said.",
)
BUILD_FAILED = register(
    "build-failed",
    "`make` failed",
    "The file build.log in the output folder has everything that make and the compiler said. A full disk "
    "is a usual reason.",
)

WITHOUT_ROOT = "elsewhere, for the compiler: pip install 'pn2code[compiler]'"
LOG = "build.log"
_COMPLAINT = re.compile(r"^([\w./-]+):(\d+):(\d+): (?:fatal )?error: (.*)$", re.MULTILINE)
_MOST = 10


def find_compiler() -> str | None:
    """The C compiler as a shell would start it: `CC`, the first of cc, gcc, clang that there is, or that of ziglang."""
    for name in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        if name and shutil.which(shlex.split(name)[0]):
            return name
    return shlex.join(_zig("cc")) or None


def find_archiver() -> tuple[str, ...]:
    """What puts object files together as a library, as a list: `ar`, or that of ziglang; () if there is none."""
    found = shutil.which("ar")
    return (found,) if found else _zig("ar")


def _zig(tool: str) -> tuple[str, ...]:
    """A tool of the Python package `ziglang`, which has a C compiler for every machine; () if it is not installed."""
    if importlib.util.find_spec("ziglang") is None:
        return ()
    return sys.executable, "-m", "ziglang", tool


def build(
    folder: Path, files: Iterable[OutputFile], d: Diagnostics, *, target: str = "supervisor"
) -> Path | None:
    """Builds a target of the folder's Makefile.

    Args:
        folder: where the files were written.
        files: the generated files, for their blocks.
        target: "supervisor", which is deployed; "supervisor.traced", the same with `--trace`; or "simulate".

    Returns:
        The program, or None after a diagnostic.
    """
    compiler, make = find_compiler(), shutil.which("make")
    if compiler is None or make is None:
        missing = [name for name, tool in (("a C compiler", compiler), ("make", make)) if not tool]
        packages = [p for p, tool in (("gcc libc6-dev", compiler), ("make", make)) if not tool]
        d.error(
            TOOL_MISSING,
            f"{' and '.join(missing)} {'are' if len(missing) > 1 else 'is'} not installed",
            Origin(str(folder)),
            hint=f"on Debian or Ubuntu type: sudo apt-get install {' '.join(packages)}"
            + ("" if compiler else f"; {WITHOUT_ROOT}"),
        )
        return None
    status, output = _made(
        [make, "-s", "-C", str(folder), f"-j{os.cpu_count() or 1}", f"CC={compiler}", target]
    )
    if status == 0:
        (folder / LOG).unlink(missing_ok=True)
        return folder / target
    log = folder / LOG
    try:
        log.write_text(output, encoding="utf-8")
        where = f"everything it said is in {log}"
    except OSError as problem:
        where = f"the log could not be written: {problem.strerror}"
    report_failure(folder, output, tuple(files), where, d)
    return None


def _made(command: list[str]) -> tuple[int, str]:
    """The exit code of `make`, and all that it said. It ends with this process, and so do its compilers."""
    with tools_of_ours() as group:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            process_group=group.number,
            env={**os.environ, "LC_ALL": "C"},
        )
        try:
            said, errors = process.communicate()
        except BaseException:
            group.end(process)
            process.communicate()
            raise
    return process.returncode, said + errors


def report_failure(
    folder: Path, output: str, files: tuple[OutputFile, ...], where: str, d: Diagnostics
) -> None:
    """One diagnostic for each complaint about generated code; one for the build if there is none.

    Args:
        folder: where it was built.
        output: what the tools said.
        files: the generated files, for their blocks.
        where: a sentence that says where more can be read.
        d: gets the errors.
    """
    blocks = {f.path: f.blocks for f in files}
    complaints = _COMPLAINT.findall(output)[:_MOST]
    for file, line, column, message in complaints:
        path = file.removeprefix("./")
        block = _block(blocks.get(path, ()), int(line))
        note = f"{folder / path}:{line}:{column}"
        if block is None:
            d.error(
                C_ERROR, f"{path}: {message}", Origin(str(folder / path), int(line)), notes=[where]
            )
        else:
            d.error(
                C_ERROR,
                f"the C code of {block.kind} `{block.element}` is refused: {message}",
                block.origin,
                notes=[note, where],
                hint="this is a bug in pn2code; please report it with the net",
            )
    if not complaints:
        last = [line for line in output.splitlines() if line.strip()][-3:]
        d.error(BUILD_FAILED, "`make` failed", Origin(str(folder)), notes=[*last, where])


def _block(blocks: Iterable[Block], line: int) -> Block | None:
    inside = [b for b in blocks if b.first <= line <= b.last]
    return min(inside, key=lambda b: b.last - b.first, default=None)

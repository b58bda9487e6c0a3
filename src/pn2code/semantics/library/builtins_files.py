"""Built-in functions on files and paths: `TextIO`, `OS`, `Output`, `CommandLine`.

Records are tuples in SML's order of the labels: `{dir, file}` is `(dir, file)`, `{isAbs, vol, arcs}` is
`(arcs, isAbs, vol)`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.evaluation.files import CHUNK, FileProblem, InStream, NameStream, OutStream
from pn2code.semantics.library.builtins_scan import scan_text
from pn2code.semantics.values.data import NONE, UNIT, Data, MlException, Value, exception, some

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]
Parts = tuple[tuple[str, ...], bool, str]


# --- exceptions ----------------------------------------------------------------------------------


def _system(problem: FileProblem) -> Data:
    """`OS.SysErr (message, SOME error)`; an error is its name."""
    return exception("SysErr", (problem.message, some(problem.code)))


def _io(name: str, function: str, cause: Data) -> MlException:
    """`IO.Io {name, function, cause}`: the fields in the order cause, function, name."""
    return MlException(exception("Io", (cause, function, name)))


def _opening(function: str, opening: Callable[[Evaluator, str], Value]) -> Function:
    def opened(e: Evaluator, name: str) -> Value:
        try:
            return opening(e, name)
        except FileProblem as problem:
            raise _io(name, function, _system(problem)) from None

    return opened


def _on_files(work: Callable[[Evaluator, Any], Value]) -> tuple[int, Function]:
    """A function of OS.FileSys: problems are `OS.SysErr`."""

    def function(e: Evaluator, argument: Any) -> Value:
        try:
            return work(e, argument)
        except FileProblem as problem:
            raise MlException(_system(problem)) from None

    return 1, function


# --- streams -------------------------------------------------------------------------------------


def _write(function: str, stream: OutStream, text: str) -> Value:
    if stream.closed:
        raise _io(stream.name, function, exception("ClosedStream"))
    stream.write(text)
    return UNIT


def write(e: Evaluator, stream: OutStream, text: str) -> Value:
    """Writes a colour or multi-set."""
    return _write("output", stream, text)


def _close_in(e: Evaluator, stream: InStream) -> Value:
    stream.closed = True
    return UNIT


def _close_out(e: Evaluator, stream: OutStream) -> Value:
    if stream not in (e.files.stdout, e.files.stderr):
        stream.close()
    return UNIT


def _input_number(e: Evaluator, p: tuple[InStream, int]) -> str:
    if p[1] < 0:
        raise MlException(exception("Size"))
    return p[0].take(p[1])


def _can_input(e: Evaluator, p: tuple[InStream, int]) -> Data:
    if p[1] < 0:
        raise MlException(exception("Size"))
    return some(min(p[1], len(p[0].rest)))


def _scan_stream(e: Evaluator, scan: Value, stream: InStream) -> Task:
    """`TextIO.scanStream`: what was scanned is read; nothing, where there was no value."""
    rest = stream.rest
    found = yield scan_text(e, scan, rest)
    if found is None:
        return NONE
    stream.take(found[1])
    return some(found[0])


def _some_text(text: str | None) -> Data:
    return some(text) if text else NONE


TEXT_IO: dict[str, tuple[int, Function]] = {
    "openIn": (1, _opening("openIn", lambda e, name: e.files.open_in(name))),
    "openOut": (1, _opening("openOut", lambda e, name: e.files.open_out(name))),
    "openAppend": (
        1,
        _opening("openAppend", lambda e, name: e.files.open_out(name, append=True)),
    ),
    "openString": (1, lambda e, text: InStream("<string>", text)),
    "closeIn": (1, _close_in),
    "closeOut": (1, _close_out),
    "input": (1, lambda e, stream: stream.take(CHUNK)),
    "input1": (1, lambda e, stream: _some_text(stream.take(1))),
    "inputN": (1, _input_number),
    "inputLine": (1, lambda e, stream: _some_text(stream.line())),
    "inputAll": (1, lambda e, stream: stream.take(len(stream.rest))),
    "canInput": (1, _can_input),
    "lookahead": (1, lambda e, stream: _some_text(stream.rest[:1])),
    "scanStream": (2, _scan_stream),
    "endOfStream": (1, lambda e, stream: not stream.rest),
    "output": (1, lambda e, p: _write("output", p[0], p[1])),
    "output1": (1, lambda e, p: _write("output1", p[0], p[1])),
    "outputSubstr": (1, lambda e, p: _write("outputSubstr", p[0], str(p[1]))),
    "flushOut": (1, lambda e, stream: UNIT),
    "print": (1, lambda e, text: _write("print", e.files.stdout, text)),
}


# --- paths ---------------------------------------------------------------------------------------


def parts(path: str) -> Parts:
    """`OS.Path.fromString`: arcs, whether absolute, volume."""
    absolute = path.startswith("/")
    rest = path[1:] if absolute else path
    return (tuple(rest.split("/")) if rest else ()), absolute, ""


def joined(p: Parts) -> str:
    """`OS.Path.toString`; raises Path when an absolute path would become relative or the reverse."""
    arcs, absolute, volume = p
    if volume or (not absolute and arcs and arcs[0] == ""):
        raise MlException(exception("Path"))
    if any("/" in arc for arc in arcs):
        raise MlException(exception("InvalidArc"))
    return ("/" if absolute else "") + "/".join(arcs)


def split(path: str) -> tuple[str, str]:
    """Folder and file."""
    arcs, absolute, volume = parts(path)
    if not arcs:
        return joined((arcs, absolute, volume)), ""
    return joined((arcs[:-1], absolute, volume)), arcs[-1]


def _join(p: tuple[str, str]) -> str:
    folder, file = p
    if "/" in file:
        raise MlException(exception("InvalidArc"))
    arcs, absolute, volume = parts(folder)
    if not arcs and not absolute and file == "":
        return ""
    if arcs and arcs[-1] == "":
        arcs = arcs[:-1]  # the folder ends with a slash
    return joined(((*arcs, file), absolute, volume)) if (arcs or file or absolute) else file


def _extension(path: str) -> tuple[str, Data]:
    """Path without extension, and the extension: what follows the last point of the file, if both are not empty."""
    folder, file = split(path)
    stem, point, extension = file.rpartition(".")
    if not point or not stem or not extension:
        return path, NONE
    return path[: len(path) - len(extension) - 1], some(extension)


def _with_extension(p: tuple[str, Data]) -> str:
    return f"{p[0]}.{p[1].argument}" if p[1].argument else p[0]


def canonical(path: str) -> str:
    """Without empty arcs, `.`, and `..` that can be done away with; `.` for nothing."""
    arcs, absolute, _ = parts(path)
    kept: list[str] = []
    for arc in arcs:
        if arc == ".." and kept and kept[-1] != "..":
            kept.pop()
        elif arc == ".." and absolute:
            continue
        elif arc not in ("", "."):
            kept.append(arc)
    if not kept and not absolute:
        return "."
    return joined((tuple(kept), absolute, ""))


def parent(path: str) -> str:
    """`OS.Path.getParent`."""
    arcs, absolute, volume = parts(path)
    if not arcs:
        return "/" if absolute else ".."
    last = arcs[-1]
    if last == ".":
        return joined(((*arcs[:-1], ".."), absolute, volume))
    if last == "..":
        return joined(((*arcs, ".."), absolute, volume))
    if last == "":
        return joined(((*arcs[:-1], ".."), absolute, volume))
    if len(arcs) == 1:
        return "/" if absolute else "."
    return joined((arcs[:-1], absolute, volume))


def concatenated(p: tuple[str, str]) -> str:
    """`OS.Path.concat`; raises Path when the second is absolute."""
    first, second = parts(p[0]), parts(p[1])
    if second[1]:
        raise MlException(exception("Path"))
    arcs = first[0][:-1] if first[0] and first[0][-1] == "" else first[0]
    return joined(((*arcs, *second[0]), first[1], ""))


def _absolute(p: tuple[str, str]) -> str:
    """`{path, relativeTo}`."""
    if parts(p[0])[1]:
        return p[0]
    if not parts(p[1])[1]:
        raise MlException(exception("Path"))
    return canonical(concatenated((p[1], p[0])))


def _relative(p: tuple[str, str]) -> str:
    """`{path, relativeTo}`."""
    if not parts(p[1])[1]:
        raise MlException(exception("Path"))
    if not parts(p[0])[1]:
        return p[0]
    to, base = parts(canonical(p[0]))[0], parts(canonical(p[1]))[0]
    common = 0
    while common < min(len(to), len(base)) and to[common] == base[common]:
        common += 1
    arcs = (*[".."] * (len(base) - common), *to[common:])
    return joined((arcs, False, "")) if arcs else "."


PATHS: dict[str, Function] = {
    "fromString": lambda e, path: parts(path),
    "toString": lambda e, p: joined(p),
    "validVolume": lambda e, p: p[1] == "",
    "getVolume": lambda e, path: "",
    "getParent": lambda e, path: parent(path),
    "splitDirFile": lambda e, path: split(path),
    "joinDirFile": lambda e, p: _join(p),
    "dir": lambda e, path: split(path)[0],
    "file": lambda e, path: split(path)[1],
    "splitBaseExt": lambda e, path: _extension(path),
    "joinBaseExt": lambda e, p: _with_extension(p),
    "base": lambda e, path: _extension(path)[0],
    "ext": lambda e, path: _extension(path)[1],
    "mkCanonical": lambda e, path: canonical(path),
    "isCanonical": lambda e, path: path == canonical(path),
    "mkAbsolute": lambda e, p: _absolute(p),
    "mkRelative": lambda e, p: _relative(p),
    "isAbsolute": lambda e, path: parts(path)[1],
    "isRelative": lambda e, path: not parts(path)[1],
    "isRoot": lambda e, path: path == "/",
    "concat": lambda e, p: concatenated(p),
    "fromUnixPath": lambda e, path: path,
    "toUnixPath": lambda e, path: path,
}


# --- folders -------------------------------------------------------------------------------------


def _done(work: Callable[[Evaluator, Any], object]) -> tuple[int, Function]:
    """A function of OS.FileSys that gives the unit value."""

    def function(e: Evaluator, argument: Any) -> Value:
        work(e, argument)
        return UNIT

    return _on_files(function)


def _next_name(e: Evaluator, names: NameStream) -> Data:
    if names.closed:
        raise FileProblem("the folder is closed", "badf")
    if names.at >= len(names.names):
        return NONE
    names.at += 1
    return some(names.names[names.at - 1])


def _rewind(e: Evaluator, names: NameStream) -> None:
    names.at = 0


def _close_names(e: Evaluator, names: NameStream) -> None:
    names.closed = True


def _real_path(e: Evaluator, name: str) -> str:
    full = e.files.full_path(name)
    return full if parts(name)[1] else _relative((full, str(e.files.here)))


FOLDERS: dict[str, tuple[int, Function]] = {
    "getDir": (1, lambda e, unit: "/" if e.files.here is None else str(e.files.here)),
    "chDir": _done(lambda e, name: e.files.change_folder(name)),
    "mkDir": _done(lambda e, name: e.files.make_folder(name)),
    "rmDir": _done(lambda e, name: e.files.remove_folder(name)),
    "remove": _done(lambda e, name: e.files.remove(name)),
    # a record in the order new, old
    "rename": _done(lambda e, p: e.files.rename(p[1], p[0])),
    "isDir": _on_files(lambda e, name: e.files.is_folder(name)),
    # links are followed before anything is looked at
    "isLink": _on_files(lambda e, name: e.files.full_path(name) == ""),
    "fileSize": _on_files(lambda e, name: e.files.size(name)),
    "access": (1, lambda e, p: e.files.may(p[0], tuple(mode.name for mode in p[1]))),
    "fullPath": _on_files(lambda e, name: e.files.full_path(name)),
    "realPath": _on_files(_real_path),
    "openDir": _on_files(lambda e, name: e.files.names(name)),
    "readDir": _on_files(_next_name),
    "rewindDir": _done(_rewind),
    "closeDir": _done(_close_names),
}

OUTPUT_FOLDER = "output"


def _make_output(e: Evaluator, unit: Value) -> Value:
    if not e.files.may(OUTPUT_FOLDER, ()):
        e.files.make_folder(OUTPUT_FOLDER)
    return UNIT


CONSTANTS: dict[str, Value] = {
    "OS.Path.parentArc": "..",
    "OS.Path.currentArc": ".",
    "OS.Process.success": 0,
    "OS.Process.failure": 1,
}

DEPENDING: dict[str, Callable[[Evaluator], Value]] = {
    "TextIO.stdIn": lambda e: e.files.stdin,
    "TextIO.stdOut": lambda e: e.files.stdout,
    "TextIO.stdErr": lambda e: e.files.stderr,
}
"""Values that depend on the run."""

FUNCTIONS: dict[str, tuple[int, Function]] = {
    **{f"TextIO.{name}": entry for name, entry in TEXT_IO.items()},
    **{f"OS.Path.{name}": (1, f) for name, f in PATHS.items()},
    **{f"OS.FileSys.{name}": entry for name, entry in FOLDERS.items()},
    "OS.Process.isSuccess": (1, lambda e, status: status == 0),
    "OS.Process.getEnv": (1, lambda e, name: NONE),
    "OS.Process.sleep": (1, lambda e, time: UNIT),
    "OS.errorMsg": (1, lambda e, code: code),
    "OS.errorName": (1, lambda e, code: code),
    "CommandLine.name": (1, lambda e, unit: "cpn"),
    "CommandLine.arguments": (1, lambda e, unit: ()),
    **{
        f"Output.{name}": (1, lambda e, unit: OUTPUT_FOLDER)
        for name in ("getSimOutputDir", "getTopOutputDir", "getRepOutputDir")
    },
    "Output.getModelDir": (1, lambda e, unit: "."),
    **{
        f"Output.{name}": _on_files(_make_output)
        for name in ("initSimOutputDir", "initTopOutputDir", "initRepOutputDir")
    },
    **{
        f"CPN'PerfReport.select{kind}Stats": (1, lambda e, choice: ())
        for kind in ("Untimed", "Timed")
    },
    "Output.myConcat": (1, lambda e, p: concatenated(p)),
}
"""Full name -> number of curried arguments, function."""

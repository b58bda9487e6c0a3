"""MISRA C:2012 in the deployed supervisor of the riveting cell: required rules are broken only as docs/misra.md says.

    python -m tools.misra [FOLDER]         # or `make misra`
    python -m tools.misra --record         # what was found is written down, where that is not yet done

cppcheck's addon (the wheel `cppcheck-py`; `tools/misra_addon.py`) looks at the generated `net.c` and `cell_config.c`,
the supervisor's own sources and the channels. The rows of docs/misra.md name a rule, a file and a reason; a finding
without a row and a row without a finding are both mistakes. Findings of advisory rules are counted, not listed.

Looking takes a quarter of a minute, so what was found is committed (`RECORD`), with a digest of all that it depends on:
where one byte of that is another, it is looked at anew. `./dev golden` writes it.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import importlib.util
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "misra.md"
COMMITTED = ROOT / "generated" / "riveting"
RECORD = ROOT / "tests" / "golden" / "misra.json"
ADDON = Path(__file__).with_name("misra_addon.py")
"""It also compares files with each other (ctu), which cppcheck asks of its own addon without being told."""
SOURCES = (
    "net.c",
    "cell_config.c",
    *(f"runtime/src/supervisor/supervisor{part}.c" for part in ("", "_cell", "_input", "_play")),
    "runtime/src/channel/pn_channel.c",
    "runtime/src/channel/pn_channel_files.c",
)
ADVISORY = frozenset((
    "1.2", "2.3", "2.4", "2.5", "2.6", "2.7", "4.2", "5.9", "8.7", "8.9", "8.11", "8.13", "10.5", "11.4",
    "11.5", "12.1", "12.3", "12.4", "13.3", "13.4", "15.1", "15.4", "15.5", "17.5", "17.8", "18.4", "18.5",
    "19.2", "20.1", "20.5", "20.10", "21.12",
))  # fmt: skip
"""By MISRA C:2012; all others are required or mandatory, and are treated as such."""
MANDATORY = frozenset((
    "9.1", "12.5", "13.6", "17.3", "17.4", "17.6", "19.1", "21.13", "21.17", "21.18", "21.19", "21.20", "22.2",
    "22.4", "22.5", "22.6",
))  # fmt: skip
"""No deviation from these is possible."""
SYSTEM = (
    *(
        f"-D{name}=1"
        for name in (
            "ENOENT",
            "ENOSPC",
            "EFBIG",
            "EDQUOT",
            "EWOULDBLOCK",
            "EACCES",
            "EROFS",
            "EPERM",
        )
    ),
    *('-DPRIu64="lu"', '-DPRIu32="u"', "-Dmax_align_t=long double", "-DUINT64_C(c)=c##ULL"),
    *("-DFLT_EVAL_METHOD=0", "-DSIZE_MAX=0xFFFFFFFFFFFFFFFFUL"),
)
"""What the system's headers define; the addon does not read them. Without `__GNUC__` it reads what is standard C."""
_FINDING = re.compile(r"^(\S+?):(\d+):(\d+): misra-c2012-(\d+\.\d+)$")
_ROW = re.compile(r"^\| (\d+\.\d+) \| `([^`]+)` \| (\S.*) \|$", re.MULTILINE)


Findings = tuple[Counter[tuple[str, str]], Counter[str]]


def digest(folder: Path) -> str:
    """Of all that findings depend on: sources, how they are compiled, how it is looked, and who looks."""
    files = sorted(path for path in folder.rglob("*") if path.suffix in (".c", ".h"))
    named = [(path.relative_to(folder).as_posix(), path) for path in files]
    named += [(path.name, path) for path in (folder / "Makefile", Path(__file__), ADDON)]
    found = hashlib.sha256(importlib.metadata.version("cppcheck-py").encode())
    for name, path in named:
        data = path.read_bytes()
        found.update(f"\0{name}\0{len(data)}\0".encode())
        found.update(data)
    return found.hexdigest()


def recorded(folder: Path, record: Path = RECORD) -> Findings | None:
    """What was found when all was as it is now, None: something has changed since, or nothing is written down."""
    if not record.exists():
        return None
    kept = json.loads(record.read_text(encoding="utf-8"))
    if kept["of"] != digest(folder):
        return None
    required = Counter({(rule, file): count for rule, file, count in kept["required"]})
    return required, Counter(kept["advisory"])


def write_down(folder: Path, found: Findings, record: Path = RECORD) -> None:
    """For `recorded`."""
    required, advisory = found
    kept = {
        "of": digest(folder),
        "required": [[rule, file, count] for (rule, file), count in sorted(required.items())],
        "advisory": dict(sorted(advisory.items())),
    }
    record.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def findings(folder: Path) -> Findings:
    """Of required rules by rule and file, of advisory ones by rule.

    Raises:
        RuntimeError: cppcheck could not look at everything.
    """
    makefile = (folder / "Makefile").read_text(encoding="utf-8")
    needs = re.findall(r"-DPN_\w+", re.findall(r"^NEEDS :=.*$", makefile, re.MULTILINE)[0])
    command = [
        *(str(Path(sys.executable).with_name("cppcheck")), "-q", "--enable=style"),
        f"--addon={json.dumps({'script': str(ADDON), 'ctu': True})}",
        *("--library=posix", "--std=c11", "--template={file}:{line}:{column}: {id}"),
        *("-Iruntime/include", "-I.", "-DPN_OWN_ONLY", *needs, *SYSTEM, "-j2", *SOURCES),
    ]
    found_at = importlib.util.find_spec("cppcheck")
    if found_at is None or found_at.origin is None:
        raise RuntimeError("cppcheck is not installed: ./dev setup")
    addons = Path(found_at.origin).parent / "data" / "addons"
    done = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MISRA_ADDONS": str(addons)},
    )
    required: Counter[tuple[str, str]] = Counter()
    advisory: Counter[str] = Counter()
    for line in dict.fromkeys(done.stderr.splitlines()):
        if "misra-config" in line or "Bailing out" in line or "syntaxError" in line:
            raise RuntimeError(f"cppcheck: {line}")
        if found := _FINDING.match(line):
            file, row, column, rule = found.groups()
            text = (folder / file).read_text(encoding="utf-8").splitlines()[int(row) - 1]
            if rule == "7.3" and not text[int(column) - 1 : int(column)].isdigit():
                continue  # the addon takes the identifier `full` for hexadecimal digits with a suffix
            if rule in ADVISORY:
                advisory[rule] += 1
            else:
                required[rule, Path(file).name] += 1
    if done.returncode != 0 or not advisory:
        raise RuntimeError(
            f"cppcheck did not do its work: {done.stdout[-500:]}{done.stderr[-500:]}"
        )
    return required, advisory


def mistakes(required: Counter[tuple[str, str]], page: str) -> list[str]:
    """Findings that the page does not name, and rows that nothing needs."""
    rows = [(rule, file) for rule, file, _ in _ROW.findall(page)]
    found = [
        f"rule {r} is broken in {f} ({required[r, f]} times)"
        for r, f in sorted(set(required) - set(rows))
    ]
    found += [
        f"the deviation from {r} in {f} is not needed any more"
        for r, f in sorted(set(rows) - set(required))
    ]
    found += [
        f"there is no deviation from the mandatory rule {r}" for r, _ in rows if r in MANDATORY
    ]
    return found


def main() -> int:
    """0: nothing is open."""
    if sys.argv[1:] == ["--record"]:
        if recorded(COMMITTED) is None:
            write_down(COMMITTED, findings(COMMITTED))
        return 0
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else COMMITTED
    required, advisory = findings(folder)
    for (rule, file), count in sorted(required.items()):
        print(f"{rule:>6} {file:24} {count:4}")
    print("advisory:", ", ".join(f"{rule} {count}" for rule, count in sorted(advisory.items())))
    open_ = mistakes(required, PAGE.read_text(encoding="utf-8"))
    for one in open_:
        print(f"misra: {one}", file=sys.stderr)
    return 1 if open_ else 0


if __name__ == "__main__":
    raise SystemExit(main())

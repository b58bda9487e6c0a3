"""`run.json`: the description of a run as a file, which version it has, and what it must have to be shown.

    write(described, Path("run"))
    described = read(Path("run/run.json"))

docs/replay.md says what is in it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pn2code.base.clearance_words import figure
from pn2code.base.conditioning import condition_text
from pn2code.base.os_reason import os_reason

Json = dict[str, Any]

VERSION = 2
_WITHOUT_ARMS = (1, VERSION)
"""In version 1 arms have meshes of another form; all else is the same."""
NAME = "run.json"
LARGEST = 500_000_000
"""Bytes of a description."""

_NEEDED: Mapping[str, type] = {
    "kind": str, "title": str, "clock": str, "end": object, "verdict": dict, "facts": list, "net": dict,
    "course": dict,
}  # fmt: skip


class NoDescription(Exception):
    """A file is not a description that can be shown; the message says why and what to do (a user's matter)."""


def text_of(described: Json) -> str:
    """The file's text: the same description gives the same bytes."""
    return json.dumps(described, ensure_ascii=False, separators=(",", ":"), allow_nan=False) + "\n"


def read(path: Path) -> Json:
    """The description in a file, or in a run's folder.

    Raises:
        NoDescription: there is none, or another version.
    """
    file = path / NAME if path.is_dir() else path
    try:
        if file.stat().st_size > LARGEST:
            raise NoDescription(f"`{file}` has more than {LARGEST:,} bytes")
        text = file.read_text(encoding="utf-8")
        data = json.loads(text, parse_constant=_no_number, parse_float=_finite)
    except FileNotFoundError:
        raise NoDescription(
            f"there is no `{file}`: `pn2code run` writes it; of a trace, name the net as well"
        ) from None
    except OSError as problem:
        raise NoDescription(f"cannot read `{file}`: {os_reason(problem)}") from None
    except (ValueError, RecursionError) as problem:
        raise NoDescription(f"`{file}` is not JSON: {problem}") from None
    why = problem_of(data)
    if why is not None:
        raise NoDescription(f"`{file}` {why}")
    return dict(data)


def _no_number(word: str) -> float:
    raise ValueError(f"`{word}` is no number of JSON")


def _finite(digits: str) -> float:
    if math.isfinite(value := float(digits)):
        return value
    raise ValueError(f"the number `{digits[:40]}` is too large")


def problem_of(data: Any) -> str | None:
    """Why data are not a description of this version; None: they are."""
    if not isinstance(data, dict) or not isinstance(data.get("pn2code"), dict):
        return "is not the description of a run: its member `pn2code` is missing"
    version = data["pn2code"].get("run")
    known = (VERSION,) if data.get("cell") else _WITHOUT_ARMS
    if type(version) is not int or version not in known:
        return f"is a description of version {version!r}, but version {VERSION} is expected: run the cell again"
    for name, kind in _NEEDED.items():
        if not isinstance(data.get(name), kind) or isinstance(data.get(name), bool):
            return f"is incomplete: its `{name}` is missing or of another type"
    for part, names in (("net", ("pages", "instances", "places", "transitions")),
                        ("course", ("steps", "time", "transition", "changes", "keys", "tokens", "texts"))):  # fmt: skip
        for name in names:
            if name not in data[part]:
                return f"is incomplete: its `{part}.{name}` is missing"
    return _damaged(data)


def _damaged(data: Json) -> str | None:
    """Which of the members that are said in words is not of its form."""
    course = data["course"]
    steps, rows = course["steps"], course["transition"]
    if not isinstance(rows, dict) or type(steps) is not int or steps != rows.get("length"):
        return "is damaged: its `course.steps` is not the number of its steps"
    for name in ("final", "failed"):
        places = data["verdict"].get(name, [])
        if not isinstance(places, list) or not all(isinstance(place, str) for place in places):
            return f"is damaged: its `verdict.{name}` is no list of names"
    refused = course.get("refused")
    if refused is not None and not (
        isinstance(refused, dict)
        and type(refused.get("step")) is int
        and isinstance(refused.get("transition"), str)
        and isinstance(refused.get("why"), str)
    ):
        return "is damaged: its `course.refused` does not say which step, and why"
    return None


def facts(summary: Mapping[str, Any]) -> list[list[str]]:
    """What is said of a run in a few lines: [what, how much]."""
    rows = [
        ["layout", str(summary["layout"])],
        ["backend", str(summary["backend"])],
        ["cycle time", f"{summary['cycle_seconds']:.2f} s"],
    ]
    rows += [[label, str(number)] for label, number in summary["counts"].items()]
    rows += [
        [f"least clearance, {name}", figure(entry, is_timed=False)]
        for name, entry in summary["clearances"].items()
    ]
    rows += [
        [f"worst condition number, {name}", condition_text(entry["worst"], 1)]
        for name, entry in summary["conditioning"].items()
    ]
    rows += [
        [f"{name} busy", f"{100 * entry['utilisation']:.0f} %"]
        for name, entry in summary["robots"].items()
    ]
    return [row for row in rows if row[1]]

"""Large explorations, done once for all tests of all workers that ask the same explorer the same.

`generate` and `verify` of an example with a million markings explore the same program with the same questions. It is
the process of the explorer that is not started a second time; all before and after it is done by each test.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from helpers.session import alone
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.meanwhile import Meanwhile

Run = Callable[..., dict[str, Any] | None]
LARGE = 100_000
"""Markings of an exploration that is remembered. Smaller ones are done each time."""
TABLES = ("--elements", "--dependency", "--queries")
"""Files whose contents count."""
WITHOUT_EFFECT = ("--memory", "--parent", "--progress-every")
"""On an exploration that has come to its end."""
LIMITS = ("--max-states", "--multiset-limit")
"""Without effect where they are not reached."""
RUNS = ("--trace-to", "--error-trace-to", "--query-trace-to")
"""Where files are written. An exploration that has written one is not remembered."""
OUTSIDE = ("--max-seconds", "--late-seconds", "--spill", "--write-graph", "--approximate")
"""With one of these it is always explored."""


class Cached:
    """`explorer_process._run`, which starts no process for a large exploration that has been done before.

    Args:
        run: what is remembered.
        folder: where it is kept, for other workers as well.
    """

    def __init__(self, run: Run, folder: Path) -> None:
        self._run = run
        self._folder = folder

    def __call__(
        self,
        net: FlatNet,
        program: Path,
        arguments: Sequence[str],
        options: ExploreOptions,
        limits: Limits,
        d: Diagnostics,
        search: Meanwhile | None,
    ) -> dict[str, Any] | None:
        def explored() -> dict[str, Any] | None:
            return self._run(net, program, arguments, options, limits, d, search)

        if search is not None or limits.memory is not None or any(x in OUTSIDE for x in arguments):
            return explored()
        key = key_of(program, arguments)
        with alone(self._folder, key) as kept:  # whoever wants the same waits for it
            if kept.exists():
                known: dict[str, Any] = json.loads(kept.read_text(encoding="utf-8"))
                return known if is_answered(known, arguments, limits) else explored()
            before = written(arguments)
            found = explored()
            if found is not None and is_worth_it(found) and written(arguments) == before:
                part = kept.with_suffix(".part")  # whoever is killed leaves nothing half
                part.write_text(json.dumps(found), encoding="utf-8")
                part.replace(kept)
            return found


def key_of(program: Path, arguments: Sequence[str]) -> str:
    """Of all that a complete exploration depends on; the name of a program has the digest of what it was made from."""
    parts = [program.name]
    passed = iter(arguments)
    for option in passed:
        if option in TABLES:
            parts += [option, Path(next(passed)).read_text(encoding="ascii")]
        elif option in WITHOUT_EFFECT + LIMITS + RUNS:
            next(passed)
        else:
            parts.append(option)
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def is_worth_it(found: Mapping[str, Any]) -> bool:
    """Whether it is large, has come to its end, and left nothing out."""
    is_whole = found["complete"] and found["error"] is None and found["nodes"] >= LARGE
    return bool(is_whole) and all(
        len(bound[f"{side}_multiset"]) == bound[f"{side}_colours"]
        for bound in found.get("bounds") or ()
        for side in ("lower", "upper")
    )


def is_answered(known: Mapping[str, Any], arguments: Sequence[str], limits: Limits) -> bool:
    """Whether this exploration would not have come to a limit either."""
    whole = {int(place) for place in _value("--whole", arguments, "").split(",") if place}
    colours = [
        bound[f"{side}_colours"]
        for place, bound in enumerate(known.get("bounds") or ())
        for side in ("lower", "upper")
        if place not in whole
    ]
    processor_seconds = known["seconds"] * known["threads"]  # at most
    return (
        known["nodes"] < float(_value("--max-states", arguments, "inf"))
        and max(colours, default=0) <= float(_value("--multiset-limit", arguments, "inf"))
        and (limits.processor_seconds is None or processor_seconds <= limits.processor_seconds)
    )


def written(arguments: Sequence[str]) -> set[Path]:
    """The files of runs that are there."""
    found: set[Path] = set()
    for option in RUNS:
        if option in arguments:
            prefix = Path(arguments[arguments.index(option) + 1])
            found.update(prefix.parent.glob(f"{prefix.name}*"))
    return found


def _value(option: str, arguments: Sequence[str], without: str) -> str:
    return arguments[arguments.index(option) + 1] if option in arguments else without

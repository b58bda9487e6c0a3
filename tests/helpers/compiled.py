"""Compiled nets in tests: from a flat net to a program with sanitizers, and its comparison with the token game.

`Workshop` compiles the C runtime once a session; `agrees` walks through a net at random in the compiled program
and follows it in the reference token game: after each step the enabled binding elements, in order, and the
markings must be the same.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from helpers import linker
from pn2code.base.resources import cnative_folder
from pn2code.cell.config import CellConfig
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.emission import arena_size, c_flags
from pn2code.emission.c import emit
from pn2code.ir.allocating import ALLOCATING, MOVES
from pn2code.ir.nodes import NetIR
from pn2code.lowering.nets.net import lower
from pn2code.lowering.nets.packing import Packing
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import (
    BindingElement,
    PlaceMarking,
    binding_to_json,
    place_to_json,
)
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.toolchain import programs

WARNINGS = (
    c_flags.STANDARD, *c_flags.FLOATS, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wconversion", "-Wsign-conversion",
    "-Wshadow", "-Wstrict-prototypes", "-Wmissing-prototypes", "-Wundef", "-Wcast-qual",
    "-Wswitch-enum", "-Wvla",
    "-Wno-tautological-compare",  # a net may well say `n < n`
)  # fmt: skip
SHARED = ("-pthread", "-fPIC")
"""Explorers need them (`helpers.explored`): compiled alike everywhere, the runtime is compiled once."""
SANITIZERS = ("-g1", "-O0", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
FAST = ("-O1",)
QUICK = ("-O0",)
ARENA = "arena"
"""The file with the bytes that a net's lists, strings and moves get."""
DELIVERED = programs.FLAGS
"""Those with which users have explorers and simulators; the tests mostly have others."""
RUNTIME = (
    "arena", "big", "codec", "file", "library", "list", "marking", "moves", "multiset", "num", "random", "read", "root",
    "scalars", "stack", "string", "text", "trace", "type",
)  # fmt: skip


def lowered(
    flat: FlatNet,
    *,
    storage: Mapping[str, str] | None = None,
    capacity: Mapping[str, int] | None = None,
    config: CellConfig | None = None,
    packing: Packing | None = None,
) -> tuple[NetIR | None, Diagnostics]:
    """The intermediate form of a net, and what lowering has to say."""
    d = Diagnostics()
    partition = divide(flat, config, d)
    assert partition is not None
    return lower(partition, storage or {}, d, capacity=capacity, packing=packing), d


@dataclass(frozen=True)
class Workshop:
    """Folders with the runtime's object files and for nets, and the compiler with the flags for all it compiles."""

    runtime: Path
    folder: Path
    compiler: str
    flags: tuple[str, ...]

    @staticmethod
    def of(runtime: Path, folder: Path, flags: tuple[str, ...] = SANITIZERS) -> Workshop:
        """With a runtime that `open` compiled."""
        compiler = shutil.which("gcc") or shutil.which("cc")
        assert compiler is not None
        return Workshop(runtime, folder, compiler, flags)

    @staticmethod
    def open(folder: Path, flags: tuple[str, ...] = SANITIZERS) -> Workshop:
        """Compile the runtime, with sanitizers unless other flags are given."""
        folder.mkdir(parents=True, exist_ok=True)
        workshop = Workshop.of(folder, folder, flags)
        source = cnative_folder() / "src"
        for name in RUNTIME:
            workshop.compile(next(source.rglob(f"pn_{name}.c")), folder / f"pn_{name}.o", folder)
        for part in sorted(source.glob("simulate/*.c")):
            workshop.compile(part, folder / f"{part.stem}.o", folder)
        walk = cnative_folder() / "tests" / "walk.c"
        workshop.compile(walk, folder / "walk.o", folder)
        return workshop

    def compile(self, source: Path, target: Path, include: Path, *flags: str) -> None:
        """One object file; the test fails with the compiler's words."""
        # Named as from there, generated files are compiled in the same way in whichever folder they are.
        named = source.relative_to(include) if source.is_relative_to(include) else source
        command = [self.compiler, *WARNINGS, *SHARED, *self.flags, *flags]
        command += [
            f"-I{cnative_folder() / 'include'}",
            "-I.",
            "-c",
            str(named),
            "-o",
            str(target),
        ]
        done = subprocess.run(command, cwd=include, capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{source}:\n{done.stderr}"

    def link(self, program: Path, *objects: Path) -> Path:
        """A program of these object files and the runtime."""
        runtime = [str(self.runtime / f"pn_{name}.o") for name in RUNTIME]
        command = [
            self.compiler,
            *self.flags,
            *linker.QUICK,
            "-o",
            str(program),
            *map(str, objects),
            *runtime,
            "-lm",
        ]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return program

    def build(self, net: NetIR, folder: Path, host: str = "walk", *flags: str) -> Path:
        """The host over a net; generated files stay in the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        files = emit(net, "test")
        for file in files:
            (folder / file.path).write_text(file.text)
        assert_calls_are_known(net, files[0].text)
        size = arena_size.of(net, None)
        (folder / ARENA).write_text(str(size.bytes if size.is_proven else arena_size.DEFAULT))
        self.compile(folder / "net.c", folder / "net.o", folder, *flags)
        return self.link(folder / host, folder / "net.o", *sorted(self.runtime.glob(f"{host}*.o")))


def assert_calls_are_known(net: NetIR, net_c: str) -> None:
    """The C calls no function that puts something into the arena but those that the passes have found."""
    called = set(re.findall(r"\bpn_\w+", re.sub(r"/\*.*?\*/", "", net_c, flags=re.DOTALL)))
    assert called & ALLOCATING <= {*net.used.makers}
    assert net.has_moves or not called & MOVES


def run(
    program: Path, *arguments: object, environment: Mapping[str, str] | None = None
) -> list[dict[str, Any]]:
    """The JSON lines that a program prints; the test fails when it crashes."""
    done = subprocess.run(
        [str(program), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
        env={**os.environ, **(environment or {})},
    )
    assert done.returncode == 0, f"{program}: {done.stderr[-3000:]}"
    return [json.loads(line) for line in done.stdout.splitlines()]


def _arena(program: Path) -> str:
    """The bytes for a program: of one that was not built for a single net, the usual ones."""
    proven = program.parent / ARENA
    return proven.read_text() if proven.exists() else str(arena_size.DEFAULT)


def agrees(
    flat: FlatNet,
    program: Path,
    *,
    seed: int,
    steps: int,
    storage: Mapping[str, str] | None = None,
    environment: Mapping[str, str] | None = None,
) -> int:
    """Walk in the program and follow in the token game; gives the number of steps that were the same.

    An exception of the net must be raised in both at the same step. The program has no more memory than a deployed one.
    """
    lines = run(program, seed, steps, _arena(program), environment=environment)
    try:
        game = Game(flat, dict(storage or {}), seed=seed)
    except GameError as error:
        assert "error" in lines[0], f"only the token game fails at the start: {error}"
        return 0
    compare = Comparison(game)
    for step, line in enumerate(lines):
        try:
            game.advance()
            enabled = game.enabled()
        except GameError as error:
            assert "error" in line, f"step {step}: only the token game fails: {error}\n{line}"
            return step
        assert "error" not in line, f"step {step}: only the compiled net fails: {line}"
        compare.step(enabled, line, step)
        if line["chosen"] < 0:
            return step
        try:
            game.fire(enabled[line["chosen"]])
        except GameError as error:
            following = lines[step + 1] if step + 1 < len(lines) else {}
            assert "error" in following, f"step {step}: only the token game fails: {error}\n{line}"
            return step
    return len(lines)


class Comparison:
    """Lines of a walking program next to a game.

    The JSON form of a place's marking is kept as long as the place holds what it held: most steps change few places.
    """

    def __init__(self, game: Game) -> None:
        self.game = game
        self._outputs = {
            t.name: {s.name for s in t.code.outputs} if t.code else set()
            for t in game.net.transitions
        }
        self._known: dict[int, tuple[PlaceMarking, Any]] = {}

    def step(self, enabled: list[BindingElement], line: dict[str, Any], step: int) -> None:
        """A line, and where the game is: the same."""
        net = self.game.net
        mine = [[net.transitions[e.transition].name, _json(binding_to_json(e))] for e in enabled]
        theirs = [
            [name, {k: v for k, v in binding.items() if k not in self._outputs[name]}]
            for name, binding in line["enabled"]
        ]
        assert theirs == mine, f"step {step}: enabled in C, enabled in the token game"
        for place in net.places:
            tokens = self.game.marking.places[place.index]
            before, form = self._known.get(place.index, (None, None))
            if before is not tokens:
                form = _json(place_to_json(self.game.colours, place.colset, tokens))
                self._known[place.index] = tokens, form
            assert line["marking"][place.name] == form, f"step {step}: place {place.name}"
        if enabled:
            assert line["t"] == self.game.marking.time, f"step {step}: model time"


def _json(value: object) -> Any:
    return json.loads(json.dumps(value))

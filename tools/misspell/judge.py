"""What becomes of a cell with a mistake in its cell.toml.

judge = Judge(Path("examples/sorting"), room)
judge.verdict(mistake)      # Verdict("refused", "cell-key"), Verdict("no effect"), ...
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tools.misspell.mutants import ADDED, Mistake, as_it_is

from pn2code.cell.config import CellConfig
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.pipeline import generate
from pn2code.verdict import checking

OPTIONS: dict[tuple[str, ...], str] = {
    ("storage",): "reals are stored as they are computed",
    ("storage", "*"): "reals of this colour set are stored as they are computed",
    ("input",): "the places begin as the net says",
    ("input", "*"): "the place begins as the net says",
    ("values",): "the constants are those of the net",
    ("values", "*"): "the constant is that of the net",
    ("capacity",): "the bounds are those that are proved",
    ("capacity", "*"): "the bound is that which is proved",
    ("supervisor", "final"): "a cell that never ends",
    ("supervisor", "final", "*"): "a cell that does not end there",
    ("supervisor", "reply_timeout_s"): "120 seconds",
}
"""What may be left out of a cell, with what it means then (docs/cell.md): nothing tells whether it was forgotten."""

_DIGESTS = re.compile(r"\b[0-9a-f]{8,64}\b")
_BLANKS = re.compile(r"[ \t-]+")


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of a mistake.

    Args:
        result: "refused", "no effect" (the generated files are equal), "renamed" (they are, but for a name that is
            chosen there), "option" (see `OPTIONS`); or what must not be: "effect", "crash".
        why: the first code, or the first file that differs.
    """

    result: str
    why: str = ""

    @property
    def is_wrong(self) -> bool:
        """Whether the mistake goes unnoticed."""
        return self.result in ("effect", "crash")


class Judge:
    """One cell.

    Args:
        cell: its folder.
        room: a folder that does not exist yet.

    Attributes:
        room: gets a copy of the cell.
        text: of cell.toml.
    """

    def __init__(self, cell: Path, room: Path) -> None:
        shutil.copytree(cell, room)
        self.room = room
        self.text = (cell / "cell.toml").read_text(encoding="utf-8")
        self._nets: dict[tuple[object, ...], front.Examined] = {}
        self._made: dict[str, Mapping[str, str] | str] = {}
        self._write(as_it_is(self.text))
        d = Diagnostics()
        config = load(room, d)
        assert config is not None, list(d)
        self._examine(config, d, whole=True)
        assert not d.has_errors, list(d)
        made = self._generated(config)
        assert not isinstance(made, str), made
        self._files = made

    def verdict(self, mistake: Mistake) -> Verdict:
        """What becomes of a mistake."""
        self._write(mistake.text)
        d = Diagnostics()
        try:
            config = load(self.room, d)
            for whole in (False, True):
                if config is not None and not d.has_errors:
                    self._examine(config, d, whole=whole)
            if d.has_errors or config is None:
                return Verdict("refused", d.errors[0].code)
            made = self._generated(config)
        except Exception as problem:  # whatever it is, it is what is looked for
            return Verdict("crash", f"{type(problem).__name__}: {problem}")
        if isinstance(made, str):
            return Verdict("refused", made)
        return self._compared(mistake, made)

    def checked(self, *, whole: bool) -> str | None:
        """The first code that `check` reports of the cell as it is in its folder; None: nothing is wrong.

        Args:
            whole: whether files beside it are looked at, and robots.
        """
        self._write(as_it_is(self.text))
        d = Diagnostics()
        config = load(self.room, d)
        if config is not None and not d.has_errors:
            self._examine(config, d, whole=whole)
        return d.errors[0].code if d.has_errors else None

    def _write(self, text: str) -> None:
        (self.room / "cell.toml").write_text(text, encoding="utf-8")

    def _examine(self, config: CellConfig, d: Diagnostics, *, whole: bool) -> None:
        """As `pn2code check` does, but for reading the net again; at first without what takes long."""
        key = (config.net_path, *sorted(config.values.items()))
        if not config.net_path.is_file():
            front.load(config.net_path, d, config.values)
            return
        if key not in self._nets:
            self._nets[key] = front.examine(config.net_path, d, config.values)
        checking.examine_cell(config.net_path, config, self._nets[key], d, ahead=whole)

    def _generated(self, config: CellConfig) -> Mapping[str, str] | str:
        """The files; the first code if the cell is refused. They follow from the logic of the cell alone."""
        key = _logic(config)
        if key not in self._made:
            d = Diagnostics()
            made = generate(self.room, d)
            if made is None:
                self._made[key] = d.errors[0].code
            else:
                self._made[key] = {f.path: _normal(f.text) for f in made.files}
        return self._made[key]

    def _compared(self, mistake: Mistake, made: Mapping[str, str]) -> Verdict:
        other = next(
            (n for n in sorted({*made, *self._files}) if made.get(n) != self._files.get(n)), None
        )
        if other is None and mistake.kind == "wrong type":
            # The programs do not depend on it, but somebody does: nobody writes a value for nothing.
            return Verdict("effect", "it is accepted")
        if other is None:
            return Verdict("no effect")
        if mistake.renamed and self._is_chosen(mistake.renamed):
            return Verdict("renamed")
        if mistake.kind == "deleted":
            shape = tuple(str(p) for p in mistake.path)
            for option in OPTIONS:
                if len(option) == len(shape) and all(
                    a in ("*", b) for a, b in zip(option, shape, strict=True)
                ):
                    return Verdict("option", OPTIONS[option])
        return Verdict("effect", other)

    def _is_chosen(self, text: str) -> bool:
        """Whether a name is chosen in cell.toml: the files are the same but for what it has at its end."""
        self._write(text)
        config = load(self.room, Diagnostics())
        made = self._generated(config) if config is not None else ""
        if isinstance(made, str):
            return False
        return self._files == {n.replace(ADDED, ""): t.replace(ADDED, "") for n, t in made.items()}


def _normal(text: str) -> str:
    """Without digests, and however columns are aligned."""
    return _BLANKS.sub(" ", _DIGESTS.sub("#", text))


def _logic(config: CellConfig) -> str:
    """Everything of a cell that `generate` makes programs from, without where it stands."""
    s = config.supervisor
    parts: list[Any] = [
        config.net_file,
        (s.instance, s.final, s.reply_timeout_s, s.order_decides),
        sorted(config.storage.items()),
        sorted(config.values.items()),
        sorted(config.capacity.items()),
        [(i.place, i.file) for i in config.inputs],
        [(c.place, c.file, c.kind, c.is_kind_given) for c in config.channels],
        list(config.primitives.items()),
        [(r.name, r.instance) for r in config.robots],
        [(r.name, r.instance) for r in config.devices],
        [(x.name, x.variable) for x in config.sensors],
    ]
    return repr(parts)

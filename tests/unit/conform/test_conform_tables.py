"""What the tables of a supervisor must say is looked up in cell.toml and the net once more."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from pn2code.conform.data import _cell
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.semantics.game.token_game import Game

EXAMPLE = Path(__file__).parents[3] / "examples" / "sorting"


def test_a_message_of_several_values_is_data_where_no_kind_is_given(tmp_path: Path) -> None:
    cell = Path(shutil.copytree(EXAMPLE, tmp_path / "cell")) / "cell.toml"
    text = cell.read_text().replace('kind = "data"\n', "")
    target = re.search(r'\[\[channel\]\]\nplace = "target"\n.*\n', text)
    assert target is not None
    cell.write_text(text.replace(target[0], "") + "\n" + target[0])  # after all flags
    d = Diagnostics()
    made = generate(cell.parent, d, checked=False)
    assert made is not None and made.config is not None, [str(i) for i in d]
    rows = _cell(made, made.config, Game(made.partition.net))["channels"]
    program = [c for c in made.partition.channels if 0 in (c.writer, c.reader)]
    assert [(r["name"], r["kind"]) for r in rows] == [(c.name, c.kind.value) for c in program]
    assert (rows[0]["name"], rows[0]["kind"]) == ("target", "data")

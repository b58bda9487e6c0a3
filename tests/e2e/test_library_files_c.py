"""Library functions on files, paths, streams and clocks: in compiled code as in the reference evaluator."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from helpers.compiled import Workshop, lowered
from helpers.netbuilder import flat
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game

pytestmark = pytest.mark.cc

DECLARATIONS = """
net Library
  standard
  colset E = with red | green;
  colset PAIR = product INT * STRING;
"""

# One a line; later ones see the files of the earlier ones.
EXPRESSIONS = Path(__file__).with_name("library_files.sml.txt").read_text().splitlines()


def test_same_values(workshop: Workshop, tmp_path: Path) -> None:
    places = [f"  place P{i} : STRING = {e}" for i, e in enumerate(EXPRESSIONS)]
    net = flat(DECLARATIONS + "\n".join(places) + "\n")
    compiled, d = lowered(net)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(compiled, tmp_path / "net", "simulate")
    folders = [tmp_path / "one" / "files", tmp_path / "two" / "files"]
    for folder in folders:
        folder.mkdir(parents=True)
    command = [str(program), "--marking", "--files", str(folders[0])]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    *printed, marking = done.stdout.splitlines()
    found = json.loads(marking)
    said: list[str] = []
    game = Game(net, seed=1, files=Files(folders[1], said.append), output=said.append)
    assert "".join(said).splitlines() == printed
    for place, expression in zip(net.places, EXPRESSIONS, strict=True):
        [expected] = game.marking.places[place.index].counts  # type: ignore[union-attr]
        assert found[place.name][0][1] == expected, expression

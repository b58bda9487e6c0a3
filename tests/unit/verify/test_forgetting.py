"""Forgotten places: the net that is left does all that the cell's does."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from tools.bench.tending import net as tending
from tools.bench.tending import toml as tending_toml

from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.verdict.opened import OpenNet, read
from pn2code.verify.controller.forgetting import Forgetful, forgetful


def opened(folder: Path, text: str) -> tuple[OpenNet, Partition]:
    (folder / "cell.cpn").write_bytes(cpn(text))
    (folder / "cell.toml").write_text(tending_toml())
    d = Diagnostics()
    found = read(folder, {}, d)
    assert found is not None and found.config is not None, [i.message for i in d]
    partition = divide(found.flat, found.config, d)
    assert partition is not None, [i.message for i in d]
    return found, partition


def without(less: Forgetful, marking: Marking, empty: Marking) -> Marking:
    """What is left of a marking."""
    held = (empty.places[i] if i in less.places else own for i, own in enumerate(marking.places))
    return Marking(marking.time, tuple(held))


def names(partition: Partition, less: Forgetful) -> set[str]:
    return {partition.net.places[p].short for p in less.places}


def test_trays_and_counters_are_forgotten(tmp_path: Path) -> None:
    found, partition = opened(tmp_path, tending(12))
    less = forgetful(partition, found.storage)
    assert less is not None
    # Not the mill, which holds one part, nor a channel, nor whatever a robot touches.
    trays = {"Feeder", "Loaded", "Milled", "Judged", "Good", "Scrap", "Left"}
    assert trays <= names(partition, less) <= trays | {"Aborted", "Finished"}
    assert all(a.place not in less.places for t in less.net.transitions for a in t.arcs)
    assert {t.priority for t in less.net.transitions} == {1000}
    # `k` of `Stow : in Judged : k, out Stowing : k` takes all of its values now.
    (stow,) = (t for t in less.net.transitions if t.short == "Stow")
    assert [s.name for s in stow.variables] == ["k"]
    assert less.whole.places == partition.net.places


@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_does_all_that_the_cell_does(tmp_path: Path, seed: int) -> None:
    text = tending(5)
    # A guard over what is forgotten, and a tray that has to be empty.
    text = text.replace("    trans Drop\n", "    trans Drop guard [n > 1]\n      inhibit Loaded\n")
    found, partition = opened(tmp_path, text)
    less = forgetful(partition, found.storage)
    assert less is not None and "Left" in names(partition, less)
    real = Game(partition.net, found.storage, files=Files(None))
    wide = Game(less.net, found.storage, files=Files(None))
    choice = Random(seed)
    marking = real.marking
    steps = 0
    while steps < 120:
        left = without(less, marking, wide.marking)
        possible = [(t, b) for t in partition.net.transitions for b in real.bindings(t, marking)]
        if not possible:
            break
        for t, b in possible:
            own = less.net.transitions[t.index]
            kept = {s: v for s, v in b.items() if s in own.variables}
            assert kept in list(wide.bindings(own, left)), (t.name, b)
            if partition.transition_owner[t.index] != 0:
                assert kept == b and own.arcs == t.arcs
        # Of what robots can do there is nothing more, either.
        for t in partition.net.transitions:
            if partition.transition_owner[t.index] != 0:
                assert len(list(wide.bindings(less.net.transitions[t.index], left))) == sum(
                    u is t for u, _ in possible
                )
        t, b = choice.choice(possible)
        marking = real.occur(marking, BindingElement.make(t, b))[0]
        steps += 1
    assert steps > 15


def test_what_changes_a_reference_is_not_forgotten(tmp_path: Path) -> None:
    """Whoever reads it would go on otherwise: here arm 2 goes to another place once a part is good."""
    text = tending(3).replace("  var j: JOB;", "  globref count = 0;\n  var j: JOB;")
    for place, says in (("Good", "(count := !count + 1; ())"), ("poseArm2", "at (3 + !count)")):
        before = {"Good": "()", "poseArm2": "at 3"}[place]
        assert f"      out {place} : {before}\n" in text
        text = text.replace(f"      out {place} : {before}\n", f"      out {place} : {says}\n")
    found, partition = opened(tmp_path, text)
    less = forgetful(partition, found.storage)
    assert less is not None and "Good" not in names(partition, less) >= {"Scrap", "Judged"}


def test_an_initial_marking_that_changes_a_reference_is_not_forgotten(tmp_path: Path) -> None:
    text = tending(3).replace("  var j: JOB;", "  globref count = 0;\n  var j: JOB;")
    assert "place Feeder = 3" in text
    text = text.replace("place Feeder = 3", "place Feeder : UNIT = (count := 5; 3`())")
    found, partition = opened(tmp_path, text)
    less = forgetful(partition, found.storage)
    assert less is not None and "Feeder" not in names(partition, less) >= {"Scrap", "Judged"}


def test_nets_with_time_are_left_alone(tmp_path: Path) -> None:
    text = tending(4).replace("place Loading\n", "place Loading : WAIT\n")
    text = text.replace("  colset JOB", "  colset WAIT = unit timed;\n  colset JOB")
    found, partition = opened(tmp_path, text)
    assert partition.net.timed and forgetful(partition, found.storage) is None

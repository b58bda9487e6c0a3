"""Two runs of a cell: the first other message and the first other pose, whatever the tempo."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.shown import PAIR, described, opened, recorded, with_arm
from pn2code.replay import trace as traces
from pn2code.replay.differences import differences, sentences


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return described(tmp_path_factory.mktemp("run"), steps=12)


def test_a_slower_run_is_no_other_run(run: dict[str, Any]) -> None:
    found = differences(with_arm(run), with_arm(run, tempo=1.7))
    assert {found[kind] for kind in ("step", "message", "pose", "end")} == {None}
    assert sentences(found) == ["both runs have the same steps, messages and poses"]


def test_another_message_is_found_on_its_channel(run: dict[str, Any]) -> None:
    other = with_arm(run, tempo=2.0, texts=lambda k: "lost" if k == 5 else str(k))
    found = differences(with_arm(run), other)
    assert (found["step"], found["pose"]) == (None, None)
    assert found["message"]["number"] == 5
    assert found["message"]["t"] == [5.0, 10.0]
    assert found["message"]["what"] == ["done write: 5 at 5.00 s", "done write: lost at 10.00 s"]


def test_a_message_that_one_run_lacks_is_found(run: dict[str, Any]) -> None:
    other = with_arm(run)
    del other["happenings"]["messages"][9:]
    found = differences(with_arm(run), other)["message"]
    assert found["what"][1] == "no more message on this channel"
    assert found["t"] == [10.0, 10.0]


def test_another_pose_is_found_where_the_arm_makes_its_step(run: dict[str, Any]) -> None:
    other = with_arm(run, tempo=2.0, joints=lambda k: 0.1 * k + 0.01 * (k > 7))
    found = differences(with_arm(run), other)
    assert found["step"] is None and found["message"] is None
    assert found["pose"]["step"] == 8 and found["pose"]["robot"] == "arm"
    assert found["pose"]["t"] == [8.0, 16.0]
    assert "joints 45.8, at 8.00 s" in found["pose"]["what"][0]
    assert "joints 46.4, at 16.00 s" in found["pose"]["what"][1]
    assert "first other pose: arm with its TCP at 696.7, 717.4, 0.0 mm" in sentences(found)[0]


def test_arms_that_stand_elsewhere_differ_before_anything_happens(run: dict[str, Any]) -> None:
    other = with_arm(run)
    other["cell"]["robots"][0]["base"][3] = 0.5
    assert differences(with_arm(run), other)["pose"]["step"] == 0


def test_after_another_step_poses_are_not_compared(run: dict[str, Any], tmp_path: Path) -> None:
    longer = described(tmp_path, steps=15)
    found = differences(with_arm(run), with_arm(longer))
    assert found["step"]["step"] == 13 and found["step"]["alike"] == 12
    assert found["pose"] is None


@pytest.fixture
def many(tmp_path: Path) -> Path:
    """Twelve steps of a net, as a trace beside the net."""
    return recorded(netbuilder.write(PAIR, tmp_path / "net.cpn"), tmp_path / "a.trace.jsonl", 12)


def shown(trace: Path, most: int = 1000) -> dict[str, Any]:
    return traces.describe(trace, *opened(trace.with_name("net.cpn")), {}, most=most)


def changed(trace: Path, old: str, new: str) -> Path:
    text = trace.read_text()
    assert old in text
    other = trace.with_name("b.trace.jsonl")
    other.write_text(text.replace(old, new, 1))
    return other


def test_of_traces_nothing_is_said_of_messages_and_poses(many: Path) -> None:
    found = differences(shown(many), shown(many))
    assert found["compared"] == ["step", "end"]
    assert sentences(found) == ["both runs have the same steps"]


def test_a_step_that_is_not_possible_is_no_end(many: Path) -> None:
    lines = many.read_text().splitlines()
    impossible = many.with_name("b.trace.jsonl")
    last = json.loads(lines[12])
    last["binding"]["n"] = 17
    impossible.write_text("\n".join([*lines[:12], json.dumps(last)]))
    cut_there = many.with_name("c.trace.jsonl")
    cut_there.write_text("\n".join(lines[:12]))
    a, b = shown(cut_there), shown(impossible)
    assert a["course"]["steps"] == b["course"]["steps"] == 11
    step = differences(a, b)["step"]
    assert step is not None and step["step"] == 12
    assert step["what"][0] == "the run has ended"
    assert "the next step is not possible: Top." in step["what"][1]
    assert "lacks 1`17" in step["what"][1]
    assert differences(b, b)["step"] is None


def test_of_a_run_with_less_steps_shown_the_rest_is_not_compared(many: Path) -> None:
    whole, part = shown(many), shown(many, most=5)
    found = differences(whole, part)
    assert found["step"] is None and found["end"] is None
    assert sentences(found) == [
        "both runs have the same steps",
        "steps of the second run after the first 5 are left out, and not compared",
    ]
    assert differences(part, shown(many, most=3))["step"] is None
    fewer = many.with_name("b.trace.jsonl")
    fewer.write_text(
        "\n".join(many.read_text().splitlines()[:5])
    )  # it ends before the other is cut
    assert differences(shown(fewer), part)["step"]["step"] == 5


def test_a_trace_that_says_it_is_cut_is_not(many: Path) -> None:
    lines = many.read_text().splitlines()
    fewer = many.with_name("b.trace.jsonl")
    head = lines[0].replace('"by": "reference"', '"by": "supervisor"')
    fewer.write_text("\n".join([head, *lines[1:5], lines[-1].replace('"steps"', '"cut"')]))
    other = shown(fewer)
    assert not other["course"]["refused"]["transition"]
    found = differences(shown(many), other)
    said = 'the run ends with what is not so: it says "cut", which is no reason for a run to end'
    assert found["step"]["step"] == 5 and found["step"]["what"][1] == said
    assert other["verdict"]["word"] == '"cut"' and not found["notes"]


def test_another_end_is_said(many: Path) -> None:
    found = differences(shown(many), shown(changed(many, '"why": "steps"', '"why": "interrupted"')))
    assert found["step"] is None
    assert sentences(found) == ["other end: steps; in the second run interrupted"]


@pytest.mark.parametrize(
    ("kind", "values", "is_rounded"),
    [
        ("REAL", ("0.1 + 0.2", "0.3"), True),
        ("REAL", ("0.25", "0.25"), False),
        ("STRING", tuple(f'implode (List.tabulate (4001, fn i => chr (65 + i div {n})))' for n in (4000, 5000)), True),
    ],
)  # fmt: skip
def test_what_is_shown_shortened_is_compared_shortened(
    kind: str, values: tuple[str, str], is_rounded: bool, tmp_path: Path
) -> None:
    runs = []
    for name, value in zip("ab", values, strict=True):
        text = f"""
        net One
          standard
          var x : {kind};
          page Top
            place A : {kind} = 1`({value})
            trans T
              in A : x
        """
        (tmp_path / name).mkdir()
        runs.append(described(tmp_path / name, text))
    said = sentences(differences(*runs))
    assert said[0] == "both runs have the same steps"
    assert [line.startswith("values are compared as") for line in said[1:]] == [True] * is_rounded


def test_what_runs_say_is_no_command_for_the_terminal(many: Path) -> None:
    odd = shown(many)
    odd["verdict"]["reason"] = "\x1b[2J\u202ex" + "y" * 10_000_000
    (said,) = sentences(differences(shown(many), odd))
    assert said.isprintable() and len(said) < 10_000
    assert "in the second run steps: \ufffd[2J\ufffdxyyy" in said and "more characters" in said


def test_an_end_that_is_a_failure_is_another_one(run: dict[str, Any]) -> None:
    ended = {"word": "finished", "reason": "", "final": ["Over"]}
    one = {**run, "verdict": {**ended, "failed": ["{ x = 1 }"]}}
    other = {**run, "verdict": {**ended, "failed": []}}
    found = differences(one, other)["end"]
    assert found["what"] == [
        "finished, with a token in Over, a failure: { x = 1 }",
        "finished, with a token in Over",
    ]
    assert differences(other, other)["end"] is None

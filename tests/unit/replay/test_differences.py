"""Two runs of a cell: the first other message and the first other pose, whatever the tempo."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from helpers.shown import described, with_arm
from pn2code.replay.differences import differences, sentences


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return described(tmp_path_factory.mktemp("run"), steps=12)


def test_a_slower_run_is_no_other_run(run: dict[str, Any]) -> None:
    found = differences(with_arm(run), with_arm(run, tempo=1.7))
    assert found == {"step": None, "message": None, "pose": None}
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

"""`pn2code run --live --intervene`: a person says what sensors see, and the records say that a person did."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers.browser import launched, opened
from helpers.legible import complaints
from helpers.lively import Person, Running, running, token_of
from helpers.processes import pn2code


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


def lines_of(run: Running) -> list[dict[str, Any]]:
    text = (run.out / "sorting.trace.jsonl").read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines()]


def test_what_a_person_says_is_done_and_recorded(root: Path, tmp_path: Path) -> None:
    cell = root / "examples/sorting"
    more = ("--intervene", "--patience", "500", "--speed", "3")
    with running(cell, tmp_path / "run", *more) as run:
        token = token_of(run)
        with Person(run) as person:
            person.act("fail", party="belt")
            assert person.hear("act") == {"act": "not joined"}
            for wrong in (run.stop_token, [token]):
                person.text(json.dumps({"do": "join", "token": wrong}))
                assert person.hear("act") == {"act": "wrong token"}
            person.text(json.dumps({"do": "join", "token": token}))
            assert person.hear("act") == {"act": "joined"}
            person.act("way", party="robot", sensor="gripper", way="own")
            first = person.asked("verdict")
            assert first["values"] == ["good", "bad"] and 0 < first["left"] <= 500
            person.act("hold", party="robot")
            person.until(lambda h: "robot" in h["held"])
            other = "bad" if first["own"] == "good" else "good"
            person.act("answer", number=first["number"], value="ugly")
            assert "ugly" in person.until(lambda h: h["refused"][0])["refused"][1]
            person.act("answer", number=first["number"], value=other)
            person.until(lambda h: not h["questions"])
            person.act("go", party="robot")
            person.until(lambda h: not h["held"])
            person.act("hold", party="belt")
            person.until(lambda h: "belt" in h["held"])
            person.text(json.dumps({"do": "stop", "token": run.stop_token}))
            person.hear("over")
        code, said = run.wait()
    assert code == 1, said
    assert "by a person" in said
    (chosen,) = (x for x in lines_of(run) if x.get("event") == "sense" and "by" in x)
    assert (chosen["robot"], chosen["value"], chosen["by"]) == ("belt", other, "person")
    summary = json.loads((run.out / "summary.json").read_text(encoding="utf-8"))
    texts = [h["text"] for h in summary["by_hand"]]
    assert any(f"verdict: {other}, chosen by a person" in text for text in texts)
    held = [(h["robot"], h["text"].split()[1]) for h in summary["by_hand"] if "held" in h["text"]]
    assert held == [("robot", "from"), ("robot", "for"), ("belt", "from"), ("belt", "for")]
    assert texts[-1].endswith(" s, until the run ended")
    standing = [x for x in lines_of(run) if x.get("event") in ("hold", "stand")]
    assert [(x["robot"], x["event"]) for x in standing] == [
        ("robot", "hold"), ("robot", "stand"), ("belt", "hold"), ("belt", "stand"),
    ]  # fmt: skip
    replayed = pn2code("replay", run.out / "sorting.trace.jsonl", cell)
    assert "each enabled when its turn came" in replayed.stdout
    assert "a person has chosen 3 of" in replayed.stdout
    events = json.loads((run.out / "run.json").read_text(encoding="utf-8"))["happenings"]["events"]
    assert any(e["text"] == f"sensor verdict: {other}, chosen by a person" for e in events)


def test_in_the_page_a_person_answers_and_lets_a_device_fail(
    root: Path, chromium: Any, tmp_path: Path
) -> None:
    cell = tmp_path / "cell"
    shutil.copytree(root / "examples/sorting", cell)
    toml = cell / "cell.toml"
    text = toml.read_text(encoding="utf-8")
    changed = text.replace("[supervisor]", "[supervisor]\nreply_timeout_s = 3600", 1)
    assert changed != text
    toml.write_text(changed, encoding="utf-8")
    more = ("--intervene", "--patience", "1000", "--speed", "3")
    with (
        running(cell, tmp_path / "run", *more) as run,
        Person(run) as other,
        opened(chromium) as browser,
    ):
        # Somebody is there from the beginning, so the question stays open until the browser has the page.
        token = token_of(run)
        other.join(token)
        other.act("way", party="robot", sensor="gripper", way="own")
        page = browser.page
        with other.listening():
            page.goto(f"{run.url}#act={token}")
            page.wait_for_selector("body[data-ready=true]")
            assert "act=" not in browser.ask("() => location.href")
            question = page.get_by_role("group", name="Question of belt")
            asked = "belt asks sensor verdict: what the camera finds of the part (v)?"
            question.get_by_text(asked).wait_for()
            assert complaints(browser) == []
            question.get_by_role("button", name="bad", exact=True).click()
            question.wait_for(state="hidden")
            page.get_by_role("tab", name="Intervene").click()
            page.get_by_text("whether the gripper holds the part").wait_for()
            names = browser.ask(
                "() => [...document.querySelectorAll('.intervene button')].map((b) => b.ariaLabel)"
            )
            assert len(set(names)) == len(names) > 8, "each button has a name of its own"
            browser.ask("() => live.page.frame.dark()")
            assert complaints(browser) == []
            page.get_by_role("button", name="Hold: belt").click()
            page.get_by_role("button", name="Go on: belt").wait_for()
            page.get_by_role("button", name="Fail: belt").click()
            page.get_by_text("The run has ended: failed").wait_for()
        code, said = run.wait()
        assert code == 1 and "as a person at the live page wanted" in said.replace("\n", " ")
        assert browser.errors == []
    chosen = [x for x in lines_of(run) if x.get("event") == "sense" and "by" in x]
    assert [x["value"] for x in chosen] == ["bad"]

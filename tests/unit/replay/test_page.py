"""The replay page: what a run says stays data, and only the scripts that pn2code wrote may run."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from lxml import etree, html

from helpers.shown import PAIR, described
from pn2code.replay import three
from pn2code.replay.description import NoDescription, problem_of, read, text_of
from pn2code.replay.page import embedded, page
from pn2code.replay.three import Three

HOSTILE = (
    "</script><script>alert(1)</script>",
    "<!--",
    "javascript:alert(1)",
    "\u2028",
    "a & b < c",
)


def embedded_in(text: str) -> dict[str, Any]:
    found = html.fromstring(text).get_element_by_id("data")
    return dict(json.loads(found.text))


@pytest.mark.parametrize("name", HOSTILE)
def test_a_text_cannot_end_the_element_that_it_is_in(name: str) -> None:
    text = embedded({name: [name]})
    assert not re.search("[<>&\u2028\u2029]", text)
    assert json.loads(text) == {name: [name]}


def test_a_lone_surrogate_does_not_prevent_the_page() -> None:
    assert json.loads(embedded(["\ud800"])) == ["?"]


def test_the_policy_names_the_hash_of_each_script_and_style_and_nothing_else(
    tmp_path: Path,
) -> None:
    shown = {**described(tmp_path), "cell": {"robots": []}, "motion": {}}
    text = page(shown, library=Three("globalThis.THREE = {};\r\n"))
    root = html.fromstring(text)
    policy = root.xpath("//meta[@http-equiv='Content-Security-Policy']/@content")[0]
    directives = dict(part.split(" ", 1) for part in policy.split("; "))
    assert directives["default-src"] == "'none'"
    assert not re.search(r"unsafe|https?:|\*", policy)
    scripts = [s.text for s in root.xpath("//script[not(@type)]")]
    assert len(scripts) == 2
    assert directives["script-src"].split() == [_hash(s) for s in scripts]
    assert directives["style-src"].split() == [_hash(s.text) for s in root.xpath("//style")]
    assert root.xpath("//@src | //link | //@onclick | //@style") == []


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_names_of_a_hostile_net_are_data(tmp_path: Path) -> None:
    shown = described(tmp_path)
    shown["title"] = HOSTILE[0]
    shown["net"]["places"][0]["name"] = HOSTILE[0]
    text = page(shown)
    assert len(re.findall("<script", text)) == 2
    assert HOSTILE[0] not in text
    assert embedded_in(text)["runs"][0]["net"]["places"][0]["name"] == HOSTILE[0]


def test_the_drawings_in_it_are_xml_without_scripts(tmp_path: Path) -> None:
    for drawn in described(tmp_path)["net"]["pages"]:
        root = etree.fromstring(f"<g>{drawn['svg']}</g>")
        assert root.xpath("//script | //@href | //@onload | //foreignObject") == []


def test_without_three_js_the_page_says_why(tmp_path: Path) -> None:
    shown = {**described(tmp_path), "cell": {"robots": []}, "motion": {}}
    text = page(shown, library="three.js is not installed: pip install it")
    assert embedded_in(text)["missing"] == "three.js is not installed: pip install it"
    assert embedded_in(page(described(tmp_path), library="not installed"))["missing"] == ""


@pytest.mark.parametrize("name", ["LIBRARY", "READER"])
def test_three_js_and_its_reader_are_those_that_are_known(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = three.find()
    assert isinstance(found, Three) and "SPDX-License-Identifier: MIT" in found.text
    assert "THREE.GLTFLoader=" in found.text
    part = getattr(three, name)
    monkeypatch.setattr(three, name, replace(part, sha256="0" * 64))
    assert f"has another {part.what}" in str(three.find())
    monkeypatch.setattr(three, name, replace(part, file="not_there.js"))
    assert f"{part.what} is not in the package" in str(three.find())
    monkeypatch.setattr(three, name, replace(part, package="a_package_that_is_not_there"))
    assert f"{part.what} is not installed" in str(three.find())


def test_a_reader_that_has_other_words_is_not_found(monkeypatch: pytest.MonkeyPatch) -> None:
    for change in ({"begins": "not there"}, {"ends": "not there"}, {"member": "not there"}):
        monkeypatch.setattr(three, "READER", replace(three.READER, **change))
        assert "GLTFLoader is not in the package trimesh" in str(three.find())
        monkeypatch.undo()


def test_a_description_reads_back(tmp_path: Path) -> None:
    shown = described(tmp_path)
    (tmp_path / "run.json").write_text(text_of(shown), encoding="utf-8")
    assert read(tmp_path) == shown
    assert page(read(tmp_path)) == page(shown)


def test_one_of_version_1_without_arms_is_as_ever(tmp_path: Path) -> None:
    shown = {**described(tmp_path), "pn2code": {"run": 1}}
    (tmp_path / "run.json").write_text(text_of(shown), encoding="utf-8")
    assert read(tmp_path) == shown


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("[1]", "`pn2code` is missing"),
        ("{", "is not JSON"),
        ('{"pn2code": {"run": 99}}', "of version 99, but version 2 is expected"),
        ('{"pn2code": {"run": 1}, "cell": {"robots": []}}', "of version 1, but version 2"),
        ('{"pn2code": {"run": true}}', "of version True, but version 2"),
        ('{"pn2code": {"run": 2}}', "its `kind` is missing"),
    ],
)
def test_another_file_is_refused(text: str, why: str, tmp_path: Path) -> None:
    (tmp_path / "run.json").write_text(text)
    with pytest.raises(NoDescription) as refused:
        read(tmp_path)
    assert why in str(refused.value)


def test_a_folder_without_a_run_says_what_writes_it(tmp_path: Path) -> None:
    with pytest.raises(NoDescription, match="`pn2code run` writes it"):
        read(tmp_path)


def test_parts_of_a_description_that_are_missing_are_named(tmp_path: Path) -> None:
    shown = described(tmp_path)
    del shown["course"]["keys"]
    assert problem_of(shown) == "is incomplete: its `course.keys` is missing"


def test_a_step_that_is_not_possible_ends_what_is_shown(tmp_path: Path) -> None:
    wrong = {"step": 31, "t": 0, "transition": "Top.Left.Move", "binding": {"n": 77}, "origin": ""}
    shown = described(tmp_path, PAIR, 30, [wrong])
    assert shown["course"]["steps"] == 30
    assert shown["course"]["refused"]["step"] == 31
    assert shown["course"]["refused"]["transition"] == "Top.Left.Move"

"""The picture of a state space in a browser: it can be zoomed, moved and searched."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.browser import launched, opened
from helpers.processes import pn2code
from pn2code.verify.report import graph_svg
from pn2code.verify.report.graph import read
from pn2code.verify.report.graph_page import page as graph_page

pytestmark = pytest.mark.cc


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def file(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("graph") / "graph.html"
    net = root / "examples/philosophers/philosophers.cpn"
    done = pn2code(
        "verify", net, "--set", "n=6", "--no-found", "--draw", file, "-q", "-o", file.parent
    )
    assert done.returncode == 0 and file.is_file(), done.stderr
    return file


@pytest.fixture
def page(chromium: Any, file: Path) -> Iterator[Any]:
    with opened(chromium) as browser:
        browser.page.goto(file.as_uri())
        yield browser.page
        assert browser.errors == []


def view(page: Any) -> list[float]:
    """Left, top, width, height of what is seen, in units of the drawing."""
    text = page.eval_on_selector(".sheet svg", "svg => svg.getAttribute('viewBox')")
    return [float(x) for x in text.split()]


def middle(page: Any) -> tuple[float, float]:
    left, top, width, height = view(page)
    return left + width / 2, top + height / 2


def centre(page: Any, node: int) -> tuple[float, float]:
    box = page.eval_on_selector(
        f"#node-{node}", "g => (b => [b.x + b.width / 2, b.y + b.height / 2])(g.getBBox())"
    )
    return box[0], box[1]


def test_a_node_is_found_by_its_number(page: Any) -> None:
    page.keyboard.press("/")
    page.keyboard.type("17")
    assert page.locator("#results a").first.text_content() == "node 17"
    page.keyboard.press("Enter")
    page.wait_for_selector(".sheet[data-node='17']")
    assert middle(page) == pytest.approx(centre(page, 17), abs=1)
    before = view(page)[2]
    page.keyboard.press("+")  # the picture has the keys at once
    assert view(page)[2] == pytest.approx(0.8 * before)
    near = page.eval_on_selector_all("a.near", "all => all.map(a => a.getAttribute('href'))")
    rows = page.eval_on_selector_all(
        "#arcs tbody tr",
        "all => all.map(r => [r.id, r.cells[0].textContent, r.cells[1].textContent])",
    )
    ends = {f"#{row}" for row, *numbers in rows if "17" in [n.strip() for n in numbers]}
    assert set(near) <= ends and near


def test_nodes_are_found_by_their_marking(page: Any) -> None:
    page.fill("#search", "waits: 1`ph(1)++ 1`ph(2)++ 1`ph(3)++ 1`ph(4)++ 1`ph(5)++ 1`ph(6)")
    assert page.locator("#results li").first.text_content() == "1 node"
    page.locator("#results a").click()
    page.wait_for_selector(".sheet[data-node]")
    number = int(page.evaluate("location.hash").rsplit("-", 1)[1])
    assert "dead" in page.locator(f"#node-{number}").get_attribute("class")
    page.fill("#search", "no such marking")
    assert page.locator("#results li").text_content() == "0 nodes"


def test_it_is_dark_where_the_page_is(page: Any) -> None:
    corner = page.locator(".sheet").bounding_box()
    clip = {"x": corner["x"] + 4, "y": corner["y"] + 4, "width": 2, "height": 2}
    light = page.screenshot(clip=clip)
    page.emulate_media(color_scheme="dark")
    assert page.screenshot(clip=clip) != light
    assert "invert" in page.eval_on_selector(".legend svg", "e => getComputedStyle(e).filter")


def test_zooming_and_moving(page: Any) -> None:
    page.locator("#tools button[value='0']").click()
    before, whole = middle(page), view(page)
    page.locator("#tools button[value='0.8']").click()
    assert view(page)[2] == pytest.approx(0.8 * whole[2], rel=1e-3)
    assert middle(page) == pytest.approx(before, abs=1)
    page.locator(".sheet").focus()
    page.keyboard.press("ArrowRight")
    assert middle(page)[0] == pytest.approx(before[0] + 0.1 * whole[2], rel=1e-2)
    page.keyboard.press("0")
    assert view(page) == pytest.approx(whole, abs=1)
    page.mouse.move(600, 500)
    page.mouse.down()
    page.mouse.move(500, 450, steps=4)
    page.mouse.up()
    scale = whole[2] / page.locator(".sheet svg").bounding_box()["width"]
    moved = [a - b for a, b in zip(middle(page), before, strict=True)]
    assert moved == pytest.approx([100 * scale, 50 * scale], rel=0.05)
    assert page.evaluate("location.hash") == "", "dragging is no click"


def test_a_large_picture_is_on_a_canvas(
    chromium: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Many markings one after the other: moves do not draw all of them, and what is clicked is found."""
    count = 60
    monkeypatch.setattr(graph_svg, "LARGE", 100)
    net = netbuilder.flat(COUNTER)
    rows: list[dict[str, Any]] = []
    for n in range(1, count + 1):
        rows.append({"node": n, "t": 0, "marking": {"Top.A": [[1, n]]}})
        if n < count:
            arc = {"from": n, "to": n + 1, "t": 0, "transition": "Top.T", "index": 0}
            rows.append({**arc, "binding": {"n": n}})
    rows.sort(key=lambda row: "node" not in row)
    listed = tmp_path / "graph.jsonl"
    listed.write_text("\n".join(map(json.dumps, rows)), encoding="utf-8")
    file = tmp_path / "graph.html"
    file.write_text(graph_page(net, read(net, listed)), encoding="utf-8")
    with opened(chromium) as browser:
        browser.page.goto(file.as_uri())
        assert browser.page.locator(".sheet canvas").is_visible()
        assert not browser.page.locator(".sheet svg").is_visible()
        browser.page.fill("#search", "34")
        browser.page.keyboard.press("Enter")
        browser.page.wait_for_selector(".sheet[data-node='34']")
        x, y = centre_of_canvas(browser.page)
        browser.page.mouse.move(
            x, y
        )  # elsewhere the wheel would scroll the page away from under the click
        seen = width(browser.page)
        browser.page.mouse.wheel(0, -200)
        browser.wait(f"{WIDTH} < {0.8 * seen}")
        browser.page.mouse.click(x, y)
        browser.wait("location.hash === '#row-34'")
        browser.wait(f"{ORANGE} > 1 && {ORANGE.replace('true', 'false')} > 1")
        assert browser.errors == []


COUNTER = """
net Counter
  standard
  var n : INT;
  page Top
    place A : INT = 1`1
    trans T
      in A : n
      out A : n + 1
"""


ORANGE = """(isRow => {
  const c = document.querySelector(".sheet canvas"), { width: w, height: h } = c;
  const line = isRow ? [0, h >> 1, w, 1] : [w >> 1, 0, 1, h];
  const d = c.getContext("2d").getImageData(...line).data;
  let n = 0;
  for (let i = 0; i < d.length; i += 4) n += d[i] > 200 && d[i + 1] > 100 && d[i + 1] < 180 && d[i + 2] < 80;
  return n;
})(true)"""
"""Orange pixels of the middle row of the canvas, or of the middle column: a node there has its border in both, and its
arcs run through one of them only."""


WIDTH = 'document.querySelector(".sheet svg").viewBox.baseVal.width'


def width(page: Any) -> float:
    """Of what is seen, in units of the drawing."""
    return float(page.evaluate(WIDTH))


def centre_of_canvas(page: Any) -> tuple[float, float]:
    box = page.locator(".sheet canvas").bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

"""`pn2code report`: one folder with everything about a cell, whose first page says what the commands have said."""

from __future__ import annotations

import csv
import hashlib
import json
import shutil
import subprocess
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import unquote

import pytest
from lxml import html

from e2e.test_input_sizes import STOCK
from e2e.test_input_sizes import cell as stock
from helpers.browser import launched, opened
from helpers.legible import complaints
from helpers.netbuilder import cpn, write
from helpers.processes import pn2code, started
from helpers.thorough import amount
from pn2code.dossier.steps import Done, Step

PHONE = {"viewport": {"width": 390, "height": 844}}
PAGES = ("index.html", "programs.html", "nets.html")

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


@contextmanager
def forks() -> Iterator[None]:
    """The commands of a report are forks of the tests', and find compiled what these have compiled."""
    with pytest.MonkeyPatch.context() as changed:
        own = SimpleNamespace(Popen=started, DEVNULL=subprocess.DEVNULL)
        changed.setattr("pn2code.dossier.steps.subprocess", own)
        yield


def first_page(folder: Path) -> html.HtmlElement:
    return html.fromstring((folder / "index.html").read_text(encoding="utf-8"))


def verdict(folder: Path) -> str:
    return " ".join(
        " ".join(p.text_content().split())
        for p in first_page(folder).xpath("//header/p[contains(@class, 'verdict')]")
    )


def commands(folder: Path) -> dict[str, str]:
    """Exit codes by verb."""
    rows = first_page(folder).xpath("//section[@id='commands']//tbody/tr")
    return {r[0].text_content().split()[1]: r[1].text_content() for r in rows}


def broken(folder: Path) -> list[str]:
    """Hashes that are not those of the files, and files without a hash."""
    listed = {}
    for line in (folder / "SHA256SUMS").read_text().splitlines():
        digest, name = line.split("  ", 1)
        listed[name] = digest
    there = {
        p.relative_to(folder).as_posix(): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in folder.rglob("*")
        if p.is_file() and p.name != "SHA256SUMS"
    }
    return sorted(name for name in {*listed, *there} if listed.get(name) != there.get(name))


@pytest.fixture(scope="module")
def minimal(root: Path, quick_build: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a net that is not called `cell`: files of runs are called as their nets."""
    folder = tmp_path_factory.mktemp("minimal")
    out, cell = folder / "report", folder / "parts"
    shutil.copytree(root / "examples/minimal", cell)
    (cell / "cell.cpn").rename(cell / "setting.cpn")
    toml = (cell / "cell.toml").read_text(encoding="utf-8")
    changed = toml.replace('file = "cell.cpn"', 'file = "setting.cpn"')
    assert changed != toml
    (cell / "cell.toml").write_text(changed, encoding="utf-8")
    options = ("--backend", "fake", "--durations")
    with forks():
        done = pn2code("report", cell, "-o", out, *options)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def test_what_was_measured_in_seconds(minimal: Path) -> None:
    text = " ".join(first_page(minimal).text_content().split())
    assert "nobody owes an answer for longer than reply_timeout_s" in text
    assert "cycle to Finished" in text and "worst" in text


def test_durations_need_a_cell(tmp_path: Path) -> None:
    net = tmp_path / "net.cpn"
    net.write_bytes(cpn("net n\n  standard\n  page Top\n    place A = 1"))
    done = pn2code("report", net, "-o", tmp_path / "report", "--durations")
    assert done.returncode == 2 and "only a cell has durations" in done.stderr


def test_a_cell_that_is_as_it_should_be(minimal: Path) -> None:
    assert verdict(minimal) == (
        "All that was looked at is as it should be. Not looked at: the moves of the arms, "
        "and whether arms and devices keep apart (--backend fake)."
    )
    assert "about the moves of its arms" not in first_page(minimal).text_content()
    verbs = ("check", "draw", "verify", "generate", "conform", "run")
    assert commands(minimal) == dict.fromkeys(verbs, "0")
    assert broken(minimal) == []
    said = json.loads((minimal / "verification.json").read_text())
    text = first_page(minimal).xpath("//section[@id='answers']")[0].text_content()
    for row in (*said["properties"], *said["controller"], *said["medium"]):
        assert row["says"].replace("`", "") in text
    assumed = first_page(minimal).xpath("//section[@id='assumptions']")[0].text_content()
    for row in said["controller"]:
        assert all(clause.replace("`", "") in assumed for clause in row["assumes"])


def test_each_link_of_the_first_page_leads_to_something(minimal: Path) -> None:
    pages = {name: html.fromstring((minimal / name).read_text("utf-8")) for name in PAGES}
    anchors = {name: set(page.xpath("//@id")) for name, page in pages.items()}
    for name in ("index.html", "programs.html"):
        links = pages[name].xpath("//a/@href | //iframe/@src | //img/@src")
        assert len(links) > 20
        for link in links:
            file, _, anchor = link.partition("#")
            assert (minimal / unquote(file)).is_file() or (not file and anchor), link
            assert not anchor or anchor in anchors[file or name], link


def test_elements_lead_to_their_drawing_and_lines_and_these_lead_back(minimal: Path) -> None:
    first = first_page(minimal)
    programs = html.fromstring((minimal / "programs.html").read_text("utf-8"))
    manifest = json.loads((minimal / "generated/manifest.json").read_text())
    for number, element in enumerate(manifest["elements"]):
        [row] = first.xpath(f"//tr[@id='e{number}']")
        links = row.xpath(".//a/@href")
        assert row[0].text_content() == element["element"]
        drawn = [x for x in links if x.startswith("nets.html#")]
        assert len(drawn) == (element["kind"] != "declaration")
        lines = [x for x in links if x.startswith("programs.html#")]
        assert len(lines) == len(element["code"])
        for link, code in zip(lines, element["code"], strict=True):
            [line] = programs.xpath(f"//span[@id='{link.split('#')[1]}']")
            own = (minimal / "generated" / code["file"]).read_text("utf-8").split("\n")
            assert line.text_content().endswith(f"{code['first']}{own[code['first'] - 1]}")
            assert f"index.html#e{number}" in line.xpath("./a/@href")


def test_in_the_dark_on_a_phone_and_on_paper(minimal: Path) -> None:
    seen = "document.querySelector('#e0').checkVisibility({ contentVisibilityAuto: true })"
    torn = """() => [...document.querySelectorAll("td.answer, thead th")].filter((cell) => {
        const range = document.createRange();
        range.selectNodeContents(cell);
        return range.getClientRects().length > cell.textContent.trim().split(/\\s+/).length;
    }).length"""
    with launched() as browser, opened(browser, **PHONE) as shown:
        for name in ("index.html", "programs.html"):
            for scheme in ("light", "dark"):
                shown.page.emulate_media(color_scheme=scheme)
                shown.page.goto((minimal / name).as_uri())
                assert complaints(shown) == [], (name, scheme)
            assert shown.ask("() => document.documentElement.scrollWidth") <= 390
            assert shown.ask(torn) == 0, "an answer is broken within a word"
        shown.page.goto((minimal / "index.html").as_uri())
        shown.wait(f"!{seen}")
        shown.page.emulate_media(media="print")
        shown.wait(seen)
        shown.page.locator("iframe").first.wait_for(state="hidden")
        shown.page.get_by_text("Released by").wait_for()
        assert shown.errors == []


def test_traceability(minimal: Path) -> None:
    manifest = json.loads((minimal / "generated/manifest.json").read_text())
    table = (minimal / "traceability.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(table.splitlines()))
    assert len(rows) == sum(len(e["code"]) or 1 for e in manifest["elements"])
    steps = [json.loads(x) for x in (minimal / "run/setting.trace.jsonl").read_text().splitlines()]
    occurred = Counter(s["transition"] for s in steps if "transition" in s)
    for row in rows:
        lines = (minimal / "generated" / row["file"]).read_text().splitlines()
        assert 1 <= int(row["first"]) <= int(row["last"]) <= len(lines)
        if row["kind"] == "transition":
            assert int(row["run"]) == occurred[row["element"]] > 0
    page = first_page(minimal).xpath("//section[@id='traceability']//tbody")
    there, back = ([" ".join(r.itertext()) for r in body] for body in page)
    assert len(there) == len(manifest["elements"]) and len(back) == len(rows)


def test_what_is_not_as_it_should_be_is_named(tmp_path: Path) -> None:
    cell = stock(tmp_path / "cell", "2\n")
    text = '[[property]]\nname = "no <b>end</b>"\nholds = "never { size (Mark.Sup\'Finished 1) > 0 }"\n'
    (cell / "cell.properties.toml").write_text(text)
    with forks():
        done = pn2code("report", cell, "-o", tmp_path / "out", "--backend", "fake")
    assert done.returncode == 1, done.stdout + done.stderr
    assert verdict(tmp_path / "out").startswith("Not as it should be: no <b>end</b>")
    assert commands(tmp_path / "out")["verify"] == "1"
    assert commands(tmp_path / "out")["conform"] == "0"  # the programs are those of the net
    assert broken(tmp_path / "out") == []


def test_what_cannot_be_made_is_left_out(tmp_path: Path) -> None:
    cell = stock(tmp_path / "cell", "2\n", STOCK.replace("in Pieces : n", "in Pieces : nn"))
    with forks():
        done = pn2code("report", cell, "-o", tmp_path / "out", "--backend", "fake")
    assert done.returncode == 1, done.stdout + done.stderr
    found = commands(tmp_path / "out")
    assert found["check"] == "1" and found["draw"] == "0"
    assert {found[v] for v in ("verify", "generate", "conform", "run")} == {"left out"}
    assert "nn" in first_page(tmp_path / "out").xpath("//section[@id='answers']")[0].text_content()
    assert "the programs (left out)" in verdict(tmp_path / "out")


def test_a_net_without_a_cell(tmp_path: Path) -> None:
    """Its commands are processes of their own, as users have them."""
    net = write(
        "net n\n  standard\n  page P\n    place A = 1\n    place B\n    trans T\n      in A : ()\n      out B : ()\n",
        tmp_path / "n.cpn",
    )
    done = pn2code("report", net, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stdout + done.stderr
    assert commands(tmp_path / "out").keys() == {"check", "draw", "verify", "generate", "conform"}
    done = pn2code("report", net, "-o", tmp_path / "out", "--layout", "a")
    assert done.returncode == 2 and "has no layouts" in done.stderr


def test_a_net_in_a_folder_below_the_cell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pn2code.dossier.steps._carried_out", lambda step, *_: Done(step, 3))
    cell = stock(tmp_path / "cell", "2\n")
    (cell / "nets").mkdir()
    (cell / "cell.cpn").rename(cell / "nets/cell.cpn")
    toml = (cell / "cell.toml").read_text().replace('"cell.cpn"', '"nets/cell.cpn"')
    (cell / "cell.toml").write_text(toml)
    done = pn2code("report", cell, "-o", tmp_path / "out")
    assert done.returncode == 3, done.stderr
    files = first_page(tmp_path / "out").xpath("(//section[@id='files']//table)[1]//th[@scope]")
    names = {f.text_content() for f in files}
    assert names == {"nets/cell.cpn", "cell.toml", "s.in"}
    done = pn2code("report", cell, "-o", tmp_path)
    assert done.returncode == 2 and "the cell is in" in done.stderr and cell.is_dir()


def test_folders_that_are_no_reports_are_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.dossier.steps._carried_out", lambda step, *_: Done(step, 3))
    net = tmp_path / "n.cpn"
    net.write_bytes(cpn("net n\n  standard\n  page P\n    place A = 1\n"))
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    done = pn2code("report", net, "-o", out)
    assert done.returncode == 2 and "is not empty, and no report" in done.stderr
    assert (out / "mine.txt").read_text() == "mine"
    (out / "SHA256SUMS").write_text("")  # others have such files, too
    done = pn2code("report", net, "-o", out)
    assert done.returncode == 2 and (out / "mine.txt").is_file()
    (out / ".pn2code-report").touch()
    done = pn2code("report", net, "-o", out)
    assert done.returncode == 3 and not (out / "mine.txt").exists()
    assert verdict(out).startswith("Nothing is known to be wrong, but not everything is known.")
    done = pn2code("report", net, "-o", net)
    assert done.returncode == 2 and "is not a folder" in done.stderr


ARM = 'model = "kr120_r2500"\ntool = "tool.urdf"\nbase = {}\nhome = [0.0, -100.0, 110.0, 0.0, 80.0, 0.0]\n'


@pytest.mark.parametrize("way", ["written and put back", "written"][: amount(1, 2)])
@pytest.mark.parametrize(
    "name", ["cell.toml", "cell.cpn", "s.in", "more.sml", "new.toml", "tool.urdf"]
)
def test_files_that_change_while_the_report_is_made(
    name: str, way: str, tmp_path: Path, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each command reads them anew: their answers may be about different ones, and no hash says which."""
    net = STOCK.replace("  var k", '  use "more.sml"\n  var k', 1)
    cell = stock(tmp_path / "cell", "2\n", net)
    (cell / "more.sml").write_text("val more = 1;\n")
    shutil.copy(root / "examples/assembly/cup.urdf", cell / "tool.urdf")
    toml = (cell / "cell.toml").read_text().replace("[devices.robot1]", "[robots.robot1]")
    (cell / "cell.toml").write_text(toml + ARM)

    def carried_out(step: Step, *_: object) -> Done:
        if step.verb == "generate" and way != "not at all":
            file = cell / name
            old = file.read_bytes() if file.is_file() else b""
            file.write_bytes(old + b" ")
            if way != "written":
                file.write_bytes(old)
        return Done(step, 0)

    monkeypatch.setattr("pn2code.dossier.steps._carried_out", carried_out)
    done = pn2code("report", cell, "-o", tmp_path / "out")
    assert done.returncode == 3, done.stdout + done.stderr
    assert f"changed while the report was made: `{name}`" in done.stdout
    said = verdict(tmp_path / "out")
    assert "Nothing is known to be wrong, but not everything is known" in said
    assert (
        f"Changed while the report was made, so that its commands may have looked at different ones: {name}."
        in said
    )
    way = "not at all"
    done = pn2code("report", cell, "-o", tmp_path / "out")
    assert done.returncode == 0, done.stdout + done.stderr
    files = first_page(tmp_path / "out").xpath("(//section[@id='files']//table)[1]//th[@scope]")
    assert {"more.sml", "tool.urdf", "s.in"} <= {f.text_content() for f in files}


def test_layouts_that_were_not_asked_for_are_named(
    tmp_path: Path, root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pn2code.dossier.steps._carried_out", lambda step, *_: Done(step, 0))
    done = pn2code(
        "report", root / "examples/riveting", "-o", tmp_path / "out", "--layout", "paper"
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "not looked at: the geometry and runs of layout" in done.stdout
    assert "Not looked at: the geometry and runs of layout" in verdict(tmp_path / "out")
    assert "All that was looked at is as it should be" in verdict(tmp_path / "out")
    done = pn2code("report", root / "examples/riveting", "-o", tmp_path / "out")
    assert "not looked at" not in done.stdout

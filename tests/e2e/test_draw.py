"""`pn2code draw` from a file to a file."""

from __future__ import annotations

import html
import re
from collections import Counter
from pathlib import Path

import imageio.v2 as imageio
import pypdf
import pytest
from lxml import etree

from helpers import netbuilder
from pn2code.base.progress_line import Line
from pn2code.cli import main
from pn2code.drawing import raster

SVG = "{http://www.w3.org/2000/svg}"

NET = """
net Twice
  standard
  var n : INT;
  page Top
    place A : INT = 2`1
    place B : INT = 1`7
    subst Left = Sub (Inp -> A)
    subst Right = Sub (Inp -> B)
  page Sub
    place Inp port in : INT
    trans Eat guard [n > 5]
      in Inp : n
"""


@pytest.fixture
def net(tmp_path: Path) -> Path:
    return netbuilder.write(NET, tmp_path / "twice.cpn")


def draw(*arguments: object) -> int:
    with pytest.raises(SystemExit) as left:
        main.app(["draw", *map(str, arguments)])
    return int(left.value.code or 0)


def texts(path: Path, kind: str) -> list[str]:
    root = etree.parse(path).getroot()
    return [
        span.text or ""
        for g in root.iter(f"{SVG}g")
        if kind in g.get("class", "").split()
        for span in g.iter(f"{SVG}tspan")
    ]


def test_one_page(net: Path, tmp_path: Path) -> None:
    out = tmp_path / "new" / "sub.svg"
    assert draw(net, "-o", out, "--page", "Sub") == 0
    assert texts(out, "place") == ["Inp"] and texts(out, "transition") == ["Eat"]


def test_all_pages_in_one_svg(net: Path, tmp_path: Path) -> None:
    out = tmp_path / "all.svg"
    assert draw(net, "-o", out) == 0
    assert texts(out, "place") == ["A", "B", "Inp"]


def test_a_folder_has_one_svg_for_each_page(net: Path, tmp_path: Path) -> None:
    assert draw(net, "-o", f"{tmp_path / 'pages'}/") == 0
    assert sorted(p.name for p in (tmp_path / "pages").iterdir()) == ["Sub.svg", "Top.svg"]
    assert 'href="Sub.svg"' in (tmp_path / "pages" / "Top.svg").read_text()


def test_html(net: Path, tmp_path: Path) -> None:
    out = tmp_path / "net.html"
    assert draw(net, "-o", out) == 0
    written = out.read_text(encoding="utf-8")
    assert written.startswith("<!DOCTYPE html>") and written.count("<svg") == 2
    assert draw(net, "-o", out) == 0
    assert out.read_text(encoding="utf-8") == written


def test_standard_output(net: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert draw(net, "-o", "-", "--page", "Top") == 0
    assert etree.fromstring(capsys.readouterr().out.encode()).tag == f"{SVG}svg"


def test_marking_of_the_first_and_of_another_instance(net: Path, tmp_path: Path) -> None:
    out = tmp_path / "sub.svg"
    assert draw(net, "-o", out, "--page", "Sub", "--marking") == 0
    assert texts(out, "tokens") == ["2`1", "2"] and texts(out, "enabled") == []
    assert draw(net, "-o", out, "--page", "Sub", "--marking", "--instance", 2) == 0
    assert texts(out, "tokens") == ["1`7", "1"] and texts(out, "enabled") == ["Eat"]


def test_html_shows_each_marking_of_a_page_that_differs(net: Path, tmp_path: Path) -> None:
    out = tmp_path / "net.html"
    assert draw(net, "-o", out, "--marking") == 0
    written = out.read_text(encoding="utf-8")
    assert written.count("<svg") == 3
    assert "<figcaption>instance 1</figcaption>" in written
    assert "<figcaption>instance 2</figcaption>" in written


WRONG = NET.replace("in Inp : n", "in Inp : m")


def test_a_net_with_errors_is_drawn_with_what_is_wrong_in_red(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    net = netbuilder.write(WRONG, tmp_path / "wrong.cpn")
    out = tmp_path / "wrong.svg"
    assert draw(net, "-o", out) == 0
    root = etree.parse(out).getroot()
    titles = [t.text or "" for t in root.iter(f"{SVG}title")]
    assert any(t.startswith("error: `m` is not declared") for t in titles)
    assert "shown in red" in capsys.readouterr().err
    out.unlink()
    assert draw(net, "-o", out, "--marking") == 1
    assert out.exists() and texts(out, "tokens") == []


def test_an_arc_without_an_end_does_not_keep_the_rest_from_being_drawn(tmp_path: Path) -> None:
    net = tmp_path / "dangling.cpn"
    data = netbuilder.cpn(NET)
    place = data[data.index(b"<placeend") :].split(b"/>")[0]
    net.write_bytes(data.replace(place, b'<placeend idref="nowhere"', 1))
    out = tmp_path / "dangling.svg"
    assert draw(net, "-o", out) == 0
    assert texts(out, "place") == ["A", "B", "Inp"]


# --- wrong usage ---------------------------------------------------------------------------------


def test_an_unknown_page_gets_a_suggestion(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert draw(net, "-o", tmp_path / "x.svg", "--page", "Subb") == 2
    error = capsys.readouterr().err
    assert "draw-page" in error and "did you mean `Sub`?" in error
    assert draw(net, "-o", tmp_path / "x.svg", "--page", "Quite another") == 2
    assert "the pages are `Top`, `Sub`" in capsys.readouterr().err
    assert not (tmp_path / "x.svg").exists()


@pytest.mark.parametrize("name", ["net.jpg", "net.xyz", "net"])
def test_other_formats_are_refused(
    net: Path, tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert draw(net, "-o", tmp_path / name) == 2
    assert "draw-output" in capsys.readouterr().err


def test_output_that_cannot_be_written(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert draw(net, "-o", tmp_path / "file" / "net.svg") == 2
    assert "cannot write" in capsys.readouterr().err


def test_instances_that_do_not_exist(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "x.svg"
    assert draw(net, "-o", out, "--page", "Sub", "--marking", "--instance", 3) == 2
    assert "numbered 1 to 2" in capsys.readouterr().err
    assert draw(net, "-o", out, "--instance", 1) == 2
    assert draw(net, "-o", out, "--marking", "--instance", 1) == 2


def test_a_missing_net(tmp_path: Path) -> None:
    assert draw(tmp_path / "no.cpn", "-o", tmp_path / "x.svg") == 2
    assert list(tmp_path.iterdir()) == []


def test_pages_without_a_usable_layout_are_noted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    net = tmp_path / "flat.cpn"
    net.write_bytes(netbuilder.cpn(NET).replace(b"<posattr", b"<nowhere"))
    assert draw(net, "-o", tmp_path / "flat.svg") == 0
    assert "arranged automatically" in capsys.readouterr().err


def test_the_riveting_cell(root: Path, tmp_path: Path) -> None:
    out = tmp_path / "cell.html"
    assert draw(root / "examples" / "riveting", "-o", out, "--marking") == 0
    assert out.read_text(encoding="utf-8").count("<section") >= 12


def test_png(net: Path, tmp_path: Path) -> None:
    assert draw(net, "-o", tmp_path / "top.png", "--page", "Top", "--marking") == 0
    assert draw(net, "-o", tmp_path / "top.svg", "--page", "Top", "--marking") == 0
    picture = imageio.imread(tmp_path / "top.png")
    root = etree.parse(tmp_path / "top.svg").getroot()
    size = [2 * float(root.attrib[name]) for name in ("height", "width")]
    assert picture.shape[:2] == pytest.approx(size, abs=1)
    colours = {tuple(map(int, p)) for row in picture[..., :3] for p in row}
    assert (255, 255, 255) in colours and len(colours) > 10
    green = [c for c in colours if c[1] > c[0] + 40 and c[1] > c[2] + 40]
    assert green, "the number of tokens"


def test_each_text_is_once_in_a_pdf(net: Path, tmp_path: Path) -> None:
    """The white edge of a text is a shape: it is neither read nor found; equal ones are kept once."""
    assert draw(net, "-o", tmp_path / "net.pdf") == 0
    assert draw(net, "-o", tmp_path / "net.svg", "--page", "Top") == 0
    svg = (tmp_path / "net.svg").read_text(encoding="utf-8")
    top = pypdf.PdfReader(tmp_path / "net.pdf").pages[0]
    contents = top.get_contents()
    assert contents is not None
    edges = svg.count('paint-order="stroke"')
    assert edges > 3
    assert contents.get_data().count(b" Do\n") == edges
    assert b"1 Tr\n" not in contents.get_data()
    written = [html.unescape(x) for x in re.findall(r"<tspan [^>]*>([^<]+)</tspan>", svg)]
    letters = Counter("".join("".join(written).split()))
    assert Counter("".join(top.extract_text().split())) == letters


def test_pdf(net: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    say = Line.say
    monkeypatch.setattr(Line, "say", lambda line, text: (said.append(text), say(line, text)))
    assert draw(net, "-o", tmp_path / "net.pdf", "--marking") == 0
    assert "making a PDF of 2 pages ..." in said, "of a large page it takes half a minute"
    top, sub = pypdf.PdfReader(tmp_path / "net.pdf").pages
    assert "Left" in top.extract_text() and "1`7" in top.extract_text()
    assert "Eat" in sub.extract_text() and "[n > 5]" in sub.extract_text()


def test_what_is_missing_is_named(
    net: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert draw(net, "-o", tmp_path / "net.png") == 2
    assert "`resvg_py`" in (error := capsys.readouterr().err) and "pn2code[pictures]" in error


def test_a_drawing_that_is_too_large_for_its_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    svg = '<svg xmlns="http://www.w3.org/2000/svg" width="400" height="100"></svg>'
    assert imageio.imread(raster.png(svg)).shape[:2] == (200, 800)
    monkeypatch.setattr(raster, "_MOST_PIXELS", 10_000)
    assert imageio.imread(raster.png(svg)).shape[:2] == (50, 200)

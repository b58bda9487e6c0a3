"""A folder that any static host serves as it is: pages of runs, counterexamples and nets: `./dev site -o site`.

    ./dev site                  # writes site/: index.html and one HTML file for each example
    ./dev site --backend fake   # without PyBullet, and so without clearances

Each page is one file with all that it needs, and says itself (by its content security policy) that it loads nothing and
asks nobody. So there is nothing to set up at the host: no server program, no headers, no folder that must be named so.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from html import escape
from pathlib import Path

from pn2code.base.frozen import frozen

ROOT = Path(__file__).parents[1]
_PICTURE = ROOT / "docs/pictures/replay.webp"
_MARK = ".pn2code-site"
"""A folder with this file is one that was written here, and may be replaced."""


@frozen
class Entry:
    """A page of the site: its file, its title, what is to be seen, and the command that made it."""

    file: str
    title: str
    text: str
    command: str


RUNS = (
    (
        "riveting",
        "Two arms rivet a fuselage",
        "Follow a rivet: a click on a bar in the chart leads to transition, line of code and pose.",
    ),
    (
        "handover",
        "Two arms hand parts over",
        "Parts are carried from hand to hand; the lines between arms are their clearances.",
    ),
    (
        "sorting",
        "A robot sorts what a camera has seen",
        "What sensors say is left open by the net; here it comes from files.",
    ),
)
PHILOSOPHERS = "examples/philosophers/philosophers.cpn"


def made(out: Path, work: Path, backend: str, cells: Sequence[str]) -> list[Entry]:
    """Writes all pages but the first."""
    found = []
    for cell, title, text in RUNS:
        if cell not in cells:
            continue
        folder = work / cell
        line = ["run", f"examples/{cell}", "--backend", backend, "--no-pictures"]
        _pn2code([*line, "-o", str(folder)])
        shutil.copy(folder / "replay.html", out / f"{cell}.html")
        found.append(Entry(f"{cell}.html", title, text, " ".join(line)))
    traces = work / "traces"
    _pn2code(["verify", PHILOSOPHERS, "-o", str(traces)], may_say_no=True)
    dead = min(traces.glob("*.dead-*.trace.jsonl"))
    _pn2code(["show", str(dead), PHILOSOPHERS, "-o", str(out / "deadlock.html")])
    text = (
        "The shortest run into a deadlock, found by exploring all markings, to be stepped through."
    )
    command = f"verify {PHILOSOPHERS}, show {dead.name} {PHILOSOPHERS}"
    found.append(Entry("deadlock.html", "Philosophers starve", text, command))
    line = ["draw", "examples/riveting/cell.cpn", "--marking"]
    _pn2code([*line, "-o", str(out / "net.html")])
    text = "All pages as their author drew them, linked with each other."
    found.append(Entry("net.html", "The net of the riveting cell", text, " ".join(line)))
    return found


def _pn2code(arguments: list[str], *, may_say_no: bool = False) -> None:
    print(f"site: pn2code {' '.join(arguments)}", file=sys.stderr)
    command = [sys.executable, "-m", "pn2code", *arguments]
    code = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL).returncode
    if code not in ((0, 1) if may_say_no else (0,)):
        raise SystemExit(f"site: `pn2code {' '.join(arguments)}` ended with exit code {code}")


def index(entries: Sequence[Entry], picture: str) -> str:
    """The first page: no script, nothing from elsewhere."""
    rows = "\n".join(
        f'<li><a href="{escape(e.file)}">{escape(e.title)}</a><p>{escape(e.text)}</p>'
        f"<p><code>pn2code {escape(e.command)}</code></p></li>"
        for e in entries
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>pn2code: robot cells as Coloured Petri nets</title>
<style>
:root {{ color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }}
body {{ max-width: 60rem; margin: 0 auto; padding: 1rem; }}
img {{ max-width: 100%; height: auto; border-radius: 8px; }}
ul {{ list-style: none; padding: 0; display: grid; gap: 1rem; }}
ul {{ grid-template-columns: repeat(auto-fit, minmax(17rem, 1fr)); }}
li {{ border: 1px solid #8886; border-radius: 8px; padding: .8rem 1rem; }}
li a {{ font-weight: 650; font-size: 1.1rem; }}
p {{ margin: .4rem 0; }}
code {{ font-size: .8rem; overflow-wrap: anywhere; }}
</style>
</head>
<body>
<h1>Robot cells as Coloured Petri nets</h1>
<p>Each page shows a run: the net's tokens, the arms in 3D, the messages and the chart move together.
Space plays; ? lists all keys.</p>
<p><img src="{escape(picture)}" width="960" height="540" alt="The page of a run, while it plays"></p>
<ul>
{rows}
</ul>
</body>
</html>
"""


def write(out: Path, backend: str, cells: Sequence[str]) -> None:
    """Writes the site; a folder with anything else in it is left alone."""
    if out.exists() and any(out.iterdir()) and not (out / _MARK).is_file():
        raise SystemExit(f"site: `{out}` holds other files; give a new or empty folder")
    with tempfile.TemporaryDirectory(prefix="pn2code-site-") as name:
        work = Path(name)
        new = work / "site"
        new.mkdir()
        entries = made(new, work, backend, cells)
        shutil.copy(_PICTURE, new / _PICTURE.name)
        (new / "index.html").write_text(index(entries, _PICTURE.name), encoding="utf-8")
        (new / _MARK).write_text("", encoding="utf-8")
        if out.exists():
            shutil.rmtree(out)
        shutil.copytree(new, out)
    size = sum(f.stat().st_size for f in out.iterdir())
    print(f"{out}: {len(entries) + 1} pages, {size / 1e6:.1f} MB")


def main() -> None:
    """Writes the site."""
    parser = argparse.ArgumentParser(prog="./dev site", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "site", metavar="DIR")
    parser.add_argument("--backend", choices=("bullet", "fake"), default="bullet")
    parser.add_argument(
        "--cells",
        nargs="*",
        default=[name for name, _, _ in RUNS],
        metavar="CELL",
        help="which examples",
    )
    asked = parser.parse_args()
    write(asked.output, asked.backend, asked.cells)


if __name__ == "__main__":
    main()

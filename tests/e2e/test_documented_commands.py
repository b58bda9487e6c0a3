"""Every command line of README.md, docs and the examples' READMEs is typed as it is printed, and ends well."""

from __future__ import annotations

import re
import shlex
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import typer

from helpers.documents import Block, Desk, blocks, documents, mentions, without_comment
from helpers.netbuilder import write
from helpers.processes import pn2code
from helpers.session import common, once
from helpers.small_cell import write as write_cell
from helpers.thorough import THOROUGH
from pn2code.cli.main import VERBS, app
from pn2code.toolchain import build

ROOT = Path(__file__).resolve().parents[2]
BLOCKS = [block for path in documents(ROOT) for block in blocks(path, ROOT)]

CELLS = "test_example_cells does the same"
LIKE_MINIMAL = "the same with the minimal cell is typed in each run of the tests"
LIKE_SORTING = "the same with the sorting cell is typed in each run of the tests"
OTHERS = (
    "assembly",
    "handover",
    "machining",
    "palletiser",
    "shared-zone",
    "tending",
    "timed",
    "welding",
)
"""Examples whose READMEs begin like that of the sorting cell."""
LONG = {
    "./dev cell": "the riveting cell in PyBullet with all of its pictures: 20 seconds",
    "pn2code run examples/riveting --layout paper": "the same in another layout",
    "pn2code run examples/riveting": "the same",
    "pn2code run examples/riveting --layout good --backend fake": "test_run_cell does the same",
    "pn2code run examples/minimal --backend fake --cycles 10": "test_many_cycles runs a smaller cell",
    "pn2code run examples/minimal -o run": "PyBullet with pictures; test_run_cell does it with the riveting cell",
    "pn2code verify pick": LIKE_MINIMAL,
    "pn2code run examples/palletiser": "PyBullet with pictures; test_carrying does it with a smaller cell",
    "pn2code contest DIR ReachabilityFireability": "test_contest_command does the same",
    "pn2code conform cell.toml --generated DIR": "test_conform does the same",
    "spin -a net.pml && gcc -O2 -DSAFETY -DNOREDUCE -o pan pan.c && ./pan -m20000000 -w24": "test_spin does the same",
    "pn2code run examples/riveting --input examples/riveting/faults": "the same",
    "pn2code run examples/riveting --realtime --live": "two minutes of real time; test_live runs a smaller cell",
    "pn2code run examples/sorting --realtime --live --intervene": "two minutes of real time; test_intervening does it",
    "pn2code replay run/cell.trace.jsonl examples/riveting": "needs the line before",
    "pn2code verify examples/riveting --report report.html": CELLS,
    "pn2code verify examples/riveting": CELLS,
    "pn2code verify examples/sorting": CELLS,
    "pn2code verify examples/shared-zone --no-medium": CELLS,
    "pn2code verify examples/timed": "31,014 markings with their times, and the medium",
    "pn2code check --geometry examples/riveting --layout good --jobs 1": "10 seconds; test_check_geometry has cells",
    "pn2code check --geometry examples/riveting --layout paper --jobs 1": "the same",
    "pn2code check --geometry examples/shared-zone": "test_geometry looks at smaller cells; ./dev geometry at this one",
    "pn2code reach examples/riveting --layout paper --robot robot2": "10 seconds; test_reach_map has fewer bases",
    "pn2code run examples/handover --backend fake -o run": CELLS,
    "pn2code run examples/sorting --backend fake --cycles 50 --warm-up 5 --seed 1 --stops robot:600/30 -o many": "a "
    "minute; test_many_cycles runs a smaller cell",
    "pn2code place examples/riveting --layout paper --free robot2.base.x,y,z,yaw": "two minutes; test_place places a "
    "smaller cell",
    "pn2code time examples/handover --run run": "needs the line before",
    "pn2code time examples/tending": "test_time_bounds asks about it",
    "./dev geometry": "two minutes; test_geometry looks at smaller cells",
    "./dev geometry --pairs 400": "half a minute; test_pairs_of_moves has fewer",
    "pn2code conform examples/riveting": "10 seconds; test_riveting_net compares it",
    "pn2code conform examples/sorting": "all states of a larger cell: a minute",
    "pn2code conform examples/shared-zone --most 1500": "the same",
    'pn2code verify net.cpn --memory 128 --property "bound Supervisor\'Finished <= 1" '
    '--property "reachable { size (Mark.Supervisor\'Scrap 1) = 10 }"': "test_sweep has smaller nets",
    "pn2code verify examples/handover": CELLS,
    "pn2code report examples/minimal -o report": "test_report does the same",
    "pn2code verify examples/tending": CELLS,
    "pn2code conform examples/tending": "all states of a larger cell",
    "pn2code run examples/tending --backend fake": CELLS,
    "pn2code generate examples/tending -o out && make -C out": CELLS,
    "pn2code check --geometry examples/welding": "./dev geometry looks at it",
    "pn2code verify examples/welding": CELLS,
    "pn2code generate examples/welding -o out && make -C out": CELLS,
    "pn2code conform examples/welding": "all states of a larger cell",
    "pn2code time examples/welding": "test_time_bounds asks about it",
    "pn2code run examples/welding --backend fake": CELLS,
    "pn2code verify examples/welding --durations": "test_verify_durations asks a smaller cell",
    "pn2code verify examples/welding --durations --property \"every fires(Supervisor'Turned) is followed by "
    "fires(Supervisor'Both) within 60 seconds\"": "the same",
    "pn2code check --geometry examples/machining": "./dev geometry looks at it",
    "pn2code verify examples/machining": CELLS,
    "pn2code generate examples/machining -o out && make -C out": CELLS,
    "pn2code conform examples/machining": "all states of a larger cell",
    "pn2code run examples/machining": "test_examples_in_3d does it",
    "pn2code check --geometry examples/assembly": "./dev geometry looks at it",
    "pn2code verify examples/assembly": CELLS,
    "pn2code generate examples/assembly -o out && make -C out": CELLS,
    "pn2code conform examples/assembly": "all states of a larger cell",
    "pn2code time examples/assembly": "test_time_bounds asks about it",
    "pn2code run examples/assembly --backend fake": CELLS,
    "pn2code verify handover --report handover.html": CELLS,
    "pn2code run handover --backend fake -o run": CELLS,
    "pn2code replay run/cell.trace.jsonl handover": "needs the line before",
    "pn2code conform examples/handover": LIKE_MINIMAL,
    "pn2code run examples/handover --backend fake": CELLS,
    "pn2code generate examples/handover -o out && make -C out": CELLS,
    "pn2code verify examples/palletiser": CELLS,
    "pn2code generate examples/palletiser -o out && make -C out": CELLS,
    "pn2code conform examples/timed --set parts=1 --set orders=1": "the same",
    "pn2code run examples/sorting --backend fake": CELLS,
    "pn2code run examples/shared-zone --backend fake": CELLS,
    "pn2code run examples/timed --backend fake": CELLS,
    "pn2code generate examples/sorting -o out && make -C out": CELLS,
    "pn2code generate examples/shared-zone -o out && make -C out": CELLS,
    "pn2code generate examples/timed -o out && make -C out": CELLS,
    "pn2code generate mynet.cpn -o out && make -C out && out/supervisor": "test_dry_runs builds and plays such nets",
    "pn2code conform handover": LIKE_MINIMAL,
    "pn2code run first --backend fake": LIKE_MINIMAL,
    "pn2code conform examples/palletiser": LIKE_MINIMAL,
    "pn2code verify examples/timed --reduce time --no-found --no-controller --no-medium": "the same with another "
    "value is typed in each run of the tests",
    "pn2code verify philosophers.cpn --set n=15 --plot plot.svg": "a large state space",
    "pn2code verify examples/philosophers/philosophers.cpn --set n=1000 --unfold --no-found --max-seconds 300": "the "
    "same with fewer is typed in each run of the tests",
    "pn2code simulate mynet.cpn --steps 1000000 --trace run.trace.jsonl": "a long trace",
    **{f"pn2code check examples/{name}": CELLS for name in OTHERS},
    **{f"pn2code simulate examples/{name} --seed 5": LIKE_SORTING for name in OTHERS},
}
"""Too long for each run of the tests; `make thorough` types them, too. With the reason."""

WATCHED = "it goes on until somebody ends it; test_watch_page does the same"
PLAYED = "a server that goes on until somebody ends it; test_play_server begins and ends it"
NEVER = {
    "./dev test": "these are the tests",
    "./dev bench": "minutes of measuring on an idle machine; tools/bench has its own tests",
    "./dev bench --firings": "the same",
    "./dev bench --states": "the same",
    "./dev bench --monitor": "the same",
    "./dev bench --swarm": "the same",
    "pn2code verify net.cpn --swarm 64": "a swarm never says yes; test_swarm_command has one",
    "pn2code verify net.cpn --swarm 10000 --scheduler tcp://host:8786 --max-states 100000000 --memory 4096": "there is "
    "no such host; a scheduler elsewhere is asked as the one here",
    "./dev bench --play": "the same, in a browser",
    "./dev bench --compile": "the same",
    "./dev bench --compile --sizes 102 201 501 1002": "the same",
    "./dev bench --replay": "the same, in a browser",
    "./dev bench --live examples/riveting --repeat 3": "the same",
    "./dev site -o site": "runs of three cells in PyBullet; test_site has its first page",
    "./dev bench --against CHECKOUT": "the same, and another checkout",
    "./dev bench --database-15": "the same, and gigabytes",
    "./dev contest --every 4 --seconds 60 --examinations StateSpace ReachabilityFireability CTLCardinality "
    "CTLFireability LTLFireability": "hours; test_contest_command does it for one net",
    "./dev contest --seconds 10 --examinations ReachabilityDeadlock UpperBounds --log contest.jsonl": "hours; "
    "test_contest_command does it for one net",
    'make CC="python3 -m ziglang cc -target aarch64-linux-musl" supervisor supervisor.traced simulate': "test_aarch64 "
    "does it where there is a compiler for it",
    "make misra": "test_misra does it",
    "make mutation": "twenty minutes; test_conform changes programs, too",
    "pn2code run mycell --realtime --live --port 8080 --speed 2": "test_live does the same",
    "pn2code watch shared --cell examples/riveting": WATCHED,
    "pn2code watch run": WATCHED,
    "pn2code play mynet.cpn": PLAYED,
    "pn2code play examples/philosophers/philosophers.cpn": PLAYED,
    "pn2code play mynet.cpn --trace mynet.dead-40.trace.jsonl": PLAYED,
    "pn2code play mycell --no-browser --port 8080": PLAYED,
    "pn2code show run --compare other-run -o both.html": "needs a run of another time; test_compare does the same",
    ". .venv/bin/activate": "the environment of the tests is one of another place",
}
"""Typed by people only, with the reason."""

NEEDS = {"spin": "https://spinroot.com, for the export to it"}
"""Programs that are not part of the project: where one is missing, its line is left out, and test_spin says so, too."""

NET = """
net Net
  standard
  val n = 3;
  colset SEATS = index seat with 1..3;
  colset LEVEL = int with 0..20;
  var k : LEVEL;
  var s : SEATS;
  page Top
    place Free : SEATS = SEATS.all ()
    place Buffer : SEATS
    place Work : LEVEL = 1`n
    subst Sender = Sender (Free -> Free, Buffer -> Buffer)
    trans Take
      in Buffer : s
      out Free : s
      both Work : k
  page Sender
    place Free port in : SEATS
    place Buffer port out : SEATS
    trans Put
      in Free : s
      out Buffer : s
"""
PNML = """<?xml version="1.0"?>
<pnml xmlns="http://www.pnml.org/version-2009/grammar/pnml">
  <net id="net" type="http://www.pnml.org/version-2009/grammar/ptnet">
    <page id="page">
      <place id="p"><initialMarking><text>2</text></initialMarking></place>
      <place id="q"/>
      <transition id="there"/>
      <transition id="back"/>
      <arc id="a1" source="p" target="there"/>
      <arc id="a2" source="there" target="q"/>
      <arc id="a3" source="q" target="back"/>
      <arc id="a4" source="back" target="p"/>
    </page>
  </net>
</pnml>
"""
PROPERTY = """[[property]]
name = "{name}"
holds = "always {{ size (Mark.Top'Buffer 1) <= n }}"
"""


def lay_out(at: Path) -> None:
    """What the documents call the reader's own: net.cpn, mynet.cpn, net.pnml, cell.toml, and what it gives in DIR."""
    at.mkdir()
    for name in ("net", "mynet"):
        write(NET, at / f"{name}.cpn")
    (at / "net.pnml").write_text(PNML)
    trace = at / "net.dead-40.trace.jsonl"
    for made in (
        pn2code("simulate", at / "net.cpn", "--steps", "4", "--trace", trace),
        pn2code("generate", write_cell(at), "-o", at / "DIR"),
    ):
        assert made.returncode == 0, made.stderr
    shutil.copy(trace, at / "run.trace.jsonl")


def in_folder(name: str) -> Callable[[Desk], None]:
    """The document is about what lies there."""

    def go(desk: Desk) -> None:
        desk.at = desk.project / name

    return go


def with_input(desk: Desk) -> None:
    """DIR is an input of the Model Checking Contest: a net and formulas."""
    folder = desk.project / "DIR"
    shutil.copy(desk.project / "net.pnml", folder / "model.pnml")
    (folder / "ReachabilityFireability.xml").write_text(
        '<property-set xmlns="http://mcc.lip6.fr/"/>'
    )


def with_run(desk: Desk) -> None:
    """The folder of a run is there, but where all lines are typed, one of which makes it."""
    if not THOROUGH:
        quick = ("--backend", "fake", "--no-pictures")
        done = pn2code("run", ROOT / "examples/minimal", *quick, "-o", desk.project / "run")
        assert done.returncode == 0, done.stderr


def with_properties(desk: Desk) -> None:
    """net.cpn has files with properties beside it."""
    for name in ("net.properties.toml", "other.toml"):
        (desk.project / name).write_text(PROPERTY.format(name=name))


def with_text(desk: Desk) -> None:
    """The document has nets as text in it, the second one with its cell."""
    printed = (ROOT / "docs/text.md").read_text(encoding="utf-8")
    nets = re.findall(r"^```cpnt\n(.*?)^```", printed, re.MULTILINE | re.DOTALL)
    (cell,) = re.findall(r"^```toml\n(.*?)^```", printed, re.MULTILINE | re.DOTALL)
    (desk.project / "belt.cpnt").write_text(nets[0], encoding="utf-8")
    (desk.project / "pick").mkdir()
    (desk.project / "pick" / "cell.cpnt").write_text(nets[1], encoding="utf-8")
    (desk.project / "pick" / "cell.toml").write_text(cell, encoding="utf-8")


PLACES: dict[str, Callable[[Desk], None]] = {
    "docs/contest.md": with_input,
    "docs/execution.md": in_folder("generated/riveting"),
    "docs/properties.md": with_properties,
    "docs/replay.md": with_run,
    "docs/text.md": with_text,
    "examples/philosophers/README.md": in_folder("examples/philosophers"),
}
"""Where a document's reader is, if not in the project's folder, and what else there is."""


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """What `make` builds need not be quick."""
    monkeypatch.setenv("CFLAGS", "-O0")


@pytest.mark.cc
@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    "document",
    sorted({b.document for b in BLOCKS if THOROUGH or set(b.lines) - set(LONG) - set(NEVER)}),
)
def test_as_printed(
    document: str, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    if build.find_compiler() is None:
        pytest.skip("no C compiler")
    desk = Desk(tmp_path, ROOT, common(tmp_path_factory) / "objects")
    own = once(tmp_path_factory, "reader", lay_out)
    shutil.copytree(own, desk.project, dirs_exist_ok=True)
    PLACES.get(document, lambda _: None)(desk)
    skipped = {**NEVER, **({} if THOROUGH else LONG)}
    lacking = [word for word in NEEDS if shutil.which(word) is None]
    for block in (b for b in BLOCKS if b.document == document):
        lines = {x: "" for x in block.lines if any(re.search(rf"\b{w} ", x) for w in lacking)}
        desk.go(block, {**skipped, **lines})


def test_what_is_left_out_is_printed_somewhere() -> None:
    printed = {line for block in BLOCKS for line in block.lines}
    assert set(LONG) | set(NEVER) <= printed


def options_of(verb: str) -> set[str]:
    command: Any = typer.main.get_command(app).get_command(None, verb)  # type: ignore[attr-defined]
    return {o for p in command.params for o in (*p.opts, *p.secondary_opts)} | {"--help"}


@pytest.mark.parametrize("path", documents(ROOT), ids=lambda p: p.relative_to(ROOT).as_posix())
def test_what_is_mentioned_exists(path: Path) -> None:
    """Commands in the middle of a sentence: verbs and options."""
    verbs = (ROOT / "dev").read_text()
    for text in mentions(path):
        words = [w.partition("=")[0] for w in shlex.split(text)]
        if words[0] == "./dev":
            assert re.search(rf"^    [\w |-]*\b{words[1]}\b[\w |-]*\)", verbs, re.MULTILINE), text
            words = words[1:]
        if words[0] != "pn2code" or words[1:2] in (
            [],
            ["VERB"],
            ["..."],
            ["--version"],
            ["--install-completion"],
            ["--show-completion"],
        ):
            continue
        assert words[1] in VERBS, text
        unknown = {w for w in words[2:] if w.startswith("-")} - options_of(words[1])
        assert not unknown, text


def test_reading_of_documents(tmp_path: Path) -> None:
    text = """
Text, `pn2code check --json` in it.

```sh
$ pn2code check net.cpn   # what is wrong
cd out && make
```

    pn2code verify net.cpn --property "a # b"   # a comment
    said by it

```json
{"pn2code": 1}
```
"""
    path = tmp_path / "text.md"
    path.write_text(text)
    assert list(blocks(path, tmp_path)) == [
        Block("text.md", 5, ("pn2code check net.cpn", "cd out && make")),
        Block("text.md", 9, ('pn2code verify net.cpn --property "a # b"',)),
    ]
    assert list(mentions(path)) == ["pn2code check --json"]
    assert without_comment("$ make # all") == "make"
    path.write_text("```sh\nrm -rf everything\n```\n")
    with pytest.raises(ValueError, match=r"text\.md:2: no command that is known"):
        list(blocks(path, tmp_path))

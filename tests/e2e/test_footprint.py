"""What the deployed supervisor of the riveting cell takes of a machine (pn2code.toolchain.footprint)."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers import list_cell
from pn2code.cli.main import app
from pn2code.toolchain import footprint
from pn2code.toolchain.footprint import FootprintError, Graph, long_functions, read_graph

pytestmark = pytest.mark.cc


@pytest.fixture
def built(riveting_program: Path) -> Path:
    if shutil.which("gcc") is None or shutil.which("objdump") is None:
        pytest.skip("the call graph needs gcc and binutils")
    return riveting_program


def test_the_riveting_supervisor(built: Path, tmp_path: Path) -> None:
    folder = tmp_path / "program"
    shutil.copytree(built, folder)

    found = footprint.measure(folder)

    assert found.is_good, found.report()
    assert found.text <= 60_000
    assert found.ram <= 300_000 and 0 < found.arena < 20_000, found.report()
    assert found.path[0] == "main" and found.stack > 1000
    assert not {"fopen", "opendir", "readdir", "realpath"} & set(found.library)


def test_what_is_deployed_has_no_code_of_others(built: Path) -> None:
    own, traced = ((built / name).read_bytes() for name in ("supervisor", "supervisor.traced"))
    for name in (b"Robot_Accept_fire", b"pn_json", b"pn_trace_open", b"sup_run_alone"):
        assert name in traced and name not in own


NOTES = """
node: { title: "main" label: "main\\nx.c:1:1\\n16 bytes (static)" }
node: { title: "x.c:walk" label: "walk\\nx.c:2:1\\n32 bytes (static)" }
edge: { sourcename: "main" targetname: "x.c:walk" }
"""


def test_recursion_is_found() -> None:
    again = NOTES + 'edge: { sourcename: "x.c:walk" targetname: "main" }'
    linked = frozenset(("main", "walk"))

    assert read_graph(NOTES, frozenset(), linked).deepest("main") == (48, ("main", "x.c:walk"))
    assert set(read_graph(again, frozenset(), linked).cycle()) == {"main", "x.c:walk"}
    assert Graph({"f": frozenset("f")}, {"f": 1}, ()).cycle() == ("f",)


WALKS = """
node: { title: "main" label: "main\\nx.c:1:1\\n16 bytes (static)" }
node: { title: "pn_type.c:compare" label: "compare\\nx.c:2:1\\n32 bytes (static)" }
node: { title: "pn_type.c:compare_parts" label: "compare_parts\\nx.c:3:1\\n8 bytes (static)" }
node: { title: "order" label: "order\\nx.c:4:1\\n4 bytes (static)" }
edge: { sourcename: "main" targetname: "pn_type.c:compare" }
edge: { sourcename: "pn_type.c:compare" targetname: "pn_type.c:compare_parts" }
edge: { sourcename: "pn_type.c:compare_parts" targetname: "pn_type.c:compare" }
edge: { sourcename: "pn_type.c:compare_parts" targetname: "order" }
"""


def test_what_walks_values_counts_once_a_level() -> None:
    linked = frozenset(("main", "compare", "compare_parts", "order"))
    walk = "compare + compare_parts (at most 3 times)"

    found = read_graph(WALKS, frozenset(), linked).with_walks(3)

    assert (found.cycle(), found.walks) == ((), (walk,))
    assert found.deepest("main") == (16 + 3 * (32 + 8) + 4, ("main", walk, "order"))
    of_net = WALKS.replace("pn_type.c:", "net.c:")
    back = WALKS + 'edge: { sourcename: "order" targetname: "pn_type.c:compare" }'
    for notes, levels in ((of_net, 3), (back, 3), (WALKS, 0)):
        again = read_graph(notes, frozenset(), linked).with_walks(levels)
        assert again.cycle() and not again.walks


def test_a_cell_whose_messages_are_lists(tmp_path: Path) -> None:
    """Lists of records, and records with lists in them: its values have three levels."""
    if shutil.which("gcc") is None or shutil.which("objdump") is None:
        pytest.skip("the call graph needs gcc and binutils")
    cell = list_cell.write(tmp_path / "cell")
    folder = tmp_path / "program"
    made = CliRunner().invoke(app, ["generate", str(cell), "-o", str(folder)])
    assert made.exit_code == 0, made.output
    subprocess.run(["make", "-s", "CC=gcc", "CFLAGS=-O1", "supervisor"], cwd=folder, check=True)

    found = footprint.measure(folder)

    assert found.is_good and found.stack > 1000, found.report()
    assert "pn_mkstr (at most 3 times)" in found.walks


def test_pointers_that_lead_nobody_knows_where_are_an_error() -> None:
    linked = frozenset(("main", "walk"))
    with pytest.raises(FootprintError, match="who calls walk"):
        read_graph(NOTES, frozenset(("walk",)), linked)
    calling = NOTES + 'edge: { sourcename: "x.c:walk" targetname: "__indirect_call" }'
    with pytest.raises(FootprintError, match="calls through a pointer"):
        read_graph(calling, frozenset(), linked)


def test_long_functions_are_found() -> None:
    body = "    x++;\n" * 59
    assert list(long_functions(f"void f(int x)\n{{\n{body}}}\n")) == [("f", 61)]
    assert list(long_functions(f"void f(int x)\n{{\n{body[9:]}}}\n")) == []


def test_large_frames_get_a_warning(built: Path, tmp_path: Path) -> None:
    """No error: records of the net may be large."""
    folder = tmp_path / "program"
    shutil.copytree(built, folder)
    for most, is_warned in ((16_384, False), (64, True)):
        (folder / "net_own.o").unlink()
        done = subprocess.run(
            ["make", "net_own.o", "CC=gcc", f"FRAME_MAX={most}"],
            cwd=folder, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert ("-Wstack-usage" in done.stderr) is is_warned

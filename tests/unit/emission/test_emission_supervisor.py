"""`cell_config.c` and `Makefile` (pn2code.emission.supervisor), and the filters of the templates."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.cell.partition import Channel, ChannelKind, Input, Owner, OwnerKind, Partition
from pn2code.diagnostics import NOWHERE
from pn2code.emission import c_flags
from pn2code.emission.environment import c_comment, c_float, c_int, c_string
from pn2code.emission.supervisor import emit
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Program
from pn2code.ml.core.types import INT, REAL, STRING
from pn2code.net.flat import FlatNet, FlatPlace
from pn2code.toolchain.programs import FLAGS

EMPTY = lowered(flat("net Cell\n  standard\n  place A : INT\n"))[0]
COORD = Colset("COORD", Kind.REAL, REAL)
COUNT = Colset("COUNT", Kind.INT, INT, low=0, high=9)
MODE = Colset("MODE", Kind.ENUM, STRING, names=("joint", "linear"))
POSE = Colset("POSE", Kind.RECORD, STRING, components=(COORD, MODE), labels=("x", "how"))
ORDER = Colset("ORDER", Kind.PRODUCT, STRING, components=(COUNT, POSE))


def place(index: int, name: str, colset: Colset) -> FlatPlace:
    return FlatPlace(
        index, f"Top.{name}", name, "Top", "Top", 1, f"ID{index}", colset, None, (NOWHERE,)
    )


def partition() -> Partition:
    places = (
        place(0, "orders", ORDER),
        place(1, "pose*/1", POSE),
        place(2, "done", COUNT),
        place(3, "end", COUNT),
    )
    program = Program.__new__(Program)  # the emitter does not look at declarations
    net = FlatNet("cell", "somewhere/cell.cpn", "ab" * 32, program, places, (), False, False)
    owners = (
        Owner(0, "supervisor", OwnerKind.SUPERVISOR, "Top/Supervisor"),
        Owner(1, "robot1", OwnerKind.ROBOT, "Top/Robot1"),
    )
    channels = (
        Channel("pose1", "pose1.robcad", 1, 0, 1, ChannelKind.DATA),
        Channel("done", "done.robcad", 2, 1, 0, ChannelKind.FLAG),
    )
    return Partition(
        net, owners, (), (0, None, None, 0), channels, (Input("orders", "orders.txt", 0),), (3,)
    )


def config(p: Partition) -> str:
    files = emit(
        p, name="cell", reply_timeout_s=120.0, digest="d" * 64, version="9.9", compiled=EMPTY
    )
    assert [f.path for f in files] == ["cell_config.c", "Makefile"]
    return files[0].text


def test_channels_inputs_and_final_places() -> None:
    text = config(partition())
    assert re.search(r'\.file = "pose1\.robcad",\s+\.place = 1U', text)
    assert text.index("PN_CHANNEL_DATA") < text.index("PN_CHANNEL_FLAG")  # I5
    assert text.count("PN_CHANNEL_OUT") == 1
    assert text.count("PN_CHANNEL_IN,") == 1
    assert '"joint", "linear"' in text
    assert '.label = "#2.how", .colset = "MODE"' in text
    assert ".low = INT64_C(0), .high = INT64_C(9)" in text
    assert ".reply_timeout_s = 120.0," in text
    assert re.search(r"s_final\[\] = \{\s+3U,", text)
    assert ".owner = 0," in text


def test_names_of_the_net_cannot_end_a_comment() -> None:
    assert "Top.pose*/1 */" not in config(partition())
    assert '"Top.pose*/1"' in config(partition())


def test_same_input_same_bytes() -> None:
    assert config(partition()) == config(partition())
    assert "somewhere" not in config(partition())  # no paths of the machine that generated


def test_blocks_name_the_channels_lines() -> None:
    files = emit(
        partition(),
        name="cell",
        reply_timeout_s=1.0,
        digest="d" * 64,
        version="9.9",
        compiled=EMPTY,
    )
    lines = files[0].text.splitlines()
    blocks = {b.element: b for b in files[0].blocks}
    block = blocks["Top.done"]
    assert any("done.robcad" in line for line in lines[block.first - 1 : block.last])
    assert lines[block.first - 1].strip() == "{"
    assert lines[block.last - 1].strip() == "},"


def test_without_a_cell_everything_is_the_supervisors() -> None:
    p = partition()
    alone = Partition(p.net, p.owners[:1], (), (0, 0, 0, 0), (), (), ())
    text = config(alone)
    assert ".owner = -1," in text
    assert ".channel = NULL," in text


@pytest.mark.parametrize("text", ["*/", "/*/", "*\\/", "a\nb", "x\\", "??/", "???/", "**//"])
def test_c_comment_neutralises(text: str) -> None:
    safe = c_comment(text)
    for bad in ("*/", "/*", "\n", "\\", "??"):
        assert bad not in safe


def test_c_literals() -> None:
    assert c_string('a"b\\') == '"a\\"b\\\\"'
    assert c_string("é1") == '"\\303\\2511"'
    assert c_string("??/") == '"\\?\\?/"'
    assert c_float(0.1) == "0.1"
    assert c_int(-(2**63)) == "INT64_MIN"
    with pytest.raises(ValueError, match="no C constant"):
        c_float(float("nan"))


def test_sums_are_rounded_everywhere_alike(tmp_path: Path) -> None:
    """Whatever the caller's CFLAGS say, the last word is that of the token game and the explorer."""
    files = emit(
        partition(),
        name="cell",
        reply_timeout_s=1.0,
        digest="d" * 64,
        version="9.9",
        compiled=EMPTY,
    )

    (makefile,) = [f for f in files if f.path == "Makefile"]
    (tmp_path / "Makefile").write_text(makefile.text)
    for name in ("net.c", "net.h", "cell_config.c"):
        (tmp_path / name).touch()
    for target in ("net.o", "supervisor.monitor", "supervisor.sanitize"):
        done = subprocess.run(
            ["make", "-n", target, "CFLAGS=-O3 -ffast-math -ffp-contract=fast"],
            cwd=tmp_path, capture_output=True, text=True, check=True,
        )  # fmt: skip
        commands = [line.split() for line in done.stdout.splitlines()]
        (words,) = (each for each in commands if "-c" in each and "net.c" in each)
        assert c_flags.STANDARD in words and c_flags.STANDARD in FLAGS
        for flag, undone in zip(c_flags.FLOATS, ("-ffp-contract=fast", "-ffast-math"), strict=True):
            assert words.index(flag) > words.index(undone) and flag in FLAGS


def test_asking_a_compiler_writes_nothing(tmp_path: Path) -> None:
    """Some compilers remove what they are to write: as root, tcc made a file of /dev/null."""
    files = emit(
        partition(),
        name="cell",
        reply_timeout_s=1.0,
        digest="d" * 64,
        version="9.9",
        compiled=EMPTY,
        net_text="x" * (c_flags.LARGE + 1),
    )
    (makefile,) = [f for f in files if f.path == "Makefile"]
    (tmp_path / "Makefile").write_text(makefile.text)
    asked = tmp_path / "asked.txt"
    compiler = tmp_path / "cc.sh"
    compiler.write_text(f'#!/bin/sh\necho "$@" >>{asked}\nexec cc "$@"\n')
    compiler.chmod(0o755)
    for name in ("net.c", "net.h", "cell_config.c"):
        (tmp_path / name).touch()
    command = ["make", "-n", "net.o", f"CC={compiler}"]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    lines = asked.read_text().splitlines()
    assert lines and all(" -E " in line and " -o " not in line for line in lines), lines


@pytest.mark.parametrize(
    ("more", "options", "is_quicker"),
    [(0, [], False), (1, [], True), (1, ["CFLAGS=-O2"], False)],
)
def test_a_large_net_is_compiled_quickly(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: int, options: list[str], is_quicker: bool
) -> None:
    """Unless the user has said how."""
    monkeypatch.delenv("CFLAGS", raising=False)
    files = emit(
        partition(),
        name="cell",
        reply_timeout_s=1.0,
        digest="d" * 64,
        version="9.9",
        compiled=EMPTY,
        net_text="x" * (c_flags.LARGE + more),
    )
    (makefile,) = [f for f in files if f.path == "Makefile"]
    (tmp_path / "Makefile").write_text(makefile.text)
    for name in ("net.c", "net.h", "cell_config.c"):
        (tmp_path / name).touch()
    for target, is_net in (("net.o", True), ("net_own.o", True), ("build/cell_config.o", False)):
        done = subprocess.run(
            ["make", "-n", target, *options],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=True,
        )
        words = done.stdout.split()
        assert ({*c_flags.QUICKER} <= {*words}) == (is_net and is_quicker)
        levels = [w for w in words if w.startswith("-O")]
        assert levels[-1] == (c_flags.QUICKER[0] if is_net and is_quicker else "-O2")


def test_flags_are_written_down_once(root: Path) -> None:
    """Whoever compiles C has them from `c_flags`; only the explorer's own code is made for this machine."""
    sources = [
        p
        for name in ("src", "templates", "tests")
        for p in (root / name).rglob("*")
        if p.suffix in (".py", ".j2")
    ]
    sources.remove(Path(__file__))
    # What a compiler makes of such a flag is asked here; nothing is compiled with it.
    asking = {"tests/helpers/remembering_cc.py", "tests/unit/tools/test_remembering_cc.py"}
    sources = [p for p in sources if p.relative_to(root).as_posix() not in asking]
    said = {
        word: sorted(p.relative_to(root).as_posix() for p in sources if word in p.read_text())
        for word in ('"-std=c11"', "-ffp-contract", "-march=")
    }
    assert said == {
        '"-std=c11"': ["src/pn2code/emission/c_flags.py"],
        "-ffp-contract": ["src/pn2code/emission/c_flags.py"],
        "-march=": ["src/pn2code/verify/exploring/programs.py"],
    }

"""`pn2code simulate` from outside: both engines give the same run, and every way in which a run ends."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from helpers.monitors import Spec, with_monitors
from helpers.netbuilder import cpn
from helpers.processes import pn2code

pytestmark = pytest.mark.cc

RANDOM = """
    net Cell
      standard
      colset JOB = product INT * STRING timed;
      colset DIE = int with 1..6;
      globref total = 0;
      fun thrown () = DIE.ran ()
      fun note n = (total := !total + n; print (Int.toString n ^ ";"); !total)
      var n, m: INT;
      var s: STRING;
      var d: DIE;
      place Bag : INT = 1`1 ++ 2`2 ++ 3`3
      place Dice : DIE
      place Jobs : JOB = 1`(0, "a\\"b")@2 +++ 1`(7, "tab\\tend")@0
      place Free = 2
      trans Take
        in Bag : n
        out Dice : thrown ()
        out Bag : if n < 12 then 1`(n + 1) else empty
      trans Work delay @+discrete (1, 4) code input (n); output (m); action note n
        in Jobs : (n, s)
        both Free : ()
        out Jobs : (n + m mod 7, s)@+round (exponential (0.5))
      trans Drop guard [d > 2]
        in Dice : d
"""
COUNTER = """
    net Cell
      standard
      var n: INT;
      place P : INT = 1`0
      place Q : INT = 1`5
      trans T
        in P : n
        out P : (n + 1) mod 1000
"""


def write(text: str, path: Path, *specs: Spec) -> Path:
    path.write_bytes(with_monitors(text, *specs) if specs else cpn(text))
    return path


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "pn2code", "simulate", *map(str, arguments)]


def simulate(
    *arguments: object,
    code: int = 0,
    env: dict[str, str] | None = None,
    cwd: Path | None = None,
) -> subprocess.CompletedProcess[str]:
    def prepare() -> None:
        if env is not None:
            os.environ.clear()
            os.environ.update(env)
        if cwd is not None:
            os.chdir(cwd)

    done = pn2code("simulate", *map(str, arguments), prepare=prepare)
    assert done.returncode == code, done.stderr[-3000:]
    return done


def result(*arguments: object, code: int = 0, **options: Any) -> dict[str, Any]:
    """What `--json` prints."""
    found: dict[str, Any] = json.loads(simulate(*arguments, "--json", code=code, **options).stdout)
    return found


def without_writer(path: Path) -> bytes:
    return path.read_bytes().replace(b'"by": "simulate"', b'"by": "reference"')


def same_but_for(one: dict[str, Any], other: dict[str, Any]) -> None:
    for key in one.keys() - {"engine", "seconds", "interpreted"}:
        assert one[key] == other[key], key


# --- one run, two engines --------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [1, 7, 2**64 - 1])
def test_the_same_seed_gives_the_same_run(tmp_path: Path, seed: int) -> None:
    """As delivered in `make thorough`; `test_compilers` runs optimized simulators each time."""
    net = write(RANDOM, tmp_path / "cell.cpn")
    found = {}
    for engine in ("compiled", "reference"):
        trace = tmp_path / f"{engine}.trace.jsonl"
        found[engine] = result(
            net, "--seed", seed, "--steps", 300, "--engine", engine, "--trace", trace
        )
        assert found[engine]["engine"] == engine
    assert without_writer(tmp_path / "compiled.trace.jsonl") == without_writer(
        tmp_path / "reference.trace.jsonl"
    )
    same_but_for(found["compiled"], found["reference"])
    assert found["compiled"]["steps"] == 300 and found["compiled"]["output"].count(";") > 10
    lines = (tmp_path / "compiled.trace.jsonl").read_text().splitlines()
    assert json.loads(lines[-1]) == {
        "t": found["compiled"]["time"],
        "event": "end",
        "why": "steps",
    }


def test_another_seed_gives_another_run(tmp_path: Path) -> None:
    net = write(RANDOM, tmp_path / "cell.cpn")
    one, other = (result(net, "--seed", k, "--steps", 50)["places"] for k in (1, 2))
    assert one != other


def test_replaying_and_going_on_is_the_run_without_a_break(tmp_path: Path) -> None:
    net = write(RANDOM, tmp_path / "cell.cpn")
    half, whole, joined = (tmp_path / f"{n}.trace.jsonl" for n in ("half", "whole", "joined"))
    result(net, "--seed", 5, "--steps", 60, "--trace", half)
    expected = result(net, "--seed", 5, "--steps", 150, "--trace", whole)
    for engine in ("compiled", "reference"):
        found = result(net, "--replay", half, "--steps", 90, "--engine", engine, "--trace", joined)
        assert (found["replayed"], found["steps"], found["seed"]) == (60, 150, 5)
        assert found["places"] == expected["places"] and found["time"] == expected["time"]
        assert without_writer(joined) == without_writer(whole)
    other = result(net, "--replay", half, "--steps", 90, "--seed", 6)
    assert other["replayed"] == 60 and other["places"] != expected["places"]


def test_a_trace_that_is_no_run_is_refused(tmp_path: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    trace = tmp_path / "run.trace.jsonl"
    result(net, "--steps", 5, "--trace", trace)
    trace.write_text(trace.read_text().replace('{"n": 3}', '{"n": 8}'))
    for engine in ("compiled", "reference"):
        found = result(net, "--replay", trace, "--engine", engine, code=1)
        assert (found["why"], found["replayed"], found["steps"]) == ("replay", 3, 3)
        assert "not enabled" in found["refusal"]
    trace.write_text('{"trace": 1, "by": "supervisor"}\n')
    assert "only traces of `simulate`" in simulate(net, "--replay", trace, code=2).stderr
    trace.write_text("nonsense\n")
    for engine in ("compiled", "reference"):
        done = simulate(net, "--replay", trace, "--engine", engine, code=2)
        assert "line 1: this is not a line of JSON" in done.stderr
    assert "no such file" in simulate(net, "--replay", tmp_path / "none", code=2).stderr


def test_a_trace_with_initial_markings_of_its_own(tmp_path: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    trace = tmp_path / "run.trace.jsonl"
    header = '{"trace": 1, "by": "reference", "initial": {"Top.P": [[1, 41]]}}'
    step = '{"step": 1, "t": 0, "transition": "Top.T", "binding": {"n": 41}}'
    trace.write_text(f"{header}\n{step}\n")
    found = result(net, "--replay", trace, "--steps", 2)
    assert (found["engine"], found["steps"]) == ("compiled", 3)
    assert found["places"][0]["marking"] == "1`44"
    trace.write_text(f"{header.replace('41]', '41], [1, 7]')}\n{step}\n")
    found = result(net, "--replay", trace, "--steps", 2)
    assert (found["engine"], found["steps"]) == ("reference", 3)
    simulate(net, "--replay", trace, "--engine", "compiled", code=1)


# --- how runs end ----------------------------------------------------------------------------------

TIMED = """
    net Cell
      standard
      colset JOB = int timed;
      var j: JOB;
      place P : JOB = 1`1@0 +++ 1`2@3 +++ 1`3@7
      place Q : JOB
      trans T
        in P : j
        out Q : j@+1
"""


@pytest.mark.parametrize("engine", ["compiled", "reference"])
@pytest.mark.parametrize(
    ("until", "steps", "time", "why"),
    [(0, 1, 0, "until"), (2, 1, 2, "until"), (3, 2, 3, "until"), (7, 3, 7, "finished")],
)
def test_until(tmp_path: Path, engine: str, until: int, steps: int, time: int, why: str) -> None:
    net = write(TIMED, tmp_path / "cell.cpn")
    found = result(net, "--until", until, "--engine", engine)
    assert (found["steps"], found["time"], found["why"]) == (steps, time, why)
    assert result(net, "--until", f"{until}.5", "--engine", engine)["steps"] == steps


def test_until_on_a_real_clock(tmp_path: Path) -> None:
    text = TIMED.replace("net Cell", "net Cell\n      option realtimestamp true")
    text = text.replace("@0", "@0.0").replace("@3", "@2.5").replace("@7", "@7.25")
    net = write(text.replace("@+1", "@++1.5"), tmp_path / "cell.cpn")
    for engine in ("compiled", "reference"):
        found = result(net, "--until", 2.75, "--engine", engine)
        assert (found["steps"], found["time"], found["why"]) == (2, 2.75, "until")
    assert simulate(net, "--until", "soon", code=2).stderr


def test_a_net_without_model_time_ends_as_without_until(tmp_path: Path) -> None:
    net = write(
        "net Cell\n  standard\n  place P = 1\n  trans T\n    both P\n", tmp_path / "cell.cpn"
    )
    found = result(net, "--until", 5, "--engine", "reference")
    assert (found["steps"], found["why"]) == (1000, "steps")


def test_steps(tmp_path: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    for engine in ("compiled", "reference"):
        found = result(net, "--steps", 0, "--engine", engine)
        assert (found["steps"], found["why"], found["time"]) == (0, "steps", 0)
        found = result(net, "--steps", 1003, "--engine", engine)
        assert (found["steps"], found["why"]) == (1003, "steps")
        assert found["places"][0]["marking"] == "1`3"


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_an_exception_is_told_with_transition_and_binding(tmp_path: Path, engine: str) -> None:
    text = COUNTER.replace("(n + 1) mod 1000", "if n = 4 then hd [] else n + 1")
    net = write(text, tmp_path / "cell.cpn")
    trace = tmp_path / "run.trace.jsonl"
    done = simulate(net, "--engine", engine, "--trace", trace, "--json", code=1)
    found = json.loads(done.stdout)
    assert (found["why"], found["steps"]) == ("error", 4)
    error = found["error"]
    assert (error["page"], error["transition"], error["binding"]) == ("Top", "T", {"n": "4"})
    assert "Empty" in error["message"] and "runtime-error" in done.stderr
    assert found["places"][0]["marking"] == "1`4", "the step that failed has changed nothing"
    assert json.loads(trace.read_text().splitlines()[-1])["why"] == "error"


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_an_error_before_the_first_step(tmp_path: Path, engine: str) -> None:
    net = write(COUNTER.replace("= 1`5", "= 1`(hd [])"), tmp_path / "cell.cpn")
    found = result(net, "--engine", engine, code=1)
    assert (found["why"], found["steps"]) == ("error", 0)
    assert found["error"]["transition"] == "" and "Empty" in found["error"]["message"]


def test_a_net_that_is_wrong(tmp_path: Path) -> None:
    net = write(COUNTER.replace("in P : n", "in P : x"), tmp_path / "cell.cpn")
    assert "x" in simulate(net, code=1).stderr
    assert simulate(tmp_path / "none.cpn", code=2).stderr


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_interrupted(tmp_path: Path, engine: str) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    trace = tmp_path / "run.trace.jsonl"
    result(net, "--steps", 1, "--engine", engine)  # compiled by now
    process = subprocess.Popen(
        command(net, "--steps", 10**12, "--engine", engine, "--trace", trace, "--json"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 600
    while time.monotonic() < deadline and (not trace.exists() or trace.stat().st_size < 10_000):
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=600)
    assert process.returncode == 130, err
    found = json.loads(out)
    assert found["why"] == "interrupted" and found["steps"] > 0
    lines = trace.read_text().splitlines()
    assert len(lines) == found["steps"] + 2
    assert json.loads(lines[-1])["why"] == "interrupted"


# --- traces that cannot be written -----------------------------------------------------------------


@pytest.mark.parametrize("engine", ["compiled", "reference"])
@pytest.mark.parametrize("monitored", [False, True])
def test_full_disk(tmp_path: Path, engine: str, monitored: bool) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("there is no /dev/full here")
    specs = [Spec("Size", "Marking size", ["Top.P"])] if monitored else []
    net = write(COUNTER, tmp_path / "cell.cpn", *specs)
    done = simulate(net, "--engine", engine, "--trace", "/dev/full", code=2)
    assert "cannot write the trace `/dev/full`: no space left on device" in done.stderr
    done = simulate(net, "--engine", engine, "--trace", tmp_path / "no" / "run", code=2)
    assert "there is no folder" in done.stderr


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_what_was_written_ends_with_a_whole_line(tmp_path: Path, engine: str) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    built = command(net, "--steps", 1, "--engine", engine)  # as below: forks compile in another way
    subprocess.run(built, check=True, capture_output=True)
    trace = tmp_path / "run.trace.jsonl"
    script = 'ulimit -f 8; trap "" XFSZ; exec "$@"'
    done = subprocess.run(
        ["bash", "-c", script, "bash", *command(net, "--engine", engine, "--trace", trace)],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert done.returncode == 2, done.stderr
    assert "cannot write the trace" in done.stderr
    text = trace.read_text()
    assert text.endswith("}\n")
    lines = [json.loads(line) for line in text.splitlines()]
    assert len(lines) > 10 and "event" not in lines[-1]


def test_a_trace_is_not_written_over_what_is_read(tmp_path: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    before = net.read_bytes()
    assert "--trace" in simulate(net, "--trace", net, code=2).stderr
    assert net.read_bytes() == before
    trace = tmp_path / "run.trace.jsonl"
    result(net, "--steps", 3, "--trace", trace)
    assert "--trace" in simulate(net, "--replay", trace, "--trace", trace, code=2).stderr
    assert len(trace.read_text().splitlines()) == 5


# --- the compiler and its cache --------------------------------------------------------------------


def _environment(tmp_path: Path, compiler: Path) -> dict[str, str]:
    """With a cache of its own, for which everything is compiled anew."""
    return {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache"), "CC": str(compiler)}


def _compiler(path: Path, usual: Path, before: str = "", after: str = "") -> Path:
    """A compiler, and what it does besides."""
    path.write_text(f'#!/bin/sh\n{before}\n{usual} "$@" || exit 1\n{after}\nexit 0\n')
    path.chmod(0o755)
    return path


def test_a_second_run_does_not_compile(tmp_path: Path, once_compiler: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    result(net, env=_environment(tmp_path, once_compiler))
    folder = tmp_path / "cache" / "pn2code" / "programs"
    kept = sorted(p.name for p in folder.iterdir())
    assert [n.split("-")[0] for n in kept] == ["simulate"] * 4  # each with its sum
    # A compiler that fails when it compiles, but still says its version.
    fake = _compiler(tmp_path / "cc", once_compiler, before='[ "$1" = --version ] || exit 1')
    environment = _environment(tmp_path, fake)
    other = write(COUNTER.replace("1000", "999"), tmp_path / "other.cpn")
    assert "build-failed" in simulate(other, "--engine", "compiled", env=environment, code=1).stderr
    assert sorted(p.name for p in folder.iterdir()) == kept, "nothing is left behind"


def test_many_at_the_same_time(tmp_path: Path, once_compiler: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    environment = _environment(tmp_path, once_compiler)
    processes = [
        subprocess.Popen(
            command(net, "--json", "--engine", "compiled"), stdout=subprocess.PIPE, env=environment
        )
        for _ in range(2)
    ]
    outs = [json.loads(p.communicate(timeout=600)[0]) for p in processes]
    assert all(p.returncode == 0 for p in processes)
    assert len({o["steps"] for o in outs}) == 1
    assert len(list((tmp_path / "cache" / "pn2code" / "programs").iterdir())) == 4


def _other_numbers(data: bytes) -> bytes:
    assert b"\xe8\x03\x00\x00" in data
    return data.replace(b"\xe8\x03\x00\x00", b"\xe7\x03\x00\x00")


DAMAGES = {
    "empty": lambda data: b"",
    "half": lambda data: data[: len(data) // 2],
    "no end": lambda data: data[: len(data) // 2] + bytes(len(data) - len(data) // 2),
    "another number": _other_numbers,
}


@pytest.mark.parametrize("suffix", ["", ".a"], ids=["program", "runtime"])
def test_what_is_kept_is_made_again_when_it_is_damaged(
    suffix: str, tmp_path: Path, once_compiler: Path
) -> None:
    """As by a power failure: it would end with an internal error for ever, or answer anything."""
    net = write(COUNTER, tmp_path / "cell.cpn")
    environment = _environment(tmp_path, once_compiler)
    right = result(net, "--engine", "compiled", env=environment)
    folder = tmp_path / "cache" / "pn2code" / "programs"
    (kept,) = [p for p in folder.iterdir() if p.suffix == suffix]
    for name, damage in DAMAGES.items():
        if suffix:  # the program is made of it
            (program,) = [p for p in folder.iterdir() if not p.suffix]
            program.unlink()
            if name == "another number":
                continue
        kept.write_bytes(damage(kept.read_bytes()))
        found = result(net, "--engine", "compiled", env=environment)
        assert {k: found[k] for k in found if "seconds" not in k} == {
            k: right[k] for k in right if "seconds" not in k
        }, name


def test_without_a_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ziglang", None)  # not installed
    net = write(COUNTER, tmp_path / "cell.cpn")
    environment = {**_environment(tmp_path, Path()), "PATH": str(tmp_path), "CC": ""}
    done = simulate(net, "--engine", "compiled", env=environment, code=2)
    assert "a C compiler is not installed" in done.stderr and "--engine reference" in done.stderr
    done = simulate(net, "--json", env=environment)
    assert json.loads(done.stdout)["engine"] == "reference"
    assert "a C compiler is not installed" in done.stderr


def test_a_cache_that_cannot_be_written(tmp_path: Path, once_compiler: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    (tmp_path / "cache").write_text("a file, no folder")
    found = result(net, "--engine", "compiled", env=_environment(tmp_path, once_compiler))
    assert (found["engine"], found["steps"]) == ("compiled", 1000)
    (tmp_path / "cache").unlink()
    folder = tmp_path / "cache" / "pn2code"
    folder.mkdir(parents=True, mode=0o700)
    (folder / "programs").write_text("a file, no folder")
    done = simulate(net, "--engine", "compiled", env=_environment(tmp_path, once_compiler))
    assert "program-cache" in done.stderr


def test_a_program_that_comes_to_a_bad_end(tmp_path: Path, once_compiler: Path) -> None:
    """As it happens when there is not enough memory."""
    killed = r'[ "$a" = program ] && printf "#!/bin/sh\nkill -9 \$\$\n" > program'
    fake = _compiler(tmp_path / "cc", once_compiler, after=f"for a; do {killed}; done")
    net = write(COUNTER, tmp_path / "cell.cpn")
    environment = _environment(tmp_path, fake)
    done = simulate(net, "--engine", "compiled", env=environment, code=1)
    assert "simulator-failed" in done.stderr and "signal 9" in done.stderr


def test_a_place_with_very_many_tokens(tmp_path: Path) -> None:
    text = COUNTER.replace("out P : (n + 1) mod 1000", "out P : n + 1\n        out Q : n * 3")
    net = write(text, tmp_path / "cell.cpn")
    found = result(net, "--steps", 30_000, "--engine", "compiled")
    assert (found["steps"], found["why"]) == (30_000, "steps")
    assert found["places"][1]["marking"].count("`") == 30_001


def test_numbers_beyond_64_bits(tmp_path: Path) -> None:
    text = """
        net Large
          standard
          var i: INTINF;
          place P : INTINF = 1`2
          trans Square
            in P : i
            out P : IntInf.* (i, i)
    """
    net = write(text, tmp_path / "cell.cpn")
    found = result(net, "--steps", 8)
    assert (found["engine"], found["steps"]) == ("compiled", 8)
    assert found["places"][0]["marking"] == f"1`{2**256}"


# --- monitors --------------------------------------------------------------------------------------

WATCHED = (
    Spec("Bag", "Marking size", ["Top.Bag"]),
    Spec("Works", "Count transition occurrence data collection", ["Top.Work"]),
    Spec(
        "Sums",
        "Data collection",
        ["Top.Work"],
        {
            "Predicate": "fun pred (Top'Work (1, {m, n, s})) = n > 0",
            "Observer": "fun obs (Top'Work (1, {m, n, s})) = Real.fromInt (m + size (Bag_ ()))",
        },
        {"Timed": "true"},
    ),
    Spec(
        "Enough",
        "Breakpoint",
        ["Top.Work"],
        {"Predicate": "fun pred b = Works.count () >= 12"},
    ),
)


def test_both_engines_give_the_same_numbers(tmp_path: Path) -> None:
    text = RANDOM.replace("var n, m: INT;", "fun Bag_ () = 1`1 ++ 1`2\n      var n, m: INT;")
    net = write(text, tmp_path / "cell.cpn", *WATCHED)
    found = [
        result(net, "--engine", e, "--trace", tmp_path / e, "--steps", 2000)
        for e in ("compiled", "reference")
    ]
    same_but_for(*found)
    assert found[0]["why"] == "breakpoint" and found[0]["breakpoint"]["name"] == "Enough"
    assert [row["count"] > 5 for row in found[0]["monitors"][:3]] == [True, True, True]
    assert without_writer(tmp_path / "compiled") == without_writer(tmp_path / "reference")
    free = [
        result(net, "--engine", e, "--steps", 100, "--no-breakpoints", "--until", 60)
        for e in ("compiled", "reference")
    ]
    same_but_for(*free)
    assert result(net, "--no-monitors", "--steps", 100)["monitors"] == []


def test_monitors_that_change_references_need_the_reference_engine(tmp_path: Path) -> None:
    spec = Spec(
        "U",
        "User defined",
        ["Top.T"],
        {
            "Predicate": "fun pred b = true",
            "Observer": "fun obs b = ()",
            "Action": "fun action () = count := !count + 1",
        },
    )
    text = COUNTER.replace("var n: INT;", "globref count = 0;\n      var n: INT;")
    net = write(text, tmp_path / "cell.cpn", spec)
    assert result(net)["engine"] == "compiled", "the net does not look at the reference"
    text = text.replace("(n + 1) mod 1000", "(n + !count) mod 1000")
    net = write(text, tmp_path / "cell.cpn", spec)
    done = simulate(net, "--json")
    assert json.loads(done.stdout)["engine"] == "reference"
    assert "its monitors change references" in done.stderr
    assert "engine-reference" in simulate(net, "--engine", "compiled", code=1).stderr


# --- for people ------------------------------------------------------------------------------------


def test_the_report(tmp_path: Path) -> None:
    net = write(RANDOM, tmp_path / "cell.cpn", Spec("Bag size", "0", ["Top.Bag"]))
    text = simulate(net, "--steps", 150).stdout
    for part in ("150 steps", "engine compiled, seed 1", "places that changed", "Top.Bag"):
        assert part in text
    assert "Top.Free" not in text, "it has not changed"
    assert "Bag size (timed)" in text and "the net printed" in text
    assert "Free" in simulate(net, "--steps", 40, "--all").stdout
    quiet = simulate(net, "--steps", 40, "--quiet")
    assert quiet.stdout == "" and quiet.stderr == ""


def test_progress_on_a_terminal_only(tmp_path: Path) -> None:
    net = write(COUNTER, tmp_path / "cell.cpn")
    result(net, "--steps", 1)
    assert "steps/s" not in simulate(net, "--steps", 100).stderr
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        command(net, "--steps", 10**12), stdout=subprocess.DEVNULL, stderr=theirs
    )
    os.close(theirs)
    seen = b""
    deadline = time.monotonic() + 600
    while b"steps/s" not in seen and time.monotonic() < deadline:
        seen += os.read(ours, 4096)
    process.send_signal(signal.SIGINT)
    process.wait(timeout=600)
    os.close(ours)
    assert b"steps/s" in seen and process.returncode == 130


def test_files_only_where_they_are_allowed(tmp_path: Path) -> None:
    text = COUNTER.replace(
        "var n: INT;",
        'fun store n = let val f = TextIO.openAppend "log" in TextIO.output (f, Int.toString n); '
        "TextIO.closeOut f; n end\n      var n: INT;",
    ).replace("(n + 1) mod 1000", "store (n + 1)")
    net = write(text, tmp_path / "cell.cpn")
    allowed = tmp_path / "files"
    allowed.mkdir()
    for engine in ("compiled", "reference"):
        result(net, "--steps", 3, "--engine", engine, cwd=tmp_path)
        assert not (tmp_path / "log").exists() and not (allowed / "log").exists()
        result(net, "--steps", 3, "--engine", engine, "--files", allowed)
        assert (allowed / "log").read_text() == "123"
        (allowed / "log").unlink()

"""Cells whose files are decided by the cell as it runs, and closed nets that are not counted to the end."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tools.reduction_cells.files import judged
from typer.testing import CliRunner

from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.channel_model import by_cell, check
from pn2code.channel_model.rules import Rules
from pn2code.cli import verify as command
from pn2code.cli.main import app
from pn2code.cli.nets import open_net
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.opened import OpenNet
from pn2code.verify.exploring import net_by_counts
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Approximation, Limits, Reduction

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """net cell
  standard
  fun act () = ();
  colset SAID = int with 1..2;
  var k: SAID;
  var n: INT;
  page Top
    place ask : SAID
    place say : SAID
    subst Supervisor = Sup (ask -> ask, say -> say)
    subst D = Device (ask -> ask, say -> say)
  page Sup
    place ask port out : SAID
    place say port in : SAID
    place Feeder = {parts}
    place Left : INT = 1`{parts}
    place Free = 1
    place Busy
    place Tray
    place Good
    place Scrap
    place Finished
    trans Send
      in Feeder : ()
      in Free : ()
      out Busy : ()
      out ask : 1
    trans Heard
      in Busy : ()
      in say : {heard}
      out Free : ()
      out Tray : ()
    trans Pack
      in Tray : ()
      in Left : n
      out Left : n - 1
      out Good : ()
    trans Drop
      in Tray : ()
      in Left : n
      out Left : n - 1
      out Scrap : ()
    trans End
      in Left : 0
      out Finished : ()
  page Device
    place ask port in : SAID
    place say port out : SAID
    place Waiting = 1
    place Told : SAID
    place Done : SAID
    trans Accept
      in Waiting : ()
      in ask : k
      out Told : k
    trans Work code action act ()
      in Told : k
      out Done : {done}
    trans Say
      in Done : k
      out Waiting : ()
      out say : k
"""
TOML = """[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
[devices.d]
instance = "D"
[[channel]]
place = "ask"
file = "ask.txt"
kind = "flag"
[[channel]]
place = "say"
file = "say.txt"
kind = "flag"
[primitives]
act = { command = "tool", action = "act", duration_s = 0.5 }
"""


def written(
    folder: Path,
    *,
    parts: int = 3,
    heard: str = "k",
    done: str = "k",
    change: tuple[str, str] = ("", ""),
) -> Path:
    """The files of a cell."""
    folder.mkdir(parents=True, exist_ok=True)
    net = NET.replace("{parts}", str(parts)).replace("{heard}", heard).replace("{done}", done)
    assert change[0] in net
    (folder / "cell.cpn").write_bytes(cpn(net.replace(*change) if change[0] else net))
    (folder / "cell.toml").write_text(TOML, encoding="utf-8")
    return folder


def opened(folder: Path) -> OpenNet:
    return open_net(folder, {}, warnings=Diagnostics())


def verified(cell: Path, *options: str) -> dict[str, Any]:
    """What `verify --json` says."""
    more = ["--json", "--traces", str(cell / "t"), *options]
    found: dict[str, Any] = json.loads(CliRunner().invoke(app, ["verify", str(cell), *more]).stdout)
    return found


def answers(found: dict[str, Any]) -> list[tuple[str, str]]:
    rows = [(c["check"], c["answer"]) for c in found["controller"]]
    return rows + [(m["check"], m["answer"]) for m in found["medium"]]


def test_a_large_cell_is_decided_without_its_files_and_without_all_markings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cell = written(tmp_path / "cell", parts=6)
    monkeypatch.setattr(command, "COUNTS_FROM", 60)
    found, whole = verified(cell), verified(cell, "--no-reduction")
    assert answers(found) == answers(whole)
    assert [check for check, answer in answers(whole) if answer != "yes"] == ["confluence"]
    (medium, *_), (other, *_) = found["medium"], whole["medium"]
    assert medium["reduced"] is True and other["reduced"] is False
    assert medium["nodes"] < other["nodes"]
    assert "no channel holds a second message" in medium["assumes"]
    assert (found["complete"], found["why"], found["nodes"]) == (False, "counted", 60)
    assert found["counted"]["dead_markings_are_ends"] is True
    assert found["counted"]["dead_transitions"] == whole["dead_transitions"] == []
    assert whole["complete"] is True and whole["counted"] is None and whole["dead_markings"] == 7
    screen = CliRunner().invoke(app, ["verify", str(cell), "--traces", str(tmp_path / "t")])
    assert screen.exit_code == 0, screen.output
    assert "Verdict: YES" in screen.output and "each has a token in a final place" in screen.output


@pytest.mark.parametrize(
    ("heard", "done", "change"),
    [
        ("1", "k", ("out ask : 1\n", "out ask : 1\n      out Free : ()\n")),  # it does not wait
        ("1", "2", ("", "")),  # an answer that is not understood: a deadlock
    ],
)
def test_what_is_not_all_good_is_not_said_without_the_files(
    tmp_path: Path, heard: str, done: str, change: tuple[str, str]
) -> None:
    net = opened(written(tmp_path, parts=2, heard=heard, done=done, change=change))
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None and by_cell.why_not(partition, Rules()) == ""
    counts: Counter[str] = Counter()
    assert list(judged(partition, net.storage, counts, None)) == []
    assert counts["files not of the cell"] == 1


DATA = """    place told : SAID
    place say : SAID"""


def with_data(folder: Path, *, alone: bool) -> OpenNet:
    """The device says data with its flag; the supervisor takes both, or (`alone`) the data first."""
    written(folder, parts=2)
    net = NET.replace("{parts}", "2").replace("{heard}", "k").replace("{done}", "k")
    net = net.replace("    place say : SAID", DATA, 1)
    net = net.replace("ask -> ask, say -> say", "ask -> ask, say -> say, told -> told")
    for where in ("in", "out"):
        port = f"    place say port {where} : SAID"
        net = net.replace(port, f"    place told port {where} : SAID\n{port}")
    net = net.replace("      in say : k\n", "      in say : k\n      in told : k\n")
    net = net.replace("      out say : k\n", "      out say : k\n      out told : k\n")
    if alone:
        early = "    place Seen\n    trans Early\n      in told : k\n      out Seen : ()\n    trans Send\n"
        net = net.replace("      in told : k\n", "      in Seen : ()\n")
        net = net.replace("    trans Send\n", early)
    (folder / "cell.cpn").write_bytes(cpn(net))
    data = '[[channel]]\nplace = "told"\nfile = "told.txt"\nkind = "data"\n'
    (folder / "cell.toml").write_text(TOML + data, encoding="utf-8")
    return opened(folder)


def test_data_that_nobody_takes_without_their_flag_need_no_look_at_files(tmp_path: Path) -> None:
    net = with_data(tmp_path, alone=False)
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None and by_cell.why_not(partition, Rules()) == ""
    counts: Counter[str] = Counter()
    assert list(judged(partition, net.storage, counts, None)) == []
    assert counts["files: yes of the cell as well"] == 1


def test_data_that_are_taken_before_their_flag_need_none_either(tmp_path: Path) -> None:
    net = with_data(tmp_path, alone=True)
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None and by_cell.why_not(partition, Rules()) == ""
    counts: Counter[str] = Counter()
    assert list(judged(partition, net.storage, counts, None)) == []
    assert counts["files: yes of the cell as well"] == 1


PEERS = """net cell
  standard
  colset SAID = int with 1..2;
  var k: SAID;
  var n: INT;
  page Top
    place ask : SAID
    place pass : SAID
    place say : SAID
    subst Supervisor = Sup (ask -> ask, say -> say)
    subst A = First (ask -> ask, pass -> pass)
    subst B = Second (pass -> pass, say -> say)
  page Sup
    place ask port out : SAID
    place say port in : SAID
    place Left : INT = 1`2
    place Free = 1
    place Busy
    place Finished
    trans Send guard [n > 0]
      in Free : ()
      in Left : n
      out Left : n - 1
      out Busy : ()
      out ask : 1
    trans Heard
      in Busy : ()
      in say : k
      out Free : ()
    trans End
      in Free : ()
      in Left : 0
      out Finished : ()
  page First
    place ask port in : SAID
    place pass port out : SAID
    place Waiting = 1
    place Passed
    trans Accept
      in Waiting : ()
      in ask : k
      out pass : k
      out Passed : ()
    trans Again
      in Passed : ()
      out Waiting : ()
  page Second
    place pass port in : SAID
    place say port out : SAID
    place Ready = 1
    place Told : SAID
    trans Take
      in Ready : ()
      in pass : k
      out Told : k
    trans Say
      in Told : k
      out Ready : ()
      out say : k
"""


def with_peers(folder: Path, *, is_hasty: bool = False) -> OpenNet:
    """One device tells the other one what it has been told; `is_hasty`: twice, without waiting."""
    net = PEERS
    if is_hasty:
        net = net.replace("in Passed : ()\n", "in Passed : ()\n      out pass : 2\n")
    channel = TOML[
        TOML.index("[[channel]]") : TOML.index("[[channel]]", TOML.index("[[channel]]") + 1)
    ]
    toml = TOML[: TOML.index("[primitives]")].replace(
        '[devices.d]\ninstance = "D"', '[devices.a]\ninstance = "A"\n[devices.b]\ninstance = "B"'
    )
    (folder / "cell.cpn").write_bytes(cpn(net))
    (folder / "cell.toml").write_text(toml + channel.replace("ask", "pass"), encoding="utf-8")
    return opened(folder)


def test_devices_empty_a_file_before_they_tell_each_other_what_it_said(tmp_path: Path) -> None:
    net = with_peers(tmp_path)
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None and by_cell.why_not(partition, Rules()) == ""
    counts: Counter[str] = Counter()
    assert list(judged(partition, net.storage, counts, None)) == []
    assert counts["files: yes of the cell as well"] == 1


def test_a_cell_that_is_large_as_it_runs_is_not_looked_at_with_its_files_first(
    tmp_path: Path,
) -> None:
    net = with_peers(tmp_path)
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    limits = Limits(threads=1, traces=0, turns_from=command.TURNS_FROM)
    run = check.Run(limits, Diagnostics(), ExploreOptions(quick=True))
    small = check.whole(partition, net.storage, run, Rules(), running_states=check.LARGE)
    large = check.whole(partition, net.storage, run, Rules(), running_states=check.LARGE + 1)
    assert (small.answer, small.reduced) == ("yes", False)
    assert (large.answer, large.reduced) == ("yes", True)
    assert large.nodes < small.nodes


def test_an_exchange_says_that_it_does_not_know_of_messages_between_devices(tmp_path: Path) -> None:
    net = with_peers(tmp_path)
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    run = check.Run(Limits(max_states=1, threads=1), Diagnostics(), ExploreOptions(quick=True))
    answer = check.exchange(partition, 1, run, Rules())
    assert "no crash harms messages of pass.txt, between two robots" in answer.assumes


def test_a_device_that_writes_to_the_file_of_another_one_too_early_is_a_fault(
    tmp_path: Path,
) -> None:
    net = with_peers(tmp_path, is_hasty=True)
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    run = check.Run(Limits(threads=1, traces=0), Diagnostics(), ExploreOptions(quick=True))
    answer = check.whole(partition, net.storage, run, Rules())
    assert answer.answer == "no" and "two robots" not in answer.assumes
    assert any("a has a message for pass.txt" in line for e in answer.evidence for line in e.lines)
    assert by_cell.shown(partition, Rules(), net.storage, run.limits, run.options) is None


def test_whoever_would_speak_after_the_end_is_noticed(tmp_path: Path) -> None:
    change = ("in Left : 0", "in Left : 1")
    net = opened(written(tmp_path, parts=2, change=change))
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    limits, options = Limits(threads=1, traces=0), ExploreOptions(quick=True)
    rows = by_cell.rows(partition, net.storage, limits, options)
    assert [answer for line, answer in rows if line.startswith("? bound")] == ["yes"] * 3
    assert rows[-1][0].startswith("? invariant") and rows[-1][1] == "no"


@pytest.mark.parametrize(
    "asked",
    [{"reductions": (Reduction.PARTIAL_ORDER,)}, {"approximation": Approximation.BITSTATE}],
)
def test_what_is_asked_for_the_closed_net_changes_nothing(
    tmp_path: Path, asked: dict[str, Any]
) -> None:
    net = opened(written(tmp_path, parts=2))
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    limits, options = Limits(threads=1, traces=0), ExploreOptions(quick=True)
    plain = by_cell.shown(partition, Rules(), net.storage, limits, options)
    other = by_cell.shown(partition, Rules(), net.storage, replace(limits, **asked), options)
    assert plain is not None and other == plain


def test_other_rules_are_looked_at_with_the_files(tmp_path: Path) -> None:
    net = opened(written(tmp_path, parts=2))
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    shown = by_cell.Shown(1, 1, 1, 1)
    run = check.Run(Limits(threads=1, traces=0), Diagnostics(), ExploreOptions(quick=True))
    answer = check.whole(
        partition, net.storage, run, Rules(checks_empty=False, renames=False), shown
    )
    assert answer.nodes > 1 and not answer.reduced


@pytest.mark.parametrize("change", [("", ""), ("in Left : 0", "in Left : 0\n      in Scrap : ()")])
def test_a_closed_net_has_the_ends_that_its_states_say(
    tmp_path: Path, change: tuple[str, str]
) -> None:
    net = opened(written(tmp_path, parts=5, change=change))
    partition = divide(net.flat, net.config, Diagnostics())
    assert partition is not None
    limits, options = Limits(threads=1, traces=0), ExploreOptions(quick=True)
    known = net_by_counts.look(net.flat, net.storage, limits, options, partition.final_places)
    assert known is not None
    (final,) = partition.final_places
    asked = f"dead\nnot 0\nwithin {final} 1 -\nor 1 2\nag 3\n? initially 4\n"
    whole = explore(
        net.flat, net.storage, limits, Diagnostics(), ExploreOptions(quick=True, questions=asked)
    )
    assert whole is not None and whole.complete
    assert known.ends == (whole.answers[0]["answer"] == "yes")
    assert known.never == whole.dead_transitions()
    assert whole.graph is not None and whole.graph.fairness is None


@pytest.mark.parametrize(
    "change",
    [
        (
            "    trans Say\n",
            "    trans Back\n      in Done : k\n      out Told : k\n    trans Say\n",
        ),  # it goes round
        ("out Left : n - 1", "out Left : n - 1 + 0 * (1 div (n - 2))"),  # an exception
    ],
)
def test_a_closed_net_of_which_states_say_nothing_is_seen_as_a_whole(
    tmp_path: Path, change: tuple[str, str]
) -> None:
    net = opened(written(tmp_path, parts=5, change=change))
    limits, options = Limits(threads=1, traces=0), ExploreOptions(quick=True)
    assert net_by_counts.look(net.flat, net.storage, limits, options, ()) is None

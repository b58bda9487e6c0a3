"""Warnings about a net are told by `check` and `verify`; other verbs say that there are some."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app

NET = """
net cell
  standard
  colset SIDE = with left | right;
  page Top
    place A : SIDE = 1`left
    trans T
      in A : left
"""
SHOWN = "warning[state-space-name]"


def said(verb: str, net: Path, *options: str) -> str:
    done = CliRunner().invoke(app, [verb, str(net), *options])
    assert done.exit_code == 0, done.output
    return done.stderr


def test_check_tells_them(tmp_path: Path) -> None:
    assert said("check", write(NET, tmp_path / "cell.cpn")).count(SHOWN) == 2


@pytest.mark.cc
def test_verify_tells_them(tmp_path: Path) -> None:
    net = write(NET, tmp_path / "cell.cpn")
    assert said("verify", net, "-o", str(tmp_path / "traces")).count(SHOWN) == 2


@pytest.mark.cc
@pytest.mark.parametrize(
    ("verb", "options"), [("generate", ("-o", "{}/out")), ("conform", ())], ids=lambda x: str(x)
)
def test_others_count_them(verb: str, options: tuple[str, ...], tmp_path: Path) -> None:
    net = write(NET, tmp_path / "cell.cpn")
    filled = [x.format(tmp_path) for x in options]
    found = said(verb, net, *filled)
    assert SHOWN not in found
    assert f"There are 2 warnings about the net itself: see `pn2code check {net}`." in found
    assert said(verb, net, *filled, "--format", "concise").count("[state-space-name]") == 2


def test_one_warning_is_one(tmp_path: Path) -> None:
    net = write(NET.replace("right", "other"), tmp_path / "cell.cpn")
    options = ("-o", str(tmp_path / "out"))
    assert "There is a warning about the net itself" in said("generate", net, *options)


@pytest.mark.cc
@pytest.mark.parametrize(
    ("page", "lack"),
    [("    place A = 1\n", "transitions"), ("    trans T\n", "places"), ("", "transitions")],
)
def test_a_net_in_which_nothing_can_happen(page: str, lack: str, tmp_path: Path) -> None:
    net = write(f"net cell\n  standard\n  page Top\n{page}", tmp_path / "cell.cpn")
    warning = f"warning[net-empty]: the net has no {lack}: its only marking is the initial one"
    assert warning in said("check", net)
    assert warning in said("verify", net, "-o", str(tmp_path / "traces"))

"""A net that wants a file where it has none: what is said tells how it gets one."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.semantics.game.errors import GameError, about_files
from pn2code.semantics.game.token_game import Game
from pn2code.simulate.run import Failure

HELP = "the net has no files but those below the folder of `pn2code simulate --files DIR`"


def failed(value: str) -> GameError:
    """What comes of a net whose initial marking is `value`."""
    net = flat(f"net Files\n  standard\n  page Top\n    place P : STRING = 1`({value})\n")
    with pytest.raises(GameError) as raised:
        Game(net, seed=1)
    return raised.value


@pytest.mark.parametrize(
    ("value", "hint"), [('TextIO.inputAll (TextIO.openIn "a")', HELP), ("hd nil", "")]
)
def test_error_of_a_file(value: str, hint: str) -> None:
    said = Diagnostics()
    failed(value).report(said)
    Failure.of(failed(value)).report(said, 0)
    assert [e.hint for e in said.errors] == [hint, hint]


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        ("the occurrence of `T` raised `Io`", True),
        ("the inscription raised the exception `Io`", True),
        ("the occurrence of `T` raised `Iota`", False),
    ],
)
def test_which_messages(message: str, expected: bool) -> None:
    assert bool(about_files(message)) is expected

"""`RealToIntInf` and `IntInfToReal` as the engine of CPN Tools computes them: its answers, recorded."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.game.token_game import Game

ANSWERS = {
    "RealToIntInf 4 3.14159": "31416",
    "RealToIntInf 0 0.5": "0",
    "RealToIntInf 0 1.5": "2",
    "RealToIntInf 0 2.5": "2",
    "RealToIntInf 0 (~0.4)": "0",
    "RealToIntInf 2 (~3.14159)": "~314",
    # Digits as `Real.fmt` has them: fifteen, then zeros; and halves upwards where it has many.
    "RealToIntInf 0 1E23": "100000000000000000000000",
    "RealToIntInf 3 1.2345678901234567E25": "12345678901234600000000000000",
    "RealToIntInf 20 (1.0 / 3.0)": "33333333333333300000",
    "RealToIntInf 0 9007199254740993.0": "9007199254741000",
    "RealToIntInf 0 2147483648.5": "2147483649",
    "RealToIntInf 0 1073741823.5": "1073741824",
    "RealToIntInf 2 10737418.245": "1073741825",
    "RealToIntInf 2 (~20737418.255)": "~2073741826",
    "RealToIntInf 310 0.0": "0",
    "RealToIntInf 30 1.0": "1000000000000000000000000000000",
    "RealToIntInf ~1 1.0 handle RealToIntInfExn => 7": "7",
    "RealToIntInf 0 (1.0 / 0.0) handle InternalError _ => 7": "7",
    "RealToIntInf 0 (0.0 / 0.0) handle InternalError _ => 7": "7",
}
BACK = {
    "IntInfToReal 4 31415": "3.1415",
    "IntInfToReal 2 (IntInf.fromInt ~314)": "~3.14",
    "IntInfToReal 3 123456789012345678901234567890": "1.23456789012E26",
    "IntInfToReal 0 (IntInf.pow (10, 23))": "1E23",
}


@pytest.mark.parametrize(
    ("expression", "answer"),
    [
        *((f"IntInf.toString ({e})", answer) for e, answer in ANSWERS.items()),
        *((f"Real.toString ({e})", answer) for e, answer in BACK.items()),
    ],
)
def test_answers_of_the_engine(expression: str, answer: str) -> None:
    game = Game(flat(f"net N\n  colset STRING = string;\n  place P : STRING = 1`({expression})"))
    assert game.marking_text("Top.P") == f'1`"{answer}"'

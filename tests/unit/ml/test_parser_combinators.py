"""`ParserComb` of the library of SML/NJ: each value is what the engine of CPN Tools gives for it."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game

VALUES = {
    'p (token Char.isDigit) "12a"': "12",
    'p (token Char.isDigit) ""': "-",
    'p (string "ab") "abc"': "ab",
    'p (string "") "abc"': "",
    'p (skipBefore Char.isSpace (string "x")) "  x"': "x",
    'p (or (string "ab", string "ac")) "ac"': "ac",
    "p (wrap (oneOrMore (char #\"a\"), implode)) \"aab\"": "aa",
    "p (wrap (oneOrMore (char #\"a\"), implode)) \"b\"": "-",
    "p (wrap (zeroOrMore (char #\"a\"), implode)) \"b\"": "",
    "p (wrap (option (char #\"a\"), fn NONE => \"none\" | SOME c => str c)) \"b\"": "none",
    "p (wrap (join (option (char #\"a\")), str)) \"b\"": "-",
    "p (wrap (or' [char #\"b\", char #\"a\", failure], str)) \"a\"": "a",
    "p (wrap (bind (eatChar Char.isAlpha, fn c => seq (char c, result \"5\")), fn (c, s) => str c ^ s)) \"zz\"": "z5",
    "p (seqWith (fn (a, b) => b ^ a) (string \"x\", token Char.isDigit)) \"x17\"": "17x",
}  # fmt: skip


@pytest.mark.parametrize("value", VALUES)
def test_what_is_parsed(value: str) -> None:
    text = (
        "net Parsing\n  standard\n"
        '  fun p f s = case StringCvt.scanString f s of NONE => "-" | SOME found => found;\n'
        f"  page Top\n    place P : STRING = 1`(let open ParserComb in {value} end)\n"
    )
    net = flat(text)
    assert str(places(net, Game(net, seed=1).marking)[0]["marking"]) == f'1`"{VALUES[value]}"'

"""The library's texts see none of the net's names, whatever the net calls its colours, functions and operators."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game

COLOURS = """
net Colours
  standard
  colset E = with first | rest | n | x | items | init | sep | f | i | up | at | next | text | out;
  colset INTS = list INT;
  {declarations}
  page Top
    place P : {colset} = 1`({value})
"""
USES = {
    "ListMergeSort.sort (fn (p, q) => p > q) [3, 1, 2]": ("INTS", "1`[1,2,3]"),
    "ListMergeSort.uniqueSort Int.compare [2, 1, 2]": ("INTS", "1`[1,2]"),
    "ListPair.mapi (fn (a, b, c) => a + b + c) ([1, 2], [3, 4])": ("INTS", "1`[4,7]"),
    'ListFormat.fmt {init = "<", sep = ";", final = ">", fmt = Int.toString} [1, 2]': ("STRING", '1`"<1;2>"'),
    'Format.format "%05.1f" [Format.REAL 9.96]': ("STRING", '1`" 10.0"'),
    "let val q = Queue.mkQueue () in Queue.enqueue (q, 7); Queue.dequeue q end": ("INT", "1`7"),
}  # fmt: skip
OWN = (
    "fun sort (l : int list) = 7;",
    "fun rev (l : int list) = hd l;",
    "infix 5 cmp",
    "structure Fifo = struct val empty = 3 end;",
)


def marking(text: str) -> str:
    """The marking of the only place."""
    net = flat(text)
    return str(places(net, Game(net, seed=1).marking)[0]["marking"])


@pytest.mark.parametrize("value", USES)
def test_colours_with_names_of_the_library(value: str) -> None:
    colset, expected = USES[value]
    text = COLOURS.format(declarations="\n  ".join(OWN), colset=colset, value=value)
    assert marking(text) == expected


def test_own_names_stay_the_net_s() -> None:
    """What the library brings in beside what was mentioned does not hide what the net declares."""
    text = COLOURS.format(
        declarations="structure Fifo = struct val empty = 3 end;\n"
        "  val made = let val q = Queue.mkQueue () in Queue.enqueue (q, 1); Queue.length q end;",
        colset="INT",
        value="Fifo.empty + made",
    )
    assert marking(text) == "1`4"


def test_two_lists_of_different_types() -> None:
    """Functions of pairs of lists that SML/NJ adds to the Basis library."""
    text = COLOURS.format(
        declarations="fun some (k, b) = if k > 1 then SOME b else NONE;",
        colset="STRING",
        value='concat (ListPair.mapPartial some ([1, 2, 3], ["a", "b", "c"]))',
    )
    assert marking(text) == '1`"bc"'


@pytest.mark.parametrize("literal", ["0wx80000000", "0wx100 : Word8.word"])
def test_words_that_are_too_large(literal: str) -> None:
    text = COLOURS.format(declarations=f"val w = {literal};", colset="INT", value="1")
    assert [e.code for e in diagnose(text).errors] == ["literal-too-large"]


def test_colour_sets_with_names_of_the_library() -> None:
    """They are the net's where the net names them, and not in the library's texts."""
    text = COLOURS.format(
        declarations="colset Fifo = list INT;\n  colset Atom = with H | He;\n  colset Format = list INT;\n"
        "  fun q () = let val q = Queue.mkQueue () in Queue.enqueue (q, 4); Queue.length q end;",
        colset="Format",
        value="Format.base ^^ [q (), AtomMap.numItems AtomMap.empty] ^^ Fifo.base ^^ map Atom.ord [He]",
    )
    assert marking(text) == "1`[1,0,1]"


@pytest.mark.parametrize("name", ["col", "tcf", "RealToIntInf"])
@pytest.mark.parametrize("used", [True, False])
def test_variables_with_names_of_the_library(name: str, used: bool) -> None:
    """Inscriptions mean the variable, also where a declaration before it has used what the library has."""
    use = {"col": "col (1 @ 3)", "tcf": "tcf (1, [1 @ 3])", "RealToIntInf": "RealToIntInf 0 1.5"}
    text = f"""
net Variables
  standard
  val first = {use[name] if used else "3"};
  var {name} : INT;
  page Top
    place A : INT = 1`1
    place B : INT
    trans T
      in A : {name}
      out B : {name} + 1
"""
    assert not diagnose(text).items

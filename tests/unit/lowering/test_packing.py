"""Which places are packed, how wide their counters are, and where they lie."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.lowering.nets.packing import Packing, bits, choose, key_bits, packed_bits
from pn2code.semantics.game.token_game import Game
from pn2code.verify.exploring.programs import Sizes

NET = """
    net Cell
      standard
      colset ONE = with only;
      colset RGB = with red | green | blue;
      colset SMALL = int with ~3..4;
      colset LARGE = int with 0..4999;
      colset WIDE = product SMALL * SMALL * RGB;
      colset EVEN = subset SMALL by (fn n => n mod 2 = 0);
      colset TIMED = SMALL timed;
      colset ANY = union A: RGB + B + C: EVEN;
      colset LIST = list RGB;
      colset TREE = union Leaf + Knot: RGB;
      place U = 9
      place O : ONE = 3`only
      place R : RGB = 1`red ++ 1`blue
      place S : SMALL = 5`1 ++ 1`2
      place Large : LARGE
      place W : WIDE
      place E : EVEN
      place T : TIMED
      place X : ANY
      place L : LIST
      place Text : STRING
      place N : INT
      place M : SMALL
"""


def _places(packing: Packing) -> dict[str, ir.Packed | None]:
    net, d = lowered(flat(NET), packing=packing)
    assert net is not None and not d.has_errors
    return {p.name.removeprefix("Top."): p.packed for p in net.places}


def test_what_is_packed() -> None:
    places = _places(Packing({}))
    colours = {name: p.colours for name, p in places.items() if p is not None}
    assert colours == {
        "U": 1, "O": 1, "R": 3, "S": 8, "W": 192, "E": 8, "X": 3 + 1 + 8, "M": 8,
    }  # fmt: skip
    assert not any(p for p in _places(Packing({}, 0)).values())
    few = _places(Packing({"Top.S": 2}, 4, most_colours=3))
    assert {n for n, p in few.items() if p} == {"U", "O", "R"}


def test_widths_come_from_the_initial_marking() -> None:
    net = flat(NET)
    marking = Game(net, {}).marking
    packing = choose(net, [Counter(tokens).values() for tokens in marking.places])
    found = {name: p.width for name, p in _places(packing).items() if p is not None}
    assert found == {"U": 5, "O": 4, "R": 1, "S": 4, "W": 1, "E": 1, "X": 1, "M": 1}
    indices = {p.short: p.index for p in net.places}
    proven = {"U": 9, "O": 100000, "R": 3, "S": 20, "W": 0, "M": 900}
    known = choose(
        net,
        [Counter(tokens).values() for tokens in marking.places],
        {indices[name]: n for name, n in proven.items()},
    )
    found = {name: p.width for name, p in _places(known).items() if p is not None}
    assert found == {"U": 4, "O": 4, "R": 2, "S": 4, "W": 1, "E": 1, "X": 1, "M": 1}
    wider = packing.wider("Top.W").wider("Top.W").wider("Top.U")
    found = {name: p.width for name, p in _places(wider).items() if p is not None}
    assert (found["W"], found["U"], found["R"]) == (4, 10, 1)
    for _ in range(3):
        wider = wider.wider("Top.U")
    assert wider.of("Top.U") == 0
    assert _places(wider)["U"] is None
    assert [bits(n) for n in (0, 1, 2, 10, 2**40)] == [1, 1, 2, 4, 32]


def test_no_counter_lies_across_words_and_none_on_another() -> None:
    for width in (1, 3, 5, 7, 12, 31):
        net, _ = lowered(flat(NET), packing=Packing({}, width))
        assert net is not None
        taken: set[int] = set()
        for p in net.places:
            if p.packed is None:
                continue
            n, w, first = p.packed.colours, p.packed.width, p.packed.bit
            assert w >= width
            own = set(range(first, first + n * w))
            assert len(own & taken) == 0
            taken |= own
            for i in range(n):
                assert (first + i * w) // 64 == (first + i * w + w - 1) // 64
            if n * w <= 64:
                assert first // 64 == (first + n * w - 1) // 64
        assert packed_bits(net.places) == max(taken) + 1


RING = """
    net Ring
      standard
      val n = {n};
      colset ID = int with 1..n;
      var i : ID;
      fun next i = if i = n then 1 else i + 1;
      place Idle : ID = ID.all ()
      place Fork : ID = ID.all ()
      place Busy : ID
      place Done : ID = {more}
      trans Start
        in Idle : i
        in Fork : 1`i ++ 1`(next i)
        out Busy : i
      trans End
        in Busy : i
        out Done : i
        out Fork : 1`i ++ 1`(next i)
      trans Again
        in Done : i
        out Idle : i
"""


def _shares(
    n: int, more: str = "empty", width: dict[str, int] | None = None
) -> dict[str, set[str]]:
    net = flat(RING.format(n=n, more=more))
    sizes = Sizes.start(net, {})
    packing = replace(sizes.packing, width={**sizes.packing.width, **(width or {})})
    compiled, d = lowered(net, packing=packing)
    assert compiled is not None and not d.has_errors
    packed = {p.name.removeprefix("Top."): p.packed for p in compiled.places}
    names = list(packed)
    kept = max(p.bit + n * p.width for p in packed.values() if p is not None and not p.shares)
    found: dict[str, set[str]] = {}
    for name, p in packed.items():
        assert p is not None
        if p.shares:
            found[name] = {names[i] for i, weight in p.shares if weight == 1}
            assert p.bit >= kept
    assert key_bits(compiled.places) == kept
    return found


def test_places_that_follow_from_others() -> None:
    assert _shares(15) == {}  # 60 bits: there is nothing to gain
    of_ids = {"Idle", "Busy", "Done"}
    for n in (20, 30, 100):
        found = _shares(n)
        assert len(found) == 1
        ((place, others),) = found.items()
        assert others | {place} == of_ids
    # With two tokens of one colour the sum is more than a counter of one bit holds.
    assert len(_shares(40, "1`1", dict.fromkeys(("Top.Idle", "Top.Busy", "Top.Done"), 2))) == 1
    assert _shares(40, "1`1", dict.fromkeys(("Top.Idle", "Top.Busy", "Top.Done"), 1)) == {}
    # Counters of different widths do not lie side by side.
    assert _shares(40, width={"Top.Idle": 2}) == {}

"""Variables that nothing binds: `check` says what CPN Tools makes of them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.net.free_variables import remark
from pn2code.verify.controller.control_types import CONFLUENT
from pn2code.verify.controller.proofs import _hint

NET = """
    net N
      standard
      colset V = with good | bad;
      var v, w : V;
      place A : UNIT = ()
      place B : V
      trans X{0}
        in A : ()
        out B : {1}
"""


@pytest.mark.parametrize(
    ("guard", "out", "says"),
    [
        ("", "v", "it is on output arcs alone, and CPN Tools draws one of the values of `V`"),
        (" guard [v <> bad]", "v", "gives it a value, and CPN Tools tries all the values of `V`"),
        (" guard [v = good]", "v", ""),
        ("", "good", ""),
    ],
)
def test_a_variable_that_nothing_binds_is_told(guard: str, out: str, says: str) -> None:
    d = Diagnostics()
    remark(flat(NET.format(guard, out)), d)
    assert len(d.items) == bool(says)
    for item in d.items:
        assert "variable `v` of transition `X` is bound by no arc" in item.message
        assert says in item.message
        assert "put `v` on an input arc" in item.hint
        assert item.severity.name == "NOTE"


def test_in_a_supervisor_it_is_a_warning() -> None:
    d = Diagnostics()
    net = flat(NET.format("", "v"))
    remark(net, d, {0})
    (item,) = d.items
    assert item.severity.name == "WARNING"
    assert "always takes the first one" in item.message
    d = Diagnostics()
    remark(net, d, ())
    assert not d.items


def test_others_are_counted_and_named() -> None:
    d = Diagnostics()
    more = "      trans Y\n        in A : ()\n        out B : w\n        out B : v\n"
    remark(flat(NET.format("", "v") + more), d)
    (item,) = d.items
    assert "(so are 2 more)" in item.message
    assert sorted(n.message for n in item.notes) == ["`v` of `Y`", "`w` of `Y`"]


@pytest.mark.parametrize(
    ("out", "transitions", "advice"),
    [
        ("v", ("N.X",), "`v` is bound by no arc: put it on an input arc"),
        ("good", ("N.X",), "leave one binding only"),
        ("v", ("N.X", "N.Y"), "give the transitions different priorities"),
    ],
)
def test_no_priority_chooses_between_the_bindings_of_one_transition(
    out: str, transitions: tuple[str, ...], advice: str
) -> None:
    net = flat(NET.format("", out))
    names = tuple(t.replace("N.X", net.transitions[0].name) for t in transitions)
    check = SimpleNamespace(name=CONFLUENT, transitions=names)
    said = _hint(check, SimpleNamespace(net=net))  # type: ignore[arg-type]
    assert advice in said
    assert ("priorities" in said) == (len(transitions) > 1)
    assert 'order = "documented"' in said

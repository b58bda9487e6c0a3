"""Small PNML files, written shortly: `place("p", "Phil", number(1, const("p1")))`."""

from __future__ import annotations

from pathlib import Path

from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.pnml.read import read_data
from pn2code.reading.document import Document
from pn2code.semantics.game.graph import StateSpace, state_space
from pn2code.semantics.game.token_game import Game
from pn2code.unfold.net import Unfolding

NAMESPACE = "http://www.pnml.org/version-2009/grammar/pnml"


def op(tag: str, *terms: str, **attributes: object) -> str:
    """An operator with subterms."""
    written = "".join(f' {k}="{v}"' for k, v in attributes.items())
    return f"<{tag}{written}>" + "".join(f"<subterm>{t}</subterm>" for t in terms) + f"</{tag}>"


def var(name: str) -> str:
    """A variable."""
    return f'<variable refvariable="{name}"/>'


def const(name: str) -> str:
    """A constant."""
    return f'<useroperator declaration="{name}"/>'


def sort(name: str) -> str:
    """A sort by its id."""
    return f'<usersort declaration="{name}"/>'


def every(name: str) -> str:
    """All values of a sort."""
    return f"<all>{sort(name)}</all>"


def number(n: int, term: str) -> str:
    """n times a term."""
    return op("numberof", f'<numberconstant value="{n}"><positive/></numberconstant>', term)


def in_range(n: int, low: int, high: int) -> str:
    """A number of a range."""
    return f'<finiteintrangeconstant value="{n}"><finiteintrange start="{low}" end="{high}"/></finiteintrangeconstant>'


def named(name: str, definition: str) -> str:
    """A named sort whose id is its name."""
    return f'<namedsort id="{name}" name="{name}">{definition}</namedsort>'


def enum(name: str, *constants: str, tag: str = "cyclicenumeration") -> str:
    """A named enumeration."""
    inside = "".join(f'<feconstant id="{c}" name="{c}"/>' for c in constants)
    return named(name, f"<{tag}>{inside}</{tag}>")


def variable(name: str, of: str) -> str:
    """A declared variable."""
    return f'<variabledecl id="{name}" name="{name}">{sort(of)}</variabledecl>'


def place(name: str, of: str = "", marking: str = "", extra: str = "") -> str:
    """A place; without a sort, of a P/T net, with a number as marking."""
    kind = f"<type><structure>{sort(of)}</structure></type>" if of else ""
    if of and marking:
        marking = f"<hlinitialMarking><structure>{marking}</structure></hlinitialMarking>"
    elif marking:
        marking = f"<initialMarking><text>{marking}</text></initialMarking>"
    return f'<place id="{name}"><name><text>{name}</text></name>{kind}{marking}{extra}</place>'


def transition(name: str, condition: str = "") -> str:
    """A transition."""
    inside = f"<condition><structure>{condition}</structure></condition>" if condition else ""
    return f'<transition id="{name}"><name><text>{name}</text></name>{inside}</transition>'


def arc(source: str, target: str, term: str = "", kind: str = "") -> str:
    """An arc with a term, or, of a P/T net, with a number."""
    inside = f'<type value="{kind}"/>' if kind else ""
    if term.isdigit() or term.startswith("-"):
        inside += f"<inscription><text>{term}</text></inscription>"
    elif term:
        inside += f"<hlinscription><structure>{term}</structure></hlinscription>"
    return f'<arc id="{source}-{target}" source="{source}" target="{target}">{inside}</arc>'


def net(*page: str, declarations: str = "", kind: str = "symmetricnet") -> str:
    """A whole file with one page; a P/T net where there are no declarations."""
    if not declarations and kind == "symmetricnet":
        kind = "ptnet"
    declared = (
        f"<declaration><structure><declarations>{declarations}</declarations></structure></declaration>"
        if declarations
        else ""
    )
    body = "\n".join(page)
    return (
        f'<?xml version="1.0"?>\n<pnml xmlns="{NAMESPACE}"><net id="n" '
        f'type="http://www.pnml.org/version-2009/grammar/{kind}">{declared}\n'
        f'<page id="page">\n{body}\n</page></net></pnml>'
    )


def document(text: str, d: Diagnostics) -> Document | None:
    """The document of a file's text."""
    return read_data(text.encode(), "net.pnml", d)


def messages(text: str) -> list[str]:
    """`line: code: message` of all that the reader says."""
    d = Diagnostics()
    document(text, d)
    return [f"{i.origin.line}: {i.code}: {i.message}" for i in d.sorted()]


def flat(text: str, folder: Path, name: str = "net.pnml") -> FlatNet:
    """The flat net; no message is expected."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return load(path)


def load(path: Path) -> FlatNet:
    """The flat net of a file; no error is expected."""
    d = Diagnostics()
    found = front.load(path, d)
    assert found is not None, [i.message for i in d.sorted()]
    return found


def graph(found: FlatNet, most: int = 10_000) -> StateSpace:
    """Its state space by the token game."""
    return state_space(Game(found), max_nodes=most)


def size(found: FlatNet) -> tuple[int, int]:
    """States and arcs."""
    space = graph(found)
    assert space.complete
    return len(space.nodes), len(space.arcs)


def unfolded_size(u: Unfolding, most: int = 100_000) -> tuple[int, int]:
    """States and arcs of an unfolded net."""
    seen, todo, arcs = {u.initial}, [u.initial], 0
    while todo:
        marking = todo.pop()
        for t in u.transitions:
            if u.is_enabled(marking, t):
                arcs += 1
                after = u.fire(marking, t)
                if after not in seen:
                    seen.add(after)
                    todo.append(after)
        assert len(seen) <= most
    return len(seen), arcs


def philosophers(n: int) -> str:
    """A symmetric net: philosophers who take one fork after the other; deadlocks are possible."""
    names = [f"p{i}" for i in range(1, n + 1)]
    p = var("p")
    return net(
        place("Think", "Phil", every("Phil")),
        place("Fork", "Phil", every("Phil")),
        place("Has", "Phil"),
        place("Eat", "Phil"),
        transition("take"),
        transition("eat"),
        transition("stop"),
        arc("Think", "take", number(1, p)),
        arc("Fork", "take", number(1, p)),
        arc("take", "Has", number(1, p)),
        arc("Has", "eat", number(1, p)),
        arc("Fork", "eat", number(1, op("successor", p))),
        arc("eat", "Eat", number(1, p)),
        arc("Eat", "stop", number(1, p)),
        arc("stop", "Think", number(1, p)),
        arc("stop", "Fork", op("add", number(1, p), number(1, op("successor", p)))),
        declarations=enum("Phil", *names) + variable("p", "Phil"),
    )

"""Pages of random cells in the making, and what they are made of."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Sort:
    """What a message can be: its colour set, some values, the variable that takes it, and tests of that variable."""

    colset: str
    values: tuple[str, ...]
    variable: str
    tests: tuple[str, ...]


def _plain(colset: str, variable: str, *values: str) -> Sort:
    return Sort(colset, values, variable, tuple(f"{variable} = {v}" for v in values))


SORTS = (
    _plain("INT", "k", "1", "2", "0"),
    _plain("B", "b", "true", "false"),
    _plain("COL", "c", "red", "green"),
    _plain("SMALL", "s", "1", "2"),
    _plain("TEXT", "t", '"a b"', '"\\"q\\""', '""'),
    Sort("REC", ("{a = 1, b = red}", "{a = 2, b = red}"), "q", ("#a q = 1", "#a q = 2")),
    Sort("REAL", ("1.5", "~0.0"), "x", ("x > 1.0", "x <= 1.0")),
    Sort("DEEP", ("(red, (1, true))", "(green, (0, true))"), "z", ("#1 z = red", "#1 (#2 z) = 0")),
    Sort("UNIT", ("()",), "u", ("true",)),
    Sort("PAIR", ("(1, true)", "(0, false)"), "p", ("#1 p = 1", "#2 p = false")),
)
DECLARATIONS = """  standard
  colset B = bool;
  colset COL = with red | green;
  colset SMALL = int with 1..2;
  colset TEXT = string;
  colset REC = record a : SMALL * b : COL;
  colset PAIR = product INT * B;
  colset DEEP = product COL * PAIR;
  colset LIST = list INT;
  colset EVENT = union told : INT + heard : COL + felt : REAL + none;
  colset EVENTS = list EVENT;
  val P_HIGH = 100;
  val P_NORMAL = 1000;
  val P_LOW = 10000;
  fun act () = ();
  fun rest (seconds : real) = ();
  var k, k9, n, m, d, e: INT;
  var b, b9, is_held: B;
  var c, c9, verdict: COL;
  var s, s9, level: SMALL;
  var t, t9: TEXT;
  var q, q9: REC;
  var p, p9: PAIR;
  var x, x9, y: REAL;
  var z, z9: DEEP;
  var u, u9: UNIT;
  var l: LIST;
  var ev: EVENT;
  var evs: EVENTS;
"""
TIMED = "  colset TU = unit timed;\n  colset TI = int timed;\n"
PRIORITIES = ("", "", "", "P_HIGH", "P_LOW", "P_NORMAL", "~5", "0")


def head(priority: str = "", guard: str = "", delay: str = "", code: str = "") -> str:
    """What stands behind the name of a transition; the code comes last."""
    clauses = {"guard": f"[{guard}]" if guard else "", "delay": delay, "priority": priority}
    text = "".join(f" {word} {what}" for word, what in clauses.items() if what)
    action = code if code.startswith("input") else f"action {code}"
    return f"{text} code {action}" if code else text


@dataclass
class Page:
    """A page in the making."""

    name: str
    ports: list[str] = field(default_factory=list)
    places: list[str] = field(default_factory=list)
    transitions: list[str] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    """of the transitions that are no substitution transitions"""

    def port(self, name: str, direction: str, colset: str) -> None:
        """A port, `in` or `out`."""
        self.ports.append(f"    place {name} port {direction} : {colset}")

    def place(self, name: str, colset: str = "", initial: str = "", fusion: str = "") -> str:
        """A place; gives its name."""
        kind = f" : {colset}" if colset else ""
        start = f" = {initial}" if initial else ""
        fused = f" fusion {fusion}" if fusion else ""
        self.places.append(f"    place {name}{fused}{kind}{start}")
        return name

    def transition(self, name: str, arcs: list[str], clauses: str = "") -> None:
        """A transition with its arcs."""
        lines = [f"    trans {name}{clauses}", *(f"      {a}" for a in arcs)]
        self.transitions.append("\n".join(lines))
        self.names.append(name)

    def also(self, name: str, *arcs: str) -> None:
        """More arcs of a transition that is there."""
        lines = [f"      {a}" for a in arcs]
        at = next(i for i, t in enumerate(self.transitions) if t.split()[1] == name)
        self.transitions[at] = "\n".join([self.transitions[at], *lines])

    def text(self) -> str:
        """As `netbuilder` reads it."""
        return "\n".join([f"  page {self.name}", *self.ports, *self.places, *self.transitions])

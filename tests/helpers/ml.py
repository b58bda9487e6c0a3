"""CPN ML in tests: a small environment of colour sets and variables, and texts as dumps or diagnostics.

m = Ml()
m.ml("fun twice x = 2 * x")
assert m.dump("twice") == "fun twice : int -> int = fn x => Int.*(2, x)"
assert m.inscription("1`twice n", "INT") == "multi-set Ms.`(1, twice(n))"
"""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.diagnostics import Diagnostic, Diagnostics, Origin, SourceText
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.dump import dump_colset, dump_dec, dump_exp
from pn2code.ml.core.types import list_of, timed_of
from pn2code.ml.elaborate import ColsetSpec, Elaborator

FORMS = ("token", "multi-set", "timed token", "timed multi-set")


def source(text: str, part: str = "declaration") -> SourceText:
    return SourceText(text, Origin("net.cpn", 1, 1, part=part))


class Ml:
    """An elaborator with colour sets INT, STRING, BOOL, REAL, UNIT, E, P, L, R (timed), U and variables of them."""

    def __init__(
        self,
        *,
        values: Mapping[str, str] | None = None,
        real_time: bool = False,
        bare: bool = False,
    ) -> None:
        self.d = Diagnostics()
        self.e = Elaborator(self.d, values=values, real_time=real_time)
        if bare:
            return
        for name in ("INT", "STRING", "BOOL", "REAL", "UNIT"):
            self.colset(name, name.lower())
        self.colset("E", "enum", "red", "green", "blue")
        self.colset("P", "product", "INT", "STRING")
        self.colset("L", "list", "INT")
        self.colset("R", "record", fields=(("b", "INT"), ("a", "STRING")), timed=True)
        self.colset("U", "union", fields=(("Ack", "INT"), ("Nil", "")))
        for names, colset in (("n m", "INT"), ("s", "STRING"), ("b", "BOOL"), ("v w", "REAL"), ("c", "E"),
                              ("p", "P"), ("l", "L"), ("r", "R"), ("un", "U")):  # fmt: skip
            self.e.variables(names.split(), colset, Origin("net.cpn"))
        assert not self.d.items

    def colset(
        self,
        name: str,
        kind: str,
        *ids: str,
        fields: tuple[tuple[str, str], ...] = (),
        texts: tuple[str, ...] = (),
        timed: bool = False,
        by: bool = False,
    ) -> Colset | None:
        spec = ColsetSpec(
            name,
            kind,
            ids,
            fields,
            tuple(source(t, "colour set") for t in texts),
            timed,
            by,
            (),
            Origin("net.cpn", 1, 1, element=f"colour set `{name}`"),
        )
        return self.e.colset(spec)

    def ml(self, text: str) -> None:
        self.e.declarations(source(text))

    def lines(self) -> list[str]:
        """The core declarations, without those of the colour sets above."""
        assert not self.d.errors, self.messages()
        lines = [line for dec in self.e.program().declarations for line in dump_dec(dec)]
        return [x for x in lines if not x.startswith(("datatype E =", "datatype U ="))]

    def dump(self, name: str) -> str:
        """The last declaration of a name."""
        found = [x for x in self.lines() if x.split(" ", 2)[1].rstrip(":") == name]
        assert found, self.lines()
        return found[-1]

    def type_of(self, name: str) -> str:
        assert not self.d.errors, self.messages()
        return str(self.e.program().globals[name].type)

    def shown(self, name: str) -> str:
        return dump_colset(self.e.program().colsets[name])

    def inscription(self, text: str, colset: str, *, output: bool = False) -> str | None:
        c = self.e.program().colsets[colset]
        types = [c.type, list_of(c.type)]
        if c.timed:
            types += [timed_of(c.type), list_of(timed_of(c.type))]
        typed = self.e.expression(
            source(text, "inscription"), types, expected_name=colset, output=output
        )
        return None if typed is None else f"{FORMS[typed[0]]} {dump_exp(typed[1])}"

    def messages(self) -> list[str]:
        """`code | message | text under the caret`."""
        return [shown(x) for x in self.d]

    def only(self) -> Diagnostic:
        assert len(self.d.items) == 1, self.messages()
        return self.d.items[0]


def shown(item: Diagnostic) -> str:
    caret = "" if item.span is None else item.span.text
    return f"{item.code} | {item.message} | {caret}"

# ruff: noqa: E501 - rows of texts
"""Unions of random nets that change references: in code segments, on output arcs, in delays; and look at them everywhere.

References of all types: of colours, of references, in lists, options and tuples, arrays, functions; some come into being
on the way. Also exceptions, which are raised and handled. Otherwise they are as those of `random_unions`.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from helpers.random_nets import BOOL, INT, REAL, STRING, UNIT, Kind, Scope
from helpers.random_unions import Everything, Union

STYLES = ("untimed", "timed", "real")


def referring(number: int, size: int) -> Union:
    """Union number so-and-so, with so many nets."""
    style = STYLES[number % len(STYLES)]
    writer = _Referring(Random(f"references {number}"), style)
    writer.declarations()
    writer.lines.append(f"  colset WHO = int with 0..{size - 1};")
    head = "\n".join(writer.lines) + "\n"
    pages = []
    for i in range(size):
        writer.r, writer.lines = Random(f"references {number} {i}"), []
        writer.page(i)
        pages.append("\n".join(writer.lines) + "\n")
    return Union(number, style, head, tuple(pages))


@dataclass(frozen=True, slots=True)
class _Held:
    """A reference, or something that holds one.

    Args:
        kind: of what is read.
        read: an expression.
        write: a statement; `%s` is the new value.
    """

    kind: Kind
    read: str
    write: str


class _Referring(Everything):
    """With references."""

    def __init__(self, r: Random, style: str) -> None:
        super().__init__(r, style)
        self.held: list[_Held] = []
        self.changes: list[str] = []
        self.exceptions: list[tuple[str, Kind]] = []
        self.may_read = False

    # --- declarations

    def declarations(self) -> None:
        super().declarations()
        r = self.r
        for i in range(2):
            kind = self.component()
            self.lines.append(f"  exception Oops{i} of {kind.name};")
            self.exceptions.append((f"Oops{i}", kind))
        for i in range(r.randint(4, 8)):
            self.reference(
                f"r{i}",
                r.choice((INT, STRING, REAL, BOOL, UNIT)) if self.chance(0.3) else self.component(),
            )
        self.lines.append("  val count = ref 0;")
        self.lines.append("  fun bump () = (count := (!count + 1) mod 5; !count);")
        self.changes += ["ignore (bump ())", "inc count; count := !count mod 4"]
        self.held.append(_Held(INT, "(!count)", "count := %s mod 6"))
        for i in range(r.randint(1, 2)):
            takes = self.component()
            target = r.choice(self.held)
            text = target.write % f"({self.value(target.kind, Scope([('p', takes)]), 1)})"
            self.lines.append(f"  fun change{i} (p : {takes.name}) = ({text});")
            self.changes.append(f"change{i} ({self.plain(takes, Scope(), 0)})")
        self.may_read = True
        self.function("looking")

    def reference(self, name: str, kind: Kind) -> None:
        """One of some form."""

        def value() -> str:
            return f"({self.plain(kind, Scope(), 1)} : {kind.name})"

        form = self.r.choice(
            (
                "globref",
                "val",
                "ref",
                "same",
                "list",
                "option",
                "tuple",
                "fresh",
                "array",
                "function",
                "local",
                "cyclic",
                "big",
            )
        )
        v = value()
        match form:
            case "globref":
                self.lines.append(f"  globref {name} = {v};")
                self.held.append(_Held(kind, f"(!{name})", f"{name} := %s"))
            case "val":
                self.lines.append(f"  val {name} = ref {v};")
                self.held.append(_Held(kind, f"(!{name})", f"{name} := %s"))
            case "ref":
                self.lines.append(f"  val {name} = ref (ref {v});")
                self.held.append(_Held(kind, f"(!(!{name}))", f"(!{name}) := %s"))
                self.held.append(_Held(kind, f"(!(!{name}))", f"{name} := ref %s"))
            case "same":  # two ways to one cell, and one that changes
                self.lines += [
                    f"  val {name} = ref {v};",
                    f"  val {name}b = ref {name};",
                    f"  val {name}c = ref (ref {value()});",
                ]
                self.held.append(_Held(kind, f"(!(!{name}b))", f"(!{name}b) := %s"))
                self.held.append(
                    _Held(kind, f"(!(!{name}c))", f"({name} := %s; {name}c := !{name}b)")
                )
                self.held.append(
                    _Held(
                        BOOL,
                        f"(!{name}b = !{name}c)",
                        f"{name}c := (if %s then {name} else ref (!{name}))",
                    )
                )
            case "list":
                self.lines.append(f"  val {name} = [ref {v}, ref {value()}];")
                self.held.append(_Held(kind, f"(!(hd {name}))", f"hd {name} := %s"))
                self.held.append(
                    _Held(kind, f"(!(List.nth ({name}, 1)))", f"List.nth ({name}, 1) := %s")
                )
            case "option":
                self.lines.append(f"  val {name} = ref (NONE : {kind.name} option);")
                self.held.append(
                    _Held(
                        kind,
                        f"(case !{name} of NONE => {v} | SOME y => y)",
                        f"{name} := (if !count > 2 then NONE else SOME %s)"
                        if any(h.read == "(!count)" for h in self.held)
                        else f"{name} := SOME %s",
                    )
                )
            case "tuple":
                self.lines.append(f"  val {name} = ({v}, ref ({value()}, 7));")
                self.held.append(_Held(kind, f"(#1 (!(#2 {name})))", f"#2 {name} := (%s, 8)"))
            case "fresh":  # shared as long as nobody makes a new one
                self.lines += [f"  val {name} = ref [ref {v}];"]
                self.held.append(
                    _Held(kind, f"(!(hd (!{name})))", f"{name} := ref %s :: List.take (!{name}, 1)")
                )
                self.held.append(
                    _Held(kind, f"(!(List.last (!{name})))", f"List.last (!{name}) := %s")
                )
            case "array":
                self.lines.append(f"  val {name} = Array.array (2, {v});")
                self.held.append(
                    _Held(kind, f"(Array.sub ({name}, 1))", f"Array.update ({name}, 1, %s)")
                )
                self.held.append(
                    _Held(kind, f"(Array.sub ({name}, 0))", f"Array.update ({name}, 0, %s)")
                )
            case "function":
                # Functions that stand by themselves: of those that are made on the way, it is not said which are the same.
                self.lines.append(f"  fun {name}a (x : int) = {v}")
                self.lines.append(f"  fun {name}b (x : int) = {value()}")
                self.lines.append(f"  val {name} = ref {name}a;")
                self.held.append(_Held(kind, f"((!{name}) 1)", "ignore (%s)"))
                self.held.append(
                    _Held(BOOL, "true", f"{name} := (if %s then {name}a else {name}b)")
                )
            case "local":
                self.lines.append(
                    f"  val ({name}get, {name}put) = let val c = ref {v} in (fn () => !c, fn x => c := x) end;"
                )
                self.held.append(_Held(kind, f"({name}get ())", f"{name}put (%s)"))
            case "cyclic":
                self.lines += [
                    f"  datatype {name}t = End{name} | Link{name} of {kind.name} * {name}t ref;",
                    f"  val {name} = ref End{name};",
                ]
                read = f"(case !{name} of End{name} => {v} | Link{name} (y, _) => y)"
                self.held.append(_Held(kind, read, f"{name} := Link{name} (%s, {name})"))
                self.held.append(_Held(kind, read, f"{name} := Link{name} (%s, ref End{name})"))
            case _:
                self.lines.append(f"  val {name} = ref (IntInf.fromInt 3, [{v}]);")
                self.held.append(
                    _Held(
                        kind,
                        f"(hd (#2 (!{name})))",
                        f"{name} := (IntInf.pow (10, 30 + length (#2 (!{name}))), [%s])",
                    )
                )

    # --- inscriptions

    def value(self, kind: Kind, scope: Scope, depth: int) -> str:
        """Often what a reference holds."""
        known = [h for h in self.held if h.kind.name == kind.name] if self.may_read else []
        if known and self.chance(0.3):
            read = self.r.choice(known).read
            return self.fit(kind, read) if kind.is_int else read
        if depth > 0 and self.exceptions and self.chance(0.05):
            name, of = self.r.choice(self.exceptions)
            inside = f"if {super().value(BOOL, scope, 0)} then {super().value(kind, scope, 0)} else raise {name} ({self.plain(of, Scope(), 0)})"
            return f"(({inside}) handle {name} _ => {super().value(kind, scope, 0)})"
        return super().value(kind, scope, depth)

    def change(self, scope: Scope) -> str:
        """A statement."""
        if self.chance(0.3):
            return self.r.choice(self.changes)
        held = self.r.choice(self.held)
        return held.write % f"({self.value(held.kind, scope, 2)} : {held.kind.name})"

    def multiset(self, kind: Kind, scope: Scope, free: bool) -> str:
        text = super().multiset(kind, scope, free)
        if self.chance(0.05) and "x" + kind.name not in text and "@" not in text:
            return f"({self.change(scope)}; {text})"
        return text

    def code(self, scope: Scope, clauses: list[str]) -> None:
        self.changing(scope, clauses)

    def changing(self, scope: Scope, clauses: list[str]) -> None:
        known = {n for n, _ in scope.bound}
        kinds = self.r.sample(self.kinds, self.r.randint(0, min(1, len(self.kinds))))
        outputs = [(f"w{k.name}", k) for k in kinds if f"w{k.name}" not in known]
        inner = Scope(list(scope.bound))
        statements = [self.change(inner) for _ in range(self.r.randint(1, 2))]
        values = [self.value(k, inner, 2) for _, k in outputs]
        text = f"input ({', '.join(n for n, _ in scope.bound)}); " if scope.bound else ""
        if outputs:
            text += f"output ({', '.join(n for n, _ in outputs)}); "
        clauses.append(f"code {text}action ({'; '.join([*statements, *(values or ['()'])])})")
        for n, k in outputs:
            scope.add(n, k)

    def chance(self, p: float) -> bool:
        """Code segments come more often: 0.2 is how often `Writer` wants one."""
        return super().chance(0.5 if p == 0.2 else p)

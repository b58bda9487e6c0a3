# ruff: noqa: E501 - rows of texts
"""`./dev oracle --programs N`: random declarations of CPN ML, answered by pn2code and by the engine of CPN Tools.

Functions with clauses and recursion, value patterns, data types, exceptions, structures, signatures, functors, `local`,
operators of their own, polymorphism, the value restriction and what becomes of overloaded operators; one in five has a
mistake. Behind them stands a tuple of all that they declare: types, values and verdict must agree.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from tools.oracle.answers import Here
from tools.oracle.expressions import campaign
from tools.oracle.texts import Texts

from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.types import (  # fmt: skip
    BOOL,
    CHAR,
    INT,
    INTINF,
    REAL,
    STRING,
    TCon,
    TFun,
    TRecord,
    TVar,
    Type,
    list_of,
    tuple_of,
)

A, B = TVar(0), TVar(1)
POLYMORPHIC: tuple[tuple[str, Type], ...] = (
    ("fun {f} x = x", TFun(A, A)),
    ("fun {f} (x, y) = (y, x)", TFun(tuple_of(A, B), tuple_of(B, A))),
    ("fun {f} g x = g (g x)", TFun(TFun(A, A), TFun(A, A))),
    ("fun {f} [] d = d | {f} (x :: _) _ = x", TFun(list_of(A), TFun(A, A))),
    ("fun {f} nil = nil | {f} (x :: r) = {f} r ^^ [x]", TFun(list_of(A), list_of(A))),
    ("fun {f} p = List.filter p", TFun(TFun(A, BOOL), TFun(list_of(A), list_of(A)))),
    ("val {f} = fn x => fn y => x", TFun(A, TFun(B, A))),
    ("val rec {f} = fn nil => 0 | _ :: r => 1 + {f} r", TFun(list_of(A), INT)),
    ("fun 'a {f} (x : 'a) (y : 'a) = [x, y]", TFun(A, TFun(A, list_of(A)))),
    ("fun {f} x y = x = y", TFun(TVar(0, True), TFun(TVar(0, True), BOOL))),
    ("fun {f} x l = List.exists (fn y => y = x) l", TFun(TVar(0, True), TFun(list_of(TVar(0, True)), BOOL))),
    ("fun {f} (SOME x) = [x] | {f} NONE = []", TFun(TCon("option", (A,)), list_of(A))),
    ("fun {f} (g, h) x = (g x, h x)", TFun(tuple_of(TFun(A, B), TFun(A, TVar(2))), TFun(A, tuple_of(B, TVar(2))))),
    ("fun {f} n x = if n <= 0 then nil else x :: {f} (n - 1) x", TFun(INT, TFun(A, list_of(A)))),
    ("fun {f} Leaf = 0 | {f} (Knot (l, _, r)) = {f} l + 1 + {f} r", TFun(TCon("tree", (A,)), INT)),
    ("fun {f} (x as (a, _)) = (a, x)", TFun(tuple_of(A, B), tuple_of(A, tuple_of(A, B)))),
    ("local fun go acc nil = acc | go acc (x :: r) = go (x :: acc) r in fun {f} l = go nil l end", TFun(list_of(A), list_of(A))),
    ("fun {f} c x y = if c then x else y", TFun(BOOL, TFun(A, TFun(A, A)))),
    ("fun {f} x = raise Bare", TFun(A, B)),
    ("fun {f} x = (x, ref x)", TFun(A, tuple_of(A, TCon("ref", (A,))))),
)  # fmt: skip
"""Functions of several types."""

RECURSIVE: tuple[tuple[str, Type], ...] = (
    ("fun {f} 0 = {0} | {f} n = if n < 0 then {f} (~n) else {f} (n - 1) + {1}", TFun(INT, INT)),
    ("fun {f} (0, y) = y | {f} (x, 0) = x | {f} (x, y) = if x < y then {f} (x, y mod x) else {f} (x mod y, y)", TFun(tuple_of(INT, INT), INT)),
    ("fun {f} 0 = true | {f} n = {g} (abs n - 1) and {g} 0 = false | {g} n = {f} (abs n - 1)", TFun(INT, BOOL)),
    ('fun {f} "" = 0 | {f} s = Char.ord (String.sub (s, 0)) mod {3} + {f} (String.extract (s, 1, NONE))', TFun(STRING, INT)),
    ("fun {f} [] = {0} | {f} [x] = x | {f} (x :: y :: r) = {f} (x * {1} - y :: r)", TFun(list_of(INT), INT)),
    ('fun {f} #"a" = 1 | {f} #"Z" = 2 | {f} c = Char.ord c', TFun(CHAR, INT)),
    ("fun {f} n = let val i = ref 0 val s = ref 0 in while !i < n do (s := !s + !i * {1}; inc i); !s end", TFun(INT, INT)),
    ("fun {f} x = x * x", TFun(INT, INT)),
    ("fun {f} x : real = x + x", TFun(REAL, REAL)),
    ("fun {f} (x, y : IntInf.int) = x * y - x", TFun(tuple_of(INTINF, INTINF), INTINF)),
    ("fun {f} {{a, b = SOME n}} = a + n | {f} {{a, b = NONE}} = a : int", TFun(TRecord((("a", INT), ("b", TCon("option", (INT,))))), INT)),
    ("fun {f} (r : {{a : int, b : string}}) = #b r ^ Int.toString (#a r)", TFun(TRecord((("a", INT), ("b", STRING))), STRING)),
    ("fun {f} (p as {{a, ...}} : {{a : int, b : int}}) = a + #b p", TFun(TRecord((("a", INT), ("b", INT))), INT)),
    ("fun {f} red = 1 | {f} green = 2 | {f} blue = 3", TFun(TCon("LIGHT"), INT)),
    ('fun {f} (Num n) = Int.toString n | {f} (Txt s) = s | {f} Quit = "q"', TFun(TCon("U"), STRING)),
    ("fun {f} (n, k) = (if n < {0} then raise Own n else k div n) handle Own m => m | Div => ~1", TFun(tuple_of(INT, INT), INT)),
    ("fun {f} e = (raise e) handle Own n => n | Fail s => String.size s | Bare => 0", TFun(TCon("exn"), INT)),
    ("fun {f} ((x, y) :: r) = x :: y :: {f} r | {f} nil = nil : int list", TFun(list_of(tuple_of(INT, INT)), list_of(INT))),
    ("fun {f} n = case (n mod 2, n mod 3) of (0, 0) => \"both\" | (0, _) => \"two\" | (_, 0) => \"three\" | _ => Int.toString n", TFun(INT, STRING)),
    ("fun {f} (x as 1) = x + {0} | {f} (x : int) = x - {1}", TFun(INT, INT)),
    ("fun {f} w = Word.andb (w, 0wxFF) + 0w1", TFun(TCon("word"), TCon("word"))),
)  # fmt: skip
"""Functions of one type; `{0}`, `{1}`, `{3}` are numbers (the last above zero)."""

ODD: tuple[tuple[str, str], ...] = (
    ("fun {f} (x, y) = x + y", "{f} (1.5, 2.0)"),
    ("fun {f} (x, y) = x < y", '{f} ("a", "b")'),
    ("fun {f} {{a, ...}} = a", "{f} {{a = 1, b = 2}}"),
    ("fun {f} x = #a x + 1", "{f} {{a = 1}}"),
    ("val {f} = ref nil", "{f} := [1]; !{f}"),
    ("val {f} = rev o rev", "{f} [1, 2]"),
    ("val {f} = let val g = fn x => x in g end", '({f} 1, {f} "a")'),
    ("val {f} = (fn x => x) (fn x => x)", "{f} 1"),
    ("fun {f} g = (g 1, g true)", "{f} (fn x => x)"),
    ("fun {f} x = {f}", "1"),
    ("fun {f} x = let val y = x fun h z = (y, z) in (h 1, h true) end", '{f} "a"'),
    ("val ({f}, g) = (fn x => x, 3)", '({f} 1, {f} "b", g)'),
    ("val {f} = [fn x => x]", "hd {f} 2"),
    ("val {f} = SOME (fn (x, y) => x)", "valOf {f} (1, 2)"),
    ("val {f} = {{id = fn x => x, n = 3}}", '(#id {f} 1, #id {f} "s")'),
    ("exception {f} of int", "(raise {f} 3) handle {f} n => n"),
    ("exception {f} = Own", "(raise {f} 3) handle Own n => n"),
    ("local val h = 3 in val {f} = h + 1 end", "h"),
    ("datatype d = D of d | E; fun {f} (D x) = 1 + {f} x | {f} E = 0", "({f} (D (D E)), D E)"),
    ("datatype 'a d = D of 'a | E of 'a d * 'a d; fun {f} (D x) = [x] | {f} (E (l, r)) = {f} l ^^ {f} r", "({f} (E (D 1, D 2)), E (D 1, D 2))"),
    ("datatype 'a d = D of 'a * ('a * 'a) d | E; fun {f} (D (x, _)) = SOME x | {f} E = NONE", "{f} (D (1, E))"),
    ("datatype d = D of k and k = K of d | Z", "(D (K (D Z)), K (D Z))"),
    ("datatype d = D of p | Z withtype p = d * int", "D (Z, 3)"),
    ("datatype d = D of int; datatype k = datatype d; val {f} = D 3", "({f} : k)"),
    ("type 'a p = 'a * 'a; val {f} : int p = (1, 2); fun g (x : 'a p) = #1 x", '(g {f}, g ("a", "b"))'),
    ("datatype d = A1 | B1; datatype d = A1; fun {f} A1 = 1", "({f} A1, B1)"),
    ("datatype d = D of int -> int; val {f} = D (fn x => x)", "{f}"),
    ("datatype d = D of int -> int; val {f} = D (fn x => x)", "{f} = {f}"),
    ("datatype d = D of real | R of string list", "(D 1.5 = D 1.5, R nil = D 2.0, [D ~1.5, R [\"a\"]])"),
    ("abstype t = T of int with val {f} = T 3 fun g (T n) = n end", "g {f}"),
    ("structure S = struct val x = 3 fun {f} y = x + y datatype u = U | V of u end", "(S.{f} 2, S.V S.U)"),
    ("structure S : sig val {f} : int -> int end = struct val h = 2 fun {f} x = x + h end", "S.{f} 3"),
    ("structure S : sig val {f} : int -> int end = struct val h = 2 fun {f} x = x + h end", "S.h"),
    ("structure S :> sig type t val mk : int -> t val {f} : t -> int end = struct type t = int fun mk x = x fun {f} x = x + 1 end", "S.{f} (S.mk 3)"),
    ("structure S :> sig type t val mk : int -> t val {f} : t -> int end = struct type t = int fun mk x = x fun {f} x = x + 1 end", "S.{f} 3"),
    ("structure S : sig type t val mk : int -> t val {f} : t -> int end = struct type t = int fun mk x = x fun {f} x = x + 1 end", "S.{f} 3"),
    ("signature G = sig type t val z : t end; structure S : G = struct type t = string val z = \"z\" end; val {f} = S.z", '{f} ^ "a"'),
    ("signature G = sig type t val z : t end; structure S : G where type t = int = struct type t = int val z = 1 end; val {f} = S.z", "{f} + 1"),
    ("signature G = sig eqtype t val z : t end; structure S :> G = struct type t = int val z = 1 end; val {f} = S.z", "{f} = S.z"),
    ("functor F (X : sig val a : int end) = struct val b = X.a + 1 end; structure S = F (struct val a = 2 end); val {f} = S.b", "{f}"),
    ("functor F (val a : int) = struct val b = a + 1 end; structure S = F (val a = 2); val {f} = S.b", "{f}"),
    ("functor F (type t val a : t) = struct val b = [a] end; structure S = F (type t = bool val a = true); val {f} = S.b", "{f}"),
    ("structure S = struct structure R = struct val {f} = 7 end open R end; open S", "({f}, S.R.{f}, R.{f})"),
    ("open List; val {f} = length [1]", "({f}, tabulate (2, fn x => x))"),
    ("open Math; val {f} = sqrt 4.0", "({f}, pi > e)"),
    ("infix 6 +++*; fun a +++* b = a * 10 + b; val {f} = 1 +++* 2 +++* 3", "({f}, op +++* (4, 5))"),
    ("infixr 5 ::*; fun a ::* b = a - b; val {f} = 9 ::* 3 ::* 1", "{f}"),
    ("infix 4 $=; fun (a, b) $= (c, d) = a = c andalso b = d; val {f} = (1, 2) $= (1, 2)", "{f}"),
    ("infix {f}; fun x {f} y = [x, y]", "1 {f} 2"),
    ("infix {f}; fun (x {f} y) z = x + y - z", "(1 {f} 2) 3"),
    ("infix {f}; datatype d = {f} of int * int; fun g (x {f} y) = x", "(g (1 {f} 2), g (3 {f} 4))"),
    ("nonfix +; val {f} = + (1, 2); infix 6 +", "{f} + 1"),
    ("fun {f} x = x and g y = {f} y + 1", '({f} "a", g 1)'),
    ("fun {f} 0 = 1 | {f} n = n * g (n - 1) and g n = {f} n", "{f} 5"),
    ("fun {f} x y z = x + y * z; val g = {f} 1; val h = g 2", "(h 3, {f} 1 2 4)"),
    ("val rec {f} = fn 0 => 0 | n => g (n - 1) and g = fn n => {f} n", "{f} 4"),
    ("val {f} = 3 val {f} = {f} + 1", "{f}"),
    ("val x = 1 and {f} = 2; val x = {f} and {f} = x", "(x, {f})"),
    ("val SOME {f} = NONE : int option", "{f}"),
    ("val [{f}, _] = [1, 2]", "{f}"),
    ("val 3 = 3; val {f} = 1", "{f}"),
    ("val (x, {f}) :: _ = [(1, \"a\"), (2, \"b\")]", "({f}, x)"),
    ("val {{a = {f}, ...}} = {{a = 3, b = true}}", "{f}"),
    ("val {{a, b = {f} as (c, _)}} = {{a = 3, b = (true, 1)}}", "(a, {f}, c)"),
    ("fun {f} (x, x) = x", "{f} (1, 2)"),
    ("fun {f} 0 = 1 | g n = n", "1"),
    ("fun {f} x = 1 | {f} x y = 2", "1"),
    ("fun {f} 1.5 = 1 | {f} _ = 2", "{f} 1.5"),
    ('fun {f} "a" = 1', '{f} "b"'),
    ("val {f} = fn 0 => 1", "{f} 2"),
    ("fun {f} n = case n of 1 => 2", "{f} 0"),
    ("fun size x = 3; val {f} = size [1, 2]", "{f}"),
    ("fun map x = x + 1", "map 3"),
    ("val length = 5", "length"),
    ("fun op ^^ (a, b) = a - b", "5 ^^ 3"),
    ("datatype order = LESS | MORE; val {f} = LESS", "({f}, Int.compare (1, 2))"),
    ("datatype t = NONE | S of int; val {f} = [NONE, S 3]", "({f}, Int.fromString \"x\")"),
    ("datatype t = nil | x :: y", "1"),
    ("datatype t = true | false", "1"),
    ("val ref {f} = ref 3", "{f}"),
    ("val {f} = let exception L of int in fn n => if n > 3 then raise L n else n end", "{f} 4"),
    ("fun {f} n = let exception L in (if n > 0 then raise L else 0) handle L => 1 end", "{f} 4"),
    ("fun {f} (n : INT) : STRING = Int.toString n", "{f} 3"),
    ("val {f} : REC = {{a = \"x\", b = 3}}", "{f}"),
    ("val {f} = (1 : INT, red : LIGHT, [(1, red)] : LP)", "{f}"),
    ("val {f} = 1`1 ++ 2`3", "({f}, cf (3, {f}), {f} == 2`3 ++ 1`1)"),
    ("val {f} = [1`1@+3]", "{f}"),
    ("val {f} = 1`1@3 +++ 1`2@4", "{f}"),
    ("fun {f} () = 3;;; ; val g = {f} ()", "g"),
    ("val {f} = if true then 1 else 2 val g = {f} before ignore {f}", "g"),
    ("val _ = 3; val {f} = (1; 2; 3)", "{f}"),
    ("val () = (); val {f} = ()", "{f}"),
    ("val {f} = #2 (1, 2, 3) + #1 {{1 = 4, 2 = 5}}", "{f}"),
    ("val {f} = {{1 = 4, 2 = 5, 3 = true}}", "{f}"),
    ("val {f} = {{1 = 4, 3 = true}}", "{f}"),
    ("val {f} = {{2 = 4, 10 = true, a = 1}}", "{f}"),
    ("val {f} = \"a\\\n   \\b\\065\\t\\u0041\\^A\"", "{f}"),
    ("val {f} = (0x1F, 0wxff, 1e3, 1.5E~2, ~0x10)", "{f}"),
    ("(* a (* nested *) comment *) val {f} = 3 (* end *)", "{f}"),
    ("val {f}' = 3; val {f}_1 = {f}' + 1", "({f}', {f}_1)"),
    ("val {f} = 1 handle _ => 2; val g = raise Own 3 handle Own n => n + 1", "({f}, g)"),
    ("val {f} = fn x => case x of SOME (SOME y) => y | SOME NONE => 1 | NONE => 2", "({f} (SOME NONE), {f} NONE)"),
    ("val {f} = op + ; val g = foldl op * 1 [2, 3]", "({f} (1, 2), g)"),
    ("val {f} = op <", "{f} (1, 2)"),
    ("val {f} = op ::", "{f} (1, [2])"),
    ("val {f} = List.foldr (op ^^) nil [[1], [2]]", "{f}"),
    ("val {f} = ~ 3 + ~3 - ~(2)", "{f}"),
    ("val {f} = not true orelse false andalso true", "{f}"),
    ("val {f} = 7 div 2 * 2 mod 4 - 1 :: nil ^^ [2]", "{f}"),
    ("type t = int; type u = t list; val {f} : u = [1]", "1 :: {f}"),
    ("eqtype t", "1"),
    ("datatype ('a, 'b) e = L of 'a | R of 'b; val {f} = [L 1, R \"x\"]", "({f}, L true)"),
    ("val {f} = Leaf; val g = Knot ({f}, 1, {f})", "({f}, g)"),
    ("fun {f} (x : 'a) = let val y : 'a = x in y end", "({f} 1, {f} true)"),
    ("fun {f} (x : ''a) = x = x", "({f} 1, {f} 1.5)"),
    ("fun {f} (x : ''a) = x = x", "{f} (fn x => x)"),
    ("val {f} : 'a -> 'a = fn x => x + 1", "{f} 1"),
    ("val {f} : int -> int = fn x => x", "{f} 1"),
    ("val {f} = fn (x : int, y) => (y, x)", "{f} (1, 2)"),
    ("fun {f} nil = 0 | {f} (_ :: xs) = 1 + {f} xs", "({f} [1], {f} [true])"),
    ("fun {f} [] _ = [] | {f} (x :: xs) g = g x :: {f} xs g; val g = {f} [1, 2]", "g (fn x => x + 1)"),
)  # fmt: skip
"""Declarations, and what is asked of them: what one must know of the language."""


class Programs(Texts):
    """Makes declarations, and keeps what they declare."""

    def __init__(self, r: Random, colsets: dict[str, Colset]) -> None:
        super().__init__(r, colsets)
        self.scope: list[tuple[str, Type]] = []

    def name(self, start: str) -> str:
        self.names += 1
        return f"{start}{self.names}"

    def of(self, t: Type, depth: int) -> str:
        """Of a type: often something declared before."""
        if self.scope and self.r.random() < 0.4:
            for name, found in self.r.sample(self.scope, len(self.scope)):
                text = self.used(name, found, t, depth)
                if text is not None:
                    return text
        return super().of(t, depth)

    def used(self, name: str, found: Type, wanted: Type, depth: int) -> str | None:
        """An application of something declared that is of a type; None if there is none."""
        arguments: list[Type] = []
        while True:
            chosen: dict[int, Type] = {}
            if _fits(found, wanted, chosen):
                opened = [self.open(x, chosen) for x in arguments]
                if opened and depth <= 0:
                    return None
                made = " ".join([name, *(self.atom(self.of(x, depth - 1)) for x in opened)])
                return f"({made})" if opened else made
            if not isinstance(found, TFun):
                return None
            arguments.append(found.argument)
            found = found.result

    def declaration(self) -> str:
        """One declaration or a few that belong together."""
        makers: tuple[Callable[[], str], ...] = (
            self.value_declared, self.value_declared, self.pattern_declared, self.clauses, self.clauses, self.polymorphic,
            self.recursive, self.recursive, self.datatype, self.wrapped,
        )  # fmt: skip
        return self.r.choice(makers)()

    def value_declared(self) -> str:
        name, t = self.name("v"), self.type()
        text = f"val {name} = {self.of(t, 2)}"
        self.scope.append((name, t))
        return text

    def pattern_declared(self) -> str:
        t = tuple_of(self.type(1), self.type(1))
        value = self.of(t, 2)
        bound: list[tuple[str, Type]] = []
        pattern = self.pattern(t, 2, bound)
        self.scope += bound
        return f"val {pattern} = {value}"

    def clauses(self) -> str:
        name, parameter, result = self.name("f"), self.type(1), self.type(1)
        curried = self.r.random() < 0.3
        other = self.type(0)
        lines = []
        for _ in range(self.r.choice((1, 2, 3))):
            bound: list[tuple[str, Type]] = []
            left = f"{name} {self.pattern(parameter, 2, bound, True)}"
            if curried:
                left += f" {self.pattern(other, 1, bound, True)}"
            kept, self.scope = self.scope, [*self.scope, *bound]
            constraint = (
                f" : {'int' if result == INT else 'string'}" if result in (INT, STRING) else ""
            )
            lines.append(f"{left}{constraint} = {self.of(result, 2)}")
            self.scope = kept
        self.scope.append((name, TFun(parameter, TFun(other, result) if curried else result)))
        return "fun " + " | ".join(lines)

    def polymorphic(self) -> str:
        name = self.name("p")
        text, t = self.r.choice(POLYMORPHIC)
        self.scope.append((name, t))
        return text.format(f=name)

    def recursive(self) -> str:
        name = self.name("f")
        text, t = self.r.choice(RECURSIVE)
        self.scope.append((name, self.known(t)))
        numbers = [self.r.randrange(9), self.r.choice((2, 3, -1)), 0, self.r.randrange(1, 9)]
        return text.format(*(str(n).replace("-", "~") for n in numbers), f=name, g=name + "'")

    def known(self, t: Type) -> Type:
        """With the types of colour sets for their names."""
        match t:
            case TCon(name) if name in self.colsets:
                return self.colsets[name].type
            case TFun(argument, result):
                return TFun(self.known(argument), self.known(result))
            case _:
                return t

    def datatype(self) -> str:
        """A data type of its own, a value and a function of it; they are seen through what they are made of."""
        name, f = self.name("t"), self.name("g")
        parts = [
            self.type(1) if self.r.random() < 0.6 else None for _ in range(self.r.choice((1, 2, 3)))
        ]
        cons = [f"{name.upper()}{'XYZ'[i]}" for i in range(len(parts))]
        lines = []
        result = self.type(0)
        for con, part in zip(cons, parts, strict=True):
            bound: list[tuple[str, Type]] = []
            pattern = con if part is None else f"({con} {self.pattern(part, 1, bound, True)})"
            kept, self.scope = self.scope, [*self.scope, *bound]
            lines.append(f"{f} {pattern} = {self.of(result, 1)}")
            self.scope = kept
        written = " | ".join(
            con if part is None else f"{con} of {self.written(part)}"
            for con, part in zip(cons, parts, strict=True)
        )
        self.scope += [
            (c, TCon(name) if p is None else TFun(p, TCon(name)))
            for c, p in zip(cons, parts, strict=True)
        ]
        self.scope.append((f, TFun(TCon(name), result)))
        return f"datatype {name} = {written}\nfun {' | '.join(lines)}"

    def written(self, t: Type) -> str:
        """A type as one writes it."""
        match t:
            case TFun(argument, result):
                return f"({self.written(argument)} -> {self.written(result)})"
            case TRecord(fields):
                if not fields:
                    return "unit"
                if t.is_tuple:
                    return f"({' * '.join(self.written(x) for _, x in fields)})"
                return "{" + ", ".join(f"{k} : {self.written(x)}" for k, x in fields) + "}"
            case TCon(name, args):
                return " ".join([*(f"({self.written(x)})" for x in args), name])
            case _:
                return "unit"

    def wrapped(self) -> str:
        """A declaration inside `local`, a structure or `let`."""
        before = len(self.scope)
        inner = self.r.choice(
            (self.value_declared, self.clauses, self.recursive, self.polymorphic)
        )()
        made = self.scope[before:]
        match self.r.randrange(4):
            case 0:
                hidden = self.name("h")
                return f"local val {hidden} = {self.of(self.type(0), 1)} in {inner} end"
            case 1:
                structure = self.name("S")
                self.scope[before:] = [(f"{structure}.{n}", t) for n, t in made]
                return f"structure {structure} = struct {inner} end"
            case 2:
                structure = self.name("S")
                return f"structure {structure} = struct {inner} end; open {structure}"
            case _:
                names = [n for n, _ in made]
                del self.scope[before:]
                outer = self.name("v")
                if len(names) == 1:
                    self.scope.append((outer, made[0][1]))
                return f"val {outer} = let {inner} in {', '.join(names) if len(names) == 1 else '()'} end"

    def pattern(
        self, t: Type, depth: int, bound: list[tuple[str, Type]], atomic: bool = False
    ) -> str:
        """A pattern of a type, often one that fits everything."""
        roll = self.r.random()
        if roll < 0.15:
            return "_"
        if roll > 0.55 and depth > 0:
            made = self.taken_apart(t, depth, bound)
            if made:
                return made
        name = self.name("x")
        bound.append((name, t))
        return name

    def taken_apart(self, t: Type, depth: int, bound: list[tuple[str, Type]]) -> str | None:
        match t:
            case TRecord(fields) if fields:
                parts = [(k, self.pattern(x, depth - 1, bound)) for k, x in fields]
                if t.is_tuple:
                    return f"({', '.join(p for _, p in parts)})"
                return "{" + ", ".join(f"{k} = {p}" for k, p in parts) + "}"
            case TCon("list", (inner,)):
                head, rest = (
                    self.pattern(inner, depth - 1, bound),
                    self.pattern(t, depth - 1, bound),
                )
                return (
                    self.r.choice((f"({head} :: {rest})", "nil", "[]"))
                    if self.r.random() < 0.7
                    else "nil"
                )
            case TCon("option", (inner,)):
                return (
                    f"(SOME {self.pattern(inner, depth - 1, bound, True)})"
                    if self.r.random() < 0.6
                    else "NONE"
                )
            case TCon("int"):
                return self.r.choice(("0", "1", "~1", "3"))
            case TCon("string"):
                return self.r.choice(('"a"', '""', '"abc"'))
            case TCon("char"):
                return self.r.choice(('#"a"', '#"0"'))
            case TCon("bool"):
                return self.r.choice(("true", "false"))
            case TCon("order"):
                return self.r.choice(("LESS", "GREATER"))
            case TCon("LIGHT"):
                return self.r.choice(("red", "green"))
        return None

    def program(self) -> str:
        """Declarations and a tuple of some of what they declare."""
        self.scope, self.names = [], 0
        if self.r.random() < 0.35:
            declared, asked = self.r.choice(ODD)
            name = self.name("f")
            first, last = declared.format(f=name), asked.format(f=name)
            more = [self.declaration() for _ in range(self.r.choice((0, 0, 1)))]
            return ";\n".join([*more, first, last])
        parts = [self.declaration() for _ in range(self.r.choice((1, 2, 3, 4)))]
        shown = [n for n, _ in self.scope[-6:]]
        shown += [self.of(self.type(0), 3) for _ in range(2)]
        return self.r.choice((";\n", ";\n", "\n")).join(parts) + f";\n({', '.join(shown)})"


def _fits(t: Type, wanted: Type, chosen: dict[int, Type]) -> bool:
    """Whether a type becomes another when its variables are chosen."""
    match t, wanted:
        case TVar(index), _:
            return chosen.setdefault(index, wanted) == wanted
        case TCon(), TCon():
            return (
                t.name == wanted.name
                and len(t.args) == len(wanted.args)
                and all(_fits(x, y, chosen) for x, y in zip(t.args, wanted.args, strict=True))
            )
        case TFun(), TFun():
            return _fits(t.argument, wanted.argument, chosen) and _fits(
                t.result, wanted.result, chosen
            )
        case TRecord(), TRecord():
            return [k for k, _ in t.fields] == [k for k, _ in wanted.fields] and all(
                _fits(x, y, chosen) for (_, x), (_, y) in zip(t.fields, wanted.fields, strict=True)
            )
    return False


def texts(count: int, seed: int, here: Here) -> list[str]:
    """The texts: one in six has a mistake."""
    r = Random(seed)
    made = Programs(r, {c.name: c for c in here.program.colsets.values()})
    found: list[str] = []
    while len(found) < count:
        text = made.program()
        if r.random() < 1 / 6:
            text = made.damaged(text)
        if len(text) < 1000:
            found.append(text)
    return found


def main(arguments: list[str]) -> int:
    """0 when nothing differs without a known reason."""
    return campaign("programs", __doc__, texts, arguments)

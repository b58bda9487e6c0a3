"""Odd corners of the nets that CPN Tools runs, and what its rules say about them, for the token game and compiled nets.

A case is a name, the body of a net (see `netbuilder`; the declarations are `HEAD`), how many steps are made, each time
the first element that is enabled, and what comes out: what places hold then, the bindings enabled at the start,
`!text` of the error that stops it, or the code of the error for which it is refused.
"""

from __future__ import annotations

HEAD = r"""
net Odd
  standard
  colset INTT = int timed;
  colset SMALL = int with 1..3;
  colset SMALLT = int with 1..3 timed;
  colset PAIR = product INT * INT;
  colset PAIRT = product INT * INT timed;
  colset REC = record b: INT * a: STRING;
  colset MSG = union Data: PAIR + Num: INT + Quit;
  colset MSGT = union DataT: PAIR + NumT: INT + QuitT timed;
  colset LIST = list INT;
  colset LISTS = list LIST;
  colset LIGHT = with red | green | blue;
  colset SW = bool with (off, on);
  colset E = unit with e;
  colset IDX = index ph with 1..3;
  colset REALT = real timed;
  colset UT = unit timed;
  colset OPT = product IDX * LIST;
  val P_HIGH = 100; val P_NORMAL = 1000; val P_LOW = 10000;
  fun inc n = n + 1;
  fun two (n : int) = (n, n * 2);
  colset STRT = string timed;
  colset H = int with 1..100;
  colset HH = int with 1..101;
  colset RECT = record k: INT * l: INT timed;
  colset NEST = union L: REC + R: PAIR;
  colset LISTT = list INT timed;
  colset TWO = product LIGHT * SMALL;
  colset MAYBE = union Non + Som: SMALL;
  colset EVENH = subset H by (fn n => n mod 2 = 0);
  colset FEW = subset INT with [5, 3, 9];
  colset SHORT = list LIGHT with 0..1;
  colset WORD = string with "a".."b" and 1..2;
  colset RT = real timed;
  colset BIG = int;
  globref cnt = 0;
  fun fact 0 = 1 | fact n = n * fact (n - 1);
  fun count () = (cnt := !cnt + 1; !cnt);
  fun safe l = hd l handle Empty => ~1;
  exception Own of int;
  fun ownf n = if n > 2 then raise Own n else n;
  var n, m, k: INT; var t, u, w: INTT; var s, s2: SMALL; var b: BOOL; var x, y: STRING; var r: REC; var g: MSG;
  var l, l2: LIST; var c: LIGHT; var sw: SW; var un: E; var i, j: IDX; var evh: EVENH; var mb: MAYBE; var p: PAIR;
  var q: REAL; var ll: LISTS; var h: H; var hh: HH; var tw: TWO; var few: FEW; var sh: SHORT;
  var wd: WORD; var nest: NEST; var rt: RECT; var lt: LISTT; var rr: RT; var xt: STRT; var pt: PAIRT;
"""

Wanted = dict[str, str] | list[str] | str

CASES: tuple[tuple[str, str, int, Wanted], ...] = (
    (
        "output fix delays all",
        r"""
place A : INT = 1`1
place B : INTT
trans T
  in A : n
  out B : 1`n ++ 1`(n + 1)@+3
""",
        1,
        {'B': '1`1@3+++ 1`2@3'},
    ),
    (
        "output fix first only",
        r"""
place A : INT = 1`1
place B : INTT
trans T
  in A : n
  out B : 1`n ++ 1`(n + 1)@+3 +++ 1`9@+1
""",
        1,
        {'B': '1`1@3+++ 1`2@3+++ 1`9@1'},
    ),
    (
        "delayed branch is a syntax error",
        r"""
place A : INT = 1`1
place B : INTT
trans T
  in A : n
  out B : if n > 0 then 1`n@+3 else empty
""",
        0,
        'syntax-error',
    ),
    (
        "no fix on both",
        r"""
place A : INTT = 1`1++1`2
trans T guard [t < u]
  both A : 1`t ++ 1`u@+3
""",
        0,
        'type-mismatch',
    ),
    (
        "if all delayed",
        r"""
place A : INT = 1`1
place B : INTT
trans T
  in A : n
  out B : if n > 5 then 1`n else 2`n@+3
""",
        1,
        {'B': '2`1@3'},
    ),
    (
        "absolute stamps",
        r"""
place B : INTT = 1`1@7+++(1`2++1`3)@+4+++2`1@2
""",
        0,
        {'B': '1`1@7+++ 2`1@2+++ 1`2@4+++ 1`3@4'},
    ),
    (
        "initial marking has no fix",
        r"""
place B : INTT = 1`1++1`2@+4
""",
        0,
        'type-mismatch',
    ),
    (
        "untimed tokens in timed place",
        r"""
place B : INTT = 1`1++2`3
""",
        0,
        {'B': '1`1@0+++ 2`3@0'},
    ),
    (
        "zero coefficient needs a token",
        r"""
place A : INT = empty
place B : INT = 1`5
trans T
  in A : 0`n
  out B : n
trans U
  in B : 0`n
  out A : n
""",
        1,
        {'A': '1`5', 'B': '1`5'},
    ),
    (
        "variable coefficient tests",
        r"""
place A : INT = 3`1 ++ 2`2
place B : INT = 2`3
trans T
  in B : n
  in A : 2`m
  in A : (n - 1)`k
  out B : inc m
""",
        0,
        'unbound-variable',
    ),
    (
        "variable coefficient of a small set",
        r"""
place A : SMALL = 3`1 ++ 2`2
place B : INT = 1`3
trans T
  in B : n
  in A : n`s
""",
        1,
        {'A': '2`2'},
    ),
    (
        "equal components",
        r"""
place A : PAIR = 1`(1,2) ++ 1`(3,3)
place B : INT
trans T
  in A : (n, n)
  out B : n
""",
        1,
        {'A': '1`(1,2)', 'B': '1`3'},
    ),
    (
        "guards bind in any order",
        r"""
place A : INT = 1`4
place B : INT
trans T guard [k = m + 1, (m, b) = (n * 2, n > 3), b]
  in A : n
  out B : 1`k ++ 1`m
""",
        1,
        {'B': '1`8++ 1`9'},
    ),
    (
        "guard binds from the right",
        r"""
place A : INT = 1`4
place B : PAIR
trans T guard [two n = (m, k)]
  in A : n
  out B : (m, k)
""",
        1,
        {'B': '1`(4,8)'},
    ),
    (
        "andalso does not bind",
        r"""
place A : INT = 1`4
place B : INT
trans T guard [n > 1 andalso m = n]
  in A : n
  out B : m
""",
        0,
        'unbound-variable',
    ),
    (
        "guard Bind is no match",
        r"""
place A : INT = 1`1 ++ 1`2
place B : INT
trans T guard [let val (1, z) = (n, 2) in z = 2 end]
  in A : n
  out B : n
""",
        5,
        {'A': '1`2', 'B': '1`1'},
    ),
    (
        "guard equation Bind is no match",
        r"""
place A : LIST = 1`[1] ++ 1`[2,3]
place B : INT
trans T guard [n::m::l2 = l]
  in A : l
  out B : n + m
""",
        5,
        {'A': '1`[1]', 'B': '1`5'},
    ),
    (
        "guard exception stops",
        r"""
place A : LIST = 1`[]
trans T guard [hd l = 1]
  in A : l
""",
        1,
        '!Empty',
    ),
    (
        "inhibitor ignores the future",
        r"""
place A : INTT = 1`1@5
place B : INT = 2`1
place D : INT
trans T
  in B : n
  out D : n
  inhibit A :
""",
        5,
        {'B': 'empty', 'D': '2`1'},
    ),
    (
        "inhibitor stops",
        r"""
place A : INTT = 1`1@0
place B : INT = 2`1
trans T
  in B : n
  inhibit A :
""",
        5,
        {'B': '2`1'},
    ),
    (
        "reset and output untimed",
        r"""
place A : INT = 3`1
place B : INT = 1`7
trans T
  in B : n
  out A : n
  reset A :
""",
        1,
        {'A': 'empty'},
    ),
    (
        "reset and output timed",
        r"""
place A : INTT = 3`1@0+++1`4@9
place B : INT = 1`7
trans T delay @+2
  in B : n
  out A : n
  reset A :
""",
        1,
        {'A': '1`4@9+++ 1`7@2'},
    ),
    (
        "reset and output timed now",
        r"""
place A : INTT = 3`1@0
place B : INT = 1`7
trans T
  in B : n
  out A : n
  reset A :
""",
        1,
        {'A': 'empty'},
    ),
    (
        "both stamps again",
        r"""
place A : INTT = 1`1@2
place B : INT = 2`7
trans T delay @+3
  in B : n
  both A : t
""",
        2,
        {'A': '1`1@8'},
    ),
    (
        "preemptive",
        r"""
place A : INTT = 1`1@5
place B : INTT
trans T
  in A : t @+ 3
  out B : t
""",
        1,
        {'B': '1`1@2'},
    ),
    (
        "preemptive of two terms",
        r"""
place A : INTT = 1`1@5+++1`2@4
place B : INTT
trans T guard [t < u]
  in A : t@+3 +++ u@+1
  out B : t
""",
        0,
        'type-mismatch',
    ),
    (
        "preemptive multi-set of two terms",
        r"""
place A : INTT = 1`1@5+++1`2@4
place B : INTT
trans T guard [t < u]
  in A : 1`t@+3 +++ 1`u@+1
  out B : t
""",
        1,
        {'B': '1`1@3', 'A': 'empty'},
    ),
    (
        "absolute on output",
        r"""
place A : INT = 1`1
place B : INTT
trans T delay @+2
  in A : n
  out B : 1`n@7
""",
        1,
        {'B': '1`1@9'},
    ),
    (
        "output absolute token",
        r"""
place A : INT = 1`1
place B : INTT
trans T delay @+2
  in A : n
  out B : n@7
""",
        1,
        {'B': '1`1@9'},
    ),
    (
        "priority expressions",
        r"""
place A : INT = 2`1
place B : INT
place D : INT
trans Low priority P_NORMAL + 1
  in A : n
  out B : n
trans High priority P_HIGH * 2 - 50
  in A : n
  out D : n
""",
        2,
        {'B': 'empty', 'D': '2`1'},
    ),
    (
        "a waiting priority does not block",
        r"""
place A : INTT = 1`1@4
place B : INT = 1`1
place D : INT
trans High priority P_HIGH
  in A : t
  in B : n
trans Low
  in B : n
  out D : n
""",
        3,
        {'D': '1`1', 'A': '1`1@4'},
    ),
    (
        "empty code segment",
        r"""
place A : INT = 1`1
place B : INT
trans T code input ();output ();action ();
  in A : n
  out B : n
""",
        1,
        {'B': '1`1'},
    ),
    (
        "code outputs in delay",
        r"""
place A : INT = 1`1
place B : INTT
trans T delay @+m code input (n); output (m, x); action (n + 4, "a")
  in A : n
  out B : size (explode x) + m
""",
        1,
        {'B': '1`6@5'},
    ),
    (
        "code without input",
        r"""
place A : INT = 1`1
place B : INT
trans T code output (m); action 5
  in A : n
  out B : m
""",
        1,
        {'B': '1`5'},
    ),
    (
        "code raises",
        r"""
place A : INT = 1`1
trans T code action raise Fail "x"
  in A : n
""",
        1,
        '!Fail',
    ),
    (
        "code of another type",
        r"""
place A : INT = 1`1
place B : INT
trans T code output (m); action "a"
  in A : n
  out B : m
""",
        0,
        'type-mismatch',
    ),
    (
        "code action without output must be unit",
        r"""
place A : INT = 1`1
trans T code action 5
  in A : n
""",
        0,
        'type-mismatch',
    ),
    (
        "code output bound by an arc",
        r"""
place A : INT = 1`1
trans T code output (n); action 5
  in A : n
""",
        0,
        'code-output-bound',
    ),
    (
        "union patterns",
        r"""
place A : MSG = 1`Data (1, 2) ++ 1`Num 4 ++ 1`Quit ++ 1`Data (7, 1)
place B : INT
trans T
  in A : Data (1, n)
  out B : n
trans U
  in A : Num n
  out B : n
trans V
  in A : Quit
  out B : 100
""",
        9,
        {'A': '1`Data((7,1))', 'B': '1`2++ 1`4++ 1`100'},
    ),
    (
        "list patterns bind",
        r"""
place A : LIST = 1`[1,2,3] ++ 1`[4] ++ 1`[5,6] ++ 1`[]
place B : LIST
trans T
  in A : n::m::k::l
  out B : k::l
trans U
  in A : [n, m]
  out B : [m, n]
trans V
  in A : []
  out B : [0]
""",
        9,
        {'A': '1`[4]', 'B': '1`[0]++ 1`[3]++ 1`[6,5]'},
    ),
    (
        "nested list patterns",
        r"""
place A : LISTS = 1`[[1],[2,3]]
place B : LIST
trans T
  in A : (n::l)::l2::ll
  out B : n::l2
""",
        1,
        {'B': '1`[1,2,3]'},
    ),
    (
        "records in any order",
        r"""
place A : REC = 1`{a = "x", b = 2}
place B : REC
trans T
  in A : {a = x, b = n}
  out B : {b = n + 1, a = x ^ "y"}
""",
        1,
        {'B': '1`{b=3,a="xy"}'},
    ),
    (
        "open record on an arc",
        r"""
place A : REC = 1`{a = "x", b = 2}
place B : INT
trans T
  in A : {b = n, ...}
  out B : n
""",
        0,
        'syntax-error',
    ),
    (
        "wildcard on an arc",
        r"""
place A : PAIR = 1`(1,2)
trans T
  in A : (n, _)
""",
        0,
        'syntax-error',
    ),
    (
        "layered on an arc",
        r"""
place A : PAIR = 1`(1,2)
place B : PAIR
place D : INT
trans T
  in A : p as (n, m)
  out B : p
  out D : n + m
""",
        1,
        {'B': '1`(1,2)', 'D': '1`3'},
    ),
    (
        "list is a token or a multi-set",
        r"""
place A : LIST = [1,2]
place B : INT = [1,2,2]
place D : LIST = [[1],[1]]
""",
        0,
        {'A': '1`[1,2]', 'B': '1`1++ 2`2', 'D': '2`[1]'},
    ),
    (
        "unit numbers",
        r"""
place A = 3
place B : UNIT
trans T
  in A : 2
  out B :
""",
        1,
        {'A': '1`()', 'B': '1`()'},
    ),
    (
        "index pattern",
        r"""
place A : IDX = IDX.all()
place B : INT
trans T guard [n <> 2]
  in A : ph n
  out B : n
""",
        9,
        {'A': '1`ph(2)', 'B': '1`1++ 1`3'},
    ),
    (
        "subtract raises",
        r"""
place A : INT = 1`1
place B : INT
trans T
  in A : n
  out B : 1`n -- 1`2
""",
        1,
        '!Subtract',
    ),
    (
        "conditional multi-set",
        r"""
place A : INT = 1`1
place B : INT
trans T
  in A : n
  out B : [n = 1, n < 5] % n ++ [n > 3] % 7 ++ [true] // (2`8)
""",
        1,
        {'B': '1`1++ 2`8'},
    ),
    (
        "coefficients not positive",
        r"""
place A : INT = 1`1
place B : INT
trans T
  in A : n
  out B : (n - 1)`5 ++ (~2)`6 ++ 0**(1`3) ++ 2**(1`4)
""",
        1,
        {'B': '2`4'},
    ),
    (
        "illegal colour",
        r"""
place A : SMALL = 1`3
trans T
  in A : n
  out A : n + 1
""",
        1,
        '!illegal',
    ),
    (
        "int with binding",
        r"""
place A : INT = 1`1 ++ 1`2 ++ 1`7
place B : INT
trans T
  in A : s
  out B : s
""",
        9,
        {'A': '1`7', 'B': '1`1++ 1`2'},
    ),
    (
        "overflow",
        r"""
place A : INT = 1`1073741823
trans T
  in A : n
  out A : n + 1
""",
        1,
        '!Overflow',
    ),
    (
        "two arcs sum up",
        r"""
place A : INT = 1`1 ++ 2`2
place B : INT
trans T
  in A : n
  in A : n
  out B : n
""",
        9,
        {'A': '1`1', 'B': '1`2'},
    ),
    (
        "tests on input arcs",
        r"""
place A : INT = 1`3
place B : INT = 1`6 ++ 1`7
place D : INT
trans T
  in A : n
  in B : n * 2
  in B : if n > 2 then 1`(inc (n * 2)) else empty
  out D : n
""",
        1,
        {'B': 'empty', 'D': '1`3'},
    ),
    (
        "if on an input arc",
        r"""
place A : BOOL = 1`false
place B : INT = 1`6
place D : INT = 1`6
trans T
  in A : b
  in D : n
  in B : if b then 1`n else empty
""",
        1,
        {'B': '1`6', 'D': 'empty'},
    ),
    (
        "string and real literals",
        r"""
place A : STRING = 1`"a" ++ 1`"b"
place B : REAL = 1`1.5 ++ 1`2.5
trans T
  in A : "b"
  in B : 2.5
""",
        2,
        {'A': '1`"a"', 'B': '1`1.5'},
    ),
    (
        "bool and unit names",
        r"""
place A : SW = 1`on ++ 1`off
place B : E = 2`e
trans T
  in A : on
  in B : un
  out A : off
""",
        3,
        {'A': '2`off', 'B': '1`e'},
    ),
    (
        "real clock",
        r"""
option realtimestamp true
place A : INT = 1`1
place B : INTT
trans T delay @++ 1.5
  in A : n
  out B : n@+2
""",
        1,
        {'B': '1`1@3.5'},
    ),
    (
        "timed operators",
        r"""
place A : INT = 1`1
place B : INTT
trans T
  in A : n
  out B : 1`n@+1 +++ (2`5)@+2
""",
        1,
        {'B': '1`1@1+++ 2`5@2'},
    ),
    (
        "time in inscriptions",
        r"""
place A : INTT = 1`1@4
place B : INT
trans T
  in A : t
  out B : t + IntInf.toInt (time ())
""",
        1,
        {'B': '1`5'},
    ),
    (
        "free small variable",
        r"""
place A : INT = 1`1
place B : LIGHT
trans T guard [c <> red]
  in A : n
  out B : c
""",
        0,
        ['c=green,n=1', 'c=blue,n=1'],
    ),
    (
        "free variables of code input",
        r"""
place A : INT = 1`1
place B : INT
trans T code input (c, n); output (m); action (LIGHT.ord c + n)
  in A : n
  out B : m
""",
        1,
        {'B': '1`1'},
    ),
    (
        "tuple with list",
        r"""
place A : OPT = 1`(ph 1, [1,2]) ++ 1`(ph 2, [])
place B : INT
trans T
  in A : (i, n::l)
  out A : (i, l)
  out B : n
""",
        9,
        {'A': '1`(ph(1),[])++ 1`(ph(2),[])', 'B': '1`1++ 1`2'},
    ),
    (
        "same coefficient list",
        r"""
place A : INT = 1`1 ++ 2`2
place B : INT
trans T
  in A : 1`n ++ 2`m
  out B : n * 10 + m
""",
        1,
        {'A': 'empty', 'B': '1`12'},
    ),
    (
        "list function on input",
        r"""
place A : LIST = 1`[3,1]
place B : INT = 1`3 ++ 1`1
trans T
  in A : l
  in B : list_to_ms l
  out A : rev l
""",
        1,
        {'A': '1`[1,3]', 'B': 'empty'},
    ),
    (
        "as pattern with constructor",
        r"""
place A : MSG = 1`Num 3 ++ 1`Quit
place B : MSG
trans T
  in A : g as Num n
  out B : g
""",
        2,
        {'A': '1`Quit', 'B': '1`Num(3)'},
    ),
    (
        "delay with real int mix",
        r"""
place A : INT = 1`1
place B : INTT
trans T delay @+ 1.5
  in A : n
  out B : n
""",
        0,
        'type-mismatch',
    ),
    (
        "negative delay",
        r"""
place A : INT = 1`1
place B : INTT
trans T delay @+ ~3
  in A : n
  out B : n
""",
        1,
        {'B': '1`1@~3'},
    ),
    (
        "token delay by variable",
        r"""
place A : INTT = 1`1@5 +++ 1`3@6
place K : INT = 1`1 ++ 1`3
place B : INTT
trans T
  in A : t@+n
  in K : n
  guard [n = t]
  out B : t
""",
        2,
        {'B': '1`1@4+++ 1`3@3'},
    ),
    (
        "token delay by the token's own variable",
        r"""
place A : INTT = 1`1@5 +++ 1`3@6
place B : INTT
trans T
  in A : t@+t
  out B : t
""",
        0,
        'binding-circle',
    ),
    (
        "delay of whole multi-set",
        r"""
place A : INTT = 1`1@5 +++ 1`3@6
place B : INTT
trans T guard [t < u]
  in A : (1`t ++ 1`u)@+2
  out B : t
""",
        1,
        {'B': '1`1@4'},
    ),
    (
        "fusion and reset",
        r"""
page Top
  place A fusion Shared : INT = 2`1
  place B : INT = 1`1
  trans T
    in B : n
    reset A :
page Other
  place A2 fusion Shared : INT = 2`1
  place D : INT = 1`5
  trans U
    in D : n
    out A2 : n
""",
        2,
        {'D': 'empty'},
    ),
    (
        "fusion inhibits elsewhere",
        r"""
page Top
  place A fusion Shared : INT
  place B : INT = 1`1
  trans T
    in B : n
    out A : n
page Other
  place A2 fusion Shared : INT
  place D : INT = 2`5
  place X : INT
  trans U priority P_LOW
    in D : n
    out X : n
    inhibit A2 :
""",
        5,
        {'X': 'empty', 'D': '2`5'},
    ),
    (
        "reset both ways",
        r"""
place A : INT = 2`1
place B : INT = 1`1
trans T
  in B : n
  in A : n
  out A : 5
  reset A :
""",
        1,
        {'A': 'empty'},
    ),
    (
        "size limit 100",
        r"""
place A : H
place B : INT = 1`1
trans T guard [h = 100 orelse h > 99]
  in B : n
  out A : h
""",
        1,
        {'A': '1`100'},
    ),
    (
        "size limit 101",
        r"""
place A : HH
place B : INT = 1`1
trans T guard [hh > 100]
  in B : n
  out A : hh
""",
        0,
        'unbound-variable',
    ),
    (
        "free subset",
        r"""
place A : INT
place B : INT = 1`1
trans T guard [few > 4]
  in B : n
  out A : few
""",
        0,
        ['few=5,n=1', 'few=9,n=1'],
    ),
    (
        "free subset by",
        r"""
place A : INT
place B : INT = 1`1
trans T guard [evh < 5]
  in B : n
  out A : evh
""",
        0,
        ['evh=2,n=1', 'evh=4,n=1'],
    ),
    (
        "free short list",
        r"""
place A : SHORT
place B : INT = 1`1
trans T guard [length sh >= 0]
  in B : n
  out A : sh
""",
        0,
        ['n=1,sh=[]', 'n=1,sh=[red]', 'n=1,sh=[green]', 'n=1,sh=[blue]'],
    ),
    (
        "free word",
        r"""
place A : WORD
place B : INT = 1`1
trans T guard [wd < "b"]
  in B : n
  out A : wd
""",
        0,
        ['n=1,wd="a"', 'n=1,wd="aa"', 'n=1,wd="ab"'],
    ),
    (
        "free union",
        r"""
place A : MAYBE
place B : INT = 1`1
trans T guard [mb <> Som 2]
  in B : n
  out A : mb
""",
        0,
        ['mb=Non,n=1', 'mb=Som(1),n=1', 'mb=Som(3),n=1'],
    ),
    (
        "free product by pattern guard",
        r"""
place A : TWO
place B : INT = 1`1
trans T guard [(c, s) = tw, s = 1]
  in B : n
  out A : tw
""",
        0,
        'binding-circle',
    ),
    (
        "priority of operators",
        r"""
place A : INT = 2`1
place B : INT
place D : INT
trans Low
  in A : n
  out B : n
trans High priority P_HIGH div 3 * 2
  in A : n
  out D : n
""",
        2,
        {'B': 'empty', 'D': '2`1'},
    ),
    (
        "input of nothing",
        r"""
place A : INT = 1`1
place B : INT
trans T code input (); output (m); action (fact 5);
  in A : n
  out B : m
""",
        1,
        {'B': '1`120'},
    ),
    (
        "action only with semicolon",
        r"""
place A : INT = 1`1
place B : INT
trans T code action (cnt := 5);
  in A : n
  out B : !cnt
""",
        1,
        {'B': '1`5'},
    ),
    (
        "code counts",
        r"""
place A : INT = 3`1
place B : INT
trans T code output (m); action (cnt := !cnt + 10; !cnt)
  in A : n
  out B : m
""",
        3,
        {'B': '1`10++ 1`20++ 1`30'},
    ),
    (
        "output evaluated once per arc",
        r"""
place A : INT = 1`1
place B : INT
place D : INT
trans T
  in A : n
  out B : count ()
  out D : count ()
""",
        1,
        {'B': '1`1', 'D': '1`2'},
    ),
    (
        "code outputs list pattern",
        r"""
place A : INT = 1`3
place B : LIST
trans T code input (n); output (l, b); action (List.tabulate (n, fn j => j * j), n > 2)
  in A : n
  out B : if b then l else []
""",
        1,
        {'B': '1`[0,1,4]'},
    ),
    (
        "handled exceptions",
        r"""
place A : LIST = 1`[] ++ 1`[4]
place B : INT
trans T
  in A : l
  out B : safe l
""",
        2,
        {'B': '1`(~1)++ 1`4'},
    ),
    (
        "own exceptions",
        r"""
place A : INT = 1`1 ++ 1`3
place B : INT
trans T
  in A : n
  out B : ownf n handle Own own => own * 100
""",
        2,
        {'B': '1`1++ 1`300'},
    ),
    (
        "own exception stops",
        r"""
place A : INT = 1`3
place B : INT
trans T
  in A : n
  out B : ownf n
""",
        2,
        '!Own',
    ),
    (
        "timed list pattern",
        r"""
place A : LISTT = 1`[1,2]@3
place B : INTT
trans T delay @+1
  in A : n::l
  out A : l
  out B : n@+10
""",
        1,
        {'A': '1`[2]@4', 'B': '1`1@14'},
    ),
    (
        "both list pattern",
        r"""
place A : LIST = 1`[1,2]
place B : INT
trans T
  both A : n::l
  out B : n
""",
        2,
        {'A': '1`[1,2]', 'B': '2`1'},
    ),
    (
        "timed union",
        r"""
place A : MSGT = 1`NumT 3@2 +++ 1`QuitT@5
place B : INT
trans T
  in A : NumT n
  out B : n
trans U
  in A : QuitT
  out B : 9
""",
        2,
        {'B': '1`3++ 1`9'},
    ),
    (
        "timed records",
        r"""
place A : RECT = 1`{k = 1, l = 2}@2
place B : RECT
trans T
  in A : {l = n, k = m}
  out B : {k = n, l = m}@+1
""",
        1,
        {'B': '1`{k=2,l=1}@3'},
    ),
    (
        "union of records",
        r"""
place A : NEST = 1`L {b = 2, a = "z"} ++ 1`R (1, 2)
place B : INT
trans T
  in A : L {a = "z", b = n}
  out B : n
trans U
  in A : R (n, m)
  out B : n * 10 + m
""",
        2,
        {'B': '1`2++ 1`12'},
    ),
    (
        "function of a timed place",
        r"""
place A : INTT = 1`6@4
place B : INT = 1`3
place D : INTT
trans T
  in B : n
  in A : n * 2
  out D : n
""",
        1,
        {'D': '1`3@4'},
    ),
    (
        "preemptive test term",
        r"""
place A : INTT = 1`6@4
place B : INT = 1`3
place D : INTT
trans T
  in B : n
  in A : (n * 2)@+3
  out D : n
""",
        1,
        {'D': '1`3@1'},
    ),
    (
        "multi-set on timed input",
        r"""
place A : INTT = 1`1@4 +++ 1`2@6
place B : INT = 1`1
place D : INTT
trans T
  in B : n
  in A : 1`n ++ 1`(n + 1)
  out D : n
""",
        1,
        {'D': '1`1@6'},
    ),
    (
        "latest token is taken",
        r"""
place A : INTT = 1`1@1 +++ 1`1@3 +++ 1`1@9
place B : INT = 1`5
trans T
  in B : n
  in A : 2`t
""",
        1,
        {'A': '1`1@9'},
    ),
    (
        "unit timed",
        r"""
place A : UT = 2`()@3
place B : UT
trans T delay @+2
  in A : ()
  out B : ()
""",
        2,
        {'B': '2`()@5'},
    ),
    (
        "real time stamps",
        r"""
option realtimestamp true
place A : RT = 1`1.5@0.25
place B : RT
trans T delay @++ 0.5
  in A : rr
  out B : (rr + 1.0)@++ 0.25
""",
        1,
        {'B': '1`2.5@1.0'},
    ),
    (
        "input delay real clock",
        r"""
option realtimestamp true
place A : RT = 1`1.5@5.0
place K : REAL = 1`1.5
place B : RT
trans T
  in A : rr @++ 0.5
  in K : rr
  out B : rr
""",
        1,
        {'B': '1`1.5@4.5'},
    ),
    (
        "strings with quotes",
        r'''
place A : STRING = 1`"a\"b" ++ 1`"x\ty"
place B : STRING
trans T
  in A : "a\"b"
  out B : "q\\"
''',
        1,
        {'B': '1`"q\\"'},
    ),
    (
        "all and mult",
        r"""
place A : TWO = TWO.mult(LIGHT.all(), 1`2)
place B : INT
trans T
  in A : (red, s)
  out B : size (TWO.all()) + TWO.ord (blue, 3)
""",
        1,
        {'B': '1`17', 'A': '1`(green,2)++ 1`(blue,2)'},
    ),
    (
        "set field",
        r"""
place A : REC = 1`{a = "x", b = 2}
place B : REC
trans T
  in A : r
  out B : REC.set_b r (#b r + 1)
""",
        1,
        {'B': '1`{b=3,a="x"}'},
    ),
    (
        "of constructor",
        r"""
place A : NEST = 1`L {b = 2, a = "z"} ++ 1`R (1, 2)
place B : INT
trans T guard [NEST.of_R nest]
  in A : nest
  out B : 1
""",
        5,
        {'B': '1`1'},
    ),
    (
        "compare multi-sets",
        r"""
place A : LIST = 1`[1,2,1] ++ 1`[2,1] ++ 1`[3]
place B : INT
trans T guard [l == [1,1,2], l >> [1], l >>= [1,1]]
  in A : l
  out B : cf (1, l)
""",
        5,
        {'B': '1`2'},
    ),
    (
        "fold over a multi-set",
        r"""
place A : LIST = 1`[1,2,1]
place B : INT
trans T
  in A : l
  out B : foldl (fn (a, b) => a + b) 0 (filter (fn z => z > 0) (1`1 ++ 2`5 -- 1`1)) + size l
""",
        1,
        {'B': '1`13'},
    ),
    (
        "ext_col and ext_ms",
        r"""
place A : LIST = 1`[1,2]
place B : INT
trans T
  in A : l
  out B : ext_col (fn z => z + 1) l ++ ext_ms (fn z => z`z) l
""",
        1,
        {'B': '1`1++ 3`2++ 1`3'},
    ),
    (
        "random needs a token",
        r"""
place A : LIST = 1`[]
place B : INT
trans T
  in A : l
  out B : ms_to_col l
""",
        1,
        '!no_singleton',
    ),
    (
        "int overflow in initial marking",
        r"""
place A : INT = 1`(1073741823 + 1)
""",
        0,
        '!Overflow',
    ),
    (
        "guard with comma and no brackets",
        r"""
place A : INT = 1`1 ++ 1`2
place B : INT
trans T guard n > 1, n < 5
  in A : n
  out B : n
""",
        3,
        {'B': '1`2'},
    ),
    (
        "guard list value",
        r"""
place A : INT = 1`1 ++ 1`2
place B : INT
trans T guard [n > 1] ^^ [n < 5]
  in A : n
  out B : n
""",
        3,
        {'B': '1`2'},
    ),
    (
        "equation with constant",
        r"""
place A : INT = 1`1 ++ 1`2
place B : INT
trans T guard [1 = n]
  in A : n
  out B : n
""",
        3,
        {'B': '1`1'},
    ),
    (
        "binding through two equations",
        r"""
place A : INT = 1`5
place B : INT
trans T guard [m = k * 2, k = n + 1]
  in A : n
  out B : m
""",
        1,
        {'B': '1`12'},
    ),
    (
        "equation with list pattern",
        r"""
place A : LIST = 1`[5, 6]
place B : INT
trans T guard [[n, m] = l]
  in A : l
  out B : n - m
""",
        1,
        {'B': '1`(~1)'},
    ),
    (
        "variable of both arcs",
        r"""
place A : INT = 1`5 ++ 1`6
place B : INT = 1`6
trans T
  in A : n
  both B : n
""",
        2,
        {'A': '1`5'},
    ),
    (
        "index arithmetic",
        r"""
place A : IDX = 1`ph 1
place B : IDX
trans T
  in A : ph n
  out B : ph (n + 2)
""",
        1,
        {'B': '1`ph(3)'},
    ),
    (
        "index out of range",
        r"""
place A : IDX = 1`ph 1
place B : IDX
trans T
  in A : ph n
  out B : ph (n + 3)
""",
        1,
        '!illegal',
    ),
    (
        "case on arcs",
        r"""
place A : MSG = 1`Num 3 ++ 1`Quit ++ 1`Data (1,2)
place B : INT
trans T
  in A : g
  out B : case g of Num one => 1`one | Data (one, two) => 1`one ++ 1`two | Quit => empty
""",
        3,
        {'B': '1`1++ 1`2++ 1`3'},
    ),
    (
        "nested comments",
        r"""
place A : INT = 1`1 (* a (* b *) c *)
place B : INT
trans T
  in A : (* in *) n
  out B : n (* out *)
""",
        1,
        {'B': '1`1'},
    ),
    (
        "step and time",
        r"""
place A : INT = 2`1
place B : INT
trans T
  in A : n
  out B : IntInf.toInt (step ())
""",
        2,
        {'B': '1`1++ 1`2'},
    ),
    (
        "real equality",
        r"""
place A : REAL = 1`0.5 ++ 1`1.0
place B : REAL
trans T guard [q = 1.0 / 2.0]
  in A : q
  out B : q * 4.0
""",
        2,
        {'B': '1`2.0'},
    ),
    (
        "local functions in arcs",
        r"""
place A : INT = 1`4
place B : INT
trans T
  in A : n
  out B : let fun f 0 = 0 | f i = i + f (i - 1) in f n end
""",
        1,
        {'B': '1`10'},
    ),
    (
        "inhibitor with tokens of other colours",
        r"""
place A : INTT = 1`1@3
place B : INTT = 1`1@0 +++ 1`2@5
place D : INTT
trans T
  in B : t
  out D : t
  inhibit A :
trans U
  in A : t
""",
        9,
        {'D': '1`1@0+++ 1`2@5'},
    ),
)  # fmt: skip

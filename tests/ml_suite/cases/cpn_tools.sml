(* what no other ML has: multi-sets printed, colour sets, time, reals that are compared; results of CPN Tools behind the arrow *)
INT.mkstr_ms (1`3 ++ 1`1 ++ 2`2 ++ 1`1) ==>> "2`1++\n2`2++\n1`3"
INT.mkstr_ms (3 ** (1`1 ++ 2`5)) ==>> "3`1++\n6`5"
INT.mkstr_ms empty ==>> "empty"
INT.mkstr ~2 ==>> "(~2)"
STRING.mkstr "a\"b" ==>> "\"a\"b\""
BOOL.mkstr true ==>> "true"
UNIT.mkstr () ==>> "()"
REAL.mkstr 1.5 ==>> "1.5"
STRING.mkstr_ms (2`"b" ++ 1`"a") ==>> "1`\"a\"++\n2`\"b\""
BOOL.all () ==>> [false, true]
BOOL.size () ==>> 2
BOOL.ord true ==>> 1
BOOL.col 0 ==>> false
INT.lt (1, 2) ==>> true
INT.cmp (2, 1) ==>> GREATER
STRING.lt ("a", "b") ==>> true
INT.legal 5 ==>> true
(INT.size () handle CPN'Error _ => ~1) ==>> ~1
(BOOL.col 7 handle CPN'Error _ => true) ==>> true
1.0 = 1.0 ==>> true
0.1 + 0.2 = 0.3 ==>> false
[1.5] = [1.5] ==>> true
Real.toString 1E10 ==>> "10000000000.0"
Real.toString 123456789012.0 ==>> "123456789012.0"
Real.toString 1E12 ==>> "1E12"
Real.toString 1.5E20 ==>> "1.5E20"
Real.toString 0.00001 ==>> "1E~05"
Real.toString 0.00012345 ==>> "0.00012345"
Real.toString ~1.5E~10 ==>> "~1.5E~10"
Real.toString 0.1 ==>> "0.1"
Real.toString ~0.0 ==>> "~0.0"
Real.toString (real 3) ==>> "3.0"
time () ==>> 0
step () ==>> 0
IntInf.toInt (time ()) ==>> 0
ModelTime.toString (time ()) ==>> "0"
ModelTime.fromInt 3 ==>> 3
size (1`3 @+ 4) ==>> 1
ms (1`3 @+ 4 +++ 1`5 @+ 2) ==>> [3, 5]
1`"a" ++ 2`"b" == 2`"b" ++ 1`"a" ==>> true
mkstr_ms (Int.toString, op <) (2`1 ++ 1`3) ==>> "2`1++\n1`3"
legal_ms (fn x => x > 0) (1`1 ++ 1`2) ==>> true
predlist (fn x => x > 2) [1, 2, 3] ==>> true
mapfilter (ref (fn x => (x > 1, x * 10)), [1, 2, 3]) ==>> [20, 30]
exnMessage (Fail "x") ==>> "Fail: x"
exnMessage Empty ==>> "Empty"
exnMessage Div ==>> "divide by zero"
uniform (2.0, 2.0) ==>> 2.00000000000E0
binomial (3, 1.0) ==>> 3
discrete (4, 4) ==>> 4
bernoulli 1.0 ==>> 1
normal (1.0, 0.0) ==>> 1.00000000000E0
(poisson ~1.0; 0) ==>> raised Poisson
(exponential 0.0; 0) ==>> raised Exponential
(uniform (2.0, 1.0); 0) ==>> raised Uniform
(discrete (2, 1); 0) ==>> raised Discrete
random (3`7) ==>> 7
(random (empty : int list)) ==>> raised Empty
OS.Path.concat ("a/b", "c") ==>> "a/b/c"
OS.Path.file "a/b.txt" ==>> "b.txt"
OS.Path.dir "a/b.txt" ==>> "a"
OS.Path.base "a/b.txt" ==>> "a/b"
OS.Path.ext "a/b.txt" ==>> SOME "txt"
OS.Path.joinDirFile {dir = "a", file = "b"} ==>> "a/b"
OS.Path.splitDirFile "/x/y" ==>> {dir = "/x", file = "y"}
OS.Path.mkCanonical "a//b/../c/." ==>> "a/c"
OS.Path.getParent "a/b" ==>> "a"
OS.Path.isAbsolute "/a" ==>> true
OS.Path.concat ("a", "/b") ==>> raised Path
TextIO.inputLine (TextIO.openString "one\ntwo") ==>> SOME "one\n"
let val s = TextIO.openString "ab" in (TextIO.input1 s, TextIO.lookahead s, TextIO.endOfStream s, TextIO.inputAll s, TextIO.input1 s) end ==>> (SOME #"a", SOME #"b", false, "b", NONE)
(TextIO.openIn "nosuch"; 1) handle IO.Io {name, ...} => String.size name ==>> 6
let val f = TextIO.openOut "out.txt" in TextIO.output (f, "x"); TextIO.closeOut f; 1 end ==>> 1
INT.input (TextIO.openString " (~5) ") ==>> ~5
INT.input_ms (TextIO.openString "2`1 ++ 1`3 ") ==>> [1, 1, 3]
STRING.input (TextIO.openString "\"a b\"") ==>> "a b"
sort (fn ((a, _), (b, _)) => a < b) [(2, "a"), (1, "b"), (2, "c"), (1, "d"), (3, "e"), (1, "f")] ==>> [(1, "b"), (1, "d"), (1, "f"), (2, "a"), (2, "c"), (3, "e")]
sort (fn ((a, _), (b, _)) => a <= b) [(2, "a"), (1, "b"), (2, "c"), (1, "d"), (3, "e"), (1, "f")] ==>> [(1, "f"), (1, "d"), (1, "b"), (2, "c"), (2, "a"), (3, "e")]
sort (fn ((a, _), (b, _)) => a <= b) [(1, "a"), (1, "b"), (1, "c")] ==>> [(1, "a"), (1, "b"), (1, "c")]
unique_sort (fn ((a, _), (b, _)) => a < b) [(2, "a"), (1, "b"), (2, "c"), (1, "d")] ==>> [(1, "d"), (2, "c")]
unique_sort (op <) [3, 1, 2, 3, 1] ==>> [1, 2, 3]
sort (op <) [5, 4, 3, 2, 1, 6, 7, 0] ==>> [0, 1, 2, 3, 4, 5, 6, 7]
map (a_cmp (op <)) [(1, 2), (2, 2), (3, 2)] ==>> [LESS, EQUAL, GREATER]
makelist Int.toString [1, ~2] ==>> "[1,~2]"
makelist Int.toString [] ==>> "[]"
split (2, [1, 2, 3], []) ==>> ([3], [1, 2])
split (4, [1], []) ==>> raised Match
map basename ["/var/tmp/test", "a/b/", "x"] ==>> ["test", "b", "x"]
flatten [[1, 2], [], [3]] ==>> [1, 2, 3]
isSubstring "ell" "hello" ==>> true
Real.fmt (StringCvt.GEN (SOME 3)) 12345.0 ==>> "1.23E04"
Real.fmt (StringCvt.GEN (SOME 3)) 100.0 ==>> "100.0"
Real.fmt (StringCvt.GEN (SOME 2)) 0.00001 ==>> "1E~05"
Real.fmt (StringCvt.GEN (SOME 1)) 0.0 ==>> "0.0"
Real.fmt (StringCvt.GEN (SOME 20)) 0.5 ==>> "0.5"
Real.fmt (StringCvt.SCI (SOME 2)) ~0.0 ==>> "~0.00E0"
Real.fmt (StringCvt.FIX (SOME 1)) ~0.0 ==>> "~0.0"
Real.toString 0.0001 ==>> "0.0001"
Real.toString 999999999999.0 ==>> "999999999999.0"
Real.toString (Real.rem (~0.0, 2.0)) ==>> "0.0"
Real.toString (Real.rem (~4.0, 2.0)) ==>> "0.0"
Real.toString (Real.rem (~4.0, ~2.0)) ==>> "~0.0"
Real.toString (#whole (Real.split ~0.0)) ==>> "~0.0"
Real.toString (#frac (Real.split ~0.0)) ==>> "0.0"
Real.toString (#frac (Real.split ~2.5)) ==>> "~0.5"
Real.toString (#frac (Real.split 2.0)) ==>> "0.0"
Real.toString (Real.realMod ~2.0) ==>> "0.0"
Real.toString (Real.realMod ~0.0) ==>> "0.0"
Real.toString (Real.realTrunc ~0.5) ==>> "0.0"
Real.toString (Real.realTrunc ~0.0) ==>> "0.0"
Real.toString (Real.min (0.0, ~0.0)) ==>> "~0.0"
Real.toString (Real.min (~0.0, 0.0)) ==>> "0.0"
Real.toString (Real.max (0.0, ~0.0)) ==>> "~0.0"
Real.toString (Real.max (~0.0, 0.0)) ==>> "0.0"
Real.toString (Real.rem (~1.0, 3.0)) ==>> "~1.0"
REAL.mkstr ~0.0 ==>> "~0.0"
REAL.mkstr_ms (1`(~0.0) ++ 1`2.0) ==>> "1`~0.0++\n1`2.0"
Real.fmt (StringCvt.FIX (SOME 1)) ~0.0001 ==>> "~0.0"
Real.toString (~0.0 + 0.0) ==>> "0.0"
Real.toString (real 0 * ~1.0) ==>> "~0.0"
Real.toString (1.0 / ~0.0) ==>> "~inf"
Real.toString (valOf (Real.fromString "~0.0")) ==>> "~0.0"
Real.toString (Math.sqrt ~0.0) ==>> "~0.0"

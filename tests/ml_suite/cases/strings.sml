"abc" ^ "def"
"" ^ ""
String.size "hello"
String.sub ("hello", 1)
String.sub ("hello", 5) handle Subscript => #"!"
substring ("hello world", 6, 5)
substring ("hello", 3, 5) handle Subscript => "no"
substring ("hello", ~1, 2) handle Subscript => "no"
String.extract ("hello", 2, NONE)
String.extract ("hello", 1, SOME 3)
String.extract ("hello", 5, NONE)
String.extract ("hello", 6, NONE) handle Subscript => "no"
String.concat ["a", "b", "", "c"]
concat ["x", "y"]
String.concatWith ", " ["a", "b", "c"]
String.concatWith "-" []
explode "abc"
implode [#"a", #"b"]
String.explode ""
String.map Char.toUpper "Hello, World"
String.translate (fn #"a" => "AA" | c => str c) "banana"
String.tokens (fn c => c = #" ") "  the  quick brown "
String.fields (fn c => c = #",") "a,,b,"
String.tokens Char.isDigit "1a2bc33"
String.isPrefix "he" "hello"
String.isPrefix "hello!" "hello"
String.isSuffix "lo" "hello"
String.isSubstring "ell" "hello"
String.isSubstring "" "hello"
String.isSubstring "xyz" "hello"
String.compare ("abc", "abd")
String.compare ("abc", "ab")
String.compare ("", "")
"abc" < "abd"
"Z" < "a"
"abc" <= "abc" andalso not ("b" > "c")
"abc" = "ab" ^ "c"
String.toString "a\"b\\c\n\t\001\127\200"
String.fromString "a\\nb\\065\\\"c"
String.fromString "abc\\qdef"
String.fromString "\\q"
String.fromString ""
String.fromString "a\\   \\b"
String.toCString "a?'\"\n\001"
String.fromCString "\\x41\\102\\n"
String.collate (fn (a, b) => Char.compare (Char.toLower a, Char.toLower b)) ("ABC", "abd")
str #"x"
size [1, 2, 3]
"tab\there"
"new\nline"
"bell\a back\b vt\v ff\f cr\r"
"\065\066\067"
"\^A\^Z"
"quote\"backslash\\"
"gap\
  \ closed"
ord #"A"
chr 97
chr 256 handle Chr => #"?"
chr ~1 handle Chr => #"?"
fun rev_string s = implode (rev (explode s)) ==> rev_string "stressed"
fun is_palindrome s = let val cs = List.filter Char.isAlpha (explode (String.map Char.toLower s)) in cs = rev cs end ==> (is_palindrome "A man, a plan, a canal: Panama", is_palindrome "hello")
fun caesar k s = String.map (fn c => if Char.isLower c then chr ((ord c - 97 + k) mod 26 + 97) else c) s ==> caesar 3 "xyz abc"
fun count c s = length (List.filter (fn d => d = c) (explode s)) ==> count #"s" "mississippi"
fun join sep [] = "" | join sep [x] = x | join sep (x :: xs) = x ^ sep ^ join sep xs ==> join "+" ["1", "2", "3"]
fun pad n s = if String.size s >= n then s else pad n (" " ^ s) ==> pad 6 "42"
StringCvt.padLeft #"0" 5 "42"
StringCvt.padRight #"." 5 "42"
StringCvt.padLeft #" " 1 "abc"

#"a"
#"\n"
#"\""
Char.ord #"z"
Char.chr 122
Char.succ #"a"
Char.pred #"b"
Char.succ #"\255" handle Chr => #"!"
Char.pred #"\000" handle Chr => #"!"
List.filter Char.isAlpha [#"a", #"Z", #"1", #" "]
List.filter Char.isDigit [#"a", #"9", #"0"]
List.filter Char.isAlphaNum [#"a", #"_", #"5"]
List.filter Char.isSpace [#" ", #"\n", #"\t", #"x"]
List.filter Char.isUpper [#"A", #"a"]
List.filter Char.isLower [#"A", #"a"]
List.filter Char.isPunct [#"!", #"a", #".", #" "]
List.filter Char.isHexDigit [#"f", #"g", #"A", #"0"]
List.filter Char.isPrint [#"a", #"\n", #" "]
List.filter Char.isGraph [#"a", #"\n", #" "]
List.filter Char.isCntrl [#"a", #"\n", #"\127"]
Char.isAscii #"\200"
Char.toUpper #"q"
Char.toUpper #"1"
Char.toLower #"Q"
Char.toString #"\n"
Char.toString #"\200"
Char.toString #"\001"
Char.fromString "abc"
Char.fromString "\\n"
Char.fromString ""
Char.toCString #"\t"
Char.compare (#"a", #"b")
#"a" < #"b"
#"a" >= #"b"
Char.contains "hello" #"l"
Char.notContains "hello" #"l"
Char.minChar
Char.maxOrd
map Char.ord [Char.minChar, Char.maxChar]

"""The grammar of scripts, for lark (LALR). docs/tdl.md explains it; a test compares the key words.

White space and line ends only separate. Key words are reserved everywhere.
"""

from __future__ import annotations

from typing import Final

KEYWORDS: Final = (
    "program", "input", "output", "const", "var", "procedure", "begin", "end", "single",
    "move", "home", "axes", "via", "in", "at", "acceleration", "speed", "default",
    "wait", "until", "read", "into", "clear", "write", "signal",
    "compute", "tool", "takes", "releases", "creates", "removes",
    "couples", "uncouples", "for",
    "measure", "sense", "mark", "with", "each", "null", "stop", "call", "return", "goto", "exit", "when",
    "if", "then", "elsif", "else", "while", "loop",
    "and", "or", "not", "div", "mod", "true", "false",
)  # fmt: skip

GRAMMAR: Final = (
    r"""
start: "program" NAME declaration* procedure* "begin" block "end" "program"

?declaration: file | const | var
file: (INPUT | OUTPUT) NAME STRING ":" _held ("," _held)*
_held: type | rows
rows: NAME "(" type ("," type)* ")"
const: "const" NAME "=" expression
var: "var" NAME ("," NAME)* ":" type (":=" expression)?
type: (NAME | SPEED | SIGNAL) SINGLE?

procedure: "procedure" NAME block "end" "procedure"

block: statement*
?statement: move | speed | wait_time | wait_until | read | clear | write | assign | compute | tool
          | measure | sense | mark | stop | call | return | label | goto | exit | if | while | loop

move: "move" MOTION target via? ("in" frame)? along? pace? ramp?
    | "move" MOTION along pace? ramp?
along: "with" external ("," external)*
external: MOTION NAME ("=" expression)? | MOTION "=" expression -> zone
?target: HOME | axes | expression
axes: "axes" "(" expression ("," expression)* ")"
via: "via" expression ("," expression)*
pace: "at" expression
ramp: "acceleration" expression
frame: NAME | TOOL | STRING
speed: SPEED MOTION (DEFAULT | expression)
wait_time: "wait" expression
wait_until: "wait" "until" expression
read: "read" NAME "into" NAME ("," NAME)*
clear: "clear" NAME
write: "write" NAME (SIGNAL | expression ("," expression)*)
assign: NAME ":=" expression
compute: "compute" expression ("," expression)*
tool: TOOL (NAME | STRING) handling? "for" expression
handling: EFFECT (NAME | STRING) ("at" (NAME | STRING))?
measure: "measure" expression "into" NAME
sense: "sense" (NAME | STRING) "into" NAME
mark: "mark" (NAME ("." NAME)* | STRING) ("with" binding ("," binding)*)?
binding: (NAME | STRING) "=" datum
?datum: expression | record | tuple | null | each
each: "each" (record | tuple)
record: "{" binding ("," binding)* "}"
tuple: "[" datum ("," datum)* "]"
null: "null"
stop: "stop" expression ("," expression)*
call: "call" NAME
return: "return"
label: NAME ":"
goto: "goto" NAME
exit: "exit" ("when" expression)?
if: "if" expression "then" block elsif* else? "end" "if"
elsif: "elsif" expression "then" block
else: "else" block
while: "while" expression "loop" block "end" "loop"
loop: "loop" block "end" "loop"

?expression: disjunction
           | "if" expression "then" expression "else" expression -> conditional
?disjunction: conjunction | disjunction OR conjunction -> binary
?conjunction: negation | conjunction AND negation -> binary
?negation: comparison | NOT negation -> unary
?comparison: sum | sum (EQUAL | NOT_EQUAL | LESS | LESS_EQUAL | GREATER | GREATER_EQUAL) sum -> binary
?sum: term | sum (PLUS | MINUS | AMPERSAND) term -> binary
?term: factor | term (TIMES | DIVIDE | DIV | MOD) factor -> binary
?factor: postfix | MINUS factor -> unary
?postfix: atom | postfix "." NAME -> field
?atom: QUANTITY -> quantity
     | REAL -> real
     | INT -> integer
     | STRING -> string
     | TRUE -> true
     | FALSE -> false
     | NAME -> name
     | (NAME | SINGLE) "(" (expression ("," expression)*)? ")" -> function
     | "(" expression ")" -> parenthesised

OR: "or"
AND: "and"
NOT: "not"
DIV: "div"
MOD: "mod"
TRUE: "true"
FALSE: "false"
HOME: "home"
TOOL: "tool"
EFFECT: "takes" | "releases" | "creates" | "removes" | "couples" | "uncouples"
SPEED: "speed"
SIGNAL: "signal"
SINGLE: "single"
DEFAULT: "default"
INPUT: "input"
OUTPUT: "output"
EQUAL: "="
NOT_EQUAL: "<>"
LESS_EQUAL: "<="
LESS: "<"
GREATER_EQUAL: ">="
GREATER: ">"
PLUS: "+"
MINUS: "-"
AMPERSAND: "&"
TIMES: "*"
DIVIDE: "/"

MOTION: /\$[A-Za-z_]*/
QUANTITY.3: /[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?(?![eE][+-]?[0-9])[ \t]*(mm\/s(?!WORD)|m\/s(?!WORD)|%|NAME_PATTERN)/
REAL.2: /[0-9]+(\.[0-9]+([eE][+-]?[0-9]+)?|[eE][+-]?[0-9]+)/
INT.1: /[0-9]+/
STRING: /"([^"\\\n]|\\["\\ntr])*"/
NAME: /NAME_PATTERN/

COMMENT: /--[^\n]*/
WHITE: /[ \t\r\n]+/
%ignore COMMENT
%ignore WHITE
""".replace("NAME_PATTERN", "(?!(?:KEYWORD)(?!WORD))[A-Za-z_]WORD*")
    .replace("KEYWORD", "|".join(KEYWORDS))
    .replace("WORD", "[A-Za-z0-9_]")
)

"""The grammar of properties, for lark (LALR). docs/properties.md explains it by examples.

CPN ML in braces is blanked out before the parser sees it (`chunks`): only CPN ML knows where it ends.
"""

from __future__ import annotations

from typing import Final

KEYWORDS: Final = (
    "deadlock", "free", "except", "bound", "always", "never", "reachable", "mutex", "every", "is", "followed", "by",
    "within", "firings", "time", "seconds", "ctl", "ltl", "assuming", "strong", "weak", "all", "true", "false", "dead",
    "initial", "enabled", "fires", "tokens", "and", "or", "not",
    "A", "E", "AX", "EX", "AF", "EF", "AG", "EG", "X", "F", "G", "U", "R", "W",
)  # fmt: skip

BLANK: Final = "\x00"
"""What stands for the characters of CPN ML."""

GRAMMAR: Final = r"""
?start: deadlock | bound | always | never | reachable | mutex | response | ctl | ltl

deadlock: "deadlock" "free" ("except" formula)?
bound: "bound" name "<=" INT -> upper
     | "bound" INT "<=" name -> lower
     | "bound" INT "<=" name "<=" INT -> both
always: "always" formula
never: "never" formula
reachable: "reachable" formula
mutex: "mutex" item ("," item)+
?item: name | formula
response: "every" formula "is" "followed" "by" formula (within | assuming)?
within: "within" INT "firings" -> within_firings
      | "within" (INT | REAL) ("time" | "seconds") -> within_time
ctl: "ctl" formula
ltl: "ltl" formula assuming?
assuming: "assuming" fair ("," fair)*
fair: (STRONG | WEAK)? (name | ALL)

?formula: implication | implication "<->" formula -> iff
?implication: disjunction | disjunction "->" implication -> implies
?disjunction: conjunction | conjunction (("||" | "or") conjunction)+ -> disjunction
?conjunction: binary | binary (("&&" | "and") binary)+ -> conjunction
?binary: unary | unary (U | R | W) binary -> until
?unary: atom
      | ("!" | "not") unary -> negation
      | (X | F | G | AX | EX | AF | EF | AG | EG) unary -> temporal
      | (AX | EX) "<" name ">" unary -> step
?atom: "(" formula ")"
     | (A | E) "[" formula "]" -> quantified
     | (TRUE | FALSE | DEAD | INITIAL) -> word
     | "enabled" "(" name ")" -> enabled
     | "fires" "(" name ("," ML)? ")" -> fires
     | operand COMPARISON operand -> comparison
     | operand "<=" operand -> at_most
     | operand "<" operand -> less
     | operand ">" operand -> more
     | ML -> ml
operand: INT | "tokens" "(" name ("," name)* ")"
name: NAME INT? | STRING

STRONG: "strong"
WEAK: "weak"
ALL: "all"
TRUE: "true"
FALSE: "false"
DEAD: "dead"
INITIAL: "initial"
A: "A"
E: "E"
AX: "AX"
EX: "EX"
AF: "AF"
EF: "EF"
AG: "AG"
EG: "EG"
X: "X"
F: "F"
G: "G"
U: "U"
R: "R"
W: "W"
COMPARISON: "==" | "=" | "<>" | ">="
ML: /\{\x00*\}/
STRING: /"[^"\n]*"/
NAME: /[A-Za-z_][A-Za-z0-9_']*/
REAL: /[0-9]+\.[0-9]+/
INT: /[0-9]+/
WHITE: /[ \t\r\n]+/
%ignore WHITE
"""

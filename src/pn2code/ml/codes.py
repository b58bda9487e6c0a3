"""Diagnostic codes of the CPN ML front end."""

from pn2code.diagnostics.codes import register

SYNTAX_ERROR = register(
    "syntax-error",
    "a text is not CPN ML",
    "The text cannot be parsed; the message says what was found and what could stand there, e.g. "
    "`1`x ++` ends where an expression is expected.",
)
LEXICAL_ERROR = register(
    "lexical-error",
    "a character or literal is not CPN ML",
    "A character that CPN ML does not know, a string or comment that is not closed, a wrong escape. "
    "Negative numbers are written with a tilde: `~5`.",
)
TOO_DEEP = register(
    "too-deep",
    "a text is nested too deeply",
    "Parentheses, lists or operators are nested beyond what pn2code follows (some hundred levels). "
    "Give parts of the expression a name with `val` or `let`.",
)
FIXITY_ERROR = register(
    "fixity-error",
    "operators are combined in a way that has no meaning",
    "An infix operator lacks an operand: `1 +`. Use `op` to name the operator itself.",
)
MIXED_OPERATORS = register(
    "mixed-operators",
    "two operators have the same precedence but different associativity",
    "`x :: y ^^ z`: both have precedence 5, `::` associates to the right and `^^` to the left. CPN Tools takes the "
    "left one first, as `(x :: y) ^^ z`. Write parentheses.",
)
TYPE_MISMATCH = register(
    "type-mismatch",
    "an expression has a different type from the one that is needed",
    "The message says what was expected and what was found; the caret shows where. For an inscription: the place "
    "holds a colour set, and the expression gives neither one token of it nor a multi-set of it.",
)
NOT_TIMED = register(
    "colour-set-not-timed",
    "tokens of a colour set that is not timed are given time stamps",
    "`@+ delay` gives tokens a time stamp, which only tokens of timed colour sets carry: "
    "`colset JOB = string timed;`. A transition's own delay (`@+5` beside it) is added to all its timed output "
    "tokens and does nothing to the others.",
)
LITERAL_TOO_LARGE = register(
    "literal-too-large",
    "a number is too large for its type",
    "`int` of CPN Tools has 31 bits: from ~1073741824 to 1073741823. Larger numbers need the type `IntInf.int` "
    "(colour set `intinf`), or the option `--int-bits 64` of pn2code.",
)
CIRCULAR_TYPE = register(
    "circular-type",
    "a type would contain itself",
    "An expression such as `fn x => x x` needs a type that is a part of itself.",
)
NOT_A_FUNCTION = register(
    "not-a-function",
    "something that is not a function is applied",
    "In CPN ML `f x` applies `f` to `x`. Two values side by side, such as `1 x`, often indicate a missing backquote "
    "or operator: `1`x`, `1 * x`.",
)
NOT_EQUALITY = register(
    "not-an-equality-type",
    "values of this type cannot be compared with `=`",
    "Functions and some abstract types have no equality. Compare a result of the function instead.",
)
OVERLOAD = register(
    "no-such-operator",
    "an operator is not defined for the type of its operands",
    "`+`, `-`, `*` and the comparisons work on numbers of the same type (comparisons also on strings); `div` and "
    "`mod` work on integers, `/` on reals. Convert with `real`, `floor`, `round`.",
)
UNBOUND = register(
    "unbound-identifier",
    "a name is not declared",
    "The name is not built in, and is not a variable, value or function declared before this point. Declarations are "
    "read from top to bottom.",
)
UNKNOWN_COLOUR_SET = register(
    "unknown-colour-set",
    "a colour set or type is not declared",
    "Colour sets must be declared before they are used in other colour sets, variables and places.",
)
UNKNOWN_CONSTRUCTOR = register(
    "unknown-constructor",
    "a name applied in a pattern is not a constructor",
    "In a pattern only constructors (of unions, datatypes, lists, options) may be applied.",
)
CONSTRUCTOR_ARITY = register(
    "constructor-argument",
    "a constructor has an argument too many or too few",
    "A constructor of a union or datatype takes exactly one value, or none.",
)
UNKNOWN_FIELD = register(
    "unknown-field",
    "a record has no such field",
    "`#label` and record patterns must name a field of the record's type.",
)
UNRESOLVED_RECORD = register(
    "unresolved-record",
    "the record type of a selector or open pattern is not known",
    "`#label` and `{.., ...}` can only be used where the whole record type is known. Give the argument a type: `(r : "
    "PART)`.",
)
DUPLICATE_NAME = register(
    "duplicate-name",
    "a name is bound twice in one pattern, record or declaration",
    "Each variable of a pattern, each label of a record, each constructor of a type has its own name.",
)
CLAUSES = register(
    "function-clauses",
    "the clauses of a function do not fit together",
    "All clauses of a `fun` declaration define the same name with the same number of arguments.",
)
VAL_REC = register(
    "val-rec",
    "`val rec` binds something that is not a function",
    "`val rec f = fn ..` may only bind functions.",
)
EXCEPTION_TYPE = register(
    "not-an-exception",
    "`raise` is given something that is not an exception",
    "`raise` needs a value of type `exn`.",
)
COLSET_RANGE = register(
    "colour-set-range",
    "the bounds of a colour set are wrong",
    "Bounds are constants of the base type, and the lower one is not above the upper one.",
)
INTINF_BOUND = register(
    "intinf-bound",
    "a bound of an `intinf` colour set is a plain number",
    "CPN Tools takes a plain number for an `int` and then refuses the colour set `intinf with 1..3`. It accepts the "
    "bounds with their type: `intinf with (1 : IntInf.int)..(3 : IntInf.int)`. pn2code accepts both.",
)
COLSET_DEFINITION = register(
    "colour-set-definition",
    "a colour set is not defined completely",
    "A definition lacks a part that its kind needs, or has one too many: an enumeration needs values, and a product "
    "needs components.",
)
NULL = register(
    "null-is-time",
    "`null` is no function of lists in CPN Tools",
    "The engine of CPN Tools opens its structure of model time at top level, in which `null` is the time 0. It refuses "
    "`null l` for a list: `operator is not a function`. Write `List.null l` or `l = []`. pn2code accepts both.",
)
SUBSET_LIST = register(
    "subset-list-computed",
    "the list of a subset is not written element by element",
    "CPN Tools reads the values of `subset INT with [1, 2]` one by one, and takes a text without brackets (`values`, "
    "`a ^^ b`) for a single element, which then has the wrong type. pn2code accepts such a list.",
)
SUBSET_BARE_FN = register(
    "subset-bare-fn",
    "the predicate of a subset is a `fn` without parentheses",
    "CPN Tools puts a type constraint after the predicate (`PREDICATE : INT -> bool`). After a bare `fn n => n > 0` "
    "it belongs to the body `n > 0`, which is not a function, so the colour set is rejected. Write `colset C = subset "
    "INT by (fn n => n > 0);`, or give the function a name with `fun`.",
)
VARIABLE_CLASH = register(
    "variable-of-other-colour-set",
    "a net variable is declared twice with different colour sets",
    "As in CPN Tools the first declaration counts everywhere, so that inscriptions written for a later one change "
    "their meaning.",
)
VALUE_CLASH = register(
    "variable-named-as-value",
    "a net variable has the name of a value or function",
    "If a net variable and a `val`, `fun` or constructor have the same name, CPN Tools uses the one that was declared "
    "first in arcs, guards and code segments, and the value in initial markings and declarations. A variable whose "
    "name becomes that of a constructor can no longer be used. Rename one of them.",
)
GUARD_TYPE = register(
    "guard-not-boolean",
    "a guard is not a boolean expression",
    "A guard is a boolean expression or a list of them: `[n > 0, m = 2]`.",
)
GUARD_LIST = register(
    "guard-computed-list",
    "CPN Tools does not test a guard that computes a list of conditions",
    "CPN Tools takes a guard apart where it is written as a list of conditions, `[a, b]`. A guard that computes such a "
    "list, `List.map f l` or `if c then [a] else []`, is accepted and then ignored: the transition occurs whatever "
    "the conditions are. pn2code tests them.",
)
GUARD_OPERATOR = register(
    "guard-list-operator",
    "CPN Tools cannot check a page with a guard that is a list made by an operator",
    "A guard such as `[a] ^^ [b]`, `[a] ++ [b]` or `2 ** [a]` ends CPN Tools' check of the page with `InternalError: "
    "fun parse_guarditems`. pn2code tests all conditions of the list.",
)
CODE_SEGMENT = register(
    "code-segment",
    "a code segment is not of the form `input (..); output (..); action ..;`",
    "`input` and `output` are optional and list net variables; `action` gives a value for each output variable, "
    "as a tuple in that order, or unit if there is none. Without `action` CPN Tools refuses the segment; it "
    "reads comments only behind the word `action`, and not after the last `;`.",
)
PRIORITY = register(
    "priority-not-constant",
    "a priority is not a constant integer",
    "A priority is an integer or a `val` that is one, such as `P_HIGH`.",
)
PRIORITY_BELOW_ZERO = register(
    "priority-below-zero",
    "a priority is below zero",
    "Smaller numbers go first, even below zero. CPN Tools accepts the inscription, but its simulator ends with "
    "`subscript out of bounds` when it starts. Add the same number to all priorities.",
)
DELAY = register(
    "delay-form",
    "a time inscription does not have the form `@+ delay`",
    "A transition's delay is written `@+ e` with an integer e, or `@++ t` with a time t.",
)
DELAY_PARENTHESES = register(
    "delay-parentheses",
    "a delay of a transition must be in parentheses",
    "CPN Tools reads the time inscription of a transition behind a token: 1`1 @+ t + 1 is (1`1 @+ t) + 1, no sum of "
    "numbers, and it refuses the page (`Error in time region`). The delay is a name, a literal, a call, an operation "
    "that binds more tightly than `@+`, or in parentheses: `@+(t + 1)`. So it is with the delays of arcs.",
)
UNKNOWN_VALUE = register(
    "unknown-value",
    "a value to be replaced is not declared by the net",
    "`[values]` of cell.toml and `--set` replace `val NAME = ...` declarations of the net.",
)
UNSUPPORTED_ML = register(
    "unsupported-ml",
    "a construct of CPN ML is not supported",
    "pn2code does not translate this construct; the message names it.",
)
UNSUPPORTED_BUILTIN = register(
    "unsupported-function",
    "a function of the standard library is not supported",
    "As an error: the name belongs to a structure of the SML library that pn2code supports only in part. As a "
    "warning: the function exists in CPN Tools, but needs something that is not available in a simulation or "
    "supervisor made by pn2code (sockets, other programs, the computer's clock). The rest of the net is checked as "
    "usual; a run stops where the function is applied, and `generate` refuses the net. To replace it, declare a "
    "function of the same name.",
)
INSTANCE_AT_OPENING = register(
    "declaration-instance",
    "a declaration asks for the number of the page instance",
    "Constants, references and the bounds of colour sets are computed when the net is opened. No page instance is "
    "looked at then, and `inst ()` is 1, in CPN Tools and here. There it is another number when the declaration is "
    "checked again after a change: that of the instance that was looked at last.",
)
UNSUPPORTED_COLSET = register(
    "unsupported-colour-set",
    "a kind of colour set is not supported",
    "The message names the kind, or the way it is written.",
)
MATCH_NOT_EXHAUSTIVE = register(
    "match-not-exhaustive",
    "a function, `case` or `val` does not cover all values",
    "If the case that the message names occurs, the exception `Match` (in a `val`: `Bind`) is raised, and a "
    "simulation stops. Often this is intended; otherwise add a rule, e.g. `| f _ = ..`.",
)
MATCH_REDUNDANT = register(
    "redundant-rule",
    "a rule is never reached",
    "The rules before it cover all its cases. Often a constructor is misspelt, so that it is read as a variable, "
    "which matches everything; or the rules are in the wrong order.",
)
TYPE_TOO_LARGE = register(
    "ml-type-too-large",
    "a type is too large",
    "The type of an expression has more than a hundred thousand parts, which happens where functions that double "
    "their argument are composed many times. Give the argument a type, or split the declaration. A colour set has "
    "such a type when it is a product of products of products.",
)
SIGNATURE = register(
    "signature-mismatch",
    "a structure does not fit its signature",
    "`structure S : SIG = ..` needs in S everything that SIG lists, at the types that it gives.",
)
USED_FILE = register(
    "used-file",
    "a file of declarations cannot be used",
    '`use "file.sml"` reads CPN ML declarations from a file in the net\'s folder. If the file is missing, CPN Tools '
    "refuses the declaration and everything that needs the names declared in the file.",
)
TYPE_VARIABLE = register(
    "type-variable",
    "a type variable stands for one particular type only",
    "In `fun f (x : 'a) = x + 1` the variable `'a` would have to be int, but it promises that the function works for "
    "any type. Leave it out, or write the intended type.",
)
TEXT_TOO_LONG = register(
    "text-too-long",
    "a text is too long",
    "One declaration or inscription has more than 300,000 symbols. Split it, or read the data at run time.",
)

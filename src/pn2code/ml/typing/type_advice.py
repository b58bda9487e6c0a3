"""What to do about a wrong type: hints of the type checker's messages (see also `advice`)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from pn2code.diagnostics import Span
from pn2code.diagnostics.suggestions import nearest
from pn2code.ml.library.datatypes import LITERAL_TYPES, WORD_TYPES
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.inference import ICon, IFun, IRec, Meta, Ty, prune

_OPERAND = re.compile(r"(?:left |right )?operand of (?:`(.+)`|the backquote)")
_CALL = re.compile(r"[A-Za-z][\w'.]* [A-Za-z0-9][\w'.]*")
MULTISET_OPERATORS = frozenset(
    {"++", "--", "+++", "@+", "@++", "==", "!=", "**", "<<", ">>", "<<=", ">>="}
)
"""Infix operators of multi-sets: messages speak of multi-sets, not lists, there."""
NUMERIC = frozenset({"+", "-", "*", "/", "div", "mod"})
_NUMBERS = frozenset({"int", "real", "IntInf.int"})
_RARE = frozenset(t.name for t in (*WORD_TYPES, *LITERAL_TYPES)) - _NUMBERS


def operand(what: str) -> str:
    """The operator in "left operand of `+`", or ""."""
    match = _OPERAND.fullmatch(what)
    if match is None:
        return ""
    return match.group(1) or "`"


def is_list(t: Ty) -> bool:
    """Whether a type is `.. list`, which multi-sets are too."""
    t = prune(t)
    return isinstance(t, ICon) and t.name == "list"


def base(t: Ty) -> str:
    """Name of a type's outermost constructor."""
    t = prune(t)
    if isinstance(t, Meta) and t.among:
        return t.among[0]
    return t.name if isinstance(t, ICon) else ""


def wrong_operand(what: str, found: Ty, text: str, wanted: Ty | None = None) -> str:
    """For an operand (or argument) of the wrong type; `text` is what stands there, `wanted` the one type that fits."""
    name, kind = operand(what), base(found)
    if kind == "ref" and name not in ("", ":=", "=", "<>"):
        return f"this is a reference: its value is `!{text}`" if text.isidentifier() else ""
    match name:
        case "+" | "-" | "*" if (
            kind == "string" and what.startswith("left") and _CALL.fullmatch(text)
        ):
            function, argument = text.split()
            return f"functions are applied before operators: `{function} ({argument} {name} ..)`"
        case "+" | "-" | "*" if kind == "string":
            return "strings are joined with `^`" if name == "+" else ""
        case _ if name in NUMERIC and _is_sequence(found):
            return "expressions one after the other are separated by `;`: (print s; n + 1)"
        case "+" | "-" | "*" if kind == "list":
            return "multi-sets are added with `++` and subtracted with `--`; lists are joined with `^^`"
        case "++" if kind == "list" and "@" in text:
            return "`@+` binds more tightly than `++`: write (1`v ++ 1`w)@+d, or add timed multi-sets with `+++`"
        case "<" | ">" | "<=" | ">=" if kind == "bool":
            if text.startswith("not "):
                return f"functions are applied before operators: `not ({text[4:]} {name} ..)`"
            return f"write each comparison separately: `{text} andalso ..`"
        case "<" | ">" | "<=" | ">=" if (
            found_is_named(found) and wanted is not None and what.startswith("right")
        ):
            left = base(wanted)
            return (
                f"both sides are of one type, and the left one is `{left}`; two colours of `{kind}` are compared with "
                f"`=`, or `{kind}.lt (a, b)`"
                if left and kind
                else "both sides are of one type"
            )
        case "=" | "<>" if (
            wanted is not None and what.startswith("right") and base(wanted) and kind
            and (found_is_named(found) or found_is_named(wanted))
        ):  # fmt: skip
            return f"both sides of `{name}` are of one type, and the left one is `{base(wanted)}`"
        case "<" | ">" | "<=" | ">=" if found_is_named(found):
            return f"the order of the colours of a colour set is `{kind or 'C'}.lt (a, b)`"
        case "==" if kind != "list":
            return "`==` compares multi-sets; values are compared with `=`"
        case "!=" if kind != "list":
            return "`!=` compares multi-sets; values are compared with `<>`"
        case "%" if kind == "int":
            return "the remainder of a division is `n mod m`"
        case "//":
            return "comments are written (* .. *)"
        case "**":
            return "`**` multiplies a multi-set by a number; numbers are multiplied with `*`"
        case "/" if kind == "int":
            return "integers are divided with `div`; convert with `real` for a real result"
        case "++" | "--" | "+++" | "@+" | "@++" | "^^" if kind == "string":
            return "strings are joined with `^`"
        case "@+" | "@++" if kind != "list":
            return (
                f"`{name}` binds as tightly as `*`, so a longer delay needs parentheses: `v {name} (a * b)`; "
                "or else one token `v` as a multi-set is written 1`v"
            )
        case "++" | "--" | "+++" if kind != "list":
            return "one token `v` as a multi-set is written 1`v"
        case "@" if kind == "list":
            return "`@` adds a time stamp to a token; lists are joined with `^^`"
        case "::" | "^^" | "^" if name != "^" or kind == "list":
            return (
                "`x :: l` puts one element before a list; two lists are joined with `^^`, "
                "one element is added at the end with `l ^^ [x]`"
            )
        case ":=" if what.startswith("left"):
            return (
                "`:=` gives a reference (`globref`) a new value; variables of the net keep theirs"
            )
        case "`" if what.startswith("left") and kind not in ("int", "list", ""):
            return "a multi-set is written `number of tokens`, backquote, token: 2`v"
    if isinstance(prune(found), IFun):
        return ""
    if what == "condition of `if`" or what.endswith(
        ("operand of `andalso`", "operand of `orelse`")
    ):
        return 'a condition is needed here, such as `n > 0` or `s = "a"`' if kind != "bool" else ""
    if what == "argument of `mem`" and kind != "list":
        return "the list comes first: `mem list value`"
    if re.fullmatch(r"argument of `#.*`", what) and not isinstance(prune(found), IRec | Meta):
        return "`#1` takes the first component of a tuple, `#name` a field of a record"
    if what.endswith("argument of `!`"):
        if kind == "bool":
            return "`!` gives the value of a reference; the negation of a condition is `not`"
        return "`!` gives the value of a reference (`globref`); a variable is its own value"
    if what.endswith("argument of `size`") and kind == "string":
        return "`size` counts the tokens of a multi-set; the length of a string is `String.size`"
    return ""


def terms(division: s.InfixExp) -> Iterator[Span]:
    """Where the numbers stand that are added and multiplied before they are divided."""
    left = [division.left, division.right]
    while left:
        e = left.pop()
        if isinstance(e, s.InfixExp) and e.operator.name in ("+", "-", "*"):
            left += (e.left, e.right)
        else:
            yield e.span


def _is_sequence(found: Ty) -> bool:
    """Whether a type is that of a tuple whose first part gives nothing."""
    t = prune(found)
    if not isinstance(t, IRec) or len(t.fields) < 2:
        return False
    first = prune(t.fields[0][1])
    return isinstance(first, IRec) and not first.fields


def found_is_named(found: Ty) -> bool:
    """Whether a type is one that a colour set declares, or made of others."""
    t = prune(found)
    return isinstance(t, IRec) or (
        isinstance(t, ICon) and t.name[:1].isupper() and "." not in t.name
    )


def _wrong_action(found: Ty, expected: Ty) -> str:
    """For the action of a code segment that does not give values for its outputs."""
    if isinstance(expected, IRec) and not expected.fields:
        return "there is no `output`, so the action must end with `()`: `action (..; ())`"
    if isinstance(found, IRec) and not found.fields:
        return "the action must end with a value for each output variable: `action (..; value)`"
    if isinstance(expected, IRec):
        return f"the action gives a tuple with a value for each of the {len(expected.fields)} output variables"
    return ""


def wrong_value(found: Ty, expected: Ty, span_text: str, what: str = "") -> str:
    """For a value of a type from which one gets to the expected one by some step."""
    f, e = prune(found), prune(expected)
    kind, wanted = base(f), base(e)
    name = span_text.strip()
    word = f"`{name}`" if re.fullmatch(r"[A-Za-z][\w'.]*", name) else "it"
    if kind == "ref":
        return f"{word} is a reference: its value is `!{name}`" if word != "it" else ""
    if isinstance(f, IFun) and not isinstance(e, IFun):
        argument = prune(f.argument)
        inside = "" if isinstance(argument, IRec) and not argument.fields else ".."
        if word != "it":
            return f"{word} is a function: apply it to its argument, `{name} ({inside})`"
        return "this is a function; apply it to its argument"
    if what == "action":
        return _wrong_action(f, e)
    if isinstance(e, IFun):
        if what.startswith("predicate"):
            return "the predicate takes one value of the colour set and gives a bool"
        if what.startswith("argument of") and not isinstance(f, IFun):
            return "the function is the first argument: `map f list`, `foldl f start list`"
        return ""
    if wanted == "ref" and operand(what) == "=" and span_text != "":
        return "`=` compares; a reference gets a new value with `:=`"
    if isinstance(e, IRec) and isinstance(f, IRec):
        return _wrong_record(f, e)
    if isinstance(e, IRec) and e.fields and what.startswith("argument of"):
        return f"one argument with {len(e.fields)} components is needed: (.., ..)"
    if isinstance(f, IRec) and f.fields and what.startswith("argument of") and _is_tuple(f):
        return "this function takes one argument, not a tuple"
    if kind == "list" and what.startswith("argument of") and name.startswith("["):
        return "brackets make a list; an argument is written in parentheses: `f (x)`"
    if what == "`else` branch" and wanted != "list" and name == "empty":
        return "`empty` is a multi-set, so the other branch must be one, too: one token is 1`x"
    if what == "`else` branch" and wanted == "list" and isinstance(e, ICon) and _is_open(e):
        return (
            "the other branch is a multi-set or a list, so this one must be one, too: 1`x, or `[x]`"
        )
    if what in ("`else` branch", "`then` branch") and wanted != "list":
        return "both branches need the same type; where no token is meant, write `empty`"
    if what.startswith("result of rule"):
        return "all rules need results of the same type"
    if kind == "list" and wanted != "list" and "`" in name:
        return "this is a multi-set; where one value is needed, leave the coefficient out"
    if wanted == "list" and kind and isinstance(e, ICon) and base(e.args[0]) == kind:
        return "a multi-set of one token is 1`x, of none `empty`; a list of one element is `[x]`"
    return _general(what, wanted)


def _is_open(e: ICon) -> bool:
    """Whether nothing is known of the items of a list, as of those of `empty`."""
    return isinstance(prune(e.args[0]), Meta)


def _general(what: str, wanted: str) -> str:
    """Where nothing better is known than what stands there."""
    if what == "right operand of the backquote":
        return "the tokens must be colours of the place's colour set"
    if what.startswith(("component", "field")):
        return "the components must have the types of the declaration, in its order"
    if what.startswith("argument of `not`"):
        return "functions are applied before operators: `not (n > 1)`"
    if what.startswith("predicate"):
        return "the predicate takes one value and gives a bool"
    if wanted == "bool":
        return "a condition is needed here, such as `n > 0`"
    return "write a value of the expected type here, or convert this one"


def not_a_function(name: str, arguments: list[str], components: int, *, constructor: bool) -> str:
    """For something applied that is no function.

    Args:
        name: what is applied, with `arguments` before the one too many, as written.
        components: number of components of the tuple that it takes as its argument; 0: it takes none.
    """
    if len(arguments) > 1 and arguments[0] in ("~", "-"):
        return f"a negative argument needs parentheses: `{name} (~{arguments[1]})`"
    if components > 1 and len(arguments) == components:
        return f"`{name}` takes its arguments as a tuple: `{name} ({', '.join(arguments)})`"
    if constructor:
        return f"the constructor `{name}` has no argument"
    if arguments and len(arguments) > 1:
        return f"`{name}` takes one argument; is an operator or a comma missing?"
    return ""


def _is_tuple(t: IRec) -> bool:
    return all(n.isdigit() for n, _ in t.fields)


def _wrong_record(found: IRec, expected: IRec) -> str:
    here, wanted = [n for n, _ in found.fields], [n for n, _ in expected.fields]
    tuple_here, tuple_wanted = (all(n.isdigit() for n in x) for x in (here, wanted))
    if tuple_here and not tuple_wanted:
        fields = ", ".join(f"{n} = .." for n in wanted)
        return f"a record is written with the names of its fields: {{{fields}}}"
    if tuple_wanted and not tuple_here:
        return "a product is written without names: (.., ..)"
    if not tuple_here:
        extra = [n for n in here if n not in wanted]
        missing = [n for n in wanted if n not in here]
        for n in extra:
            close = nearest(n, missing, cutoff=0.5)
            if close:
                return f"did you mean the field `{close}` instead of `{n}`?"
        return f"a record has all its fields and no others: {{{', '.join(f'{n} = ..' for n in wanted)}}}"
    return f"a tuple with {len(wanted)} components is needed: ({', '.join('..' for _ in wanted)})"


def among(names: tuple[str, ...]) -> str:
    """The types that an overloaded operator is defined for, in words, without those that are hardly meant."""
    names = tuple(n for n in names if n not in _RARE) or names
    if set(names) == _NUMBERS:
        return "a number"
    if set(names) > _NUMBERS:
        return "a number or a string"
    return " or ".join(f"`{n}`" for n in names)


def label_notes(found: Ty, expected: Ty) -> list[str]:
    """Components or fields that are missing or too many."""
    f, e = prune(found), prune(expected)
    if not isinstance(f, IRec) or not isinstance(e, IRec):
        return []
    here, wanted = [n for n, _ in f.fields], [n for n, _ in e.fields]
    if here == wanted:
        return []
    if all(n.isdigit() for n in (*here, *wanted)):
        return [f"{len(wanted)} components are expected, here are {len(here)}"]
    if any(n.isdigit() for n in (*here, *wanted)):
        return []
    notes = [f"field `{n}` is missing" for n in wanted if n not in here]
    return notes + [f"field `{n}` does not belong here" for n in here if n not in wanted]


def conversion(found: Ty, wanted: Iterable[str]) -> str:
    """How to convert between the number types."""
    t = prune(found)
    name = t.name if isinstance(t, ICon) else ""
    if isinstance(t, Meta) and t.among:
        name = t.among[0]
    pairs = {
        ("int", "real"): "convert with `real`, or write the number with a decimal point: `5.0`",
        ("real", "int"): "convert with `floor`, `round` or `trunc`",
        ("int", "string"): "convert with `Int.toString`",
        ("real", "string"): "convert with `Real.toString`",
        ("IntInf.int", "int"): "convert with `IntInf.toInt`",
        ("int", "IntInf.int"): "convert with `IntInf.fromInt`",
        (
            "real",
            "IntInf.int",
        ): "convert with `floor`, `round` or `trunc`, and then with `IntInf.fromInt`",
        ("IntInf.int", "string"): "convert with `IntInf.toString`",
        ("string", "int"): "convert with `Option.valOf (Int.fromString ..)`",
        ("char", "string"): "convert with `str`",
        ("bool", "string"): "convert with `Bool.toString`",
    }
    return next((pairs[name, w] for w in wanted if (name, w) in pairs), "")

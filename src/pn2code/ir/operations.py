"""How built-in functions look in C: the table from names of `ml.library.builtins` (and of lowering's own operations)
to C.

Three forms: an infix operator, a function, a function that takes the context (because it may raise or needs
the arena).
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Rep


@frozen
class Infix:
    """A binary operator of C."""

    operator: str
    precedence: int


@frozen
class Prefix:
    """A unary operator of C."""

    operator: str


@frozen
class Call:
    """A C function. `context`: its first argument is the context; `table`: the next is the type's table;
    `pointers`: which operands are passed by address; `order`: it gives -1, 0, 1, of which an `order` is made."""

    function: str
    context: bool = False
    table: bool = False
    pointers: tuple[int, ...] = ()
    order: bool = False


@frozen
class Compared:
    """A comparison by way of a function that gives -1, 0, 1."""

    function: str
    operator: str


@frozen
class Literal:
    """A constant."""

    text: str


Form = Infix | Prefix | Call | Compared | Literal

MULTIPLY, ADD, RELATION, EQUALITY, AND, OR = 13, 12, 10, 9, 5, 4

OPS: dict[str, Form] = {
    "andalso": Infix("&&", AND),
    "orelse": Infix("||", OR),
    "Bool.not": Prefix("!"),
    "Bool.toString": Call("pn_string_of_bool"),
    "Real.+": Infix("+", ADD),
    "Real.-": Infix("-", ADD),
    "Real.*": Infix("*", MULTIPLY),
    "Real./": Infix("/", MULTIPLY),
    "Real.~": Prefix("-"),
    "Real.abs": Call("fabs"),
    "Real.min": Call("pn_real_min"),
    "Real.max": Call("pn_real_max"),
    "Real.sign": Call("pn_real_sign", context=True),
    "Real.compare": Call("pn_real_compare", context=True, order=True),
    "Real.==": Call("pn_real_equal"),
    "Real.!=": Call("!pn_real_equal"),
    "Real.rem": Call("pn_real_rem"),
    "Real.fromInt": Call("pn_int_to_real"),
    "Real.fromLargeInt": Call("pn_big_to_real"),
    "Real.realFloor": Call("floor"),
    "Real.realCeil": Call("pn_ceil"),
    "Real.realRound": Call("pn_real_round_even"),
    "Real.realTrunc": Call("pn_trunc"),
    "Real.isNan": Call("pn_real_is_nan"),
    "Real.isFinite": Call("pn_real_is_finite"),
    "Real.posInf": Literal("(double)INFINITY"),
    "Real.negInf": Literal("-(double)INFINITY"),
    "Real.toString": Call("pn_string_of_real", context=True),
    "Math.pi": Literal("PN_PI"),
    "Math.e": Literal("PN_E"),
    "Math.ln": Call("log"),
    "String.^": Call("pn_string_concat", context=True),
    "String.size": Call("pn_string_size"),
    "String.sub": Call("pn_string_at", context=True),
    "String.substring": Call("pn_string_sub", context=True),
    "String.str": Call("pn_string_of_char", context=True),
    "String.isPrefix": Call("pn_string_is_prefix"),
    "String.isSuffix": Call("pn_string_is_suffix"),
    "String.isSubstring": Call("pn_string_is_substring"),
    "String.compare": Call("pn_string_order", order=True),
    "Char.ord": Call("pn_char_code"),
    "Char.chr": Call("pn_char_of_int", context=True),
    "Char.compare": Call("pn_int_order", order=True),
    "Int.toString": Call("pn_string_of_int", context=True),
    "IntInf.toString": Call("pn_big_string", context=True),
    "Int.fromLarge": Call("pn_big_to_int", context=True),
    "IntInf.toInt": Call("pn_big_to_int", context=True),
    "TextIO.print": Call("pn_print", context=True),
    "Time.step": Call("pn_big_step", context=True),
    "time.same": Call(""),
    "time.+": Call("pn_time_sum", context=True),
    "time.latest": Call("pn_real_latest"),
    "time.to_large": Call("pn_big_of"),
    "time.of_large": Call("pn_big_to_time", context=True),
    "Int.toLarge": Call("pn_big_of"),
    "IntInf.fromInt": Call("pn_big_of"),
    "IntInf.compare": Call("pn_big_order", order=True),
    "IntInf.min": Call("pn_big_min"),
    "IntInf.max": Call("pn_big_max"),
    "IntInf.sign": Call("pn_big_sign"),
    "List.null": Prefix("IS_NIL"),
    "List.length": Call("pn_list_length"),
    "Ms.size": Call("pn_list_length"),
    "List.@": Call("pn_list_append", context=True, table=True),
    "List.union": Call("pn_list_append", context=True, table=True),
    "Ms.++": Call("pn_list_append", context=True, table=True),
    "List.rev": Call("pn_list_reverse", context=True, table=True),
    "List.revAppend": Call("pn_list_reverse_onto", context=True, table=True),
    "List.remdupl": Call("pn_list_remdupl", context=True, table=True),
    "List.intersect": Call("pn_ms_intersect", context=True, table=True),
    "List.pos": Call("pn_list_position", context=True, table=True, pointers=(1,)),
    "String.concat": Call("pn_string_join", context=True),
    "String.implode": Call("pn_string_implode", context=True),
    "String.explode": Call("pn_string_explode", context=True, table=True),
    "List.take": Call("pn_list_take", context=True, table=True),
    "List.drop": Call("pn_list_drop", context=True),
    "List.hd": Call("pn_list_first_cell", context=True),
    "List.last": Call("pn_list_last_cell", context=True),
    "List.tl": Call("pn_list_rest", context=True),
    "List.nth": Call("pn_list_nth_cell", context=True),
    "List.concat": Call("pn_list_concat", context=True, table=True),
    "List.mem": Call("pn_list_has", table=True, pointers=(1,)),
    "List.rm": Call("pn_list_remove", context=True, table=True, pointers=(1,)),
    "List.rmall": Call("pn_list_remove_all", context=True, table=True, pointers=(1,)),
    "List.contains": Call("pn_list_contains", table=True),
    "List.contains_all": Call("pn_ms_contains", table=True),
    "List.listsub": Call("pn_ms_subtract", context=True, table=True),
    "Ms.--": Call("pn_ms_subtract", context=True, table=True),
    "Ms.**": Call("pn_ms_times", context=True, table=True),
    "Ms.==": Call("pn_ms_equal", table=True),
    "Ms.!=": Call("!pn_ms_equal", table=True),
    "Ms.>>=": Call("pn_ms_contains", table=True),
    "Ms.>>": Call("pn_ms_contains_strictly", table=True),
    "Ms.cf": Call("pn_list_count", table=True, pointers=(1,)),
    "Ms.`": Call("pn_list_copies", context=True, table=True, pointers=(1,)),
    "Ms.ms_to_col": Call("pn_ms_only_cell", context=True),
    "Ms.random": Call("pn_ms_random_cell", context=True),
    "list.cons": Call("pn_list_cons", context=True, table=True, pointers=(0,)),
    "list.all_true": Call("pn_list_all_true"),
    "exn.name": Call("pn_exception_name", table=True, pointers=(0,)),
    "Colset.lt": Compared("pn_order", "<"),
    "Colset.cmp": Call("pn_order", table=True, pointers=(0, 1), order=True),
    "Colset.mkstr": Call("pn_mkstr_string", context=True, table=True, pointers=(0,)),
    "Colset.legal": Call("pn_is_legal", context=True, table=True, pointers=(0,)),
    "Colset.ord": Call("pn_colset_ord", context=True, table=True, pointers=(0,)),
    "Colset.size": Call("pn_colset_size", context=True, table=True),
}
"""Name -> form, for what the loops below do not add."""

for _structure, _prefix in (("Int", "pn_int"), ("IntInf", "pn_big")):
    for _name, _function in (
        ("+", "add"), ("-", "sub"), ("*", "mul"), ("~", "neg"), ("abs", "abs"), ("div", "div"), ("mod", "mod"),
        ("quot", "quot"), ("rem", "rem"),
    ):  # fmt: skip
        OPS[f"{_structure}.{_name}"] = Call(f"{_prefix}_{_function}", context=True)
OPS |= {
    "exact.+": Infix("+", ADD),
    "exact.-": Infix("-", ADD),
    "exact.*": Infix("*", MULTIPLY),
    "exact.~": Prefix("-"),
    "exact.div": Infix("/", MULTIPLY),
    "exact.mod": Infix("%", MULTIPLY),
}
"""Those of integers where nothing can overflow, and nothing negative is divided (`lowering.passes.ranges`)."""
for _name in ("min", "max", "sign"):
    OPS[f"Int.{_name}"] = Call(f"pn_int_{_name}")
OPS["Int.compare"] = Call("pn_int_order", order=True)
for _structure in ("Int", "Real", "Char"):
    for _name in ("<", "<=", ">", ">="):
        OPS[f"{_structure}.{_name}"] = Infix(_name, RELATION)
for _name in ("<", "<=", ">", ">="):
    OPS[f"String.{_name}"] = Compared("pn_string_order", _name)
    OPS[f"IntInf.{_name}"] = Compared("pn_big_order", _name)
for _name in (
    "sqrt",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "exp",
    "log10",
    "sinh",
    "cosh",
    "tanh",
):
    OPS[f"Math.{_name}"] = Call(_name)
OPS["Math.pow"] = Call("pn_real_power")
for _name in ("floor", "ceil", "round", "trunc"):
    OPS[f"Real.{_name}"] = Call(f"pn_real_{_name}", context=True)
for _name in ("isDigit", "isAlpha", "isAlphaNum", "isSpace", "isUpper", "isLower"):
    OPS[f"Char.{_name}"] = Call(f"pn_char_is_{_name[2:].lower()}")
OPS["Char.toUpper"] = Call("pn_char_to_upper")
OPS["Char.toLower"] = Call("pn_char_to_lower")
for _name in (
    "bernoulli",
    "binomial",
    "uniform",
    "discrete",
    "normal",
    "exponential",
    "poisson",
    "erlang",
    "chisq",
    "student",
    "gamma",
    "beta",
    "weibull",
    "rayleigh",
):
    OPS[f"Random.{_name}"] = Call(f"pn_random_{_name}", context=True)

OPS |= {
    "prim.stop": Call("pn_stop", context=True),
    "prim.and": Call("pn_big_and", context=True),
    "prim.or": Call("pn_big_or", context=True),
    "prim.xor": Call("pn_big_xor", context=True),
    "prim.not": Call("pn_big_not", context=True),
    "prim.shift_left": Call("pn_big_shift_left", context=True),
    "prim.shift_right": Call("pn_big_shift_right", context=True),
    "prim.real_exponent": Call("pn_real_exponent"),
    "prim.real_scale": Call("pn_real_scale"),
    "prim.real_next": Call("pn_real_next"),
    "prim.real_fused": Call("pn_real_fused"),
    "prim.real_sign_bit": Call("pn_real_sign_bit"),
    "prim.real_copy_sign": Call("pn_real_copy_sign"),
    "prim.real_is_normal": Call("pn_real_is_normal"),
    "prim.real_to_large": Call("pn_big_of_real", context=True),
    "prim.real_format": Call("pn_real_styled", context=True),
    "prim.real_read": Call("pn_real_read"),
    "prim.do_read_accept": Call("pn_read_accept"),
    "prim.do_read_integer": Call("pn_read_integer", context=True),
    "prim.do_read_number": Call("pn_read_number", context=True),
    "prim.do_read_is_done": Call("pn_read_is_done"),
    "prim.do_read_fail": Call("pn_read_fail", context=True),
    "prim.do_random_below": Call("pn_big_random_below", context=True),
    "prim.do_random_unit": Call("pn_random_unit", context=True),
    "prim.do_file_problem_name": Call("pn_file_problem_name"),
    "prim.do_file_has_failed": Call("pn_file_has_failed"),
    **{
        f"prim.do_file_{name}": Call(f"pn_file_{name}", context=True)
        for name in (
            "read", "open", "write", "close", "problem", "change", "rename", "is_folder", "size", "may",
            "full_path", "here", "names",
        )
    },
}  # fmt: skip
"""Operations of the functions of the prelude."""

WIDE: dict[str, Form] = {
    **{
        f"Int.{_name}": Call(f"pn_wide_{_function}", context=True)
        for _name, _function in (
            ("+", "add"), ("-", "sub"), ("*", "mul"), ("~", "neg"), ("abs", "abs"), ("div", "div"), ("quot", "quot"),
        )
    },
    "Int.mod": Call("pn_wide_mod", context=True),
    "Int.rem": Call("pn_wide_rem", context=True),
    "Int.fromLarge": Call("pn_big_to_wide", context=True),
    "IntInf.toInt": Call("pn_big_to_wide", context=True),
    **{f"Real.{_name}": Call(f"pn_wide_{_name}", context=True) for _name in ("floor", "ceil", "round", "trunc")},
}  # fmt: skip
"""Name -> form where `int` has 64 bits."""


def form_of(name: str, int_bits: int) -> Form:
    """How an operation looks in C."""
    return (WIDE.get(name) if int_bits > 31 else None) or OPS[name]


SWAPPED = frozenset({"List.rm", "List.rmall", "List.pos", "Ms.cf"})
"""Operations whose ML operands are (value, list) and whose C operands are (list, value)."""
CONTAINED = {"Ms.<<=": "Ms.>>=", "Ms.<<": "Ms.>>"}
"""Operations that are another one with its operands exchanged."""


def op_needs_table(e: ir.Op) -> bool:
    """Whether the operation looks at the table of a type in C."""
    if e.name == "=" and e.arguments[0].type.rep is Rep.REF:
        return False
    form = OPS.get(CONTAINED.get(e.name, e.name))
    return form is None or isinstance(form, Compared) or (isinstance(form, Call) and form.table)


def op_needs_context(e: ir.Op) -> bool:
    """Whether the operation takes the context in C."""
    if e.name == "Colset.all":
        return True
    form = OPS.get(CONTAINED.get(e.name, e.name))
    return isinstance(form, Call) and form.context

"""Which pieces of IR put something into the arena: by the functions of the runtime that they are in C."""

from __future__ import annotations

from collections.abc import Mapping

from pn2code.ir import nodes as ir
from pn2code.ir.operations import CONTAINED, OPS, WIDE, Call

MOVES = frozenset(("pn_moves_put", "pn_moves_reset", "pn_moves_take"))
"""Functions that allocate one move a call, or one a token: their bytes are counted."""
ALLOCATING = frozenset((
    "pn_arena_alloc", "pn_arena_copy", "pn_multiset_add_bytes", "pn_multiset_decode", "pn_multiset_put",
    "pn_multiset_relocate",
    "pn_big_abs", "pn_big_add", "pn_big_and", "pn_big_copy", "pn_big_difference", "pn_big_div", "pn_big_mod",
    "pn_big_mul", "pn_big_neg", "pn_big_not", "pn_big_of_digits", "pn_big_of_real", "pn_big_or", "pn_big_quot",
    "pn_big_rem", "pn_big_shift_left", "pn_big_shift_right", "pn_big_string", "pn_big_sub", "pn_big_sum",
    "pn_big_xor", "pn_colset_all", "pn_colset_input", "pn_decode", "pn_decode_with", "pn_file_full_path",
    "pn_file_here", "pn_file_names", "pn_file_problem", "pn_file_read", "pn_from_scalars", "pn_list_append",
    "pn_list_concat", "pn_list_cons", "pn_list_copies", "pn_list_new", "pn_list_remdupl", "pn_list_remove",
    "pn_list_remove_all", "pn_list_reverse", "pn_list_reverse_onto", "pn_list_take", "pn_marking_collect",
    "pn_marking_decode", "pn_marking_put", "pn_mkstr_string", "pn_moves_put_list", "pn_moves_put_timed",
    "pn_moves_take_list", "pn_ms_intersect", "pn_ms_subtract", "pn_ms_times", "pn_raise_value",
    "pn_read_integer", "pn_real_styled", "pn_ref_new", "pn_relocate", "pn_roots_decode", "pn_string_concat",
    "pn_string_explode", "pn_string_implode", "pn_string_join", "pn_string_make", "pn_string_of_char",
    "pn_string_of_int", "pn_string_of_real", "pn_string_sub",
))  # fmt: skip
"""All other functions of the runtime that allocate for a net without nested types; a test holds this against the
runtime's call graph."""


MAY_ALLOCATE = frozenset(
    {ir.Op, ir.Fill, ir.NewRef, ir.RaiseValue, ir.TakeAll, ir.PutAll, ir.MakeUnion}
)
"""Those that `maker` knows; all others allocate nothing."""


def maker(node: object, definitions: Mapping[str, ir.Definition], int_bits: int) -> str:
    """The function that a piece of IR calls, if it allocates; else ""."""
    name = ""
    match node:
        case ir.Op(name="Colset.all"):
            name = "pn_colset_all"
        case ir.Op(name=op):
            op = CONTAINED.get(op, op)
            form = (WIDE.get(op) if int_bits > 31 else None) or OPS.get(op)
            name = form.function.removeprefix("!") if isinstance(form, Call) else ""
        case ir.Fill(name=what):
            name = f"pn_colset_{what}"
        case ir.NewRef():
            name = "pn_ref_new"
        case ir.RaiseValue():
            name = "pn_raise_value"
        case ir.TakeAll():
            name = "pn_moves_take_list"
        case ir.PutAll(timed=timed):
            name = "pn_moves_put_timed" if timed else "pn_moves_put_list"
        case ir.MakeUnion(tag=tag, type=t) if node.argument is not None:
            definition = definitions[t.name]
            assert isinstance(definition, ir.UnionDef)
            name = "pn_arena_copy" if definition.constructors[tag][2] else ""
        case _:
            pass
    return name if name in ALLOCATING else ""

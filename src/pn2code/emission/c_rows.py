"""Rows of the constant tables by which hosts know places and transitions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from pn2code.emission.c_lines import WIDTH, wrap
from pn2code.emission.c_literals import c_integer
from pn2code.emission.environment import c_bool, c_float, c_string
from pn2code.ir import nodes as ir


def braces(head: str, members: Iterable[str], end: str = ";", indent: str = "") -> list[str]:
    """`head { member, member, ... };`, as many members in a line as fit."""
    whole = list(members)
    texts = [*(f"{m}," for m in whole[:-1]), f"{whole[-1]} }}{end}"]
    lines = [f"{indent}{head}{{"]
    for text in texts:
        if len(lines[-1]) + 1 + len(text) <= WIDTH:
            lines[-1] += f" {text}"
        else:
            lines += wrap(f"{indent}    {text}")
    return lines


def indices(member: str, numbers: Sequence[int]) -> list[str]:
    """A list of indices with its length, as members of a row; none for no indices."""
    return [f"PN_INDICES({member}, {', '.join(f'{i}U' for i in numbers)})"] if numbers else []


def early(name: str, p: ir.Place, real_time: bool) -> list[str]:
    """The constant delays of input arcs."""
    times = [
        f"{{ .real = {c_float(float(e))} }}"
        if real_time
        else f"{{ .integer = {c_integer(int(e))} }}"
        for e in p.early
    ]
    return braces(f"static const pn_time_t {name}[] = ", times)


def multiset(
    name: str,
    p: ir.Place,
    *,
    table: str,
    where: str,
    real_time: bool,
    early_name: str,
    numbering: tuple[str, str],
) -> list[str]:
    """Where a place has its tokens.

    Args:
        name: of the constant.
        p: the place.
        table: of its colour set.
        where: the macro that gives the offsets; "" for packed places.
        real_time: whether its stamps are reals.
        early_name: the constant made by `early`.
        numbering: of packed places, the functions that number colours.
    """
    members = [
        f".origin = {c_string(p.origin.describe())}",
        f".type = &{table}",
        f".capacity = {p.capacity}U",
    ]
    if p.timed:
        members += [".is_timed = true", f".is_real_time = {c_bool(real_time)}"]
    if p.packed:
        members += [
            ".is_packed = true",
            f".bit = {p.packed.bit}U",
            f".colours = {p.packed.colours}U",
            f".width = {p.packed.width}U",
            f".number_of = {numbering[0]}",
            f".colour_of = {numbering[1]}",
        ]
    members += [where] if where else []
    if p.early:
        members += [f".early_count = {len(p.early)}U", f".early = {early_name}"]
    return braces(f"static const pn_multiset_t {name} = ", members)


def place(p: ir.Place, multiset_name: str, initial: str, shares: str) -> list[str]:
    """What hosts know of a place.

    Args:
        p: the place.
        multiset_name: the constant made by `multiset`.
        initial: the function of its initial marking; "": there is none.
        shares: the constant of its shares; "": it has none.
    """
    members = [
        f".name = {c_string(p.name)}",
        f".colset = {c_string(p.colset)}",
        f".owner = {p.owner}",
        f".multiset = &{multiset_name}",
    ]
    if p.bound is not None:
        members += [".is_bounded = true", f".bound = {p.bound}U"]
    members += [f".initial = {initial}"] if initial else []
    if p.packed and shares:
        members += [f".share_count = {len(p.packed.shares)}U", f".share = {shares}"]
    return braces("", members, ",", "    ")


def counts(
    name: str, t: ir.Transition, places: Sequence[ir.Place], multisets: Sequence[str]
) -> list[str]:
    """The table of a transition that only counts; none if there is nothing that it does.

    Args:
        name: of the constant.
        t: the transition.
        places: of the net.
        multisets: by place, where its multiset is: "&s_at_P".
    """
    rows = []
    for c in t.counts or ():
        kept = places[c.place].packed
        assert kept is not None, c
        values = (kept.bit, kept.width, c.needs, c.takes, c.puts)
        rows.append(f"    PN_COUNT({multisets[c.place]}, {', '.join(f'{v}U' for v in values)}),")
    return [f"static const pn_count_t {name}[] = {{", *rows, "};"] if rows else []


def counting(name: str, t: ir.Transition, key: int | None) -> str:
    """The members for its functions, in the table of transitions.

    Args:
        name: of the constant made by `counts`.
        t: the transition.
        key: the bits of the key, where markings have a short one.
    """
    rows = f"{name if t.counts else 'NULL'}, {len(t.counts or ())}U"
    return f"PN_COUNTING({rows})" if key is None else f"PN_COUNTING_WORDS({rows}, 0x{key:x}U)"


def transition(
    t: ir.Transition,
    code: str,
    further: Sequence[str],
    *,
    is_others: bool = False,
    functions: str = "",
) -> list[str]:
    """What hosts know of an instance of a transition.

    Args:
        t: the instance.
        code: the stem of the names of its functions.
        further: members that not all have.
        is_others: it is played by another program than the supervisor.
        functions: the members for its functions, if it has none of its own.
    """
    own = f"{'PN_OTHERS' if is_others else 'PN_CODE'}({code})"
    members = [
        f"/* {t.index} */ .name = {c_string(t.name)}",
        f".id = {c_string(t.id)}",
        f".origin = {c_string(t.origin.describe())}",
        f".owner = {t.owner}",
        f".priority = {t.priority}",
        functions or own,
        *further,
    ]
    return braces("", members, ",", "    ")


def binding(
    code: str, name: str, variables: Sequence[tuple[str, str, ir.Variable, str]]
) -> list[str]:
    """The struct of a transition's bindings, and the tables that describe it.

    Args:
        code: the stem of the names.
        name: for messages.
        variables: C type, member, variable, table of the colour set.
    """
    members = [
        f"{c_type} {member};" + (" /* output of the code segment */" if v.is_output else "")
        for c_type, member, v, _ in variables
    ] or ["uint8_t none; /* no variables */"]
    rows = [
        f"{{ {c_string(v.name)}, &{table}, offsetof({code}_binding_t, {member}), false }}"
        for _, member, v, table in variables
    ]
    fields = f"s_variables_{code}" if variables else "NULL"
    record = [
        ".kind = PN_KIND_RECORD",
        f".name = {c_string(name)}",
        f".size = sizeof({code}_binding_t)",
        f".count = {len(variables)}U",
        f".field = {fields}",
    ]
    lines = [f"typedef struct {code}_binding {{", *(f"    {m}" for m in members)]
    lines.append(f"}} {code}_binding_t;")
    if rows:
        lines += [
            f"static const pn_field_t {fields}[] = {{",
            *(f"    {row}," for row in rows),
            "};",
        ]
    return [*lines, *braces(f"static const pn_type_t s_binding_{code} = ", record)]


def each(rows: Iterable[tuple[int, str, bool]]) -> list[str]:
    """`EACH` of index, code, and whether each choice of tokens gives a binding."""
    lines = ["   "]
    for i, code, plain in rows:
        text = f" EACH({i}U, {code}, {c_bool(plain)})"
        if len(lines[-1]) + len(text) > WIDTH:
            lines.append("   ")
        lines[-1] += text
    return lines

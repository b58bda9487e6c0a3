"""The functions in C that work out multi-sets of arcs once for each value of their variables; see `passes.sums`."""

from __future__ import annotations

from collections.abc import Callable

from pn2code.base.frozen import frozen
from pn2code.emission.c_packed import Numbers
from pn2code.ir import nodes as ir


@frozen
class SumFunction:
    """The name of the function that gives the counters of a multi-set, and the multi-set."""

    name: str
    of: ir.Sum


def functions(t: ir.Transition, stem: str) -> dict[tuple[int, ir.Ir], SumFunction]:
    """Those of a transition by place and multi-set; `stem` is its name in C."""
    return {
        (s.place, s.multiset): SumFunction(f"{stem}_sum_{number}", s)
        for number, s in enumerate(t.sums, 1)
    }


def function(
    known: SumFunction,
    binding: str,
    multiset: str,
    list_table: str,
    numbers: Numbers,
    text: Callable[[ir.Ir], str],
    address: Callable[[int], str],
) -> list[str]:
    """The function in C.

    Args:
        known: its name and the multi-set.
        binding: type of the binding.
        multiset: a pointer to the table of the place.
        list_table: of the list.
        numbers: of colours.
        text: prints an expression over `b->`.
        address: of a variable.
    """
    s = known.of
    lines = [
        f"static const uint64_t *{known.name}(pn_ctx_t *cx, const {binding} *b)",
        "{",
        f"    static PN_OF_THREAD uint8_t state[{s.count}];",
        f"    static PN_OF_THREAD uint64_t counters[{s.count}][{s.words}];",
    ]
    number = ""
    for k, (index, table, n) in enumerate(s.variables, 1):
        own = f"{numbers.number_of(table)}({address(index)})"
        name = "number" if len(s.variables) == 1 else f"number_{k}"
        lines.append(f"    const uint32_t {name} = {own};")
        lines += [f"    if ({name} == PN_NO_COLOUR) {{", "        return NULL;", "    }"]
        number = f"(({number}) * {n}U) + {name}" if number else name
    if not s.variables:
        lines += ["    const uint32_t number = 0U;", "    (void)b;"]
    elif len(s.variables) > 1:
        lines.append(f"    const uint32_t number = {number};")
    lines += [
        "    if (state[number] == PN_SUM_UNKNOWN) {",
        "        const size_t start = pn_arena_mark(cx->arena);",
        f"        state[number] = (uint8_t)pn_sum_make(cx, {multiset}, &{list_table},",
        f"            {text(s.multiset)}, counters[number]);",
        "        if (pn_ok(cx)) {",
        "            pn_arena_release(cx->arena, start);",
        "        }",
        "    }",
        "    return (state[number] == PN_SUM_KNOWN) ? counters[number] : NULL;",
        "}",
    ]
    return lines

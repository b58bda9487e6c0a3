"""The function in C that works out a multi-set of an arc once for each value of its variables."""

from __future__ import annotations

from collections.abc import Callable

from pn2code.emission.c_packed import Numbers
from pn2code.ir import nodes as ir
from pn2code.lowering.passes.sums import Sum


def function(
    s: Sum,
    binding: str,
    bag: str,
    list_table: str,
    numbers: Numbers,
    text: Callable[[ir.Ir], str],
    address: Callable[[int], str],
) -> list[str]:
    """The function in C.

    Args:
        s: the sum.
        binding: type of the binding.
        bag: a pointer to the table of the place.
        list_table: of the list.
        numbers: of colours.
        text: prints an expression over `b->`.
        address: of a variable.
    """
    lines = [
        f"static const uint64_t *{s.name}(pn_ctx_t *cx, const {binding} *b)",
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
        f"        state[number] = (uint8_t)pn_sum_make(cx, {bag}, &{list_table},",
        f"            {text(s.multiset)}, counters[number]);",
        "        if (pn_ok(cx)) {",
        "            pn_arena_release(cx->arena, start);",
        "        }",
        "    }",
        "    return (state[number] == PN_SUM_KNOWN) ? counters[number] : NULL;",
        "}",
    ]
    return lines

"""Random small cells of the families whose firings commute (`tools.bench.families`), most of them a little wrong.

In two of three one or two lines of the supervisor are changed: an arc is missing, or goes to another place, or a
transition is more urgent than the others.
"""

from __future__ import annotations

from random import Random

from tools.bench import families

SMALL = {"ring": (2, 3), "zones": (2, 3), "line": (1, 2), "pallets": (2, 2), "retries": (1, 1)}
"""By family, how many robots."""


def stations(r: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    family = r.choice(sorted(SMALL))
    size = r.choice(SMALL[family])
    lines = families.net(family, size, r.choice([2, 3, 4])).split("\n")
    lines.insert(lines.index("  standard") + 1, "  val P_HIGH = 100;")
    for _ in range(r.choice([0, 1, 2])):
        _change(r, lines)
    return "\n".join(lines), families.toml(family, size)


def _change(r: Random, lines: list[str]) -> None:
    begins = lines.index("  page Supervisor")
    ends = next(i for i in range(begins + 1, len(lines)) if lines[i].startswith("  page "))
    own = range(begins + 1, ends)
    arcs = [i for i in own if lines[i].split()[:1] in (["in"], ["out"]) and "()" in lines[i]]
    dots = sorted({lines[i].split()[1] for i in arcs})
    where = r.choice(arcs)
    match r.choice(["gone", "elsewhere", "urgent"]):
        case "gone":
            del lines[where]
        case "elsewhere":
            words = lines[where].split()
            lines[where] = f"      {words[0]} {r.choice(dots)} : ()"
        case _:
            at = r.choice([i for i in own if lines[i].startswith("    trans ")])
            if "priority" not in lines[at]:
                name, *guard = lines[at].split(" guard ")
                lines[at] = name + " priority P_HIGH" + "".join(f" guard {g}" for g in guard)

"""Small changes of C code and of robot scripts, each of which may change what a program does.

for mutant in of_c(text, "net.c", lambda function: function.name.endswith("_fire")): ...
mutant.text       # the changed file
mutant.what       # "net.c:431: `b.n == 2` -> `b.n != 2`"
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Mutant:
    """A changed file.

    Args:
        file: its name.
        line: of the change.
        kind: of the change, such as "condition negated".
        what: the change in words.
        text: the whole file.
    """

    file: str
    line: int
    kind: str
    what: str
    text: str


@dataclass(frozen=True, slots=True)
class Function:
    """A C function: its name, and the lines of its braces, counted from 1."""

    name: str
    first: int
    last: int


Rule = tuple[str, re.Pattern[str], Callable[[re.Match[str]], str]]

_COMMENT = re.compile(r"/\*.*?\*/|//.*$|\"(?:[^\"\\]|\\.)*\"")
_PLACES = re.compile(r"(?<=&m->)\w+(?=[,)])|(?<=own->)\w+(?=[,)])|(?<=^    m->)\w+(?=\.\w+ = )")


def _other(pairs: dict[str, str]) -> Callable[[re.Match[str]], str]:
    return lambda m: m[0].replace(m[1], pairs[m[1]], 1)


_COMPARED = {"==": "!=", "!=": "==", "<": "<=", ">": ">=", "<=": "<", ">=": ">"}
_EQUALS = {"=": "<>", "<>": "="}
_ADDED = {"+": "-", "-": "+"}
_JOINED = {"&&": "||", "||": "&&"}
_SPEED = {"j": "30 %", "l": "50 mm/s"}
_SWITCHED = {"true": "false", "false": "true"}
_TYPES = {
    "int": "real",
    "real": "int",
    "string": "word",
    "word": "string",
    "bool": "int",
    "pose": "real",
}
_SCALARS = {
    "INT": "REAL",
    "REAL": "STRING",
    "BOOL": "INT",
    "ENUM": "STRING",
    "INDEX": "INT",
    "UNIT": "BOOL",
}
SAID = re.compile(r"\.(?:version) = ")
"""Members that only messages to people are made of."""


def _negated(m: re.Match[str]) -> str:
    return m[0].replace(f"({m[1]})", f"(!({m[1]}))", 1)


C_RULES: tuple[Rule, ...] = (
    ("comparison", re.compile(r"(?<=[\w)\]] )(==|!=|<=|>=|<|>)(?= [\w(~-])"), lambda m: _COMPARED[m[1]]),
    ("condition negated", re.compile(r"\b(?:if|while) \((?!!)(.*)\) \{(?: /\*.*\*/)?$"), _negated),
    ("condition negated", re.compile(r"\bif \(!([\w.>-]+)\) \{(?: /\*.*\*/)?$"), lambda m: m[0].replace("(!", "(", 1)),
    ("arithmetic", re.compile(r"(?<=[\w)\]] )([+-])(?= [\w(])"), lambda m: _ADDED[m[1]]),
    ("arithmetic", re.compile(r"\bpn_int_(add|sub)\("), _other({"add": "sub", "sub": "add"})),
    ("logic", re.compile(r"(&&|\|\|)"), lambda m: _JOINED[m[1]]),
    ("constant", re.compile(r"(?<![\w.])(\d+)(?=U?[;,)])"), lambda m: str(int(m[1]) + 1)),
    ("constant", re.compile(r"\b(true|false)\b(?=[;,)])"), lambda m: _SWITCHED[m[1]]),
    ("write skipped", re.compile(r"(?<== )\w+_add\(cx, [^;]*?\)(?=;| &&)"), lambda m: "true"),
    ("token not taken", re.compile(r"(?<== )\w+_take\([^;]*?\)(?=;| &&)"), lambda m: "true"),
    ("call dropped", re.compile(r"^(\s*)(?:\(void\))?[\w.>-]+\([^=]*\);$"), lambda m: f"{m[1]};"),
)  # fmt: skip
COMMAND = re.compile(r"^(\s+)(?:move|tool|measure|wait(?! until)) .*$")
_CHANGED = {"couples": "uncouples", "uncouples": "couples"}
SCRIPT_RULES: tuple[Rule, ...] = (
    ("comparison", re.compile(r"(?<= )(=|<>|<=|>=|<|>)(?= .* then$)"), lambda m: _EQUALS.get(m[1]) or _COMPARED[m[1]]),
    ("line dropped", re.compile(r"^(\s+)(?:clear|write|mark|sense|read) .*$"), lambda m: f"{m[1]}-- dropped"),
    ("command dropped", COMMAND, lambda m: f"{m[1]}-- dropped"),
    ("command repeated", COMMAND, lambda m: f"{m[0]}\n{m[0]}"),
    ("constant", re.compile(r"(?<![\w.\"])(\d+)(?=$| |,)"), lambda m: str(int(m[1]) + 1)),
    ("motion", re.compile(r"\$(joint|linear)"), _other({"joint": "linear", "linear": "joint"})),
    ("frame", re.compile(r" in tool$"), lambda m: ""),
    ("frame", re.compile(r"(?<=move \$linear )(\w+)$"), lambda m: f"{m[1]} in tool"),
    ("speed", re.compile(r"(?<=move )(\$joint .*|\$linear .*)$"), lambda m: f"{m[1]} at {_SPEED[m[1][1]]}"),
    ("wait dropped", re.compile(r"^(\s+)wait until .*$"), lambda m: f"{m[1]}-- dropped"),
    ("part dropped", re.compile(r" (?:takes|releases|(?:creates|removes) \w+ at) \w+(?= for )"), lambda m: ""),
    ("tool dropped", re.compile(r" (?:un)?couples \w+(?= for )"), lambda m: ""),
    ("part", re.compile(r" (takes|releases)(?= \w+ for )"), _other({"takes": "releases", "releases": "takes"})),
    ("part", re.compile(r" (couples|uncouples)(?= \w+ for )"), _other(_CHANGED)),
    ("part", re.compile(r" (creates|removes)(?= \w+ at )"), _other({"creates": "removes", "removes": "creates"})),
    ("part", re.compile(r" (?:takes|releases|creates|removes|(?:un)?couples) (\w+)(?= )"), lambda m: f"{m[0]}x"),
    ("place", re.compile(r" (?:creates|removes) \w+ at (\w+)(?= for )"), lambda m: f"{m[0]}x"),
    ("speed dropped", re.compile(r"(?<=[\w)]) at (?:(?! at ).)* (?:mm/s|%)$"), lambda m: ""),
    ("rounding", re.compile(r"(?<![\w.\"])(\d+\.\d*[1-9]\d*)"), lambda m: repr(round(float(m[1]), 1) + 1e-4)),
    ("arithmetic", re.compile(r"(?<= )([+-])(?= [\w(])"), lambda m: _ADDED[m[1]]),
    ("logic", re.compile(r"(?<= )(and|or)(?= )"), _other({"and": "or", "or": "and"})),
    ("real", re.compile(r"(?<![\w.\"])(\d+\.\d+)"), lambda m: str(float(m[1]) + 0.5)),
    ("longer wait", re.compile(r"(?<=wait )(?!until)(.*)$"), lambda m: f"({m[1]}) * 1000"),
    ("line dropped", re.compile(r"^(\s+)(?:wait(?! until) .*|\w+ := .*)$"), lambda m: f"{m[1]}-- dropped"),
    ("a wait more", re.compile(r"^(\s+)(?=(?:clear|write|mark|move|tool|measure|sense|read|wait|\w+ :=))"),
     lambda m: f"{m[1]}wait 7 s\n{m[1]}"),
)  # fmt: skip
NAMES = (
    ("tool", re.compile(r"^\s+tool (\w+) for ")),
    ("file", re.compile(r"^\s+(?:clear|write|read) (\w+)")),
    ("file awaited", re.compile(r"(?:filled|empty)\((\w+)\)")),
    ("sensor", re.compile(r"^\s+sense (\w+) into ")),
    ("transition", re.compile(r"^\s+mark ([\w.]+)")),
)
"""Names in scripts, each to be exchanged for the others of its kind."""
STATEMENT = re.compile(
    r"^\s+(?:clear|write|mark|move|tool|measure|sense|read|wait|\w+ :=)(?: .*)?$"
)
DECLARATION_RULES: tuple[Rule, ...] = (
    ("name", re.compile(r"^(program) (\w+)$"), lambda m: f"{m[1]} {m[2]}x"),
    ("direction", re.compile(r"^(input|output)"), _other({"input": "output", "output": "input"})),
    ("file", re.compile(r'^((?:in|out)put +\w+ +)"(.*)" '), lambda m: f'{m[1]}"x{m[2]}" '),
    ("type", re.compile(r"(?<= )(int|real|string|word|bool|pose)(?= |,|$)(?! single)"), lambda m: _TYPES[m[1]]),
    ("single", re.compile(r"(?<= )(real|pose)(?= |,|$)(?! single)"), lambda m: f"{m[1]} single"),
    ("single", re.compile(r"(?<= )single(?= |,|$)"), lambda m: ""),
    ("constant", re.compile(r"(?<==) *(-?\d+)(?= |$)"), lambda m: f" {int(m[1]) + 1}"),
)  # fmt: skip
"""The lines of a script before its first statement."""
TABLE_RULES: tuple[Rule, ...] = (
    ("number", re.compile(r"(?<![\w.\"])(\d+)(?=U?[,)])"), lambda m: str(int(m[1]) + 1)),
    ("number", re.compile(r"(?<![\w.\"])(\d+\.\d+)"), lambda m: str(float(m[1]) / 240.0 + 0.125)),
    ("text", re.compile(r'"([^"]*)"(?=,| )'), lambda m: f'"x{m[1]}"'),
    ("constant", re.compile(r"\b(true|false)\b"), lambda m: _SWITCHED[m[1]]),
    ("kind", re.compile(r"PN_CHANNEL_(DATA|FLAG)"), _other({"DATA": "FLAG", "FLAG": "DATA"})),
    ("direction", re.compile(r"PN_CHANNEL_(IN|OUT)"), _other({"IN": "OUT", "OUT": "IN"})),
    ("scalar", re.compile(r"PN_SCALAR_(\w+)"), lambda m: f"PN_SCALAR_{_SCALARS.get(m[1], 'INT')}"),
    ("table", re.compile(r"(?<= = )(s_\w+?)(\d+)(?=,)"), lambda m: f"{m[1]}{int(m[2]) + 1}"),
    ("table", re.compile(r"(?<= = )(s_\w+)(?=,)"), lambda m: "NULL"),
    ("row dropped", re.compile(r"^    (?:\{ .* \}|\d+U),.*$"), lambda m: ""),
)  # fmt: skip


DEFENSIVE = re.compile(
    r"error\b|sup_stop|sup_warn|sup_say|snprintf|verbosity|pn_trace|pn_text|pn_json|crowded|max_firings|stop_signal"
    r"|fired_of|most_fired|!is_taken|!fits|!pn_ok|pn_raise|pn_begin|pn_has_room|PN_ERR|->rounds|is_lost|all_ended|refused|owes"
    r"|sup_monitor|fired\(|\*count|\*fired|(?:transition|index) = 0U|first_binding_t first|result = -1|/\* I3"
    r"|return -?[12];|s_cell\.(?:sent|received)|scalars_format|->t = |\*fired = "
)
"""Lines, with the blocks that they begin, that nothing reaches in a cell that works: errors, reports, statistics. What
they do has tests of its own (`tests/e2e/test_supervisor_host.py`, `test_compiled_core.py`)."""
_KEPT = re.compile(r"^\s*(?:return (?:true|false);|(?:is_taken|fits) = .*(?:&&|\|\|).*)$")
"""Answers of a search that nobody asks for, and the `&&` between moves that never fail; so with the `||` between tests
for tokens that the search has found."""


def of_c(text: str, file: str, is_wanted: Callable[[Function], bool]) -> Iterator[Mutant]:
    """Mutants of some functions, without what is defensive."""
    lines = text.split("\n")
    for function in functions(lines):
        if not is_wanted(function):
            continue
        wanted = list(range(function.first, function.last - 1))
        block = ""  # the indentation of a defensive block that has begun
        for i in list(wanted):
            indent = lines[i][: len(lines[i]) - len(lines[i].lstrip())]
            if block:
                wanted.remove(i)
                if indent == block and lines[i].startswith(f"{indent}}}"):
                    block = ""
                    if lines[i].rstrip().endswith("{"):  # } else {
                        block = indent if DEFENSIVE.search(lines[i]) else ""
            elif DEFENSIVE.search(lines[i]):
                wanted.remove(i)
                block = indent if lines[i].rstrip().endswith("{") else ""
        for i in wanted:
            for mutant in _changed(lines, i, file, C_RULES):
                is_taking = any("pn_fail_missing" in line for line in lines[i + 1 : i + 4])
                is_answer = _KEPT.match(lines[i]) and mutant.kind in ("logic", "constant")
                is_kept = is_answer or (is_taking and mutant.kind == "logic")
                if not (is_kept and (mutant.kind == "logic" or "return" in lines[i])):
                    yield mutant
        yield from _swapped(lines, wanted, file)


def functions(lines: list[str]) -> Iterator[Function]:
    """The functions of a C file as our formatter leaves it."""
    start = 0
    for i, line in enumerate(lines):
        if line == "{" and i > 0:
            start = i
        elif line == "}" and start:
            head = " ".join(lines[max(0, start - 3) : start])
            (name, *_) = re.findall(r"\b(\w+)\(", head.rsplit("}", 1)[-1].rsplit("*/", 1)[-1])
            yield Function(name, start + 1, i + 1)
            start = 0


def of_script(text: str, file: str) -> Iterator[Mutant]:
    """Mutants of a robot's script, of its statements and of the values in them."""
    lines = text.split("\n")
    begin = lines.index("begin")
    for i, line in enumerate(lines):
        if not line.lstrip().startswith(("--", "program", "input", "output", "var")):
            yield from _changed(lines, i, file, SCRIPT_RULES)
    for kind, name in NAMES:
        yield from _renamed(lines, range(begin, len(lines)), file, kind, name)
    for i in range(begin, len(lines) - 1):
        a, b = lines[i], lines[i + 1]
        if STATEMENT.match(a) and STATEMENT.match(b) and _indent(a) == _indent(b) and a != b:
            what = f"{file}:{i + 1}: statements exchanged: `{a.strip()}` and `{b.strip()}`"
            text = "\n".join([*lines[:i], b, a, *lines[i + 2 :]])
            yield Mutant(file, i + 1, "statements exchanged", what, text)


def _renamed(
    lines: list[str], wanted: Iterable[int], file: str, kind: str, name: re.Pattern[str]
) -> Iterator[Mutant]:
    """Another name of the same kind, of those that stand anywhere."""
    known = list(dict.fromkeys(m[1] for i in wanted for m in name.finditer(lines[i])))
    for i in wanted:
        for match in name.finditer(lines[i]):
            for other in known:
                if other != match[1]:
                    new = lines[i][: match.start(1)] + other + lines[i][match.end(1) :]
                    yield _mutant(lines, i, new, file, kind)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def of_declarations(text: str, file: str) -> Iterator[Mutant]:
    """Mutants of what a robot's script declares."""
    lines = text.split("\n")
    for i, line in enumerate(lines[: lines.index("begin")]):
        if line.startswith(("program", "input", "output", "const", "var")):
            yield from _changed(lines, i, file, DECLARATION_RULES)


def of_tables(text: str, file: str) -> Iterator[Mutant]:
    """Mutants of the tables of cell_config.c: each value of each line, rows dropped, neighbours exchanged."""
    lines = text.split("\n")
    first = next(i for i, line in enumerate(lines) if line.startswith("#include"))
    bodies = dict(re.findall(r"(s_\w+)\[\] = \{\n(.*?)\n\};", text, re.DOTALL))
    for i in range(first, len(lines)):
        if SAID.search(lines[i]):
            continue
        for mutant in _changed(lines, i, file, TABLE_RULES):
            names = [re.findall(r"= (s_\w+),", x) for x in (lines[i], mutant.text.split("\n")[i])]
            old, new = ([bodies.get(n) for n in found] for found in names)
            if (
                old != new or None in old or not old
            ):  # another table with the same rows is the same table
                yield mutant
    for i in range(first, len(lines) - 1):
        a, b = lines[i], lines[i + 1]
        row = re.compile(r"^    (?:\{ .* \}|\d+U),")
        if row.match(a) and row.match(b) and a != b:
            what = f"{file}:{i + 1}: rows exchanged: `{a.strip()}` and `{b.strip()}`"
            new = [*lines[:i], b, a, *lines[i + 2 :]]
            yield Mutant(file, i + 1, "rows exchanged", what, "\n".join(new))
        name = re.compile(r'\.name = "(\w+)"')
        if (x := name.search(a)) and (y := name.search(b)) and row.match(a) and row.match(b):
            what = f"{file}:{i + 1}: names exchanged: `{x[1]}` and `{y[1]}`"
            new = [*lines[:i], a.replace(x[1], y[1], 1), b.replace(y[1], x[1], 1), *lines[i + 2 :]]
            yield Mutant(file, i + 1, "names exchanged", what, "\n".join(new))


def _changed(lines: list[str], i: int, file: str, rules: tuple[Rule, ...]) -> Iterator[Mutant]:
    line = lines[i]
    hidden = [m.span() for m in _COMMENT.finditer(line)]
    for kind, pattern, change in rules:
        for match in pattern.finditer(line):
            if any(a <= match.start() < b for a, b in hidden):
                continue
            new = line[: match.start()] + change(match) + line[match.end() :]
            if new != line:
                yield _mutant(lines, i, new, file, kind)


def _swapped(lines: list[str], wanted: list[int], file: str) -> Iterator[Mutant]:
    """Another place of the same function instead; that often does not compile, and is no mutant then."""
    found = [(i, m) for i in wanted for m in _PLACES.finditer(lines[i])]
    places = list(dict.fromkeys(m[0] for _, m in found))
    for i, match in found:
        for other in places:
            if other != match[0]:
                new = lines[i][: match.start()] + other + lines[i][match.end() :]
                yield _mutant(lines, i, new, file, "places swapped")


def of_instances(text: str, file: str, is_wanted: Callable[[str], bool]) -> Iterator[Mutant]:
    """Two places exchanged in the tables of page instances, by their paths."""
    lines = text.split("\n")
    start = re.compile(r"^static const \w+ s_in_\w+ = \{$")
    for i, line in enumerate(lines):
        if not start.match(line) or not is_wanted(lines[i - 1].strip("/* ")):
            continue
        end = lines.index("};", i)
        for k in range(i + 1, end - 1):
            (a, x), (b, y) = (row.strip(" ,").split(" = ") for row in lines[k : k + 2])
            new = [*lines[:k], f"    {a} = {y},", f"    {b} = {x},", *lines[k + 2 :]]
            what = f"{file}:{k + 1}: places of an instance exchanged: `{a}` and `{b}`"
            yield Mutant(file, k + 1, "places exchanged", what, "\n".join(new))


def _mutant(lines: list[str], i: int, new: str, file: str, kind: str) -> Mutant:
    what = f"{file}:{i + 1}: {kind}: `{lines[i].strip()}` -> `{new.strip()}`"
    return Mutant(file, i + 1, kind, what, "\n".join([*lines[:i], new, *lines[i + 1 :]]))

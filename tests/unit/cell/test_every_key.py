"""Every key of cell.toml: it has an effect; a wrong value and a misspelt name are refused, by readers and by editors.

The keys are those of `pn2code.cell_file`; a key that is added there must be said in `FULL`.
"""

from __future__ import annotations

import copy
import json
import math
import tomllib
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, get_args

import jsonschema
import pytest

from helpers.documents import between
from helpers.full_cell import FULL, PathOf, about, declared, keys, read
from helpers.processes import pn2code
from helpers.thorough import amount
from pn2code.cell.config import COMMANDS, CommandName
from pn2code.cell_file import json_schema, listing
from pn2code.cell_file.keys import Key
from pn2code.cell_file.whole import FILE
from pn2code.robot.branches import ALL_NAMES
from pn2code.robot.commands import EFFECTS

SCHEMA = json_schema.schema()
EDITOR = jsonschema.Draft202012Validator(SCHEMA)
EVERY = [*keys(FULL)]
WRONG = amount(1, 10)
"""Values that are wrong for a key, of all that `wrong` gives."""
MISSPELT = amount(2, 100)
"""Keys of a table."""


def is_right(data: dict[str, Any], section: str) -> bool:
    """For editors. They look at that section only: the others are those of the full cell, which is right."""
    return editor(section).is_valid(data)


@cache
def editor(section: str) -> jsonschema.Draft202012Validator:
    rules = {name: rule if name == section else True for name, rule in SCHEMA["properties"].items()}
    return EDITOR.evolve(schema={**SCHEMA, "properties": rules})


def changed(path: PathOf, *new: Any) -> dict[str, Any]:
    """What the full cell says about a section, with another value of a key, or without it."""
    data = copy.deepcopy(about(str(path[0])))
    table: Any = data
    for part in path[:-1]:
        table = table[part]
    if new:
        table[path[-1]] = new[0]
    else:
        del table[path[-1]]
    return data


def wrong(key: Key) -> Iterator[Any]:
    """Values that a key must not have."""
    if key.kind == "scalar":
        yield [1]
        return
    yield [3] if key.kind == "text" else "text"
    match key.kind:
        case "text":
            yield 3
            if key.words:
                yield "no such word"
        case "whole" | "number":
            yield True
            yield from (x for x in outside(key))
        case "numbers":
            yield ["text"]
            if key.counts:
                yield [0.5] * (max(key.counts) + 1)
            yield from ([x] * max(key.counts or (1,)) for x in outside(key))
        case "texts":
            yield [3]
        case "flag":
            yield 1
        case "table" | "named" | "entries":
            yield 3
        case "tables":
            yield [3]
    if key.kind == "whole":
        yield 1.5


def outside(key: Key) -> Iterator[float]:
    if key.low > -math.inf:
        yield int(key.low) if key.above else int(key.low) - 1
    if key.high < math.inf:
        yield int(key.high) + 1


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What is made of the full cell, for each section that is looked at."""
    out = {}
    for section in FULL:
        out[section], d = read(tmp_path_factory.mktemp("full"), about(section), section)
        assert not d.items, [e.message for e in d.items]
    return out


def test_the_full_cell_says_everything() -> None:
    said = {id(key) for _, key in EVERY}
    in_layouts = {id(k) for k in declared(FILE["layouts"].inner)}
    assert [k.name for k in declared() if id(k) not in said | in_layouts] == []
    assert [e.message for e in EDITOR.iter_errors(FULL)] == []


def test_each_key_has_an_effect(whole: dict[str, str], tmp_path: Path) -> None:
    """Without it something else is read, or it is said that something is missing; and to editors it is so, too."""
    idle = []
    for path, key in EVERY:
        data = changed(path)
        text, d = read(tmp_path, data, str(path[0]))
        missing = [e.message for e in d.errors if "is missing" in e.message]
        if text == whole[str(path[0])] and (key.default is None or not is_default(path, key)):
            idle.append((path, "has no effect"))
        if key.required is True and path[0] != "layouts" and not missing:
            idle.append((path, "can be left out"))
        if is_right(data, str(path[0])) == bool(missing) and path[-1] not in ("at", "kind"):
            idle.append((path, "is missing to one of them only", missing))
    assert idle == []


def is_default(path: PathOf, key: Key) -> bool:
    value: Any = FULL
    for part in path:
        value = value[part]
    return bool(value == key.default)


def test_each_wrong_value_is_refused_by_the_reader_and_by_editors(tmp_path: Path) -> None:
    """And the message names the key, or what it is about."""
    passed = []
    for number, (path, key) in enumerate(EVERY):
        names = [str(part) for part in path if isinstance(part, str)]
        values = [*wrong(key)]
        first = number % len(values)  # so that each kind of them has its turn
        for value in [*values[first:], *values[:first]][:WRONG]:
            data = changed(path, value)
            _, d = read(tmp_path, data, str(path[0]))
            if not any(names[-1] in e.message + e.origin.part for e in d.errors):
                passed.append((path, value, "reader", [e.message for e in d.errors]))
            if is_right(data, str(path[0])):
                passed.append((path, value, "editors"))
    assert passed == []


def test_each_misspelt_key_is_refused_by_the_reader_and_by_editors(tmp_path: Path) -> None:
    passed = []
    tables: Counter[PathOf] = Counter()
    for path, key in EVERY:
        if key.name != path[-1]:
            continue  # a name that is chosen
        tables[path[:-1]] += 1
        if tables[path[:-1]] > MISSPELT:
            continue
        data = changed(path)
        table: Any = data
        for part in path[:-1]:
            table = table[part]
        misspelt = f"{key.name}q"
        table[misspelt] = 1
        _, d = read(tmp_path, data, str(path[0]))
        if not any(f"unknown key `{misspelt}`" in e.message for e in d.errors):
            passed.append((path, "reader", [e.message for e in d.errors]))
        if is_right(data, str(path[0])):
            passed.append((path, "editors"))
    assert passed == []


@pytest.mark.parametrize(
    "path",
    [
        *sorted((Path(__file__).parents[3] / "examples").glob("*/cell.toml")),
        *sorted((Path(__file__).parents[3] / "templates/init").glob("*/cell.toml")),
    ],
    ids=lambda p: p.parent.name,
)
def test_the_examples_are_right_for_editors(path: Path) -> None:
    data = tomllib.loads(path.read_text())
    assert [e.message for e in EDITOR.iter_errors(data)] == []


def test_the_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(json_schema.schema())
    assert json.loads(json_schema.text()) == json_schema.schema()


def test_words_are_those_of_the_parts_that_use_them() -> None:
    assert get_args(CommandName) == COMMANDS
    primitive = FILE["primitives"].inner
    robot = FILE["robots"].inner
    assert primitive is not None and robot is not None
    assert set(EFFECTS) < primitive.names("tool") and not set(EFFECTS) & primitive.names("wait")
    assert set(robot["branch"].words) == {"any", *ALL_NAMES}


def test_the_manual_has_all_keys(root: Path) -> None:
    """`python -m helpers.manual` writes them."""
    assert between(root / "docs/cell.md") == listing.markdown()
    robots = (root / "docs/robots.md").read_text()
    for name in ("robots", "motion", "scene", "parts", "places", "frames"):
        inner = FILE[name].inner
        assert inner is not None
        missing = [k.name for k in declared(inner) if k.name not in robots]
        assert missing in ([], ["instance"])  # the page is said in docs/cell.md


def test_the_command_prints_them() -> None:
    done = pn2code("cell", "--keys", "--section", "supervisor")
    assert done.returncode == 0
    assert "reply_timeout_s = 120\n      number above 0 to 1000000, s\n" in done.stdout
    assert pn2code("cell", "--keys").stdout == listing.text().rstrip("\n") + "\n"
    assert pn2code("cell", "--schema").stdout == json_schema.text()
    for words in (
        (),
        ("--keys", "--schema"),
        ("--schema", "--section", "net"),
        ("--keys", "--section", "nets"),
    ):
        assert pn2code("cell", *words).returncode == 2

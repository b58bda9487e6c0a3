"""Each test of this suite can fail: it asserts something, or calls a helper that does.

Read from the syntax trees: a function checks if it has an `assert`, `pytest.raises`, `fail` or `warns`, raises an
AssertionError, runs a process with `check=True`, or calls a function of the tests that checks.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

PYTEST = {"raises", "fail", "warns"}


class Function(NamedTuple):
    """A function of a module, or a method of a class.

    Args:
        name: of its own.
        file: where it is; line: of its `def`.
        is_method: whether it belongs to a class.
        checks: whether it checks something itself.
        called: the functions that it calls by their names.
        asked: the methods that it calls, and functions of modules: what comes after the dot.
    """

    name: str
    file: str
    line: int
    is_method: bool
    checks: bool
    called: frozenset[str]
    asked: frozenset[str]


def functions(tree: ast.Module, file: str) -> Iterator[Function]:
    """All of a module; what is inside a function counts for it."""
    todo: list[tuple[ast.stmt, bool]] = [(node, False) for node in tree.body]
    while todo:
        node, is_method = todo.pop()
        if isinstance(node, ast.ClassDef):
            todo += [(inner, True) for inner in node.body]
        elif isinstance(node, ast.FunctionDef):
            inside = list(ast.walk(node))
            calls = [n.func for n in inside if isinstance(n, ast.Call)]
            yield Function(
                node.name,
                file,
                node.lineno,
                is_method,
                any(map(_checks, inside)),
                frozenset(c.id for c in calls if isinstance(c, ast.Name)),
                frozenset(c.attr for c in calls if isinstance(c, ast.Attribute)),
            )


def _checks(node: ast.AST) -> bool:
    match node:
        case ast.Assert():
            return True
        case ast.Call(func=ast.Attribute(ast.Name("pytest"), name)) if name in PYTEST:
            return True
        case ast.Raise(exc=ast.Name("AssertionError") | ast.Call(func=ast.Name("AssertionError"))):
            return True
        case ast.Call(keywords=keywords):
            return any(
                k.arg == "check" and isinstance(k.value, ast.Constant) and k.value.value is True
                for k in keywords
            )
    return False


def without_check(found: list[Function]) -> list[str]:
    """Where the tests are that check nothing.

    A name means the function of the same file, else those of other files; a name after a dot any method or function. If
    there are several, all of them must check.
    """
    meant: dict[tuple[str, str], list[Function]] = defaultdict(list)
    for f in found:
        meant[".", f.name].append(f)
        if not f.is_method:
            meant[f.file, f.name].append(f)
            meant["", f.name].append(f)

    def callees(f: Function) -> Iterator[list[Function]]:
        for name in f.called:
            yield meant.get((f.file, name)) or meant.get(("", name), [])
        for name in f.asked:
            yield meant.get((".", name), [])

    checking = {f for f in found if f.checks}
    before = -1
    while before != len(checking):
        before = len(checking)
        checking.update(f for f in found if any(c and checking.issuperset(c) for c in callees(f)))
    tests = (f for f in found if f.name.startswith("test_"))
    return [f"{f.file}:{f.line}" for f in tests if f not in checking]


def read(text: str) -> list[Function]:
    return list(functions(ast.parse(text), "test.py"))


def test_each_test_checks_something(root: Path) -> None:
    found: list[Function] = []
    for path in sorted((root / "tests").rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        found.extend(functions(tree, path.relative_to(root).as_posix()))
    assert sum(f.name.startswith("test_") for f in found) > 1000
    assert without_check(found) == []


@pytest.mark.parametrize(
    ("body", "is_fine"),
    [
        ("assert x", True),
        ("with pytest.raises(ValueError): f()", True),
        ("run(x, check=True)", True),
        ("run(x, check=False)", False),
        ("print(x)", False),
        ("helper(x)", True),
        ("twin(x)", True),
        ("x.twin()", False),
        ("x.go()", False),
        ("idle(x)", False),
    ],
)
def test_what_counts(body: str, is_fine: bool) -> None:
    helpers = (
        "def helper(x): deeper(x)\ndef deeper(x): assert x\ndef idle(x): return x\n"
        "def twin(x): assert x\nclass Other:\n    def twin(self): return 3\n    def go(self): return 3\n"
    )
    found = read(f"{helpers}def test_it(x):\n    {body}\n")
    assert (without_check(found) == []) == is_fine


def test_a_name_means_the_function_of_the_same_file() -> None:
    own, other = "def helper(x): assert x\n", "def helper(x): return x\n"
    test = "def test_it(): helper(3)\n"
    for here, there, wrong in ((own, other, []), (other, own, ["test.py:2"])):
        found = [*read(here + test), *functions(ast.parse(there), "other.py")]
        assert without_check(found) == wrong

"""No module needs itself by way of others: imports have no circles, neither at the top of a module nor in a function.

Imports for type checkers alone (`if TYPE_CHECKING:`) load nothing, and do not count. The package `pn2code` itself is
loaded before any of its modules, so that an import of it (for `pn2code.__version__`) is no circle either.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from helpers.statements import blocks


def modules_of(base: Path) -> dict[str, Path]:
    """Name -> file, of all modules below a folder."""
    found = {}
    for path in sorted(base.rglob("*.py")):
        parts = path.relative_to(base).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def loaded(nodes: Iterable[ast.AST]) -> Iterator[ast.Import | ast.ImportFrom]:
    """The imports that are carried out sooner or later."""
    for node in nodes:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        elif isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            yield from loaded(node.orelse)
        else:
            yield from loaded(blocks(node))


def graph(modules: dict[str, Path], root: str) -> dict[str, set[str]]:
    """Module -> the modules that it loads."""
    found: dict[str, set[str]] = {}
    for name, path in modules.items():
        targets: set[str] = set()
        for node in loaded([ast.parse(path.read_text(encoding="utf-8"))]):
            if isinstance(node, ast.Import):
                targets.update(alias.name for alias in node.names)
                continue
            assert node.level == 0, f"{path}: a relative import"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                targets.add(whole if whole in modules else str(node.module))
        found[name] = {t for t in targets if t in modules and t not in (name, root)}
    return found


def test_no_module_needs_itself(root: Path) -> None:
    modules = modules_of(root / "src")
    found = graph(modules, "pn2code")
    assert len(found) > 100
    assert sum(map(len, found.values())) > 1000
    try:
        TopologicalSorter(found).prepare()
    except CycleError as problem:
        pytest.fail("a circle: " + " <- ".join(problem.args[1]))


@pytest.mark.parametrize(
    ("text", "is_circle"),
    [
        ("from top.b import y", True),
        ("def f():\n    from top import b", True),
        ("if TYPE_CHECKING:\n    from top.b import y", False),
        ("if TYPE_CHECKING:\n    pass\nelse:\n    import top.b", True),
        ("import top", False),
    ],
)
def test_what_counts_as_a_circle(text: str, is_circle: bool, tmp_path: Path) -> None:
    package = tmp_path / "top"
    package.mkdir()
    (package / "__init__.py").write_text("from top import a\n")
    (package / "a.py").write_text(text + "\n")
    (package / "b.py").write_text("from top.a import x\n")
    found = graph(modules_of(tmp_path), "top")
    if is_circle:
        with pytest.raises(CycleError):
            TopologicalSorter(found).prepare()
    else:
        TopologicalSorter(found).prepare()

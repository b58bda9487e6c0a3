"""Imports run one way, along the pipeline. Walks the syntax trees of all modules."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

# package -> the packages of ours that it may import
ALLOWED: dict[str, set[str]] = {
    "diagnostics": set(),
    "resources": set(),
    "private_folder": set(),
    "parser_cache": set(),
    "expected": set(),
    "bytecode": set(),
    "frozen": set(),
    "whole_file": set(),
    "real_json": set(),
    "deadline": set(),
    "os_reason": set(),
    "ml": {"diagnostics"},
    "reading": {"diagnostics"},
    "pnml": {"diagnostics", "ml", "reading"},
    "net": {"diagnostics", "ml", "pnml", "reading"},
    "semantics": {"diagnostics", "ml", "net"},
    "structure": {"diagnostics", "ml", "net", "semantics"},
    "conformance": {"diagnostics", "ml", "net", "reading", "semantics", "verify"},
    "cell": {"diagnostics", "ml", "net"},
    "properties": {"diagnostics", "ml", "net", "cell", "expected", "parser_cache", "semantics"},
    "lowering": {"diagnostics", "ml", "net", "cell", "tdl"},
    "robot": {"diagnostics"},
    "tdl": {"diagnostics", "robot", "expected", "parser_cache"},
    "emission": {"diagnostics", "ml", "net", "cell", "lowering", "resources", "tdl"},
    "drawing": {"diagnostics", "net", "reading", "resources", "semantics"},
    "channels": {"diagnostics", "cell"},
    "toolchain": {"diagnostics", "emission"},
    "run": {"diagnostics", "cell", "channels", "emission", "net", "robot", "semantics", "tdl", "toolchain", "report",
            "pipeline"},
    "report": {"cell", "run", "robot", "diagnostics"},
    "pipeline": {"diagnostics", "cell", "emission", "lowering", "net", "reading", "robot", "semantics", "tdl",
                 "verify"},
    "unfold": {"diagnostics", "ml", "net", "semantics"},
    "convert": {"diagnostics", "ml", "net", "reading", "semantics", "unfold", "pnml"},
    "contest": {"diagnostics", "properties", "toolchain", "unfold"},
    "monitors": {"diagnostics", "ml", "net", "reading", "semantics"},
    "simulate": {"diagnostics", "ml", "net", "semantics", "monitors", "cell", "lowering", "emission", "toolchain",
                 "parser_cache"},
    "verify": {"diagnostics", "ml", "net", "semantics", "structure", "cell", "lowering", "emission", "toolchain",
               "resources", "simulate", "drawing", "reading", "unfold", "properties", "channels", "tdl"},
    "conform": {"diagnostics", "cell", "channels", "emission", "ml", "net", "pipeline", "robot", "semantics",
                "simulate", "tdl", "toolchain", "verify"},
    "medium": {"diagnostics", "ml", "net", "cell", "lowering", "semantics", "verify"},
    "verdict": {"diagnostics", "cell", "channels", "lowering", "medium", "ml", "net", "pipeline", "properties", "robot",
                "run", "semantics", "simulate", "tdl", "verify"},
    "api": {"diagnostics", "drawing", "emission", "net", "pipeline", "reading", "semantics", "simulate", "verdict",
            "verify"},
    "__init__": {"api"},
    "__main__": {"start"},
    "start": {"cli"},
    "cli": {"diagnostics", "cell", "channels", "emission", "net", "pipeline", "run", "report", "semantics", "toolchain",
            "robot", "tdl", "ml", "lowering", "bytecode", "reading", "drawing", "simulate", "monitors", "structure",
            "convert", "unfold", "verify", "properties", "conform", "medium", "verdict",
            "contest"},
}  # fmt: skip
EVERYWHERE = {"deadline", "frozen", "os_reason", "private_folder", "real_json", "whole_file"}

# Of `robot`, the script language may know the commands (plain values) only; of the reports, running only the data.
ONLY = {("tdl", "robot"): {"pn2code.robot.commands"}}


def modules(root: Path) -> Iterator[tuple[Path, str]]:
    base = root / "src" / "pn2code"
    for path in sorted(base.rglob("*.py")):
        relative = path.relative_to(base)
        yield path, relative.parts[0] if len(relative.parts) > 1 else relative.stem


def imported(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            if node.module == "pn2code":
                yield from (f"pn2code.{alias.name}" for alias in node.names)


def test_imports_run_one_way(root: Path) -> None:
    wrong = []
    seen = 0
    for path, package in modules(root):
        for name in imported(path):
            parts = name.split(".")
            if parts[0] != "pn2code" or len(parts) < 2:
                continue
            target = parts[1]
            seen += 1
            if target in (package, "__version__", *EVERYWHERE):
                continue
            only = ONLY.get((package, target))
            if target not in ALLOWED.get(package, set()) or (only and name not in only):
                wrong.append(f"{path.relative_to(root)} imports {name}")
    assert seen > 50
    assert not wrong, "\n".join(wrong)


def test_the_token_game_shares_nothing_with_the_compiler(root: Path) -> None:
    """Reachability, not only direct imports: semantics must never load lowering or emission, nor they it."""
    edges: dict[str, set[str]] = {}
    for path, package in modules(root):
        edges.setdefault(package, set()).update(
            parts[1]
            for name in imported(path)
            if (parts := name.split("."))[0] == "pn2code" and len(parts) > 1
        )

    def reach(start: str) -> set[str]:
        found, todo = set(), [start]
        while todo:
            for target in edges.get(todo.pop(), set()) - found:
                found.add(target)
                todo.append(target)
        return found

    assert not reach("semantics") & {"lowering", "emission"}
    assert "semantics" not in reach("lowering") | reach("emission")

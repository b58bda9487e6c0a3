"""Imports run one way, along the pipeline. Walks the syntax trees of all modules."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from helpers.statements import statements

# package -> the packages of ours that it may import
ALLOWED: dict[str, set[str]] = {
    "base": set(),
    "cell_file": set(),
    "diagnostics": set(),
    "ir": {"diagnostics"},
    "ml": {"diagnostics"},
    "reading": {"diagnostics"},
    "robot": {"cell_file", "diagnostics"},
    "pnml": {"diagnostics", "ml", "reading"},
    "text_form": {"diagnostics", "reading"},
    "tdl": {"diagnostics", "robot"},
    "net": {"diagnostics", "ml", "pnml", "reading", "text_form"},
    "cell": {"cell_file", "diagnostics", "ml", "net", "robot"},
    "arms": {"cell", "diagnostics", "robot"},
    "semantics": {"diagnostics", "ml", "net"},
    "channels": {"cell"},
    "primitive_calls": {"cell", "ml", "robot", "semantics"},
    "drawing": {"diagnostics", "net", "reading", "semantics"},
    "input_files": {"cell", "channels", "diagnostics", "ml", "net", "semantics"},
    "lowering": {"cell", "diagnostics", "ir", "ml", "net"},
    "monitors": {"diagnostics", "ml", "net", "reading", "semantics"},
    "properties": {"cell", "cell_file", "diagnostics", "ml", "net", "semantics"},
    "robot_scripts": {"cell", "diagnostics", "ml", "net", "tdl"},
    "registers": {"cell", "diagnostics", "ml", "net", "robot_scripts"},
    "structure": {"diagnostics", "ml", "net", "semantics"},
    "trace": {"cell", "diagnostics", "ml", "net", "semantics"},
    "unfold": {"diagnostics", "ml", "net", "semantics"},
    "convert": {"diagnostics", "drawing", "ml", "net", "pnml", "reading", "semantics", "text_form", "unfold"},
    "emission": {"cell", "diagnostics", "ir", "lowering", "net", "robot_scripts", "tdl"},
    "toolchain": {"diagnostics", "emission"},
    "contest": {"diagnostics", "ml", "net", "properties", "semantics", "symbolic", "toolchain", "unfold"},
    "simulate": {"cell", "diagnostics", "emission", "lowering", "monitors", "net", "semantics", "toolchain", "trace"},
    "verify": {"cell", "channels", "diagnostics", "drawing", "emission", "ir", "lowering", "ml", "net",
        "primitive_calls", "properties", "reading", "robot", "robot_scripts", "semantics", "simulate", "structure",
        "tdl", "toolchain", "trace", "unfold"},
    "channel_model": {"cell", "diagnostics", "lowering", "ml", "net", "properties", "semantics", "verify"},
    "engine_comparison": {"diagnostics", "ml", "net", "reading", "semantics", "trace", "verify"},
    "new_cell": {"cell", "cell_file", "diagnostics"},
    "division": {"cell", "diagnostics", "net", "robot"},
    "pipeline": {"arms", "cell", "diagnostics", "division", "emission", "input_files", "lowering", "net",
        "properties", "registers", "robot_scripts", "semantics", "verify"},
    "conform": {"cell", "channels", "diagnostics", "emission", "input_files", "ml", "net", "pipeline",
        "primitive_calls", "robot", "semantics", "simulate", "tdl", "toolchain", "trace", "verify"},
    "__init__": {"api"},
    "__main__": {"start"},
    "api": {"diagnostics", "drawing", "emission", "net", "pipeline", "reading", "semantics", "simulate", "verdict",
        "verify"},
    "report": {"cell", "channels", "robot", "run"},
    "run": {"cell", "channels", "diagnostics", "emission", "input_files", "net", "pipeline", "properties", "report",
        "robot", "tdl", "toolchain", "trace"},
    "replay": {"cell", "channels", "drawing", "emission", "net", "reading", "robot", "run", "semantics", "trace"},
    "verdict": {"arms", "cell", "channel_model", "channels", "contest", "diagnostics", "division", "input_files", "ml",
        "net", "pipeline", "properties", "registers", "robot", "robot_scripts", "run", "semantics", "tdl", "trace",
        "unfold", "verify"},
    "web": set(),
    "play": {"cell", "diagnostics", "drawing", "ml", "monitors", "net", "properties", "reading", "registers", "replay",
        "run", "semantics", "simulate", "trace", "verdict", "verify", "web"},
    "live": {"cell", "channels", "diagnostics", "emission", "net", "pipeline", "properties", "reading", "replay",
        "robot", "run", "semantics", "trace", "web"},
    "geometry": {"cell", "diagnostics", "ml", "net", "primitive_calls", "robot", "semantics", "trace", "verdict",
        "verify"},
    "timing": {"cell", "channel_model", "diagnostics", "geometry", "net", "properties", "robot", "semantics", "trace",
        "verdict", "verify"},
    "dossier": {"arms", "cell", "diagnostics", "net", "robot", "semantics", "toolchain", "verify"},
    "cli": {"cell", "cell_file", "channels", "conform", "contest", "convert", "diagnostics", "division", "dossier",
        "drawing", "emission", "geometry", "input_files", "ir", "live", "lowering", "ml", "net", "new_cell", "pipeline",
        "play", "properties", "reading", "registers", "replay", "report", "robot", "robot_scripts", "run", "semantics",
        "simulate", "structure", "tdl", "text_form", "timing", "trace", "unfold", "verdict", "verify", "web"},
    "start": {"cli", "contest"},
}  # fmt: skip
EVERYWHERE = {"base"}

# Of `robot`, the script language and the proofs may know the commands (plain values) only.
ONLY = {
    ("cell", "robot"): {"pn2code.robot.commands"},
    ("start", "contest"): {"pn2code.contest", "pn2code.contest.watchdog"},
    ("tdl", "robot"): {"pn2code.robot.approach", "pn2code.robot.commands"},
    ("verify", "robot"): {"pn2code.robot.commands"},
    ("primitive_calls", "robot"): {"pn2code.robot.approach", "pn2code.robot.commands"},
}


def modules(root: Path) -> Iterator[tuple[Path, str]]:
    base = root / "src" / "pn2code"
    for path in sorted(base.rglob("*.py")):
        relative = path.relative_to(base)
        yield path, relative.parts[0] if len(relative.parts) > 1 else relative.stem


@cache
def imported(path: Path) -> list[str]:
    found = []
    for node in statements(ast.parse(path.read_text(encoding="utf-8")).body):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.append(node.module)
            if node.module == "pn2code":
                found += [f"pn2code.{alias.name}" for alias in node.names]
    return found


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

    assert not reach("semantics") & {"ir", "lowering", "emission"}
    assert "semantics" not in reach("lowering") | reach("emission")

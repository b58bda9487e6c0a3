"""What a path on the command line means: which net, which cell."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pn2code.cell import codes
from pn2code.diagnostics import Diagnostics, Origin

if TYPE_CHECKING:
    from pn2code.cell.config import CellConfig


def locate(
    path: Path, d: Diagnostics, *, layout: str | None = None
) -> tuple[Path, CellConfig | None] | None:
    """The net and the cell that a path means: a `.cpn` file (with a `cell.toml` beside it, or not),
    a `cell.toml`, a folder with one, or a folder whose only net it is."""
    if not path.exists():
        d.error(
            codes.CELL_MISSING,
            f"there is no file or folder `{path}`",
            Origin(str(path)),
            hint="check the path",
        )
        return None
    if path.is_dir() and not (path / "cell.toml").exists():
        return _only_net(path, d)
    beside = path.parent / "cell.toml"
    if path.is_file() and path.suffix != ".toml" and not beside.is_file():
        return path, None
    from pn2code.cell.load import load  # most nets have no cell

    if path.is_dir() or path.suffix == ".toml":
        config = load(path, d, layout=layout)
        return (config.net_path, config) if config and _has_net(config, d) else None
    if not beside.is_file():
        return path, None
    config = load(beside, d, layout=layout)
    if config is None:
        return None
    # A cell.toml describes one net; others in the same folder stand for themselves.
    return (path, config) if config.net_path.resolve() == path.resolve() else (path, None)


def _only_net(folder: Path, d: Diagnostics) -> tuple[Path, None] | None:
    """The net of a folder that has no `cell.toml`: its only one."""
    nets = _nets(folder)
    if len(nets) == 1:
        return nets[0], None
    names = ", ".join(f"`{p.name}`" for p in nets[:5]) + (", ..." if len(nets) > 5 else "")
    d.error(
        codes.CELL_MISSING,
        f"there is no file `{folder / 'cell.toml'}`, and {f'{len(nets)} nets' if nets else 'no net'} in the folder",
        Origin(str(folder)),
        hint=f"give one of the nets ({names})"
        if nets
        else "give a folder with a cell.toml, or a .cpn file; docs/cell.md describes cell.toml",
    )
    return None


def _nets(folder: Path) -> list[Path]:
    return sorted(
        p for p in folder.iterdir() if p.suffix in (".cpn", ".cpnt", ".pnml") and p.is_file()
    )


def _has_net(config: CellConfig, d: Diagnostics) -> bool:
    """Whether the file that `[net] file` names is there."""
    if config.net_path.exists():
        return True
    near = ", ".join(f"`{p.name}`" for p in _nets(config.folder)[:5])
    d.error(
        codes.CELL_MISSING,
        f"there is no net `{config.net_path}`",
        config.locator.origin("net", "file"),
        hint=f"`file` of section [net] names a file in the folder of cell.toml, which has {near or 'no net'}",
    )
    return False

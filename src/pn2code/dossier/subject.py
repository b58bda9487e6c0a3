"""The files that a report is about: which ones, their hashes, and whether they stay as they are.

subject = Subject.of(folder, [*used(path, config), path])
...                                             # each command of the report reads them again
subject.changed(Subject.of(folder, paths))      # ("cell.toml",): what was answered is not about the same files
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics
from pn2code.dossier import hashes

Stamp = tuple[int, int, int]
"""Which file it is, and when its content and anything about it were changed."""


@frozen
class Subject:
    """Files at some time.

    Args:
        rows: name and SHA-256 of each, sorted.
        stamps: of each, by name.
    """

    rows: list[tuple[str, str]]
    stamps: dict[str, Stamp]

    @staticmethod
    def of(folder: Path, paths: Iterable[Path]) -> Subject:
        """Files as they are now, with names as seen from a folder; what is no file is passed over."""
        found = [p for p in paths if p.is_file()]
        stamps = {hashes.name_of(folder, p): _stamp(p) for p in found}
        return Subject(hashes.of_files(folder, found), stamps)

    def changed(self, later: Subject) -> tuple[str, ...]:
        """Names of files that were written, came or went meanwhile, also if they are as they were now."""
        before, after = ({(*row, x.stamps[row[0]]) for row in x.rows} for x in (self, later))
        return tuple(sorted({name for name, _, _ in before ^ after}))


def _stamp(path: Path) -> Stamp:
    status = path.stat()
    return status.st_ino, status.st_mtime_ns, status.st_ctime_ns


def used(path: Path, config: CellConfig | None) -> list[Path]:
    """Files that a net uses, and models and meshes of what stands in a cell; what is wrong with them others report."""
    from pn2code.net import front  # these take longer to load than all the rest
    from pn2code.semantics.evaluation.constants import compute

    values = config.values if config is not None else {}
    net = front.examine(path, Diagnostics(), values, compute=compute).flat
    found = [Path(name) for name, _ in net.program.used] if net is not None else []
    if config is not None:
        from pn2code.arms import Arms
        from pn2code.robot.model import MODELS

        arms = Arms.of(config, Diagnostics())
        found += [p for p in (arms.files if arms is not None else ()) if MODELS not in p.parents]
    return found

"""Generated programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from pn2code import pipeline
from pn2code.api.errors import refuse
from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostic, Diagnostics
from pn2code.emission.write import OutputFolderError, write

__all__ = ["OutputFolderError", "Programs", "generate"]


@frozen
class Programs:
    """The C supervisor, and a script for each robot.

    Args:
        files: path in the output folder -> text.
        digest: of the net and of what the cell contributes: it stands in the head of each file.
        warnings: what was found that is no error.
    """

    files: Mapping[str, str]
    digest: str
    warnings: tuple[Diagnostic, ...]
    _made: pipeline.Generated

    def write(self, folder: str | Path) -> int:
        """Writes the files that have changed, as `pn2code generate -o` does; how many these were.

        Raises:
            OutputFolderError: the folder cannot be written, or is not one that pn2code has made; the message says why.
        """
        return len(write(Path(folder), self._made.files).changed)


def generate(
    path: str | Path,
    *,
    values: Mapping[str, str] | None = None,
    layout: str | None = None,
    inputs: str | Path | None = None,
) -> Programs:
    """The programs of a net or cell, in memory.

    Args:
        path: as for `load`.
        values: replace `val`s of the net.
        layout: a layout of the cell; None: the one that cell.toml names.
        inputs: the input files with which the supervisor is checked, as for `load`.

    Raises:
        NetError: the net or the cell has errors, or what it does cannot be a program.
    """
    d = Diagnostics()
    given = None if inputs is None else Path(inputs)
    made = pipeline.generate(Path(path), d, values=values, layout=layout, inputs=given)
    if made is None:
        raise refuse(d)
    files = MappingProxyType({f.path: f.text for f in made.files})
    return Programs(files, made.digest, tuple(d.sorted()), made)

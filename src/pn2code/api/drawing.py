"""Pictures of nets and markings, as notebooks show them."""

from __future__ import annotations

from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.whole_file import whole_file


@frozen
class Drawing:
    """A picture; a notebook shows it by itself.

    Args:
        svg: the picture as a whole SVG file.
    """

    svg: str

    def save(self, path: str | Path) -> None:
        """Writes it to a file.

        Raises:
            OSError: it cannot be written; a file that was there before is as it was.
        """
        with whole_file(Path(path)) as beside:
            beside.write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg

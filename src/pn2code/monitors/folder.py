"""Where monitors write their files: below the folder that the user allows, or nowhere."""

from __future__ import annotations

from contextlib import suppress

from pn2code.semantics.evaluation.files import FileProblem, Files, OutStream


class Folder:
    """The files that monitors write in one run.

    Args:
        files: the allowed folder; without one everything is dropped.
        below: where they are put below its folder `output`; "": there.
    """

    def __init__(self, files: Files, below: str = "") -> None:
        self._files = files
        self._below = f"output/{below}/" if below else "output/"
        self._open: dict[str, OutStream] = {}

    def append(self, name: str, text: str) -> None:
        """Adds to a file, which is emptied when it is first written to.

        Raises:
            FileProblem: it cannot be written.
            OSError: the same, while it was written.
        """
        name = self._below + name.removeprefix("output/")
        if name not in self._open:
            parts = name.split("/")[:-1]
            for i in range(len(parts)):
                with suppress(
                    FileProblem
                ):  # it is there; if it cannot be made, the file cannot either
                    self._files.make_folder("/".join(parts[: i + 1]))
            self._open[name] = self._files.open_out(name)
        self._open[name].write(text)

    def close(self) -> None:
        """Closes all files."""
        for stream in self._open.values():
            stream.close()
        self._open.clear()

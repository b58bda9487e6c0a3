"""Where monitors write their files: below the folder that the user allows, or nowhere."""

from __future__ import annotations

from contextlib import suppress

from pn2code.semantics.evaluation.files import FileProblem, Files, OutStream

OUTPUT = "output"
"""The folder of CPN Tools for what monitors write."""


class Folder:
    """The files that monitors write in one run.

    Args:
        files: the allowed folder; without one everything is dropped.
        output: where they are put below it.
    """

    def __init__(self, files: Files, output: str = OUTPUT) -> None:
        self._files = files
        self._output = output
        self._open: dict[str, OutStream] = {}

    def path(self, name: str) -> str:
        """Where a file is in the allowed folder."""
        return f"{self._output}/{name}"

    def append(self, name: str, text: str) -> None:
        """Adds to a file, which is emptied when it is first written to.

        Raises:
            FileProblem: it cannot be written.
            OSError: the same, while it was written.
        """
        if name not in self._open:
            path = self.path(name)
            parts = path.split("/")[:-1]
            for i in range(len(parts)):
                with suppress(
                    FileProblem
                ):  # it is there; if it cannot be made, the file cannot either
                    self._files.make_folder("/".join(parts[: i + 1]))
            self._open[name] = self._files.open_out(path)
        self._open[name].write(text)

    def close(self) -> None:
        """Closes all files."""
        for stream in self._open.values():
            stream.close()
        self._open.clear()

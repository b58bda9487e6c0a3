"""What a report of `verify` is about: files with their digests, so that a reader knows later whether they are these.

subject = Subject.of(opened, path, {"n": "3"}, beside)
subject.rows            # (("Net", "cell.cpn", "9f86d0.."), ...)
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from pn2code import pipeline
from pn2code.base.deadline import NEVER, Deadline, TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.base.kept_answers import KeptAnswers
from pn2code.base.sha256 import sha256_of
from pn2code.diagnostics import Diagnostics
from pn2code.emission.output import OutputFile
from pn2code.verdict.opened import OpenNet

RUNTIME = "runtime/"
"""Generated files below it are the same for all nets."""


@frozen
class Subject:
    """What was looked at.

    Args:
        rows: what it is, its name, and its SHA-256 or value.
        remark: why there are no generated files; "": there are, or the net is no cell.
    """

    rows: tuple[tuple[str, str, str], ...]
    remark: str = ""

    @staticmethod
    def of(
        opened: OpenNet,
        path: Path,
        values: Mapping[str, str],
        properties: Sequence[Path],
        *,
        int_bits: int,
        complete: bool,
        deadline: Deadline = NEVER,
    ) -> Subject:
        """Of a net or cell; the programs of a cell are generated for it, in memory.

        Args:
            opened: the net.
            path: as the user gave it.
            values: replace `val`s of the net.
            properties: files of properties.
            int_bits: width of `int`.
            complete: whether all markings were seen; if not, nothing is generated, for that would look at them again.
            deadline: when generating has to be over.
        """
        rows = [("Net", opened.flat.file, opened.flat.sha256)]
        if opened.config is not None:
            rows.append(("Cell", str(opened.config.path), _file_digest(opened.config.path)))
            config = opened.config
            inputs = [config.input_path(entry, opened.inputs) for entry in config.inputs]
            rows += [("Input", str(file), _file_digest(file)) for file in inputs if file.is_file()]
        rows += [("Properties", str(file), _file_digest(file)) for file in properties]
        rows += [("Value", name, value) for name, value in sorted(values.items())]
        rows.append(("Integers", "width of `int`", f"{int_bits} bits"))
        if opened.config is None:
            return Subject(tuple(rows))
        if not complete:
            return Subject(tuple(rows), "No programs were generated: not all markings were seen.")
        d = Diagnostics()
        try:
            with deadline.enforced():
                made = pipeline.generate(
                    path,
                    d,
                    values=values,
                    int_bits=int_bits,
                    inputs=opened.inputs,
                    kept=KeptAnswers.of_user(),
                )
        except TimeIsOverError:
            return Subject(tuple(rows), "No programs were generated: the time was up.")
        if made is None:
            why = d.errors[0].message if d.errors else "it cannot be generated"
            return Subject(tuple(rows), f"`generate` refuses the cell: {why}.")
        rows.append(("Generated", "digest in the head of each file", made.digest))
        return Subject((*rows, *_generated(made.files)))


def _generated(files: Sequence[OutputFile]) -> Iterator[tuple[str, str, str]]:
    for file in files:
        if not file.path.startswith(RUNTIME):
            yield "Generated", file.path, _digest(file.text)
    common = [f for f in files if f.path.startswith(RUNTIME)]
    lines = "".join(f"{_digest(f.text)}  {f.path}\n" for f in common)
    yield "Generated", f"{RUNTIME} ({len(common)} files, as a list by sha256sum)", _digest(lines)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _file_digest(file: Path) -> str:
    try:
        return sha256_of(file)
    except OSError:
        return ""

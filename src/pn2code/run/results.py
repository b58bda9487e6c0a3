"""What a run gives, and the files with it in the output folder."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.base.os_reason import os_reason
from pn2code.cell.names import counted
from pn2code.emission.write import OutputFolderError
from pn2code.report.messages import messages_tsv
from pn2code.report.rows import rows_tsv
from pn2code.report.summary import summarise
from pn2code.run.prepare import Prepared
from pn2code.run.record import RunRecord
from pn2code.trace.growing import trace_text


@frozen
class RunResult:
    """What a run gave; the files are in the output folder."""

    record: RunRecord
    summary: dict[str, Any]
    prepared: Prepared


def summary_of(record: RunRecord, prepared: Prepared) -> dict[str, Any]:
    """The figures of a run."""
    occurrences = counted(prepared.generated.partition.net, prepared.config)
    return summarise(record, prepared.config.report, _names_of_programs(prepared), occurrences)


def _names_of_programs(prepared: Prepared) -> tuple[str, ...]:
    return tuple(r.name for r in prepared.config.programs)


def write_results(
    record: RunRecord, summary: dict[str, Any], prepared: Prepared, out: Path
) -> None:
    """Trace, rows, messages and summary of a run."""
    name = prepared.generated.partition.net.name
    texts = {
        f"{name}.trace.jsonl": trace_text(record.header, record.events),
        "rows.tsv": rows_tsv(record.messages, prepared.config.report.rows),
        "messages.tsv": messages_tsv(prepared.generated.partition, record.traffic),
        "summary.json": json.dumps(summary, indent=1, ensure_ascii=False) + "\n",
    }
    partial = {file: out / f".{file}.tmp" for file in texts}
    try:
        for file, text in texts.items():
            partial[file].write_text(text, encoding="utf-8")
        for file, path in partial.items():
            path.replace(out / file)
    except OSError as problem:
        raise OutputFolderError(
            f"cannot write the results in `{out}`: {os_reason(problem)}"
        ) from problem
    finally:
        for path in partial.values():
            with suppress(OSError):
                path.unlink(missing_ok=True)

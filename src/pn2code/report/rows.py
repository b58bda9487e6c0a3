"""`rows.tsv`: the rows that the supervisor sent, in the form of the paper's Table 2."""

from __future__ import annotations

from pn2code.run.record import MessageRecord, fixed4, merged_rows


def rows_tsv(messages: list[MessageRecord], channels: tuple[str, ...]) -> str:
    """Row number, then the numbers of each channel, four decimals, tab-separated, one row a line."""
    lines = [
        "\t".join([str(number), *map(fixed4, row)])
        for number, row in enumerate(merged_rows(messages, channels), 1)
    ]
    return "".join(line + "\n" for line in lines)

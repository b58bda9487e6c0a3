"""`messages.tsv`: all messages of a run, as robots and devices took and wrote them."""

from __future__ import annotations

from pathlib import PurePath

from pn2code.cell.partition import Partition
from pn2code.cell.scalars import message_scalars
from pn2code.channels.scalars import format_scalars
from pn2code.run.record import MessageRecord

HEAD = ("seconds", "channel", "from", "to", "what", "values")


def messages_tsv(partition: Partition, traffic: list[tuple[str, MessageRecord]]) -> str:
    """A line for each message that a robot or device took, and for each that it wrote, in order.

    Tab-separated; the values are those of the first line of the file that carries the message.

    Args:
        partition: the cell.
        traffic: each message with what was done: "taken" or "written".
    """
    channels = {PurePath(c.file).stem: c for c in partition.channels}
    rows = ["\t".join(HEAD)]
    for what, m in traffic:
        channel = channels[m.channel]
        names = [partition.owners[i].name for i in (channel.writer, channel.reader)]
        scalars = message_scalars(partition.net.places[channel.place].colset) or ()
        text = format_scalars(scalars, m.values) or " ".join(map(str, m.values))
        rows.append("\t".join([f"{m.t:.6f}", m.channel, *names, what, text]))
    return "".join(f"{row}\n" for row in rows)

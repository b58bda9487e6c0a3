"""Messages as they are seen in the shared files: what came, what was not seen, and what cannot be taken.

    observed = Observed(specs, session)
    for row in observed.look(1.25, {"flag1_interno": "1\\n# 4 9f3ac01d 5efc4210\\n"}):
        row.channel, row.text

Whoever only looks sees a message while it lies there. How often a file was replaced, and the numbers of messages
(line 2), tell how many lay there unseen: a channel is empty and holds a message in turn.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.channels import ChannelSpec, Refused, is_empty
from pn2code.channels.message import parse

GRACE_S = 0.5
"""A file that cannot be taken for a message may be one that is being written (I6)."""
_SEQ = re.compile(r"#[ \t\r]+([0-9]{1,18})[ \t\r]+(\S{1,15})[ \t\r]")
LONGEST = 300


@frozen
class SeenMessage:
    """A message that was seen: when (s), where, and its first line."""

    t: float
    channel: str
    text: str


class Observed:
    """What has been seen in one session.

    Args:
        specs: the channels.
        session: the supervisor's.

    Attributes:
        knows_turns: whether each replacement of a file is told.
    """

    def __init__(self, specs: Sequence[ChannelSpec], session: str) -> None:
        self._specs = {spec.name: spec for spec in specs}
        self._session = session
        self._before: dict[str, str | None] = {}
        self._seq: dict[str, int] = {}
        self._odd: dict[str, tuple[str, float]] = {}
        self._said: set[tuple[str, str]] = set()
        self._turns: dict[str, int] = {}
        self._held: dict[str, bool] = {}
        self._seen: Counter[str] = Counter()
        self._unseen: Counter[str] = Counter()
        self.knows_turns = False

    @property
    def seen(self) -> int:
        """How many messages were seen."""
        return sum(self._seen.values())

    @property
    def missed(self) -> int:
        """How many were not, as far as anything tells."""
        return sum(self._unseen.values())

    def arrivals(self) -> dict[str, int]:
        """How many messages have come into each channel, seen or not."""
        return {name: self._seen[name] + self._unseen[name] for name in self._specs}

    def begin(self, texts: Mapping[str, str | None], *, knows_turns: bool) -> None:
        """What the files hold when the first turn is counted."""
        self.knows_turns = knows_turns
        self._held = {name: bool(text) and not is_empty(text or "") for name, text in texts.items()}

    def turned(self, name: str, times: int) -> None:
        """A channel's file has been replaced so often; to be called before `look`."""
        self._turns[name] = self._turns.get(name, 0) + times

    def look(self, t: float, texts: Mapping[str, str | None]) -> Iterator[SeenMessage]:
        """The messages that have come since the last look."""
        for name, text in texts.items():
            if text == self._before.get(name, ""):
                continue
            self._before[name] = text
            if text is None or is_empty(text):
                continue
            found = _SEQ.match(text.partition("\n")[2])
            if found is not None and found[2] != self._session:
                continue  # of an older session: the supervisor will throw it away
            if found is not None:
                seq = int(found[1])
                self._seq[name] = seq
            self._seen[name] += 1
            yield SeenMessage(t, name, text.partition("\n")[0][:LONGEST].strip())

    def count(self) -> None:
        """After a look: how many messages came and went since the beginning that no look has seen."""
        for name in self._specs:
            came = self._seq.get(name, 0)
            if self.knows_turns:
                had = self._held.get(name, False)
                turns = self._turns.get(name, 0)
                came = max(came, turns // 2 + 1 if had else (turns + 1) // 2)
            self._unseen[name] = max(self._unseen[name], came - self._seen[name])

    def oddities(self, t: float) -> Iterator[tuple[str, str]]:
        """Files that can be taken for no message, and not only for a moment: whose reader it is, and what is wrong."""
        for name, spec in self._specs.items():
            why = self._why_odd(spec, self._before.get(name, "0\n"))
            known, since = self._odd.get(name, ("", t))
            if why != known:
                self._odd[name] = (why, t)
            elif why and t - since >= GRACE_S and (name, why) not in self._said:
                self._said.add((name, why))
                yield spec.reader, f"{spec.file}: {why}"

    def _why_odd(self, spec: ChannelSpec, text: str | None) -> str:
        if text is None:
            return "the file is missing"
        found = parse(spec, text, session=self._session, consumed=self._seq.get(spec.name, 1) - 1)
        return found.text if isinstance(found, Refused) else ""

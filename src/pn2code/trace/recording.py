"""Recordings of runs by the real CPN Tools engine: what such a file says.

    {"steps": [{"step": 1, "time": "0", "page": "Top", "instance": 1, "transition": "Send_Packet", "id": "ID7",
                "binding": {"n": "1", "p": "\\"Modellin\\""}}, ...],
     "final_time": "7", "final_marking": [{"id": "ID4", "instance": 1, "marking": "1`3@7"}, ...]}

Names are as the engine writes them: blanks and the like are `_`, a second transition of one name has `_u1` behind it, a
name that begins with a digit an `N` before it. The XML id of the transition may be left out; if given, it decides.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.net.engine_names import engine_name
from pn2code.net.flat import FlatNet, FlatTransition


class NotARecording(ValueError):
    """The data have another form; the message says which part."""


@frozen
class RecordedStep:
    """An occurrence: all as text but the number of the page instance (0: not given); `id` is "" if not given."""

    time: str
    page: str
    instance: int
    transition: str
    binding: Mapping[str, str]
    id: str = ""


@frozen
class Recording:
    """A run.

    Args:
        steps: what occurred.
        final_time: "" where it is not said.
        final_marking: (place id, instance number) -> marking text.
        stopped_by_error: the exception with which the engine stopped, "" if it did not.
    """

    steps: tuple[RecordedStep, ...]
    final_time: str
    final_marking: Mapping[tuple[str, int], str]
    stopped_by_error: str


def recording(data: Any) -> Recording:
    """The recording that JSON data are.

    Raises:
        NotARecording: they are not.
    """
    if isinstance(data, list):
        data = {"steps": data}
    if not isinstance(data, dict) or not isinstance(data.get("steps"), list):
        raise NotARecording("it is neither a trace nor a recording: there is no list `steps`")
    return Recording(
        steps=tuple(_step(n, step) for n, step in enumerate(data["steps"], 1)),
        final_time=_text(data.get("final_time")),
        final_marking=dict(_final(data.get("final_marking") or [])),
        stopped_by_error=_text(data.get("stopped_by_error")),
    )


def _text(data: Any) -> str:
    return "" if data is None else str(data)


def _step(number: int, data: Any) -> RecordedStep:
    if not isinstance(data, dict) or not isinstance(data.get("transition"), str):
        raise NotARecording(f"step {number} has no `transition`")
    binding = data.get("binding") or {}
    if not isinstance(binding, dict) or not all(isinstance(x, str) for x in binding.values()):
        raise NotARecording(f"the binding of step {number} is not an object of CPN ML texts")
    if not isinstance(data.get("time", ""), str | int | float | None):
        raise NotARecording(f"the `time` of step {number} is not a text or number")
    instance = data.get("instance", 0)
    if isinstance(instance, bool) or not re.fullmatch(r"[0-9]+", str(instance)):
        raise NotARecording(f"the instance of step {number} is not a number")
    return RecordedStep(
        time=_text(data.get("time")),
        page=_text(data.get("page")),
        instance=int(instance),
        transition=data["transition"],
        binding=binding,
        id=_text(data.get("id")),
    )


def _final(data: Any) -> Iterator[tuple[tuple[str, int], str]]:
    if not isinstance(data, list):
        raise NotARecording("`final_marking` is not a list")
    for entry in data:
        if not isinstance(entry, dict) or not {"id", "marking"} <= set(entry):
            raise NotARecording("an entry of `final_marking` lacks `id` or `marking`")
        instance = entry.get("instance", 1)
        if isinstance(instance, bool) or not isinstance(instance, int):
            raise NotARecording("the `instance` of an entry of `final_marking` is not a number")
        yield (str(entry["id"]), instance), str(entry["marking"])


# --- names -----------------------------------------------------------------------------------------


def _bare(name: str) -> str:
    """Without what the engine adds to make names unique and legal."""
    name = re.sub(r"_u[0-9]+$", "", name)
    name = re.sub(r"^N(?=[0-9]|id)", "", name)
    return re.sub("_+", "_", name).strip("_")


class TransitionNames:
    """Finds the transitions that a recorded step may mean."""

    def __init__(self, net: FlatNet) -> None:
        self._found: dict[str, list[FlatTransition]] = {}
        self._by_id: dict[str, list[FlatTransition]] = {}
        for t in net.transitions:
            self._by_id.setdefault(t.id, []).append(t)
            for name in dict.fromkeys((_bare(engine_name(t.short)), t.short, t.id)):
                self._found.setdefault(name, []).append(t)

    def candidates(self, step: RecordedStep) -> list[FlatTransition]:
        """All with that id, or else that name on that page, and on that instance."""
        if step.id in self._by_id:
            return [t for t in self._by_id[step.id] if step.instance in (0, t.instance_number)]
        named = self._found.get(_bare(step.transition)) or self._found.get(step.transition, [])
        page = _bare(step.page)
        there = [
            t for t in named if step.page in ("", t.page) or _bare(engine_name(t.page)) == page
        ]
        there = there or [t for t in named if not engine_name(t.page)]
        return [t for t in there if step.instance in (0, t.instance_number)]

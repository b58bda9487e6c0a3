"""Place/transition nets read from PNML straight into tables, without positions, names or origins.

    tables = tables_of(path)              # None: the front end is to read the file

The front end knows where everything stands, so that it can say what is wrong with a net. Of a net of a hundred thousand
transitions it needs a minute, of which this is a thirtieth. It takes only what is plain: whatever is unusual, or wrong,
is left to the front end, which says so.
"""

from __future__ import annotations

import gc
import re
from collections.abc import Callable
from pathlib import Path
from xml.parsers import expat

from pn2code.contest.tables import Tables

_TYPES = ("ptnet", "ptNet", "PTNet")
_DIGITS = re.compile(r"[0-9]{1,18}")
"""Of a number. The engine reads smaller ones (`Tables.fits`); equations and reductions need no limit."""
_SKIPPED = frozenset({"name", "graphics", "toolspecific"})
_CHILDREN = {
    "": frozenset({"pnml"}),
    "pnml": frozenset({"net"}),
    "net": frozenset({"page", "place", "transition", "arc"}),
    "page": frozenset(
        {"page", "place", "transition", "arc", "referencePlace", "referenceTransition"}
    ),
    "place": frozenset({"initialMarking"}),
    "transition": frozenset[str](),
    "referencePlace": frozenset[str](),
    "referenceTransition": frozenset[str](),
    "arc": frozenset({"inscription", "type"}),
    "type": frozenset[str](),
    "initialMarking": frozenset({"text"}),
    "inscription": frozenset({"text"}),
    "text": frozenset[str](),
}
"""Element -> what is understood inside it."""
_NORMAL = ("", "normal")
"""Kinds of arcs that move tokens and do nothing else."""
_DEEPEST = 50
"""Pages inside one another; the front end does not look into deeper ones."""


def tables_of(path: Path) -> Tables | None:
    """The net of a file; None if anything in it is not plain."""
    was_enabled = gc.isenabled()
    gc.disable()  # nothing is given back before all is read: looking for it would take a third of the time
    try:
        reader = _Reader()
        with path.open("rb") as stream:
            reader.parser.ParseFile(stream)
        return reader.tables()
    except (_UnusualError, expat.ExpatError, LookupError, ValueError, OSError):
        return None
    finally:
        if was_enabled:
            gc.enable()


class _UnusualError(Exception):
    """Something that the front end has to look at."""


class _Reader:
    def __init__(self) -> None:
        self.place: dict[str, int] = {}
        self.transition: dict[str, int] = {}
        self.used: set[str] = set()
        self.initial: list[int] = []
        self.arcs: list[tuple[str, str, int]] = []
        self.references: dict[str, tuple[str, str]] = {}
        """Reference node -> its element, and what it stands for, which may be another one."""
        self.nets = 0
        self.pages = 0
        """That are open."""
        self.within = [""]
        self.skipped = 0
        self.source = self.target = ""
        self.number = 1
        self.is_read = False
        self.text: list[str] = []
        p = self.parser = expat.ParserCreate()
        p.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
        p.buffer_text = True
        p.StartElementHandler = self._start
        p.EndElementHandler = self._end
        p.StartDoctypeDeclHandler = _refuse
        p.ExternalEntityRefHandler = _refuse

    def tables(self) -> Tables:
        """What was read."""
        pre: list[dict[int, int]] = [{} for _ in self.transition]
        post: list[dict[int, int]] = [{} for _ in self.transition]
        if self.nets != 1:
            raise _UnusualError
        place, transition = self._with_references()
        for source, target, weight in self.arcs:
            if source in place:
                arcs, p = pre[transition[target]], place[source]
            else:
                arcs, p = post[transition[source]], place[target]
            arcs[p] = arcs.get(p, 0) + weight
        return Tables(
            tuple(self.initial),
            tuple(pre),
            tuple(post),
            {name: (i,) for name, i in self.place.items()},
            {name: (i,) for name, i in self.transition.items()},
        )

    def _with_references(self) -> tuple[dict[str, int], dict[str, int]]:
        """The numbers of places and of transitions, by their ids and those of what stands for them."""
        if not self.references:
            return self.place, self.transition
        found = {"referencePlace": {**self.place}, "referenceTransition": {**self.transition}}
        for identity, (kind, ref) in self.references.items():
            seen = {identity}
            while ref in self.references and ref not in seen:
                seen.add(ref)
                ref = self.references[ref][1]
            found[kind][identity] = found[kind][ref]
        return found["referencePlace"], found["referenceTransition"]

    # --- elements ---------------------------------------------------------------------------------

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        outer = self.within[-1]
        tag = tag.rpartition(":")[2]
        if tag in _SKIPPED and outer not in ("", "pnml"):
            self.skipped = 1
            self.parser.StartElementHandler = self._deeper
            self.parser.EndElementHandler = self._higher
            return
        if tag not in _CHILDREN[outer]:
            raise _UnusualError
        self.within.append(tag)
        begun = _BEGUN.get(tag)
        if begun is not None:
            begun(self, attributes)

    def _end(self, _tag: str) -> None:
        tag = self.within.pop()
        if tag == "arc":
            self.arcs.append((self.source, self.target, self.number))
        elif tag == "page":
            self.pages -= 1
        elif tag == "text":
            self._weight()
        elif tag in ("initialMarking", "inscription") and not self.is_read:
            raise _UnusualError

    def _deeper(self, _tag: str, _attributes: dict[str, str]) -> None:
        self.skipped += 1

    def _higher(self, _tag: str) -> None:
        self.skipped -= 1
        if not self.skipped:
            self.parser.StartElementHandler = self._start
            self.parser.EndElementHandler = self._end

    def net(self, attributes: dict[str, str]) -> None:
        """A net of the kind that is understood."""
        self.nets += 1
        name = attributes.get("type", "").strip().rstrip("/").rpartition("/")[2].rpartition("#")[2]
        if name not in _TYPES:
            raise _UnusualError

    def page(self, _attributes: dict[str, str]) -> None:
        """One of perhaps several pages: ids are those of the whole file."""
        self.pages += 1
        if self.pages > _DEEPEST:
            raise _UnusualError

    def begin_place(self, attributes: dict[str, str]) -> None:
        """A place without tokens."""
        self._new(self.place, attributes)
        self.initial.append(0)
        self.is_read = False

    def begin_transition(self, attributes: dict[str, str]) -> None:
        """A transition without arcs."""
        self._new(self.transition, attributes)

    def begin_reference(self, attributes: dict[str, str]) -> None:
        """A place or transition of another page."""
        identity = self._identity(attributes)
        self.references[identity] = self.within[-1], attributes["ref"].strip()

    def begin_type(self, attributes: dict[str, str]) -> None:
        """What kind of arc it is."""
        if attributes.get("value", "").strip().lower() not in _NORMAL:
            raise _UnusualError

    def begin_arc(self, attributes: dict[str, str]) -> None:
        """An arc of weight 1."""
        if attributes.get("type", "").strip().lower() not in _NORMAL:
            raise _UnusualError
        identity = attributes.get("id", "").strip()
        if identity:  # nobody refers to arcs
            self._use(identity)
        self.source = attributes["source"].strip()
        self.target = attributes["target"].strip()
        self.number = 1
        self.is_read = False

    def begin_text(self, _attributes: dict[str, str]) -> None:
        """A number, of which there is one in each place or arc."""
        if self.is_read:
            raise _UnusualError
        self.is_read = True
        self.text.clear()
        self.parser.CharacterDataHandler = self.text.append

    def _weight(self) -> None:
        self.parser.CharacterDataHandler = None
        digits = "".join(self.text).strip()
        is_marking = self.within[-1] == "initialMarking"
        if _DIGITS.fullmatch(digits) is None:
            raise _UnusualError
        number = int(digits)
        if is_marking:
            self.initial[-1] = number
        elif number:
            self.number = number
        else:
            raise _UnusualError

    def _new(self, known: dict[str, int], attributes: dict[str, str]) -> None:
        known[self._identity(attributes)] = len(known)

    def _identity(self, attributes: dict[str, str]) -> str:
        identity = attributes["id"].strip()
        if not identity:
            raise _UnusualError
        self._use(identity)
        return identity

    def _use(self, identity: str) -> None:
        if identity in self.used:
            raise _UnusualError
        self.used.add(identity)


def _refuse(*_: object) -> int:
    raise _UnusualError


_BEGUN: dict[str, Callable[[_Reader, dict[str, str]], None]] = {
    "net": _Reader.net,
    "page": _Reader.page,
    "place": _Reader.begin_place,
    "transition": _Reader.begin_transition,
    "referencePlace": _Reader.begin_reference,
    "referenceTransition": _Reader.begin_reference,
    "type": _Reader.begin_type,
    "arc": _Reader.begin_arc,
    "text": _Reader.begin_text,
}

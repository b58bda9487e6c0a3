"""Flattening: `TypedNet` -> `FlatNet`.

Pages become instances; ports merge with their sockets, the places of a fusion set with each other.

Example: page `Robot` used by the substitution transitions `Robot1` and `Robot2` of page `Top`
gives transitions "Top.Robot1.Accept" and "Top.Robot2.Accept"; port `Flag` of the first is the
place "Top.flag1" if that is its socket.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pn2code.base.frozen import replace
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.ml.core.instances import numbered
from pn2code.net.codes import FUSION_MISMATCH, NET_TOO_LARGE, PORT_COLSET, PORT_INITIAL
from pn2code.net.flat import (
    FlatArc,
    FlatFusion,
    FlatNet,
    FlatPlace,
    FlatTransition,
    Form,
    PlaceInstance,
)
from pn2code.net.instances import PageInstance, expand, measure, unique_names
from pn2code.net.typed import TypedNet, TypedPlace, TypedTransition

MAX_ELEMENTS = 500_000
"""Places and transitions of a flat net."""
MAX_DEPTH = 1_000
"""Pages one below the other."""

Node = TypeVar("Node", TypedPlace, TypedTransition)
Key = tuple[int, str]
"""A place instance: index of the page instance, place id."""


def flatten(net: TypedNet, d: Diagnostics) -> FlatNet | None:
    """Expand the hierarchy; None after errors."""
    total, depth = measure(net)
    if depth > MAX_DEPTH:
        d.error(
            NET_TOO_LARGE,
            f"pages are nested {depth:,} levels deep, more than the {MAX_DEPTH:,} allowed",
            Origin(net.net.document.file),
            hint="real nets have fewer than ten levels: was the file made by a program?",
        )
        return None
    if total > MAX_ELEMENTS:
        d.error(
            NET_TOO_LARGE,
            f"the hierarchy expands to {total:,} elements, more than the {MAX_ELEMENTS:,} allowed",
            Origin(net.net.document.file),
            hint="use fewer substitution transitions",
        )
        return None
    before = len(d.errors)
    flat = _Flattener(net, expand(net), d).flat()
    return None if len(d.errors) > before else flat


def check_hierarchy(net: TypedNet, d: Diagnostics) -> None:
    """Report ports and fusion sets that do not fit, of a net in which other things are wrong and may be missing."""
    total, depth = measure(net)
    if total <= MAX_ELEMENTS and depth <= MAX_DEPTH:
        _Flattener(net, expand(net), d).merge()


class _Flattener:
    def __init__(self, net: TypedNet, instances: Sequence[PageInstance], d: Diagnostics) -> None:
        self.net = net
        self.instances = instances
        self.d = d
        self.typed: dict[Key, TypedPlace] = {
            (i.index, p.id): p for i in instances for p in i.page.places
        }
        self.order = {key: n for n, key in enumerate(self.typed)}
        self.fusion_order = {f.name: n for n, f in enumerate(net.fusions)}

    def flat(self) -> FlatNet:
        groups, group_of = self.merge()
        places = tuple(self.places(groups))
        transitions = tuple(self.transitions(group_of))
        document = self.net.net.document
        captions = {p.id: p.caption for page in document.pages for p in page.places}
        arcs = sum(len(t.arcs) for t in transitions)
        return FlatNet(
            name=c_stem(document.file),
            file=document.file,
            sha256=document.sha256,
            program=self.net.program,
            places=places,
            transitions=transitions,
            timed=any(p.colset.timed for p in places),
            real_time=self.net.real_time,
            place_instances=tuple(
                PlaceInstance(
                    id=place.id,
                    name=place.name,
                    page=instance.page.name,
                    instance=instance.path,
                    number=instance.number,
                    place=group_of[(instance.index, place.id)],
                    caption=captions.get(place.id, place.name),
                    is_assigned=self.has_socket(instance, place),
                    is_port=bool(place.port),
                )
                for instance in self.instances
                for place in instance.page.places
            ),
            fusions=tuple(self.fusions(group_of)),
            statistics={
                "pages": len(self.net.pages),
                "page_instances": len(self.instances),
                "places": len(places),
                "place_instances": len(self.typed),
                "transitions": len(transitions),
                "arcs": arcs,
                "fusion_sets": len(self.net.fusions),
                "colour_sets": len(self.net.program.colsets),
                "variables": len(self.net.program.variables),
            },
            blocks=self.net.net.blocks,
        )

    def fusions(self, group_of: dict[Key, int]) -> Iterator[FlatFusion]:
        at = {self.typed[key].fusion: index for key, index in group_of.items()}
        for fusion in self.net.fusions:
            yield FlatFusion(fusion.id, fusion.name, at.get(fusion.name, -1))

    def merge(self) -> tuple[list[list[Key]], dict[Key, int]]:
        """Groups of place instances that are one place, topmost member first, and the group of each instance."""
        top: dict[Key, Key] = {}
        for instance in self.instances:
            for place in instance.page.places:
                key = (instance.index, place.id)
                if not self.has_socket(instance, place):
                    top[key] = key
                else:
                    above = (instance.parent, instance.sockets[place.id])
                    # Parents come before their children, so the socket's own top is known.
                    top[key] = top[above]
                    self.check_port(place, self.typed[above])
        first_of_fusion: dict[str, Key] = {}
        last_of_fusion = self.compared_with()
        checked: set[str] = set()  # once, however often the page is used
        parent = {key: key for key in top}

        def root(key: Key) -> Key:
            while parent[key] != key:
                parent[key] = parent[parent[key]]
                key = parent[key]
            return key

        for key, above in top.items():
            parent[root(key)] = root(above)
        for key, place in self.typed.items():
            if place.fusion:
                first = first_of_fusion.setdefault(place.fusion, key)
                last = last_of_fusion[place.fusion]
                if place.id not in checked:
                    self.check_fusion(place.fusion, self.typed[top[key]], self.typed[top[last]])
                    checked.add(place.id)
                a, b = root(first), root(key)
                if a != b:
                    low, high = sorted((a, b), key=self.order.__getitem__)
                    parent[high] = low
        members: dict[Key, list[Key]] = {}
        for key in self.typed:
            members.setdefault(root(key), []).append(key)
        groups = [self.topmost_first(g, top) for g in members.values()]
        return groups, {key: n for n, group in enumerate(groups) for key in group}

    def compared_with(self) -> dict[str, Key]:
        """Of each fusion set the place with which CPN Tools compares the others: the last one on its first page."""
        found: dict[str, Key] = {}
        for key, place in self.typed.items():
            known = found.get(place.fusion)
            if place.fusion and (known is None or known[0] == key[0]):
                found[place.fusion] = key
        return found

    def has_socket(self, instance: PageInstance, place: TypedPlace) -> bool:
        """Whether a place is a port that is assigned to a socket."""
        return (instance.parent, instance.sockets.get(place.id, "")) in self.typed

    def topmost_first(self, group: list[Key], top: dict[Key, Key]) -> list[Key]:
        return sorted(group, key=lambda k: (top[k] != k, self.order[k]))

    def check_port(self, port: TypedPlace, socket: TypedPlace) -> None:
        if (
            port.colset.resolved != socket.colset.resolved
            or port.colset.timed != socket.colset.timed
        ):
            self.d.error(
                PORT_COLSET,
                f"port `{port.name}` has colour set `{port.colset.name}`, but its socket "
                f"`{socket.name}` has `{socket.colset.name}`",
                port.origin,  # no instance: said once, however often the page is used
                notes=[Note("the socket is declared here", socket.origin)],
                hint="give both the same colour set",
            )
        elif port.initial_text and _words(port.initial_text) != _words(socket.initial_text):
            # no instance: said once, however often the page is used
            self.d.warning(
                PORT_INITIAL,
                f"the initial marking of port `{port.name}` is not used: that of its socket "
                f"`{socket.name}` counts",
                port.origin,
                notes=[Note("the socket is declared here", socket.origin)],
                hint="remove the port's initial marking, or write the same at both",
            )

    def check_fusion(self, name: str, first: TypedPlace, other: TypedPlace) -> None:
        """A place of a fusion set must be as the other one is."""
        if first.initial is not None and first.initial[1] is Form.TIMED_TOKEN:
            self.d.error(
                FUSION_MISMATCH,
                f"the initial marking of place `{first.name}` of fusion set `{name}` is one token with a time stamp, "
                "which CPN Tools compares with nothing: it refuses it as different (Mismatch in fusion group)",
                first.origin,
                hint=f"make it a multi-set: ``1`{first.initial_text.strip()}``",
            )
            return
        colsets = first.colset.name, other.colset.name
        what, is_certain = "", True
        if colsets[0] != colsets[1] and first.colset.resolved != other.colset.resolved:
            what = f"colour sets, `{colsets[0]}` and `{colsets[1]}`"
        elif _words(first.initial_text) != _words(other.initial_text):
            is_same = self.have_same_tokens(first, other)
            if is_same:
                return
            is_certain = is_same is not None
            texts = [f"`{t}`" if t else "none" for t in (first.initial_text, other.initial_text)]
            what = f"initial markings, {texts[0]} and {texts[1]}"
        if what:
            (self.d.error if is_certain else self.d.warning)(
                FUSION_MISMATCH,
                f"places `{first.name}` and `{other.name}` of fusion set `{name}` {'' if is_certain else 'may '}have "
                f"different {what}",
                first.origin,
                notes=[Note(f"`{other.name}` is declared here", other.origin)],
                hint="the places of a fusion set are one place: make them equal",
            )

    def have_same_tokens(self, first: TypedPlace, other: TypedPlace) -> bool | None:
        """Whether initial markings of different texts are the same for CPN Tools; None when it cannot be said.

        It compares tokens with their time stamps, but one token is not the multi-set of it, and a multi-set with time
        stamps is none without them, not even an empty one; `empty` is both.
        """
        forms = {p.initial[1] if p.initial else Form.MULTISET for p in (first, other)}
        if len(forms) > 1 and not (
            forms == {Form.MULTISET, Form.TIMED_MULTISET}
            and any(p.takes_stamps for p in (first, other))
        ):
            return False
        is_token = forms <= {Form.TOKEN, Form.TIMED_TOKEN}
        for tokens_of in (self.tokens, self.evaluated_tokens):
            a, b = (tokens_of(p, is_token) for p in (first, other))
            if a is not None and b is not None:
                return a == b
        return None

    def tokens(self, place: TypedPlace, is_token: bool) -> Counter[Any] | None:
        if place.initial is None:
            return Counter()
        elaborator = self.net.elaborator
        return None if elaborator is None else elaborator.tokens(place.initial[0], is_token)

    def evaluated_tokens(self, place: TypedPlace, is_token: bool) -> Counter[Any] | None:
        """The tokens by the evaluator that was lent, which knows all of CPN ML."""
        if place.initial is None:
            return Counter()
        elaborator = self.net.elaborator
        value = None if elaborator is None else elaborator.evaluated(place.initial[0]).value
        if value is None:
            return None
        return Counter([value] if is_token else value)

    def places(self, groups: list[list[Key]]) -> list[FlatPlace]:
        short = {p.id: unique_names((x.id, x.name) for x in p.places) for p in self.net.pages}
        proposals: list[tuple[str, str]] = []
        for n, group in enumerate(groups):
            instance = self.instances[group[0][0]]
            fusions = {self.typed[k].fusion for k in group} - {""}
            name = instance.name(short[instance.page.id][group[0][1]])
            if fusions:
                name = "Fusion." + min(fusions, key=lambda f: self.fusion_order[f])
            proposals.append((str(n), name))
        names = unique_names(proposals)
        found = []
        for n, group in enumerate(groups):
            instance = self.instances[group[0][0]]
            first = self.typed[group[0]]
            found.append(
                FlatPlace(
                    index=n,
                    name=names[str(n)],
                    short=first.name,
                    page=instance.page.name,
                    instance=instance.path,
                    instance_number=instance.number,
                    id=first.id,
                    colset=first.colset,
                    initial=self.on(instance, first).initial,
                    origins=tuple(
                        replace(self.typed[k].origin, instance=self.instances[k[0]].path)
                        for k in group
                    ),
                    member_ids=tuple((k[1], self.instances[k[0]].path) for k in group),
                )
            )
        return found

    def on(self, instance: PageInstance, node: Node) -> Node:
        """A place or transition, typed for all instances of its page, on one of them."""
        if node.id not in self.net.with_instance:
            return node
        assert self.net.elaborator is not None  # it has typed them
        return numbered(node, instance.number, self.net.elaborator.another)

    def transitions(self, group_of: dict[Key, int]) -> list[FlatTransition]:
        found: list[FlatTransition] = []
        short = {p.id: unique_names((x.id, x.name) for x in p.transitions) for p in self.net.pages}
        proposals = [
            (f"{i.index}/{t.id}", i.name(short[i.page.id][t.id]))
            for i in self.instances
            for t in i.page.transitions
        ]
        names = unique_names(proposals)
        document = self.net.net.document
        captions = {t.id: t.caption for page in document.pages for t in page.transitions}
        for instance in self.instances:
            for t in (self.on(instance, one) for one in instance.page.transitions):
                arcs = tuple(
                    FlatArc(
                        id=a.id,
                        kind=a.kind,
                        place=group_of[(instance.index, a.place)],
                        inscription=a.inscription,
                        origin=replace(a.origin, instance=instance.path),
                        place_name=self.typed[instance.index, a.place].name,
                    )
                    for a in t.arcs
                )
                found.append(
                    FlatTransition(
                        index=len(found),
                        name=names[f"{instance.index}/{t.id}"],
                        short=t.name,
                        page=instance.page.name,
                        instance=instance.path,
                        instance_number=instance.number,
                        id=t.id,
                        variables=t.variables,
                        guards=t.guards,
                        plan=t.plan,
                        arcs=arcs,
                        delay=t.delay,
                        code=t.code,
                        priority=t.priority,
                        origin=replace(t.origin, instance=instance.path),
                        caption=captions.get(t.id, t.name),
                    )
                )
        return found


def c_stem(file: str) -> str:
    """The file name's stem as a C identifier; "net" when nothing of it remains."""
    stem = re.sub(r"[^A-Za-z0-9_]+", "_", Path(file).stem).strip("_").lower()
    if not stem:
        return "net"
    return f"net_{stem}" if stem[0].isdigit() else stem


_WORD = re.compile(r"\"(?:[^\"\\]|\\.)*\"|[\w'.]+|[!%&$#+\-/:<=>?@\\~`^|*]+|\S", re.DOTALL)


def _words(text: str) -> list[str]:
    """A text without its blanks, but for those in strings and those that keep words apart."""
    return _WORD.findall(text)

"""Linking: `Document` -> `Net`. References by id become checked references; nothing is typed yet.

Example: `subst subpage="ID7" portsock="(ID8,ID3)"` becomes a `SubstitutionTransition` whose
`ports` say that place ID8 of page ID7 is place ID3 of this page; page ID7 is then no longer a
prime page.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.net import editor
from pn2code.net.codes import (
    FUSION_MEMBER,
    MONITOR_NODE,
    PAGE_RECURSION,
    PORT_ASSIGNMENT,
    PORT_DIRECTION,
    PORT_IDLE,
    SUBPAGE_UNKNOWN,
    SUBSTITUTION_INSCRIPTION,
    UNSUPPORTED_CHANNEL,
)
from pn2code.net.flat import ArcKind
from pn2code.net.linked import (
    Arc,
    FusionSet,
    Net,
    Page,
    Place,
    PortSocket,
    SubstitutionTransition,
    Transition,
)
from pn2code.reading.document import (
    Document,
    Inscription,
    RawArc,
    RawBlock,
    RawDeclaration,
    RawFusion,
    RawMl,
    RawPage,
    RawPlace,
    RawTransition,
)

_KINDS = {
    "ptot": ArcKind.INPUT,
    "ttop": ArcKind.OUTPUT,
    "bothdir": ArcKind.BOTH,
    "inhibitor": ArcKind.INHIBITOR,
    "reset": ArcKind.RESET,
}
_PORTS = {
    "in": "in",
    "out": "out",
    "i/o": "io",
    "io": "io",
    "inout": "io",
    "in/out": "io",
    "general": "io",
}
_EMPTY_GUARD = {"[]"}
_EMPTY_DELAY = {"@+", "@++"}
_EMPTY_CODE = {
    "input();output();action();",
    "input();output();action()",
    "input();output();action",
}


def link(document: Document, d: Diagnostics, *, partial: bool = False) -> Net | None:
    """Resolve the references of a document; None after errors.

    With `partial` the net is given even after errors, without what could not be resolved: its declarations and
    inscriptions can be checked, but it must not be flattened (pages may contain themselves).
    """
    before = len(d.errors)
    linker = _Linker(document, d)
    net = linker.net()
    return None if len(d.errors) > before and not partial else net


class _Linker:
    def __init__(self, document: Document, d: Diagnostics) -> None:
        self.document = document
        self.d = d
        self.pages = {p.id: p for p in document.pages}
        self.places = {place.id: place for page in document.pages for place in page.places}

    def net(self) -> Net:
        fusions, fusion_of = self.fusions()
        pages = tuple(self.page(p, fusion_of) for p in self.document.pages)
        self.check_recursion(pages)
        for page in pages:
            self.check_directions(page)
        self.check_idle_ports()
        editor.warn(self.document, pages, self.d)
        self.check_monitors()
        used = {s.subpage for p in pages for s in p.substitutions}
        options = {k.lower(): v for k, v in self.document.options.items()}
        return Net(
            document=self.document,
            declarations=tuple(_flatten(self.document.globbox)),
            pages=pages,
            prime_pages=tuple(p.id for p in pages if p.id not in used),
            fusions=fusions,
            real_time=options.get("realtimestamp", "").lower() == "true",
            blocks=dict(_blocks(self.document.globbox)),
        )

    def page(self, page: RawPage, fusion_of: dict[str, str]) -> Page:
        arcs: dict[str, list[RawArc]] = {}
        for arc in page.arcs:
            arcs.setdefault(arc.transition, []).append(arc)
        transitions, substitutions = [], []
        for t in page.transitions:
            if t.substitution is not None:
                found = self.substitution(page, t)
                if found is not None:
                    substitutions.append(found)
            else:
                transitions.append(self.transition(t, arcs.get(t.id, [])))
        return Page(
            id=page.id,
            name=page.name,
            places=tuple(self.place(p, fusion_of) for p in page.places),
            transitions=tuple(transitions),
            substitutions=tuple(substitutions),
            origin=page.origin,
        )

    def place(self, place: RawPlace, fusion_of: dict[str, str]) -> Place:
        port = _PORTS.get(place.port.lower(), "")
        if place.port and not port:
            self.d.warning(
                PORT_ASSIGNMENT,
                f"place `{place.name}` has the unknown port type `{place.port}`, taken for I/O",
                place.origin,
                hint="port types are In, Out and I/O",
            )
            port = "io"
        return Place(
            id=place.id,
            name=place.name,
            colset=place.type,
            initial_marking=_initial(place.initial),
            port=port,
            fusion=fusion_of.get(place.id, ""),
            origin=place.origin,
            layout=place.layout,
        )

    def transition(self, t: RawTransition, arcs: list[RawArc]) -> Transition:
        if t.channel is not None and t.channel.text.text.strip() != "()":
            self.d.error(
                UNSUPPORTED_CHANNEL,
                f"synchronous channels are not supported: transition `{t.name}` has one",
                t.channel.text.span(),
                hint="use a place between the transitions, or merge them",
            )
        return Transition(
            id=t.id,
            name=t.name,
            guard=_unless(t.guard, _EMPTY_GUARD),
            delay=_unless(t.delay, _EMPTY_DELAY),
            code=_unless(t.code, _EMPTY_CODE),
            priority=t.priority,
            arcs=tuple(
                Arc(a.id, _KINDS[a.orientation], a.place, a.inscription, a.origin, a.layout)
                for a in arcs
            ),
            origin=t.origin,
            layout=t.layout,
        )

    def substitution(self, page: RawPage, t: RawTransition) -> SubstitutionTransition | None:
        raw = t.substitution
        assert raw is not None
        for text in (
            _unless(t.guard, _EMPTY_GUARD),
            _unless(t.delay, _EMPTY_DELAY),
            _unless(t.code, _EMPTY_CODE),
        ):
            if text is not None:
                self.d.warning(
                    SUBSTITUTION_INSCRIPTION,
                    f"the {text.text.origin.part} of substitution transition `{t.name}` has no effect",
                    text.text.span(),
                    hint="write it at a transition of the subpage",
                )
        target = self.pages.get(raw.subpage)
        if target is None:
            which = f"page `{raw.subpage}`, which does not exist" if raw.subpage else "no page"
            self.d.error(
                SUBPAGE_UNKNOWN,
                f"substitution transition `{t.name}` stands for {which}",
                raw.origin,
                hint="assign a subpage again in CPN Tools, or make it an ordinary transition",
            )
            return None
        ports = {p.id: p for p in target.places if p.port}
        plain = {p.id for p in target.places if not p.port}
        own = {p.id: p for p in page.places}
        pairs: dict[str, str] = {}
        for port, socket in raw.portsock:
            wrong = ""
            hint = "assign the ports of this substitution transition again"
            if port not in ports:
                wrong = f"`{self.name(port)}` is not a port of page `{target.name}`"
                if port not in plain and socket in own:
                    self.d.error(
                        PORT_ASSIGNMENT,
                        f"a port assignment of `{t.name}` is wrong: {wrong}",
                        raw.origin,
                        hint=f"CPN Tools refuses place `{own[socket].name}`; {hint}",
                    )
                    continue
                if port in plain:
                    hint = (
                        f"make place `{self.name(port)}` of page `{target.name}` a port (In, Out or I/O), or remove "
                        "the assignment"
                    )
            elif socket not in own:
                wrong = f"`{self.name(socket)}` is not a place of page `{page.name}`"
            if wrong:
                self.d.warning(
                    PORT_ASSIGNMENT,
                    f"a port assignment of `{t.name}` is ignored: {wrong}",
                    raw.origin,
                    hint=hint,
                )
                continue
            if pairs.get(port, socket) != socket:
                self.d.warning(
                    PORT_ASSIGNMENT,
                    f"port `{ports[port].name}` of `{t.name}` is assigned to `{own[pairs[port]].name}` and "
                    f"to `{own[socket].name}`; the last counts",
                    raw.origin,
                    hint="remove one of the assignments",
                )
            pairs[port] = socket
        return SubstitutionTransition(
            id=t.id,
            name=t.name,
            subpage=raw.subpage,
            ports=tuple(PortSocket(p, s) for p, s in pairs.items()),
            origin=t.origin,
            layout=t.layout,
        )

    def name(self, identity: str) -> str:
        """Name of a place, or the id if there is none."""
        place = self.places.get(identity)
        return place.name if place else identity

    def check_directions(self, page: Page) -> None:
        """Warn of arcs against the direction of a port."""
        against = {"in": ArcKind.OUTPUT, "out": ArcKind.INPUT}
        ports = {p.id: p for p in page.places if p.port in against}
        words = {
            "in": "an input port, but it gets tokens",
            "out": "an output port, but it loses tokens",
        }
        wrong: dict[str, list[tuple[Transition, Arc]]] = {}
        for t in page.transitions if ports else ():
            for arc in t.arcs:
                port = ports.get(arc.place)
                if port is not None and arc.kind in (against[port.port], ArcKind.BOTH):
                    wrong.setdefault(port.id, []).append((t, arc))
        for place, found in wrong.items():
            port = ports[place]
            names = list(dict.fromkeys(f"`{t.name}`" for t, _ in found))
            who = f"transition {names[0]}" if len(names) == 1 else f"transitions {', '.join(names)}"
            self.d.warning(
                PORT_DIRECTION,
                f"place `{port.name}` is {words[port.port]} from {who}",
                found[0][1].origin,
                hint="make it an I/O port, or turn the arc around",
            )

    def check_idle_ports(self) -> None:
        """Warn of ports that nothing on their page uses: the page does nothing with what its instances are given."""
        if self.document.tool == "PNML":
            return
        for page in self.document.pages:
            used = {arc.place for arc in (*page.arcs, *page.undirected)}
            for place in page.places:
                if place.port and not place.fusion and place.id not in used:
                    self.d.warning(
                        PORT_IDLE,
                        f"port `{place.name}` has no arc on its page: page `{page.name}` does nothing with its sockets",
                        place.origin,
                        hint="draw the arcs that are missing, or remove the port and its assignments",
                    )

    def check_monitors(self) -> None:
        """Warn of monitors of nothing."""
        known = set(self.places) | {t.id for page in self.document.pages for t in page.transitions}
        for monitor in self.document.monitors:
            for node, _ in monitor.nodes:
                if node not in known:
                    self.d.warning(
                        MONITOR_NODE,
                        f"monitor `{monitor.name}` watches `{node}`, which does not exist",
                        monitor.origin,
                        hint="remove it from the monitor's nodes",
                    )

    def fusions(self) -> tuple[tuple[FusionSet, ...], dict[str, str]]:
        """The fusion sets, and the set's name for each place id. Sets of one name are one set.

        A place belongs to the set that it names itself, whatever the sets list: so does the engine get it.
        """
        listed: dict[str, list[str]] = {}
        for fusion in self.document.fusions:
            known = listed.setdefault(fusion.name, [])
            for member in fusion.members:
                self.check_member(fusion, member)
                if member in self.places and member not in known:
                    known.append(member)
        members: dict[str, list[str]] = {
            name: [i for i in ids if self.places[i].fusion == name] for name, ids in listed.items()
        }
        for place in self.places.values():
            if place.fusion in members:
                if place.id not in listed[place.fusion]:
                    members[place.fusion].append(place.id)
                    self.d.warning(
                        FUSION_MEMBER,
                        f"place `{place.name}` names fusion set `{place.fusion}`, which does not list it",
                        place.origin,
                        hint="it is treated as a member, as in CPN Tools",
                    )
            elif place.fusion:
                self.d.warning(
                    FUSION_MEMBER,
                    f"place `{place.name}` names fusion set `{place.fusion}`, which does not exist",
                    place.origin,
                    hint="it is treated as a separate place, as in CPN Tools",
                )
        fusion_of = {i: name for name, ids in members.items() for i in ids}
        raw = {f.name: f for f in reversed(self.document.fusions)}
        sets = (FusionSet(raw[n].id, n, tuple(ids), raw[n].origin) for n, ids in members.items())
        return tuple(sets), fusion_of

    def check_member(self, fusion: RawFusion, member: str) -> None:
        """Warn of a listed place that does not exist, or does not name the set."""
        place = self.places.get(member)
        if place is None:
            self.d.warning(
                FUSION_MEMBER,
                f"fusion set `{fusion.name}` lists place `{member}`, which does not exist",
                fusion.origin,
                hint="it is ignored; remove it from the set",
            )
        elif place.fusion != fusion.name:
            names = f"names fusion set `{place.fusion}`" if place.fusion else "names no fusion set"
            self.d.warning(
                FUSION_MEMBER,
                f"fusion set `{fusion.name}` lists place `{place.name}`, which {names}",
                place.origin,
                notes=[Note("the set is here", fusion.origin)],
                hint="it is not treated as a member, as in CPN Tools; if it should be one, put it into the set again",
            )

    def check_recursion(self, pages: tuple[Page, ...]) -> None:
        """Refuse pages that contain themselves, naming the way around."""
        by_id = {p.id: p for p in pages}
        finished: set[str] = set()
        for start in pages:
            # Depth first with explicit iterators: a chain of pages may be long.
            path: list[str] = []
            stack: list[Iterator[SubstitutionTransition]] = []
            if start.id not in finished:
                path, stack = [start.id], [iter(start.substitutions)]
            while stack:
                step = next(stack[-1], None)
                if step is None:
                    finished.add(path.pop())
                    stack.pop()
                elif step.subpage in path:
                    around = path[path.index(step.subpage) :] + [step.subpage]
                    names = " -> ".join(f"`{by_id[i].name}`" for i in around)
                    self.d.error(
                        PAGE_RECURSION,
                        f"page `{by_id[step.subpage].name}` contains itself: {names}",
                        step.origin,
                        hint=f"substitution transition `{step.name}` must stand for another page",
                    )
                elif step.subpage not in finished:
                    path.append(step.subpage)
                    stack.append(iter(by_id[step.subpage].substitutions))


def _flatten(block: RawBlock) -> Iterator[RawDeclaration]:
    for item in block.items:
        if isinstance(item, RawBlock):
            yield from _flatten(item)
        else:
            yield item


def _blocks(block: RawBlock, outer: str = "") -> Iterator[tuple[Origin, str]]:
    for item in block.items:
        if isinstance(item, RawBlock):
            yield from _blocks(item, "/".join(filter(None, (outer, item.name))))
        elif isinstance(item, RawMl) and outer:
            yield item.origin, outer


def _initial(marking: Inscription | None) -> Inscription | None:
    """None where the text still stands that CPN Tools shows for no initial marking."""
    stands = marking is not None and marking.text.text.strip() == "INIT MARK"
    return None if stands else marking


def _unless(inscription: Inscription | None, defaults: set[str]) -> Inscription | None:
    """None for the texts that CPN Tools shows where nothing has been written."""
    if inscription is None or "".join(inscription.text.text.split()) in defaults:
        return None
    return inscription

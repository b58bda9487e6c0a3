"""Checking: `Net` -> `TypedNet`. Declarations and inscriptions are typed, binding plans are made.

All independent errors are reported; elements that depend on something broken are passed over in silence.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from pn2code.base.how_far import counted
from pn2code.diagnostics import Diagnostics, Note, SourceText
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.computing import Compute
from pn2code.ml.core.terms import Exp, Lit
from pn2code.ml.core.types import INT
from pn2code.ml.elaborate import Elaborator, is_layered
from pn2code.ml.parsing.parser import odd_declaration, opens
from pn2code.net import (
    engine_guards,
    initial_effects,
    instance_numbers,
    space_names,
)
from pn2code.net.binding import Parts, Planner
from pn2code.net.codes import (
    ARC_AS,
    ARC_EMPTY,
    ARC_IGNORED,
    DECLARATION_INSIDE,
    NEIGHBOUR_WRONG,
    PLACE_COLSET,
)
from pn2code.net.declare import Declaring, declared_in
from pn2code.net.engine_binding import PlaceNode
from pn2code.net.engine_fields import fields
from pn2code.net.flat import ArcInscription, ArcKind, CodeSegment, Form, Term
from pn2code.net.forms import (
    ARC_TIMED,
    UNTIMED,
    form_type,
    is_unit,
    typed_marking,
    typed_text,
    unit_number,
)
from pn2code.net.linked import Arc, Net, Page, Place, Transition
from pn2code.net.terms import TermReader
from pn2code.net.typed import TypedArc, TypedNet, TypedPage, TypedPlace, TypedTransition
from pn2code.net.uses import NetVariables
from pn2code.reading.document import (
    RawColset,
)

NORMAL_PRIORITY = 1000
"""Priority of a transition without one."""
_MOST_NEIGHBOURS = 6
_STANDARD = ("UNIT", "BOOL", "INT", "INTINF", "TIME", "REAL", "STRING")


def check(
    net: Net,
    d: Diagnostics,
    values: Mapping[str, str] | None = None,
    *,
    partial: bool = False,
    int_bits: int = 31,
    compute: Compute | None = None,
) -> TypedNet | None:
    """Type a net.

    Args:
        net: the linked net.
        d: gets the errors.
        values: replacements for `val` declarations: name -> CPN ML text.
        partial: give the typed net even after errors, without the elements that are wrong.
        int_bits: width of `int`, 31 or 64.
        compute: evaluates bounds and priorities that cannot be folded.

    Returns:
        The typed net, or None if there were errors.
    """
    before = len(d.errors)
    typed = _Checker(net, d, values or {}, int_bits, compute).typed()
    return None if len(d.errors) > before and not partial else typed


class _Checker:
    def __init__(
        self,
        net: Net,
        d: Diagnostics,
        values: Mapping[str, str],
        int_bits: int,
        compute: Compute | None,
    ) -> None:
        self.net = net
        self.d = d
        self.elaborator = Elaborator(
            d,
            values=values,
            real_time=net.real_time,
            int_bits=int_bits,
            folder=Path(net.document.file).parent,
            compute=compute,
        )
        self.is_pnml = net.document.tool == "PNML"
        self.tests: list[Exp] = []  # of arcs `x as pattern` of the present transition
        declared = {
            c.name
            for c in net.declarations
            if isinstance(c, RawColset) and {"all", "'all"} & set(c.declare)
        }
        self.elaborator.announce(lambda: declared_in(net))
        declaring = Declaring(self.elaborator, d, self.is_pnml)
        declaring.declare_all(net.declarations)
        self.broken = declaring.broken
        for text in _texts(net):
            self.elaborator.with_library(text)
        self.program = self.elaborator.program()
        self.variables = NetVariables(self.program.variables)
        self.terms = TermReader(self.program, self.variables, d)
        self.planner = Planner(self.variables, self.terms, frozenset(declared), d)

    def typed(self) -> TypedNet:
        pages = tuple(self.page(p) for p in self.net.pages)
        if not self.is_pnml:
            colsets = {c.name: c.origin for c in self.net.declarations if isinstance(c, RawColset)}
            space_names.warn(self.program, colsets, self.d)
            initial_effects.warn(self.program, pages, self.d)
        with_instance: frozenset[str] = frozenset()
        if self.elaborator.mentions_instances:
            instance_numbers.warn(pages, self.d)
            with_instance = instance_numbers.mentioning(pages)
        return TypedNet(
            net=self.net,
            program=replace(self.program, datatypes=self.elaborator.datatypes()),
            pages=pages,
            prime_pages=self.net.prime_pages,
            fusions=self.net.fusions,
            real_time=self.net.real_time,
            elaborator=self.elaborator,
            with_instance=with_instance,
        )

    def page(self, page: Page) -> TypedPage:
        colsets = {p.id: self.colset(p) for p in page.places}
        places = []
        wrong: dict[str, Place] = {}
        for place in page.places:
            colset = colsets[place.id]
            before = len(self.d.errors)
            if colset is not None:
                places.append(self.place(place, colset))
            name = place.colset.text.text if place.colset else "UNIT"
            unknown = colset is None and name not in self.broken
            if unknown or len(self.d.errors) > before:
                wrong[place.id] = place
        if wrong:
            self.note_neighbours(page.transitions, wrong)
        names = {p.id: p for p in page.places}
        all_of_it = counted(page.transitions, f"transitions of page {page.name}")
        transitions = [self.transition(t, colsets, names) for t in all_of_it]
        return TypedPage(
            id=page.id,
            name=page.name,
            places=tuple(places),
            transitions=tuple(t for t in transitions if t is not None),
            substitutions=page.substitutions,
            origin=page.origin,
        )

    def note_neighbours(
        self, transitions: Sequence[Transition], wrong: Mapping[str, Place]
    ) -> None:
        """Mention the transitions beside a place with an error, which CPN Tools refuses to check: once a place."""
        beside: dict[str, list[Transition]] = {}
        for t in transitions:
            place = next((a.place for a in t.arcs if a.place in wrong), None)
            if place is not None:
                beside.setdefault(place, []).append(t)
        for place, found in beside.items():
            names = [f"`{t.name}`" for t in found]
            if len(names) > _MOST_NEIGHBOURS:
                names[_MOST_NEIGHBOURS:] = [f"{len(names) - _MOST_NEIGHBOURS} more"]
            listed = " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
            self.d.note(
                NEIGHBOUR_WRONG,
                f"transition{'s' * (len(found) > 1)} {listed} cannot be checked completely, because place "
                f"`{wrong[place].name}` has an error",
                found[0].origin,
                notes=[Note("the place is here", wrong[place].origin)],
                hint="correct the place first",
            )

    def colset(self, place: Place) -> Colset | None:
        """Colour set of a place; UNIT where none is written."""
        name = place.colset.text.text if place.colset else "UNIT"
        colset = self.program.colsets.get(name)
        if colset is not None or name in self.broken:
            return colset
        hint = did_you_mean(name, self.program.colsets, f"declare `colset {name} = ...;`")
        if name in _STANDARD:
            hint = f"declare it as CPN Tools does in a new net: `colset {name} = {name.lower()};`"
            if place.origin.file.lower().endswith(".cpnt"):
                hint += ", or write `standard` on a line of its own for all of these"
        if not name.isidentifier():
            hint = f"give it a name, `colset NAME = {name};`, and write the name here"
        if place.colset is None:
            self.d.error(
                PLACE_COLSET,
                f"place `{place.name}` has no colour set, and `UNIT` is not declared",
                place.origin,
                hint="write a colour set at the place, or declare `colset UNIT = unit;`",
            )
        else:
            self.d.error(
                PLACE_COLSET,
                f"place `{place.name}` has the unknown colour set `{name}`",
                place.colset.text.span(),
                label="not declared",
                hint=hint,
            )
        return None

    def place(self, place: Place, colset: Colset) -> TypedPlace:
        text = place.initial_marking.text if place.initial_marking else None
        initial: tuple[Exp, Form] | None = None
        if text is not None:
            initial = typed_marking(self.elaborator, text, colset)
            self.warn_of_opening(text)
        takes_stamps = text is None
        if text is not None and initial is not None and colset.timed and place.fusion:
            stamped = form_type(Form.TIMED_MULTISET, colset.type)
            takes_stamps = initial[1] is Form.MULTISET and self.elaborator.fits(
                text, stamped, colset.name
            )
        return TypedPlace(
            id=place.id,
            name=place.name,
            colset=colset,
            initial=initial,
            initial_text=text.text if text else "",
            port=place.port,
            fusion=place.fusion,
            origin=place.origin,
            takes_stamps=takes_stamps,
        )

    def inscription(
        self, text: SourceText, colset: Colset, forms: tuple[Form, ...], output: bool
    ) -> tuple[Exp, Form] | None:
        """The expression and the first form that fits it; None after an error."""
        return typed_text(self.elaborator, text, colset, forms, output)

    def transition(
        self, t: Transition, colsets: dict[str, Colset | None], places: dict[str, Place]
    ) -> TypedTransition | None:
        before = len(self.d.errors)
        self.tests = []
        arcs: list[TypedArc] = []
        complete = True
        for arc in t.arcs:
            colset = colsets[arc.place]
            if colset is None:
                complete = False
                continue
            typed = self.arc(arc, places[arc.place], colset)
            if typed is None:
                complete = False
            else:
                arcs.append(typed)
        guards = self.elaborator.guard(t.guard.text) if t.guard else ()
        delay = self.elaborator.delay(t.delay.text, self.net.real_time) if t.delay else None
        priority = self.elaborator.priority(t.priority.text) if t.priority else NORMAL_PRIORITY
        if t.delay is not None and delay is None:
            complete = False
        code = None
        if t.code is not None:
            segment = self.elaborator.code_segment(t.code.text)
            if segment is None:
                complete = False
            else:
                origin = t.code.text.origin
                code = CodeSegment(segment.inputs, segment.outputs, segment.action, origin)
        if not complete or guards is None or priority is None or len(self.d.errors) > before:
            return None
        written, guards = guards, (*guards, *self.tests)
        parts = Parts(
            name=t.name,
            origin=t.origin,
            arcs=[(a.kind, a.inscription) for a in arcs],
            guards=guards,
            delay=delay,
            code=code,
            code_span=t.code.text.span() if t.code else None,
            written=len(written),
            places=None if self.is_pnml else [self.node(a, colsets) for a in arcs],
        )
        self.warn_of_declarations(t)
        planned = self.planner.plan(parts)
        if planned is None:
            return None
        variables, plan = planned
        if not self.is_pnml:
            engine_guards.warn(written, self.terms, self.variables, t.name, self.d)
        return TypedTransition(
            id=t.id,
            name=t.name,
            variables=variables,
            guards=guards,
            plan=plan,
            arcs=tuple(arcs),
            delay=delay,
            code=code,
            priority=priority,
            origin=t.origin,
        )

    @staticmethod
    def node(arc: TypedArc, colsets: Mapping[str, Colset | None]) -> PlaceNode:
        """The place of an arc."""
        colset = colsets[arc.place]
        return PlaceNode(
            arc.place, colset is not None and colset.timed, () if colset is None else fields(colset)
        )

    def warn_of_declarations(self, t: Transition) -> None:
        """Warn of inscriptions that keep CPN Tools from checking the page."""
        inscriptions = [t.guard, t.priority, *(a.inscription for a in t.arcs)]
        for text in (i.text for i in inscriptions if i is not None and not self.is_pnml):
            word = odd_declaration(text)
            if word:
                self.warn_of_declaration(
                    word, text, "declare it in the net, or write it with `val`"
                )
        for part in (t.code, t.delay):
            if part is not None:
                self.warn_of_opening(part.text)

    def warn_of_opening(self, text: SourceText) -> None:
        """Warn of `open` where CPN Tools permits all other declarations."""
        if opens(text) and not self.is_pnml:
            self.warn_of_declaration(
                "open", text, "write the names of the structure in full: `Int.abs`"
            )

    def warn_of_declaration(self, word: str, text: SourceText, hint: str) -> None:
        self.d.warning(
            DECLARATION_INSIDE,
            f"CPN Tools cannot check a page with `{word}` in an inscription like this {text.origin.part}",
            text.span(),
            hint=hint,
        )

    def arc(self, arc: Arc, place: Place, colset: Colset) -> TypedArc | None:
        if arc.kind in (ArcKind.INHIBITOR, ArcKind.RESET):
            if arc.inscription is not None:
                self.d.warning(
                    ARC_IGNORED,
                    f"the inscription of {arc.kind.value} {arc.origin.element} has no effect",
                    arc.inscription.text.span(),
                    hint="remove the inscription",
                )
            return TypedArc(arc.id, arc.kind, arc.place, None, arc.origin)
        if arc.inscription is not None:
            text = unit_number(arc.inscription.text, colset)
        elif is_unit(colset):
            text = SourceText("1`()", replace(arc.origin, part="inscription"))
        else:
            self.d.error(
                ARC_EMPTY,
                f"{arc.origin.element} has no inscription",
                arc.origin,
                notes=[Note(f"place `{place.name}` has colour set `{colset.name}`", place.origin)],
                hint="write 1`(); CPN Tools adds it only at places of the colour set `UNIT`"
                if colset.resolved.kind is Kind.UNIT
                else f"write which tokens of `{colset.name}` it moves",
            )
            return None
        if not colset.timed and arc.kind is not ArcKind.OUTPUT and is_layered(text):
            return self.layered(arc, text, colset)
        forms = ARC_TIMED if colset.timed else UNTIMED
        found = self.inscription(text, colset, forms, arc.kind is ArcKind.OUTPUT)
        if found is None:
            return None
        value, form = found
        terms = () if arc.kind is ArcKind.OUTPUT else self.terms.terms(value, form)
        if terms is None:
            return None
        inscription = ArcInscription(value, form, terms, text.origin)
        return TypedArc(arc.id, arc.kind, arc.place, inscription, arc.origin)

    def layered(self, arc: Arc, text: SourceText, colset: Colset) -> TypedArc | None:
        """`x as pattern`: one token, whose parts are bound as well; that they fit x is a guard."""
        found = self.elaborator.layered(text, colset.type)
        if found is None:
            return None
        self.d.warning(
            ARC_AS,
            f"CPN Tools refuses `as` on an arc: {arc.origin.element} is accepted by pn2code only",
            text.span(),
            hint="write the pattern alone, with a variable for each part",
        )
        value, pattern, test = found
        self.tests.append(test)
        term = Term(_one(value), pattern, value, None, False, text.origin)
        inscription = ArcInscription(value, Form.TOKEN, (term,), text.origin)
        return TypedArc(arc.id, arc.kind, arc.place, inscription, arc.origin)


def _texts(net: Net) -> Iterator[SourceText]:
    """All inscriptions of places, arcs and transitions."""
    for page in net.pages:
        for place in page.places:
            yield from (x.text for x in (place.initial_marking,) if x)
        for t in page.transitions:
            yield from (x.text for x in (t.guard, t.delay, t.priority, t.code) if x)
            yield from (a.inscription.text for a in t.arcs if a.inscription)


def _one(value: Exp) -> Lit:
    """The coefficient of one token."""
    return Lit(1, INT, replace(value.span, end=value.span.start))

"""Transitions in C: one block of code for all instances that share it, and for each instance a row of the table."""

from __future__ import annotations

from pn2code.emission import c_rows, c_sums
from pn2code.emission.c_firing import DirectFiring
from pn2code.emission.c_frame import Frame
from pn2code.emission.c_net_statements import NetStatements
from pn2code.emission.c_own import OwnPlaces
from pn2code.emission.c_sums import SumFunction
from pn2code.emission.c_texts import where
from pn2code.emission.environment import c_comment, c_string
from pn2code.emission.names import Members
from pn2code.emission.needs import SIDE
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import PlaceTable, Shared
from pn2code.lowering.passes.counting import is_large


class Transitions(Frame):
    """Those of one net."""

    def _model(self, shared: Shared) -> ir.Transition:
        """The instance from which the code is made."""
        return self._net.transitions[shared.instances[0]]

    def _own_places(self, shared: Shared) -> OwnPlaces | None:
        """How the code of a transition of several instances reaches the places that each has for its own."""
        if shared.table is None:
            return None
        table = self._net.place_tables[shared.table]
        members = self._member_names(table)
        return OwnPlaces(
            self._struct(table),
            {p: members[c] for p, c in zip(shared.varying, shared.columns, strict=True)},
            {p: self._kept[p] for p in shared.varying},
        )

    def _struct(self, table: PlaceTable) -> str:
        """The stem of the C type of the rows of a table."""
        return self._names.page_places(table.page, table.paths)

    def _member_names(self, table: PlaceTable) -> tuple[str, ...]:
        members = Members()
        return tuple(members.name(i, name) for i, name in enumerate(table.names))

    def _place_table(self, table: PlaceTable) -> dict[str, object]:
        """The struct of a page, and what it is for each of its instances."""
        members = self._member_names(table)
        struct = self._struct(table)
        return {
            "title": f"page {table.page}: the places that each of its instances has for its own"
            if not table.is_of_transitions
            else "the places that each of some transitions has for its own",
            "struct": struct,
            "members": members,
            "instances": [
                {
                    "path": path,
                    "name": self._names.instance(path, struct),
                    "fields": [(m, self._multisets[p]) for m, p in zip(members, row, strict=True)],
                }
                for path, row in zip(table.paths, table.rows, strict=True)
            ],
        }

    def _is_of_page(self, shared: Shared) -> bool:
        """Whether it is one transition, of one page."""
        elements = {
            (t.origin.file, t.origin.page, t.id)
            for t in (self._net.transitions[i] for i in shared.instances)
        }
        return len(elements) == 1

    def _stem(self, shared: Shared) -> str:
        """The stem of the names of what is printed for a transition."""
        t = self._model(shared)
        if len(shared.instances) == 1 or not self._is_of_page(shared):
            return self._names.transition(t.index, t.name)
        return self._names.page_transition(t.index, t.origin.page, t.short)

    def _row(self, t: ir.Transition, shared: Shared, code: dict[str, object]) -> dict[str, object]:
        """What the tables of hosts say of one instance."""
        stem, flags = str(code["stem"]), ("looks", "looks_outside", "assigns", "search_assigns")
        counting = ""
        if t.counts is not None:
            counting = c_rows.counting(
                f"s_counts_of_{stem}", t, self._key if self._has_words else None
            )
        further = self._own_row(t, shared)
        if not counting:
            own_stem = "net" if self._shares_successors(t) else stem
            further += [f".successors = {own_stem}_successors"] if self._net.has_successors else []
            further += [f".words = {stem}_words"] if self._has_words else []
        if len(t.effects.affected) < len(self._net.transitions):
            further += c_rows.indices("affected", t.effects.affected)
        further += c_rows.indices("touched", t.effects.touched)
        further += c_rows.indices("read", t.effects.read)
        further += [f".{flag} = true" for flag in flags if code[flag]]
        return {
            "index": t.index,
            "code": code,
            "lines": c_rows.transition(
                t, stem, further, is_others=self._is_others(t), functions=counting
            ),
        }

    def _own_row(self, t: ir.Transition, shared: Shared) -> list[str]:
        """The constant with the places that an instance has for its own."""
        if shared.table is None:
            return []
        table = self._net.place_tables[shared.table]
        path = t.name if table.is_of_transitions else t.path
        return [f".places = &{self._names.instance(path, self._struct(table))}"]

    def _shares_successors(self, t: ir.Transition) -> bool:
        """Whether the function that makes its successors is one for many transitions of a large net.

        A copy for each of them, which needs to be compiled, is only a little faster.
        """
        draws = t.effects.search_draws and t.effects.fire_draws
        return is_large(self._net) and not draws and t.counts is None

    def _is_others(self, t: ir.Transition) -> bool:
        """Whether it is played by another program than the supervisor of the cell."""
        return 0 <= t.owner < len(self._net.owners) and self._net.owners[t.owner] != SIDE

    def _binding_name(self, shared: Shared) -> str:
        """The name of the instance, or of the page's transition where there are several."""
        t = self._model(shared)
        is_one = len(shared.instances) == 1 or not self._is_of_page(shared)
        return t.name if is_one else f"{t.origin.page}.{t.short}"

    def _title(self, shared: Shared) -> list[str]:
        """The element of the net, and all of its instances that the code is of."""
        t = self._model(shared)
        element = f"{t.origin.describe()}, {where(t.origin)}"
        if len(shared.instances) == 1:
            return [c_comment(f"transition {t.name}: {element}")]
        names = [self._net.transitions[i].name for i in shared.instances]
        instances = [f"    {c_comment(name)}" for name in names]
        if self._is_of_page(shared):
            return [c_comment(f"transition: {element}, at all of these:"), *instances]
        return [
            c_comment(f"transition: {element}, and all that do the same elsewhere:"),
            *instances,
        ]

    def _counting(self, shared: Shared) -> dict[str, object]:
        """What is printed of a transition that only counts: it looks at nothing and assigns nothing."""
        t, name = self._model(shared), self._stem(shared)
        return {
            "marks": [self._block(t.name, "transition", t.origin)],
            "index": t.index,
            "stem": name,
            "title": self._title(shared),
            "guard": c_comment(f"guard [{t.guard_text}]") if t.guard_text else "",
            "is_counting": True,
            "counts": c_rows.counts(f"s_counts_of_{name}", t, self._net.places, self._multisets),
            "is_plain": False,
            "thresholds": [],
            **dict.fromkeys(("looks", "looks_outside", "assigns", "search_assigns"), False),
        }

    def _transition(self, shared: Shared) -> dict[str, object]:
        t = self._model(shared)
        if t.counts is not None:
            return self._counting(shared)
        name, own = self._stem(shared), self._own_places(shared)
        members = Members()
        variables = tuple(members.name(i, v.name) for i, v in enumerate(t.variables))
        search, x, _ = self._printer(t.enumerate, "b.", own)
        x.variables = variables
        search.variable_types = tuple(v.type for v in t.variables)
        search.keeps = t.search_needs_context
        search.is_flat = t.is_flat
        search.releases = not t.effects.search_writes
        search.may_fail = search.keeps or any(
            isinstance(n, ir.Wanted | ir.UnlessLegal) for n in ir_nodes(t.enumerate)
        )
        sums = self._sums(t)
        search.sums = sums
        search.body(t.enumerate)
        search.end_search()
        fire = self._firing(t, t.is_direct, variables, own, name)
        lists = self._firing(t, False, variables, own, name) if t.lists_access else None
        thresholds = self._thresholds(t, variables, own)
        called = {*t.search_access.sums, *t.fire_access.sums}
        return {
            "marks": [
                self._block(x.name, "transition", x.origin)
                for x in (self._net.transitions[i] for i in shared.instances)
            ],
            "index": t.index,
            "search_draws": t.effects.search_draws,
            "fire_draws": t.effects.fire_draws,
            "draws_between": t.effects.search_draws and t.effects.fire_draws,
            "name": t.name,
            "stem": name,
            "title": self._title(shared),
            "binding": c_rows.binding(
                name,
                self._binding_name(shared),
                [
                    (self._types.name(v.type), member, v, self._names.table(v.table))
                    for v, member in zip(t.variables, variables, strict=True)
                ],
            ),
            "guard": c_comment(f"guard [{t.guard_text}]") if t.guard_text else "",
            "begins": c_string(t.origin.describe())
            if self._is_of_page(shared)
            else "pn_net.transition[self].origin",
            "is_plain": t.is_plain,
            "keeps": search.keeps and search.releases,
            "is_flat": search.is_flat,
            "search": search.lines,
            "search_reach": own.reach(t.search_access, is_const=True) if own else [],
            "thresholds": thresholds,
            "thresholds_reach": own.reach(t.thresholds_access, is_const=True) if own else [],
            "thresholds_draw": t.effects.thresholds_draw,
            "fire": fire.lines,
            "fire_reach": own.reach(t.fire_access, is_const=False) if own else [],
            "is_counting": False,
            "is_direct": t.is_direct,
            "sums": [
                self._sum_function(s, t, name, variables)
                for number, s in enumerate(sums.values())
                if number in called
            ],
            "lists": lists.lines if lists else [],
            "lists_reach": own.reach(t.lists_access, is_const=False)
            if own and t.lists_access
            else [],
            "lists_use_binding": t.lists_access is not None and t.lists_access.binding,
            "uses_binding": t.fire_access.binding,
            "touched_multisets": [
                self._place_names[i] for i in t.effects.touched if not self._net.places[i].packed
            ],
            "shares_successors": self._shares_successors(t),
            "looks": t.effects.looks,
            "looks_outside": t.effects.looks_outside,
            "assigns": t.effects.assigns,
            "search_assigns": t.effects.search_assigns,
        }

    def _thresholds(
        self, t: ir.Transition, variables: tuple[str, ...], own: OwnPlaces | None
    ) -> list[str]:
        """The search for the times at which tokens become available, without its preamble."""
        if not t.thresholds:
            return []
        search, x, _ = self._printer(t.thresholds, "b.", own)
        x.variables = variables
        search.variable_types = tuple(v.type for v in t.variables)
        search.is_void = True
        search.body(t.thresholds)
        return search.lines

    def _sums(self, t: ir.Transition) -> dict[tuple[int, ir.Ir], SumFunction]:
        return c_sums.functions(t, self._names.transition(t.index, t.name))

    def _sum_function(
        self, s: SumFunction, t: ir.Transition, name: str, variables: tuple[str, ...]
    ) -> list[str]:
        _, x, _ = self._printer((), "b->")
        x.variables = variables
        return c_sums.function(
            s,
            f"{name}_binding_t",
            self._multisets[s.of.place],
            self._names.table(s.of.table),
            self._numbers,
            x.text,
            lambda i: x.address(ir.Bound(i, t.variables[i].type)),
        )

    def _firing(
        self,
        t: ir.Transition,
        is_direct: bool,
        variables: tuple[str, ...],
        own: OwnPlaces | None,
        name: str,
    ) -> NetStatements:
        printer, x, scope = self._printer(t.fire, "b->", own)
        x.variables = variables
        if is_direct:
            scope.reserve("is_taken", "fits")
            direct = DirectFiring(
                self._types,
                x,
                scope,
                self._net.real_time,
                puts_back=not self._net.has_successors,
            )
            direct.multisets, direct.timed = printer.multisets, printer.timed
            direct.tables_of_places = printer.tables_of_places
            direct.token_types = printer.token_types
            direct.slots = self._slots
            direct.sums = self._sums(t)
            direct.otherwise = f"{name}_fire_lists(cx, m, self, b)"
            direct.variable_types = tuple(v.type for v in t.variables)
            direct.fire(t.fire, t.staying, t.fire_needs_context)
            return direct
        printer.variable_types = tuple(v.type for v in t.variables)
        printer.body(t.fire)
        return printer

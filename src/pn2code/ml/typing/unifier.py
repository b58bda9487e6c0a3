"""Unification of types with holes, and generalisation.

Example: for `fn x => x + 1` the operator has type `m * m -> m` with `m` restricted to numbers; the literal
unifies with m; nothing else is known of m at the end of the declaration, so it becomes int.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from pn2code.ml.core.types import TCon, TRecord, TVar, Type
from pn2code.ml.library.datatypes import NO_EQUALITY
from pn2code.ml.typing.inference import (
    I_UNIT,
    IAbstract,
    ICon,
    IError,
    IFun,
    IRec,
    Meta,
    Quant,
    Ty,
    from_type,
    parts,
    prune,
)


class UnifyError(Exception):
    """Two types differ.

    Args:
        reason: "mismatch", "circular", "equality" (`left` has no equality), "among" (`left` is not one of the
            types of an overloaded operator), "field" (`detail`: a record without this field).
    """

    def __init__(self, reason: str, left: Ty, right: Ty, detail: str = "") -> None:
        super().__init__(reason)
        self.reason = reason
        self.left = left
        self.right = right
        self.detail = detail


MAX_TYPE_NODES = 100_000
"""Parts of one type that are looked at in one step: exponential types end here."""
MAX_WORK = 5_000_000
"""Parts of types that are looked at for one text."""


class TypeTooLargeError(Exception):
    """A type passes the limits; reported at the border of the text."""


class Unifier:
    """Unification with a trail, so that an attempt can be taken back.

    Args:
        equality: whether a datatype (of equality arguments) has equality; those that are not in it have.

    Attributes:
        see_through: whether abstract types count as their implementations, while a structure is matched.
        work: parts of types looked at since the text began.
    """

    def __init__(self, equality: Mapping[str, bool]) -> None:
        self._equality = equality
        self._trail: list[tuple[Meta, int, bool, tuple[str, ...], dict[str, Ty] | None, Ty | None]]
        self._trail = []
        self.level = 0
        self.unknown_rows: list[Meta] = []
        self.pending: list[Meta] = []
        """metas with `among` or `fields`, to be looked at when the declaration ends"""
        self.see_through = False
        self.work = 0
        self._limit = MAX_TYPE_NODES

    def start(self) -> None:
        """A new text begins."""
        self.work = 0
        self._limit = MAX_TYPE_NODES
        self._trail.clear()
        self.pending.clear()

    def _step(self) -> None:
        """One part of a type is looked at.

        Raises:
            TypeTooLargeError: that is too many.
        """
        self.work += 1
        if self.work > self._limit:
            raise TypeTooLargeError

    def _begin(self) -> None:
        """A step over one type begins."""
        self._limit = min(self.work + MAX_TYPE_NODES, MAX_WORK)

    def fresh(self, *, equality: bool = False, among: Iterable[str] = ()) -> Meta:
        """A new unknown."""
        meta = Meta(self.level, equality, tuple(among))
        if meta.among:
            self.pending.append(meta)
        return meta

    def fresh_record(self, fields: Mapping[str, Ty]) -> Meta:
        """A record with at least these fields."""
        meta = Meta(self.level, fields=dict(fields))
        self.pending.append(meta)
        return meta

    def mark(self) -> int:
        """A point to which `rollback` can return."""
        return len(self._trail)

    def rollback(self, mark: int) -> None:
        """Forgets what was learned since the mark."""
        while len(self._trail) > mark:
            meta, level, equality, among, fields, ref = self._trail.pop()
            meta.level, meta.equality, meta.among = level, equality, among
            meta.fields, meta.ref = fields, ref

    def _save(self, m: Meta) -> None:
        self._trail.append((m, m.level, m.equality, m.among, m.fields, m.ref))

    def attempt(self, left: Ty, right: Ty) -> bool:
        """Unifies if possible; else nothing changes."""
        mark = self.mark()
        try:
            self.unify(left, right)
        except UnifyError:
            self.rollback(mark)
            return False
        return True

    def unify(self, left: Ty, right: Ty) -> None:
        """Makes two types equal.

        Raises:
            UnifyError: they cannot be; some metas may have been solved.
        """
        self._begin()
        self._unify(left, right)

    def _unify(self, left: Ty, right: Ty) -> None:
        a, b = prune(left), prune(right)
        if a is b:
            return
        self._step()
        if isinstance(a, Meta):
            if not isinstance(b, IError):
                self._bind(a, b)
        elif isinstance(b, Meta):
            if not isinstance(a, IError):
                self._bind(b, a)
        elif isinstance(a, ICon) and isinstance(b, ICon):
            if a.name != b.name or len(a.args) != len(b.args):
                raise UnifyError("mismatch", a, b)
            for x, y in zip(a.args, b.args, strict=True):
                self._unify(x, y)
        elif isinstance(a, IFun) and isinstance(b, IFun):
            self._unify(a.argument, b.argument)
            self._unify(a.result, b.result)
        elif isinstance(a, IRec) and isinstance(b, IRec):
            if [n for n, _ in a.fields] != [n for n, _ in b.fields]:
                raise UnifyError("mismatch", a, b)
            for (_, x), (_, y) in zip(a.fields, b.fields, strict=True):
                self._unify(x, y)
        elif isinstance(a, IError) or isinstance(b, IError):
            return
        elif isinstance(a, IAbstract) and isinstance(b, IAbstract) and a.name == b.name:
            for x, y in zip(a.args, b.args, strict=True):
                self._unify(x, y)
        elif self.see_through and (isinstance(a, IAbstract) or isinstance(b, IAbstract)):
            self._unify(
                a.hidden if isinstance(a, IAbstract) else a,
                b.hidden if isinstance(b, IAbstract) else b,
            )
        else:
            raise UnifyError("mismatch", a, b)

    def _bind(self, meta: Meta, t: Ty) -> None:
        if isinstance(t, Meta):
            self._merge(meta, t)
            return
        if self.see_through and isinstance(t, IAbstract) and (meta.among or meta.fields):
            self._unify(meta, t.hidden)
            return
        self._occurs(meta, t)
        if meta.among and not (isinstance(t, ICon) and t.name in meta.among):
            raise UnifyError("among", t, meta)
        if meta.fields is not None:
            if not isinstance(t, IRec):
                raise UnifyError("mismatch", t, meta)
            have = dict(t.fields)
            for name, field in meta.fields.items():
                if name not in have:
                    raise UnifyError("field", t, meta, name)
                self._unify(field, have[name])
        if meta.equality:
            self.require_equality(t)
        self._save(meta)
        meta.ref = t

    def _merge(self, a: Meta, b: Meta) -> None:
        """`a` becomes `b`, which takes over the restrictions."""
        if (a.among and b.fields is not None) or (b.among and a.fields is not None):
            raise UnifyError("mismatch", a, b)
        self._save(a)
        self._save(b)
        b.level = min(a.level, b.level)
        b.equality = a.equality or b.equality
        if a.among and b.among:
            common = tuple(n for n in a.among if n in b.among)
            if not common:
                raise UnifyError("mismatch", a, b)
            b.among = common
        elif a.among:
            b.among = a.among
            self.pending.append(b)
        if a.fields is not None:
            mine, theirs = a.fields, b.fields
            if theirs is None:
                self.pending.append(b)
                b.fields = dict(mine)
            else:
                b.fields = {**mine, **theirs}
                for name in mine.keys() & theirs.keys():
                    self._unify(mine[name], theirs[name])
        a.ref = b
        for field in (b.fields or {}).values():
            self._occurs(b, field)  # fields are generalised where their record is

    def _occurs(self, meta: Meta, t: Ty) -> None:
        """Refuses a type that contains the meta; lowers the levels of the metas inside."""
        t = prune(t)
        if isinstance(t, ICon) and not t.args:
            return
        self._step()
        if t is meta:
            raise UnifyError("circular", meta, t)
        if isinstance(t, Meta):
            if t.level > meta.level:
                self._save(t)
                t.level = meta.level
            for field in (t.fields or {}).values():
                self._occurs(meta, field)
        else:
            for part in parts(t):
                self._occurs(meta, part)

    def require_equality(self, t: Ty) -> None:
        """Restricts a type to equality types.

        Raises:
            UnifyError: "equality", it has none.
        """
        t = prune(t)
        if isinstance(t, Meta):
            if not t.equality:
                self._save(t)
                t.equality = True
                for field in (t.fields or {}).values():
                    self.require_equality(field)
        elif isinstance(t, Quant):
            t.equality = (
                True  # generalised within the same declaration: the scheme asks for equality
            )
        elif isinstance(t, IFun):
            raise UnifyError("equality", t, t)
        elif isinstance(t, IAbstract):
            if not t.equality:
                raise UnifyError("equality", t, t)
            for arg in t.args:
                self.require_equality(arg)
        elif isinstance(t, IRec):
            for _, field in t.fields:
                self.require_equality(field)
        elif isinstance(t, ICon):
            if t.name == "ref":
                return
            if t.name in NO_EQUALITY or not self._equality.get(t.name, True):
                raise UnifyError("equality", t, t)
            for arg in t.args:
                self.require_equality(arg)

    # --- schemes

    def generalise(self, types: Iterable[Ty]) -> list[Quant]:
        """Quantifies the unknowns that belong to levels deeper than the present one.

        Open records among them are in `unknown_rows` afterwards: nothing outside may decide them.
        """
        roots = list(types)
        self.unknown_rows.clear()
        self._begin()
        for t in roots:
            self._pin(t)
        quants: list[Quant] = []
        for t in roots:
            self._quantify(t, quants)
        return quants

    def _pin(self, t: Ty) -> None:
        """Overloaded and open-record unknowns are decided by the surroundings, not generalised."""
        self._step()
        t = prune(t)
        if isinstance(t, Meta):
            if t.level > self.level and (t.among or t.fields is not None):
                if t.fields is not None:
                    self.unknown_rows.append(t)
                self._lower(t)
        else:
            for part in parts(t):
                self._pin(part)

    def lower(self, t: Ty) -> None:
        """Makes all unknowns of a type belong to the present level: they are not generalised."""
        self._begin()
        self._lower(t)

    def _lower(self, t: Ty) -> None:
        self._step()
        t = prune(t)
        if isinstance(t, Meta):
            if t.level > self.level:
                t.level = self.level
                for field in (t.fields or {}).values():
                    self._lower(field)
        else:
            for part in parts(t):
                self._lower(part)

    def close(self, t: Ty) -> None:
        """Settles what nothing has decided and nothing may decide later."""
        self._step()
        t = prune(t)
        if isinstance(t, Meta):
            t.ref = ICon(t.among[0]) if t.among else I_UNIT
        else:
            for part in parts(t):
                self.close(part)

    def _quantify(self, t: Ty, quants: list[Quant]) -> None:
        self._step()
        t = prune(t)
        if isinstance(t, Meta):
            if t.level > self.level:
                quant = Quant(t.equality)
                quants.append(quant)
                t.ref = quant
        else:
            for part in parts(t):
                self._quantify(part, quants)

    def instantiate(self, t: Ty, quants: list[Quant]) -> tuple[Ty, list[Ty]]:
        """A copy with fresh unknowns for the quantified variables, and these."""
        if not quants:
            return t, []
        fresh: dict[int, Ty] = {id(q): self.fresh(equality=q.equality) for q in quants}
        return self.substitute(t, fresh), [fresh[id(q)] for q in quants]

    def substitute(self, t: Ty, by: Mapping[int, Ty]) -> Ty:
        """Replaces quantified variables, given by identity."""
        self._begin()
        return self._substitute(t, by)

    def _substitute(self, t: Ty, by: Mapping[int, Ty]) -> Ty:
        self._step()
        t = prune(t)
        if isinstance(t, Quant):
            return by.get(id(t), t)
        if isinstance(t, ICon):
            return ICon(t.name, tuple(self._substitute(a, by) for a in t.args)) if t.args else t
        if isinstance(t, IRec):
            return IRec(tuple((n, self._substitute(f, by)) for n, f in t.fields))
        if isinstance(t, IFun):
            return IFun(self._substitute(t.argument, by), self._substitute(t.result, by))
        if isinstance(t, IAbstract):
            args = tuple(self._substitute(a, by) for a in t.args)
            return IAbstract(t.name, args, self._substitute(t.hidden, by), t.equality)
        return t

    def instantiate_type(self, t: Type, generics: int) -> tuple[Ty, list[Ty]]:
        """The same for a finished type with `TVar`s."""
        equality = [False] * generics
        _mark_equality(t, equality)
        fresh: list[Ty] = [self.fresh(equality=e) for e in equality]
        return from_type(t, fresh), fresh


def _mark_equality(t: Type, equality: list[bool]) -> None:
    """Notes which variables of a type have to be equality types."""
    if isinstance(t, TVar):
        equality[t.index] = equality[t.index] or t.equality
    elif isinstance(t, TCon):
        for a in t.args:
            _mark_equality(a, equality)
    elif isinstance(t, TRecord):
        for _, f in t.fields:
            _mark_equality(f, equality)
    else:
        _mark_equality(t.argument, equality)
        _mark_equality(t.result, equality)

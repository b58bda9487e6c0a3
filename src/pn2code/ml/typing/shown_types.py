"""Types as text, in the words of the user: how they are shown to people."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pn2code.ml.typing.inference import (
    IAbstract,
    ICon,
    IError,
    IFun,
    Meta,
    Quant,
    Ty,
    parts,
    prune,
    to_type,
)

if TYPE_CHECKING:
    from pn2code.ml.typing.context import Context


class Shower:
    """Types as text; unknown ones get letters, the same in one message."""

    def __init__(self, ctx: Context) -> None:
        self._ctx = ctx
        self._letters: dict[int, str] = {}

    def __call__(self, t: Ty) -> str:
        """The text."""
        t = prune(t)
        if isinstance(t, IError):
            return "?"
        if isinstance(t, Meta) and t.among:
            return t.among[0]
        if isinstance(t, Meta) and t.fields is not None:
            return "{" + ", ".join(f"{n}: {self(f)}" for n, f in t.fields.items()) + ", ...}"
        if isinstance(t, Meta | Quant):
            letter = self._letters.setdefault(id(t), chr(ord("a") + len(self._letters) % 26))
            return ("''" if t.equality else "'") + letter
        if isinstance(t, IFun):
            argument = self(t.argument)
            if isinstance(prune(t.argument), IFun):
                argument = f"({argument})"
            return f"{argument} -> {self(t.result)}"
        if isinstance(t, IAbstract):
            t = ICon(t.name, t.args)
        if isinstance(t, ICon):
            return self._con(t)
        if _is_closed(t) and (name := self._ctx.type_name(to_type(t))):
            return name
        if not t.fields:
            return "unit"
        if len(t.fields) > 1 and all(n == str(i) for i, (n, _) in enumerate(t.fields, 1)):
            return " * ".join(self._inner(f) for _, f in t.fields)
        return "{" + ", ".join(f"{n}: {self(f)}" for n, f in t.fields) + "}"

    def _con(self, t: ICon) -> str:
        name = t.name.split("#")[0]
        if not t.args:
            return name
        if len(t.args) == 1:
            return f"{self._inner(t.args[0])} {name}"
        return f"({', '.join(map(self, t.args))}) {name}"

    def _inner(self, t: Ty) -> str:
        text = self(t)
        return f"({text})" if " * " in text or "->" in text else text


def _is_closed(t: Ty) -> bool:
    t = prune(t)
    return not isinstance(t, Meta | Quant | IError) and all(map(_is_closed, parts(t)))


def quoted(name: str) -> str:
    """A name in back-ticks, unless it has one itself."""
    if name == "`":
        return "the backquote"
    return f'"{name}"' if "`" in name else f"`{name}`"

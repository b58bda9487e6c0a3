"""How a cell that has come to its end has failed, where a token's value tells it: conditions of `failed` in `[report]`.

    failing = Failing.of(config, net, elaborator, d)
    failing.in_(game, marking)        # ["{ Mark.Supervisor'Result 1 = [scrap] }"]: those that hold there

A condition is one on markings, as in properties, and begins with `{`; everything else in `failed` is a place.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.ml.elaborate import Elaborator
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate
from pn2code.properties import codes
from pn2code.properties import meaning as m
from pn2code.properties.bind import Binder, Written
from pn2code.properties.judge import look
from pn2code.semantics.evaluation.effects import effects_of, outside
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException, MlLimit

_WORD = "reachable "
_OPERATORS = frozenset({"not", "and", "or", "implies", "iff"})


@frozen
class Failing:
    """The conditions of a cell.

    Args:
        conditions: text, and what it says of a marking.
        predicates: what they are made of.
    """

    conditions: tuple[tuple[str, m.Formula], ...] = ()
    predicates: tuple[Predicate, ...] = ()

    @staticmethod
    def of(
        config: CellConfig | None, net: FlatNet, elaborator: Elaborator | None, d: Diagnostics
    ) -> Failing:
        """Those of a cell; what is wrong with them is reported."""
        if config is None or elaborator is None or not config.report.conditions:
            return Failing()
        binder = Binder(net, elaborator, d, is_cell=True)
        for number, (text, at) in enumerate(config.report.conditions):
            origin = replace(at, column=at.column - len(_WORD) if at.column else 0)
            holds = SourceText(f"{_WORD}{text}", origin)
            binder.add(Written(f"failed #{number}", "", holds, of_net=True))
        found = binder.properties()
        effects = effects_of(net.program)
        out: list[tuple[str, m.Formula]] = []
        for p in found.properties:
            assert isinstance(p.asked, m.Invariant)
            text = p.holds.removeprefix(_WORD)
            if not _is_of_places(p.asked.condition):
                d.error(
                    codes.FORM,
                    f"`failed`: `{text}` is not about what places hold",
                    replace(p.origin, column=p.origin.column + len(_WORD) if p.origin.line else 0),
                    hint="a run has ended there: write a condition on markings, "
                    "e.g. `{ Mark.Supervisor'Result 1 = [scrap] }`",
                )
                continue
            out.append((text, m.negation(p.asked.condition)))
        for predicate in found.predicates:
            if outside(effects, predicate.exp):
                d.error(
                    codes.OUTSIDE,
                    "`failed`: the condition depends on random numbers or files",
                    predicate.exp.span,
                    hint="write it about the contents of places",
                )
        return Failing(tuple(out), found.predicates)

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self.conditions)

    def in_(self, game: Game, marking: Marking) -> list[str]:
        """Which of them hold in a marking, as their author wrote them; of which that is not known is said."""
        out = []
        for text, formula in self.conditions:
            try:
                if self._holds(formula, game, marking):
                    out.append(text)
            except (MlException, MlLimit) as problem:
                out += not_known([text], str(problem))
        return out

    def not_known(self, why: str) -> list[str]:
        """Of all of them it is not known whether they hold, which is no good end."""
        return not_known([text for text, _ in self.conditions], why)

    def _holds(self, f: m.Formula, game: Game, marking: Marking) -> bool:
        if isinstance(f, m.Atom):
            return f.kind == "true" or look(game, self.predicates[f.number], marking)
        parts = (self._holds(p, game, marking) for p in f.parts)
        match f.operator:
            case "not":
                return not next(parts)
            case "and":
                return all(parts)
            case "or":
                return any(parts)
            case "implies":
                return not next(parts) or next(parts)
            case _:
                return next(parts) == next(parts)


def not_known(texts: Iterable[str], why: str) -> list[str]:
    """Conditions of which nobody knows whether they hold."""
    return [f"not known whether {text}: {why}" for text in texts]


def _is_of_places(f: m.Formula) -> bool:
    if isinstance(f, m.Atom):
        return f.kind in ("true", "pred")
    return f.operator in _OPERATORS and all(map(_is_of_places, f.parts))

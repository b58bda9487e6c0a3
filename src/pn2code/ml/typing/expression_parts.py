"""What typing any kind of expression needs: the expressions inside it, whichever they are."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

from pn2code.ml.core import terms as core
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.annotations import Annotations
from pn2code.ml.typing.context import Context, Draft
from pn2code.ml.typing.inference import Ty
from pn2code.ml.typing.names import Names
from pn2code.ml.typing.patterns import Patterns

DeclareFunction = Callable[[s.Dec], Callable[[], Sequence[core.Dec]]]


class ExpressionParts(ABC):
    """Types expressions of one kind; those inside them are of any kind.

    Args:
        ctx: what is shared.
        annotations: types written types.
        patterns: types patterns.
        names: types names.
    """

    declare: DeclareFunction
    """Types a declaration inside an expression; whoever types declarations sets it."""

    def __init__(
        self, ctx: Context, annotations: Annotations, patterns: Patterns, names: Names
    ) -> None:
        self._ctx = ctx
        self._annotations = annotations
        self._patterns = patterns
        self._names = names

    @abstractmethod
    def check(self, e: s.Exp, t: Ty, what: str) -> Draft:
        """An expression that must have type `t`; `what` names it in messages (`argument of `f``)."""

    @abstractmethod
    def infer(self, e: s.Exp) -> Draft:
        """An expression of any type."""

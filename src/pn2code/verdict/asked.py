"""What is asked about a net: its properties, gathered from where they are written and understood, not yet answered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.properties import codes, sources
from pn2code.properties import meaning as m
from pn2code.properties.ltl_expansion import TooLargeError
from pn2code.properties.questions import Questions
from pn2code.properties.split import NoSplitError, Split, groups, is_about_bindings
from pn2code.semantics.evaluation.effects import Effect, effects_of
from pn2code.verdict.opened import OpenNet

_OUTSIDE = frozenset({Effect.DRAW, Effect.LOOK, Effect.WRITE, Effect.COUNT})


@frozen
class Asked:
    """What is asked about a net; nothing, if no properties are written anywhere."""

    properties: m.Properties = m.Properties()
    questions: str = ""
    """of all but those about bindings"""
    splits: tuple[tuple[Split, str], ...] = ()
    """nets for those about bindings, each with its questions"""
    partition: Partition | None = None
    """who runs what in the cell that it is asked of; None: the net is no cell"""

    def __bool__(self) -> bool:
        """Whether anything is asked."""
        return bool(self.properties.properties)

    @property
    def plain(self) -> m.Properties:
        """Those that are asked of the net itself."""
        plain = (p for p in self.properties.properties if not is_about_bindings(p))
        return replace(self.properties, properties=tuple(plain))

    def endings_of_net(self, ending: Sequence[int]) -> tuple[int, ...]:
        """Of the properties that end a swarm those that are asked of the closed net of a cell."""
        plain = self.plain.properties
        return tuple(i for i in ending if plain[i].of_net)


def gather(
    opened: OpenNet, texts: Sequence[str], file: Path | None, d: Diagnostics, *, found: bool
) -> Asked:
    """All properties of a net; what is wrong with them is reported.

    Args:
        opened: the net.
        texts: of the command line.
        file: a file of properties; None: the one beside the net, if there is one.
        d: gets the errors.
        found: whether those of the file beside the net and of the cell count.
    """
    written = [sources.from_option(text, i) for i, text in enumerate(texts, 1)]
    for path in files(opened, file, found=found):
        written += sources.from_file(path, d)
    if found:
        written += sources.from_cell(opened.config, d)
    typed = opened.examined.typed
    if not written or typed is None or typed.elaborator is None:
        return Asked()
    is_cell = opened.config is not None
    properties = sources.bind(written, opened.flat, typed.elaborator, d, is_cell=is_cell)
    _check_effects(opened, properties, d)
    try:
        splits = tuple(Split.of(opened.flat, properties, x) for x in groups(properties))
    except NoSplitError as problem:
        d.error(
            codes.FORM,
            str(problem),
            problem.about.origin,
            hint="write several properties, or join conditions in CPN ML: `{ n = 3 orelse n = 5 }`",
        )
        return Asked(properties)
    made = Asked(properties, splits=tuple((s, as_text(s.properties, d)) for s in splits))
    return replace(made, questions=as_text(made.plain, d))


def as_text(properties: m.Properties, d: Diagnostics) -> str:
    """As the explorer reads them; formulas that are too large are reported."""
    questions = Questions()
    for p in properties.properties:
        try:
            questions.ask(p.asked)
        except TooLargeError:
            d.error(
                codes.FORM,
                "the automaton of this formula becomes too large",
                p.origin,
                hint="write several properties instead of one",
            )
    return questions.text()


def files(opened: OpenNet, file: Path | None, *, found: bool) -> tuple[Path, ...]:
    """The files of properties that are read: that one, or the one beside the net."""
    beside = sources.beside(Path(opened.flat.file))
    if file is not None:
        return (file,)
    return (beside,) if found and beside.is_file() else ()


def _check_effects(opened: OpenNet, properties: m.Properties, d: Diagnostics) -> None:
    """Conditions follow from the state: the marking, and what references hold."""
    effects = effects_of(opened.flat.program)
    conditions = [p.exp for p in properties.predicates] + [s.exp for s in properties.steps]
    for exp in conditions:
        own = effects.of(exp)
        wrong = [e for e in Effect if e in own and e in _OUTSIDE]
        if wrong:
            d.error(
                codes.OUTSIDE,
                f"this condition {wrong[0].value}",
                exp.span,
                hint="write it about the contents of places and references: nothing else is determined by the state",
            )

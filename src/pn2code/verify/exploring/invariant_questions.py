"""Which exchanges of places and transitions leave what is asked as it is.

    asked = AskedOf(questions, predicates)
    asked.stays(image_of_place, image_of_transition)

A question about single states (`always`, `never`, `reachable`, `mutex`, `bound`, `deadlock free`) has the same answer
in a state and in its image if it is the same question after its places and transitions have been exchanged, but for the
order of what commutes: of `and` and `or`, of `andalso` and `orelse` where no operand can raise an exception, and of
sums of numbers of tokens, which raise the same one in any order. All else has to be equal.

Of a formula of CTL, each operand of an operator of paths has to stay in the same way, not only the whole: `AF p and AF
q` is the same after p and q have been exchanged, but along a path of representatives it is not always p that is p.
Then representatives and their arcs are bisimilar to the state space (E. Emerson, A. Sistla, *Symmetry and model
checking*, 1996).

Other questions (about runs that are fair, and about steps) are not looked at: the explorer does not answer them where
parts are exchanged.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence

from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol
from pn2code.net.predicate import Predicate
from pn2code.verify.controller.unsure import is_total
from pn2code.verify.exploring.transition_shape import texture

Image = Callable[[int], int]
_NUMBERS = frozenset({"List.length", "Ms.size"})
"""Functions that give a number of tokens."""
_KEPT = ("invariant", "bound", "initially")
_OF_STATES = ("true", "dead", "initial", "pred", "within", "enabled", "not", "and", "or")
"""Items that look at one state, if their operands do."""


class AskedOf:
    """What the explorer is asked (`properties.questions`), as far as it answers that."""

    def __init__(self, questions: str = "", predicates: Sequence[Predicate] = ()) -> None:
        lines = [line.split() for line in questions.splitlines()]
        self._items = []
        for words in lines:
            if words[:1] == ["?"]:
                break
            self._items.append(words)
        self._asked = [w[1:] for w in lines if w[:1] == ["?"] and w[1] in _KEPT]
        self._predicates = predicates
        self._same = self._meaning(_same, _same)

    def stays(self, place: Image, transition: Image) -> bool:
        """Whether each question remains the same one."""
        return not self._asked or self._meaning(place, transition) == self._same

    def _meaning(self, place: Image, transition: Image) -> list[Hashable]:
        known: list[Hashable] = []
        for words in self._items:
            known.append(self._item(words, known, place, transition))
        said: list[Hashable] = []
        for words in self._asked:
            if words[0] == "bound":
                said.append(("bound", place(int(words[1])), *words[2:]))
            else:
                said.append(known[int(words[1])])
        for words in self._needed():
            numbers = words[1:]
            if words[0] == "exa":
                said.append(("step", transition(int(words[1]))))
                numbers = words[2:]
            said += [known[int(number)] for number in numbers]
        return said

    def _needed(self) -> list[list[str]]:
        """Items about paths on which what is asked rests."""
        waiting = [int(words[1]) for words in self._asked if words[0] != "bound"]
        seen: set[int] = set()
        found: list[list[str]] = []
        while waiting:
            number = waiting.pop()
            words = self._items[number]
            if number in seen or words[0] in ("pred", "within", "enabled"):
                continue
            seen.add(number)
            waiting += map(int, words[2:] if words[0] == "exa" else words[1:])
            if words[0] not in _OF_STATES:
                found.append(words)
        return found

    def _item(
        self, words: Sequence[str], known: Sequence[Hashable], place: Image, transition: Image
    ) -> Hashable:
        match words:
            case ["pred", number]:
                return _Condition(self._predicates[int(number)], place).text()
            case ["within", number, low, high]:
                return ("within", place(int(number)), low, high)
            case ["enabled", number]:
                return ("enabled", transition(int(number)))
            case ["exa", number, item]:
                return ("exa", transition(int(number)), known[int(item)])
            case ["and" | "or" as word, a, b]:
                return _sorted(word, (known[int(a)], known[int(b)]))
            case [word, *items]:
                return (word, *(known[int(i)] for i in items))
        raise AssertionError(words)


def _same(i: int) -> int:
    return i


def _sorted(word: str, operands: Sequence[Hashable]) -> Hashable:
    """An operation that is associative and commutative."""
    flat: list[Hashable] = []
    for one in operands:
        is_same = isinstance(one, tuple) and one[:1] == (word,) and len(one) == 2
        flat += one[1] if is_same else [one]  # type: ignore[index]
    return (word, tuple(sorted(flat, key=repr)))


class _Condition:
    """A predicate with its places exchanged."""

    def __init__(self, predicate: Predicate, place: Image) -> None:
        self._exp = predicate.exp
        self._places = {symbol.uid: place(index) for symbol, index in predicate.places}

    def text(self) -> Hashable:
        return self._of(self._exp)

    def _of(self, e: core.Exp) -> Hashable:
        match e:
            case core.If() if (parts := _operands(e)) is not None:
                word, exps = parts
                return _sorted(word, [self._of(x) for x in exps])
            case core.Apply(core.Builtin("Int.+")) if (summands := _summands(e)) is not None:
                return _sorted("sum", [self._of(x) for x in summands])
            case core.Apply(function, argument):
                return ("apply", self._of(function), self._of(argument))
            case core.RecordExp(fields):
                return ("record", *((name, self._of(x)) for name, x in fields))
            case core.If(condition, then, otherwise):
                return ("if", self._of(condition), self._of(then), self._of(otherwise))
        return ("text", texture(e, self._named))

    def _named(self, s: Symbol) -> Hashable:
        """A place, or what stands for itself; None: it is declared in the condition."""
        if s.uid in self._places:
            return ("place", self._places[s.uid])
        return ("symbol", s.uid) if s.is_global else None


def _operands(e: core.If) -> tuple[str, list[core.Exp]] | None:
    """Of `andalso` and `orelse`, if their order does not matter."""
    found: tuple[str, list[core.Exp]] | None = None
    if _is_constant(e.otherwise, "false"):
        found = "andalso", [e.condition, e.then]
    elif _is_constant(e.then, "true"):
        found = "orelse", [e.condition, e.otherwise]
    return found if found is not None and all(map(_raises_nothing, found[1])) else None


def _is_constant(e: core.Exp, name: str) -> bool:
    return isinstance(e, core.Con) and e.constructor.name == name


def _raises_nothing(e: core.Exp) -> bool:
    match e:
        case core.If(condition, then, otherwise):
            return all(map(_raises_nothing, (condition, then, otherwise)))
        case core.Apply(core.Builtin(), core.RecordExp(fields)) if is_total(_without(e)):
            return all(_raises_nothing(x) for _, x in fields)
    return _is_number(e) or is_total(e)


def _without(e: core.Apply) -> core.Exp:
    """The same with nothing to compare."""
    assert isinstance(e.argument, core.RecordExp)
    empty = core.RecordExp((), e.argument.type, e.argument.span)
    return core.Apply(e.function, empty, e.type, e.span)


def _is_number(e: core.Exp) -> bool:
    """Whether it is surely a number of 0 or more, and raises nothing."""
    match e:
        case core.Lit(int() as value):
            return value >= 0
        case core.Apply(core.Builtin(name), core.Var()):
            return name in _NUMBERS
    return False


def _summands(e: core.Exp) -> list[core.Exp] | None:
    """Of a sum of numbers of tokens; None: it is none."""
    found: list[core.Exp] = []
    waiting = [e]
    while waiting:
        match waiting.pop():
            case core.Apply(core.Builtin("Int.+"), core.RecordExp(((_, a), (_, b)))):
                waiting += [a, b]
            case one if _is_number(one):
                found.append(one)
            case _:
                return None
    return found

"""Formulas of the Model Checking Contest, from its XML files.

    read(Path("CTLFireability.xml")) -> [Question("Net-CTLFireability-00", formula), ...]

A formula speaks of places and transitions of the net by their ids. Paths are maximal: one that ends in a dead marking
stays there, and counts.
"""

from __future__ import annotations

from pathlib import Path

from lxml import etree

from pn2code.base.frozen import frozen

_NAMESPACE = "{http://mcc.lip6.fr/}"
_LARGEST = 64 << 20
_DIGITS = 16
"""Of a number; no place of the contest holds that many tokens."""


class FormulaError(Exception):
    """A file of formulas is not as the contest writes them."""


@frozen
class Constant:
    """A number."""

    value: int


@frozen
class Tokens:
    """The number of tokens that some places hold together."""

    places: tuple[str, ...]


@frozen
class AtMost:
    """Comparison: left <= right."""

    left: Constant | Tokens
    right: Constant | Tokens


@frozen
class Fireable:
    """One of the transitions is enabled."""

    transitions: tuple[str, ...]


@frozen
class Truth:
    """True, or false, in all markings."""

    value: bool


@frozen
class Op:
    """An operator: `not`, `and`, `or`; `A`, `E` (paths); `X`, `F`, `G`, `U` (time)."""

    operator: str
    parts: tuple[Formula, ...]


Formula = AtMost | Fireable | Truth | Op | Tokens
"""`Tokens` alone asks for a bound."""


@frozen
class Question:
    """One formula of a file.

    Args:
        name: the contest's name for it.
        formula: None: it is not as the contest writes formulas.
        why_not: what is wrong with it then.
    """

    name: str
    formula: Formula | None
    why_not: str = ""


_OPERATORS = {
    "negation": ("not", 1), "conjunction": ("and", 0), "disjunction": ("or", 0),
    "all-paths": ("A", 1), "exists-path": ("E", 1),
    "next": ("X", 1), "finally": ("F", 1), "globally": ("G", 1), "until": ("U", 2),
}  # fmt: skip


def read(path: Path) -> list[Question]:
    """The questions of a file. What is wrong with one formula takes nothing from the others.

    Raises:
        FormulaError: it cannot be read, or a question has no name.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise FormulaError(f"{path}: {error.strerror}") from error
    if len(data) > _LARGEST:
        raise FormulaError(f"{path}: larger than {_LARGEST >> 20} MiB")
    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise FormulaError(f"{path}: {error.msg}") from error
    found: dict[str, Question] = {}
    for question in (_question(p) for p in root if _tag(p) == "property"):
        name = question.name
        if name in found:
            question = Question(name, None, "several formulas have this name")
        found[name] = question
    return list(found.values())


def _tag(node: etree._Element) -> str:
    return str(node.tag).removeprefix(_NAMESPACE) if isinstance(node.tag, str) else ""


def _children(node: etree._Element) -> list[etree._Element]:
    return [c for c in node if isinstance(c.tag, str)]


def _question(node: etree._Element) -> Question:
    found = {_tag(c): c for c in _children(node)}
    name = (found["id"].text or "").strip() if "id" in found else ""
    if not name:
        raise FormulaError(f"line {node.sourceline}: a property without an id")
    try:
        if "formula" not in found:
            raise FormulaError(f"line {node.sourceline}: a property without a formula")
        return Question(name, _formula(_only(found["formula"])))
    except FormulaError as error:
        return Question(name, None, str(error))


def _only(node: etree._Element) -> etree._Element:
    children = _children(node)
    if len(children) != 1:
        raise FormulaError(
            f"line {node.sourceline}: `{_tag(node)}` has {len(children)} elements, not one"
        )
    return children[0]


def _two(node: etree._Element) -> list[etree._Element]:
    children = _children(node)
    if len(children) != 2:
        raise FormulaError(
            f"line {node.sourceline}: `{_tag(node)}` has {len(children)} elements, not two"
        )
    return children


def _names(node: etree._Element) -> tuple[str, ...]:
    return tuple((c.text or "").strip() for c in _children(node))


def _formula(node: etree._Element) -> Formula:
    tag = _tag(node)
    if tag == "place-bound":
        return Tokens(_names(node))
    if tag == "is-fireable":
        return Fireable(_names(node))
    if tag == "integer-le":
        left, right = map(_number, _two(node))
        return AtMost(left, right)
    if tag == "until":
        before, reach = _two(node)
        if (_tag(before), _tag(reach)) != ("before", "reach"):
            raise FormulaError(f"line {node.sourceline}: `until` needs `before` and `reach`")
        return Op("U", (_formula(_only(before)), _formula(_only(reach))))
    if tag not in _OPERATORS:
        raise FormulaError(f"line {node.sourceline}: `{tag}` is not known")
    operator, count = _OPERATORS[tag]
    parts = tuple(_formula(c) for c in _children(node))
    if not parts or (count and len(parts) != count):
        raise FormulaError(f"line {node.sourceline}: `{tag}` has {len(parts)} parts")
    return Op(operator, parts)


def _number(node: etree._Element) -> Constant | Tokens:
    tag = _tag(node)
    if tag == "integer-constant":
        text = (node.text or "").strip()
        if not text.removeprefix("-").isdecimal() or len(text) > _DIGITS:
            raise FormulaError(f"line {node.sourceline}: `{text[:_DIGITS]}` is no number")
        return Constant(int(text))
    if tag == "tokens-count":
        return Tokens(_names(node))
    raise FormulaError(f"line {node.sourceline}: `{tag}` is no number")

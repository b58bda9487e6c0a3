"""In which forms tokens are written at places and arcs: one token, a multi-set, with or without time stamps."""

from __future__ import annotations

import re

from pn2code.diagnostics import SourceText
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Exp
from pn2code.ml.core.types import Type, list_of, timed_of
from pn2code.ml.elaborate import Elaborator
from pn2code.net.flat import Form

_NUMBER = re.compile(r" *[0-9]+ *")
UNTIMED = (Form.TOKEN, Form.MULTISET)
_INITIAL_TIMED = (Form.TOKEN, Form.MULTISET, Form.TIMED_MULTISET, Form.TIMED_TOKEN)
ARC_TIMED = (Form.TOKEN, Form.MULTISET, Form.TIMED_TOKEN, Form.TIMED_MULTISET)


def typed_marking(
    elaborator: Elaborator, text: SourceText, colset: Colset
) -> tuple[Exp, Form] | None:
    """What a place of this colour set shall hold, and the first form that fits it; None after an error.

    `text.origin.part` must be "initial marking": there the variables of the net are not known.
    """
    forms = _INITIAL_TIMED if colset.timed else UNTIMED
    return typed_text(elaborator, unit_number(text, colset), colset, forms, False)


def typed_text(
    elaborator: Elaborator,
    text: SourceText,
    colset: Colset,
    forms: tuple[Form, ...],
    output: bool,
) -> tuple[Exp, Form] | None:
    """A text, and the first of the forms that fits it; None after an error."""
    types = [form_type(f, colset.type) for f in forms]
    found = elaborator.expression(text, types, expected_name=colset.name, output=output)
    return None if found is None else (found[1], forms[found[0]])


def form_type(form: Form, t: Type) -> Type:
    """The type of texts in a form, at a place with tokens of a type."""
    match form:
        case Form.TOKEN:
            return t
        case Form.MULTISET:
            return list_of(t)
        case Form.TIMED_TOKEN:
            return timed_of(t)
        case Form.TIMED_MULTISET:
            return list_of(timed_of(t))


def is_unit(colset: Colset) -> bool:
    """Whether CPN Tools' editor completes the texts at places of this colour set; it goes by the name."""
    return colset.name == "UNIT"


def unit_number(text: SourceText, colset: Colset) -> SourceText:
    """CPN Tools' editor shows 3`() as 3 on places of colour set UNIT."""
    if is_unit(colset) and _NUMBER.fullmatch(text.text):
        return SourceText(text.text.strip() + "`()", text.origin, text.marks)
    return text

"""The form of code segments: what the engine of CPN Tools was seen to accept and to refuse."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat

NET = """
    net Form
      standard
      var n: INT;  var s: STRING;
      page Top
        place A : INT = 1`1
        place S : STRING
        trans T
          in A : n
          {out}
          code {code}
"""


def codes(code: str) -> list[str]:
    out = "out S : s" if "output (s" in code else ""
    return [x.code for x in diagnose(NET.format(out=out, code=code)).items]


@pytest.mark.parametrize(
    "code",
    [
        "input (n); action (* c *) ();",
        "input (n); action () (* c *)",
        "input (n); action (* c *)",
        'input (n); output (s); action (* c *) "(* q *)";;',
        "input (); output (); action",
        "input (); output (); action ();",
    ],
)
def test_accepted(code: str) -> None:
    assert not codes(code)


@pytest.mark.parametrize(
    "code",
    [
        "(* c *) input (n); action ();",
        "input (n); (* c *) action ();",
        "input (n) (* c *); action ();",
        "input (n (* c *)); action ();",
        "(* c *) action ();",
        "input (n); action (); (* c *)",
        "action",
        "action;",
        "input (n); output (); action",
        "input (n);",
        "(* input (n); *)",
        "input (n); output (s);",
    ],
)
def test_refused(code: str) -> None:
    assert codes(code) == ["code-segment"]


def test_a_space_that_does_not_break_is_no_space() -> None:
    text = NET.replace("trans T", "trans T guard [n\u00a0< 3]").format(out="", code="action ()")
    assert "lexical-error" in [x.code for x in diagnose(text).items]


@pytest.mark.parametrize(
    "action",
    ["(n + 1) * 2", "((n) + 1) * (n)", "(f) (n)", "(n) handle _ => (2)", "(n > 1) andalso (n < 3)"],
)
def test_the_action_is_quoted_with_its_parentheses(action: str) -> None:
    """In the comment of the generated C; the operands have spans without theirs."""
    net = flat(
        f"""
        net Form
          standard
          var n: INT;  var m: {"BOOL" if "andalso" in action else "INT"};
          fun f x = x + 1;
          place A : INT = 1`1
          place B : {"BOOL" if "andalso" in action else "INT"}
          trans T
            in A : n
            out B : m
            code input (n); output (m); action {action}
        """
    )
    code = net.transitions[0].code
    assert code is not None
    assert code.action.span.text == action

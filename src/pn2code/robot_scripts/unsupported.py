"""What is raised where a part of a net has no form in a robot script."""

from __future__ import annotations

from pn2code.diagnostics import Span
from pn2code.robot_scripts import codes


class UnsupportedError(Exception):
    """An expression that scripts do not have; caught where the transition is translated.

    Args:
        hint: what to do about it.
    """

    def __init__(
        self,
        message: str,
        span: Span,
        code: str = codes.UNSUPPORTED_EXPRESSION,
        hint: str = "",
    ) -> None:
        super().__init__(message)
        self.message = message
        self.span = span
        self.code = code
        self.hint = hint

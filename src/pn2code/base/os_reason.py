"""Why a file could not be read or written, in words."""

from __future__ import annotations


def os_reason(problem: OSError | UnicodeDecodeError) -> str:
    """What the operating system says, to stand after a colon: "permission denied"."""
    if isinstance(problem, UnicodeDecodeError):
        return "not UTF-8 text"
    reason = problem.strerror or str(problem)
    return f"{reason[:1].lower()}{reason[1:]}"

"""Origins, diagnostics, the registry of their codes, and the ways they are printed."""

from pn2code.diagnostics.diagnostic import (
    Diagnostic,
    Diagnostics,
    Note,
    Severity,
    TooManyDiagnosticsError,
)
from pn2code.diagnostics.origin import NOWHERE, Origin, PlacedText, SourceText, Span

__all__ = [
    "NOWHERE",
    "Diagnostic",
    "Diagnostics",
    "Note",
    "Origin",
    "PlacedText",
    "Severity",
    "SourceText",
    "Span",
    "TooManyDiagnosticsError",
]

"""The built-in exceptions: by constructor, by qualified and by short name."""

from __future__ import annotations

from pn2code.ml.core.terms import Constructor
from pn2code.ml.core.types import EXN, STRING, TCon, Type, record, tuple_of

_EXCEPTIONS: tuple[tuple[str, Type | None], ...] = (
    ("Match", None),
    ("Bind", None),
    ("Div", None),
    ("Overflow", None),
    ("Subscript", None),
    ("Empty", None),
    ("Size", None),
    ("Chr", None),
    ("Domain", None),
    ("Option", None),
    ("Span", None),
    ("Fail", STRING),
    ("Subtract", None),
    ("no_singleton", None),
    ("CPN'Error", STRING),
    ("UnequalLengths", None),
    ("Io", record({"name": STRING, "function": STRING, "cause": EXN})),
    ("SysErr", tuple_of(STRING, TCon("option", (TCon("OS.syserror"),)))),
    ("Path", None),
    ("InvalidArc", None),
    ("Time", None),
    ("Date", None),
    ("Unordered", None),
    *(
        (name, None)
        for name in (
            "Bernoulli", "Binomial", "Uniform", "Discrete", "Normal", "Exponential", "Poisson", "Erlang", "Chisq",
            "Student", "Gamma", "Beta", "Weibull", "Rayleigh",
        )
    ),
    ("ClosedStream", None),
    ("IOError", STRING),
    ("InternalError", STRING),
    ("InvalidDataExn", None),
    ("DupConnNameExn", STRING),
    ("ElementMissingExn", STRING),
)  # fmt: skip


EXCEPTIONS: dict[str, tuple[Constructor, Type | None]] = {
    name: (Constructor(name, "exn", tag, argument is not None, 0), argument)
    for tag, (name, argument) in enumerate(_EXCEPTIONS)
}
"""The built-in exceptions: constructor and argument type. Tags of a net's own exceptions start at
`FIRST_EXCEPTION_TAG`.
"""


QUALIFIED_EXCEPTIONS: dict[str, str] = {
    "IO.Io": "Io",
    "IO.ClosedStream": "ClosedStream",
    "CPN'StreamIO.IOError": "IOError",
    "OS.SysErr": "SysErr",
    "OS.Path.Path": "Path",
    "OS.Path.InvalidArc": "InvalidArc",
    "Time.Time": "Time",
    "Date.Date": "Date",
    "IEEEReal.Unordered": "Unordered",
    "ListPair.UnequalLengths": "UnequalLengths",
    "ConnManagementLayer.InvalidDataExn": "InvalidDataExn",
    "ConnManagementLayer.DupConnNameExn": "DupConnNameExn",
    "ConnManagementLayer.ElementMissingExn": "ElementMissingExn",
    "Option.Option": "Option",
    "List.Empty": "Empty",
    **{
        f"General.{name}": name
        for name in (
            "Match", "Bind", "Div", "Overflow", "Subscript", "Size", "Chr", "Domain", "Span", "Fail",
        )
    },
}  # fmt: skip
"""Exceptions that have a qualified name."""


TOP_LEVEL_EXCEPTIONS: frozenset[str] = frozenset(
    {
        "Match", "Bind", "Div", "Overflow", "Subscript", "Empty", "Size", "Chr", "Domain", "Option", "Span", "Fail",
        "Subtract", "no_singleton", "CPN'Error", "InternalError",
        "Bernoulli", "Binomial", "Uniform", "Discrete", "Normal", "Exponential", "Poisson", "Erlang", "Chisq",
        "Student", "Gamma", "Beta", "Weibull", "Rayleigh", "DupConnNameExn", "ElementMissingExn",
    }
)  # fmt: skip
"""Exceptions that have a short name."""


FIRST_EXCEPTION_TAG = 100

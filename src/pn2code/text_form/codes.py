"""Diagnostic codes of nets as text."""

from pn2code.diagnostics.codes import register

TEXT_SYNTAX = register(
    "text-syntax",
    "a line of a net as text cannot be read",
    "A .cpnt file has declarations, and pages with places, transitions and their arcs, one on each line; what belongs "
    "to a line, or continues it, stands on deeper lines below it. docs/text.md describes all of it.",
)
TEXT_NAME = register(
    "text-name",
    "a name in a net as text is that of nothing, or of several things",
    "Arcs name places of their own page, a substitution transition names a page and the ports and sockets that belong "
    "together. So each name belongs to one place of a page, and to one page of the net.",
)
UNSUPPORTED_IN_TEXT = register(
    "unsupported-in-text",
    "the net has something that cannot be written as text",
    "The text has no monitors, no layout, and none of the things that CPN Tools itself does not execute. Two places of "
    "one name on a page cannot be told apart in it.",
)

"""Names that are written almost right."""

from __future__ import annotations

from pn2code.diagnostics.suggestions import did_you_mean, nearest


def test_nearest() -> None:
    assert nearest("Bufer", ["Buffer", "Belt"]) == "Buffer"
    assert nearest("BUFFER", ["Buffers", "Buffer"]) == "Buffer"
    assert nearest("Bufer", ["Buffed"], ["Buffer"]) == "Buffed"
    assert nearest("Gripper", ["Belt"]) == ""


def test_a_name_is_not_near_itself() -> None:
    assert did_you_mean("Buffer", ["Buffer", "Belt"], "else") == "else"
    assert nearest("Buffer", ["Buffer", "Buffers"]) == "Buffers"

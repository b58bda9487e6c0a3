"""Traces (docs/trace.md): written, read while they grow, merged, replayed by the token game."""

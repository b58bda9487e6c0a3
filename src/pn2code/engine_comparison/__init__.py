"""Comparison with what the real CPN Tools engine recorded of many nets; makes docs/conformance.md."""

"""Helpers for tests: nets in a short text form."""

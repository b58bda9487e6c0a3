"""Nets: link (names to things), check (types and binding), flatten (one instance of everything)."""

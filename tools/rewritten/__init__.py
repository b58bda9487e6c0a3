"""Nets written in another way, which must behave as before."""

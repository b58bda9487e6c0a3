"""Measurements: `./dev bench`. Not part of the tests."""

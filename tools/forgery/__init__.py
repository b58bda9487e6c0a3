"""Traces of real runs with one thing changed: `replay` must refuse each that says something else."""

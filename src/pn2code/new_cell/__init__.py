"""Cells to begin with: templates, and the files of a new cell."""

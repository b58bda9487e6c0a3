"""Emission: IR -> files in memory. Pure text: same input, same bytes."""

"""Nets in the formats of other tools: PNML, Promela (SPIN), CPN Tools."""

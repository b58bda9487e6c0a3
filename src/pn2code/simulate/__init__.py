"""Automatic simulation: one run, two engines (the compiled net, the reference token game), monitors, traces."""

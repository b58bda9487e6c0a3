"""Comparison with the real engine of CPN Tools, where it is at hand: `./dev oracle`."""

"""The token game: markings, what is enabled, what occurs."""

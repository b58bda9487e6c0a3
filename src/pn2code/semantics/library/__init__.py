"""What the built-in functions of CPN ML mean, by structure."""

"""Fuzzing the whole way from a file to generated C; see `__main__`."""

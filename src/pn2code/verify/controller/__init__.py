"""Whether a cell's supervisor may follow its execution scheme, and what a generated program needs."""

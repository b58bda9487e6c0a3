"""Random cells whose programs are looked at in turns, held against the whole space (docs/reductions.md)."""

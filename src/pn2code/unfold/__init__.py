"""Unfolding: a coloured net with finitely many colours as a place/transition net. See `unfold.unfold.unfold`."""

"""Verification: the compiled net explored exhaustively, and what its state space says about the net."""

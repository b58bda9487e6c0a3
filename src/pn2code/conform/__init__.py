"""Proof that programs are the model: the compiled core against the token game, each program
in product with the net."""

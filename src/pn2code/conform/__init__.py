"""Proof that programs are the model: the compiled core against the token game, the supervisor in product with the net."""

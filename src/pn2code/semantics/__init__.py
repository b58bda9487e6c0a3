"""The reference meaning of a net in Python: evaluator, multi-sets, token game. Shares nothing with
lowering or emission."""

"""Values of CPN ML in Python, colour sets over them, multi-sets and their texts."""

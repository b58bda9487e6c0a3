"""CPN ML text to a syntax tree: tokens, grammar, fixity."""

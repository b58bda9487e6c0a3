"""CPN ML expressions, functions and values as IR: bodies, choices, built-in functions, closures, types."""

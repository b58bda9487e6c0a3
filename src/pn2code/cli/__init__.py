"""The command line: one module per verb, no logic that a test cannot call directly."""

"""The command line: one module per verb, no logic that a test cannot call directly."""

from pn2code.cli import bytecode

bytecode.keep()  # before the verbs are loaded

"""Random cells with registers: what `verify` says of them in several ways, held against each other and against runs."""

# What `make` users expect; ./dev does the work and says what else there is.
.PHONY: thorough database-15 help test lint fuzz bench ml-suite conformance mutation oracle misspell

help:
	@./dev help

test lint bench ml-suite conformance mutation oracle misspell:
	./dev $@

# The tests with all of their long sweeps.
thorough:
	PN2CODE_THOROUGH=1 ./dev test

# The state space of the distributed database of 15 managers: minutes, and 1 to 2 GiB.
database-15:
	./dev bench --database-15

# Ten minutes of changed nets and random CPN ML, then some random nets compiled and compared with the token game.
fuzz:
	./dev fuzz --seconds 600
	./dev fuzz --nets 50

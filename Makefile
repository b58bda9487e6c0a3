# What `make` users expect; ./dev does the work and says what else there is.
.PHONY: thorough help test lint fuzz bench ml-suite conformance mutation

help:
	@./dev help

test lint bench ml-suite conformance mutation:
	./dev $@

# The tests with all of their long sweeps.
thorough:
	PN2CODE_THOROUGH=1 ./dev test

# Ten minutes of changed nets and random CPN ML, then some random nets compiled and compared with the token game.
fuzz:
	./dev fuzz --seconds 600
	./dev fuzz --nets 50

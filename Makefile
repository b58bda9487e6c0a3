# What `make` users expect; ./dev does the work and says what else there is.
.PHONY: help test lint fuzz bench ml-suite conformance

help:
	@./dev help

test lint bench ml-suite conformance:
	./dev $@

# Ten minutes of changed nets and random CPN ML, then some random nets compiled and compared with the token game.
fuzz:
	./dev fuzz --seconds 600
	./dev fuzz --nets 50

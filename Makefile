# What `make` users expect; ./dev does the work and says what else there is.
.PHONY: misra thorough database-15 help test lint fuzz hosts declarations expressions sanitized bench ml-suite conformance mutation oracle misspell elements forgery adversary registers rewritten geometry

help:
	@./dev help

test lint bench ml-suite conformance mutation oracle misspell elements forgery sanitized:
	./dev $@

# MISRA C:2012 in the deployed supervisor of the riveting cell; docs/misra.md has the deviations.
misra:
	./dev misra

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

# Two thousand random nets with references, exceptions, strings, lists and time: all hosts do what the token game does.
hosts:
	./dev fuzz --hosts 2000

# Every type at every position, three times over, with other expressions: all of it compiles without a warning, and agrees.
declarations:
	./dev fuzz --declarations 5445

# Random CPN ML over the whole library: alone, and on arcs, in guards, delays and code segments.
expressions:
	./dev fuzz --expressions 20000
	./dev fuzz --inscriptions 2000

# Random cells of two arms: what collides in PyBullet was never said to keep apart; and the examples.
geometry:
	./dev geometry
	./dev geometry --cells 200

# Nets and random cells written in other ways, which must behave as before.
rewritten:
	./dev rewritten examples
	./dev rewritten --cells 60

# A thousand random cells: what `verify` proves of them must be true in runs of their programs.
registers:
	./dev registers --cells 300

adversary:
	./dev adversary --cells 1000

# ruff: noqa: E501 - rows of texts
"""The part of docs/conformance.md about where the engine itself is wrong, or differs from its editor."""

ENGINE = """## Where the engine is wrong

`make oracle` gives random CPN ML (`--expressions`), random declarations (`--programs`), everything that the engine has in scope (`--library`), random nets (`--nets`) and published nets with one text changed (`--mutants`) to both the engine of CPN Tools and
pn2code; `--compiled` puts random CPN ML into compiled nets. The last run took 20,000 expressions (22 differed without a known reason, half of them fixed since), 3,000 programs (8) and all 7,211 values in scope. Of 1,366 compiled
expressions 1,361 agreed with the evaluator (of the others three need more memory than a small program has, one is an `Overflow` in an argument that is not needed, one the sign of a zero). The following faults of the engine are found again and again; the right column says what pn2code does.

| net | engine | pn2code |
|---|---|---|
| several arcs from one place that share variables with others: `(n, r)` and `(m, r)` | `InternalError: insert_transvar` or `ins_compressed`, the page cannot be checked; or it takes the variables for others: `No complete binding sequence`, `Cannot bind`, `IllegalBit`; mostly accepted when the arcs come in another order | accepts it with a warning (`arcs-share-variables`): a shared variable has one value |
| a record or tuple on an arc whose fields stand in another order than in the colour set, if one of them is known before: `{b = j, a = i}` and `[i = 1]` with `record a : INT * b : INT` | takes one field for another in its search: finds none or some of the tokens, also in state spaces, or cannot compile the code that it generated | finds all, with a warning (`engine-field-order`) |
| a declaration other than `val` in an arc inscription, guard or priority: `let fun f x = x + 1 in f n end` | `InternalError: Illegal FunDec`, the page cannot be checked | accepts it, with a warning (`declaration-in-inscription`) |
| `open` in an initial marking, a delay or a code segment: `let open List in hd l end` | `Uncaught Exception: Compile`, the page cannot be checked | accepts it, with a warning (`declaration-in-inscription`) |
| arcs from two places of one fusion set to one transition: ``2`()`` and `()` | looks at each for itself: enabled with 2 tokens, then `Subtract` | needs 3 tokens |
| a reset arc at an assigned port or a member of a fusion set | the simulator empties the place, the state space tool does not | empties it in both |
| a variable twice in one pattern: `(x, x)`, `[x, x]`, `x :: x :: l` | may take a token whose parts differ; then `Subtract`, or `Internal Error: rm ...` | requires both parts to be equal, with a warning (`pattern-repeats`) |
| a variable twice in a pattern of a guard equation: `[p = (x, x)]` | does not compare the two, so that the transition occurs where it should not | requires both parts to be equal, with a warning (`pattern-repeats`) |
| a guard equation with a variable twice on one side, of which no side is a pattern with variables: `[x * x = 4]`, `[#1 p + #2 p = 3]` | `InternalError: fun get_vids`, the page cannot be checked | tests it, with a warning (`guard-equation-repeats`) |
| a guard equation that gives a variable a value outside its colour set: `[s = n + 5]`, `s` of `int with 0..3` | binds it without a look; stops if it comes into a place that cannot hold it | there is no such binding; `verify` says *not known* |
| `Bind` raised by a guard (`let val (x :: _) = [] in x end`) before any token is tried or an equation has bound: `[f s > 0]` with all values of `s` | stops with `Bind`; elsewhere there is no binding | there is no binding; `verify` says *not known* |
| something that may raise an exception beside another condition: `[length l > 0, m = hd l]` | may compute it first, and stops, whatever the other condition is | asks in the order that docs/semantics.md says, with a warning (`guard-order`); `verify` asks in every order |
| a guard that is a list of conditions made by an operator other than `::`: `[a] ^^ [b]`, `[a] ++ [b]` | `InternalError: fun parse_guarditems`, the page cannot be checked | tests it, with a warning (`guard-list-operator`) |
| a guard that computes a list of conditions: `List.map f l`, `if c then [a] else []` | accepts it, and does not test it | tests it, with a warning (`guard-computed-list`) |
| a variable in a delay that nothing binds: `@+m` | accepts it, then cannot compile the code that it generated | `unbound-variable` |
| an operator at the top of an inscription of several arcs from one place (`h :: t` and `l`), or with a coefficient on an arc from a place with a clock: ``2`(h :: t)`` | writes it without the parentheses, then cannot compile the code that it generated | takes what is written, with a warning (`engine-code`) |
| a computed component of a tuple or record of which another one is known before a token is looked for: `(x, 1 + 1)`; `(a + 1, b)` | accepts it, then cannot compile the code that it generated | computes it, with a warning (`engine-code`); `unbound-variable` if a variable has no value |
| a guard equation for a variable that has its value already (`[j = j + 1]`; `[even j, i = j, j = 1]`), in a transition whose arcs fall into groups without a common variable | accepts it, compares a variable of another group, and cannot compile the code that it generated | tests it |
| an integer literal of more than 31 bits | accepts it, then cannot compile the code that it generated | `literal-too-large` |
| a port that has a socket at one substitution transition of the page and none at another | uses the wrong socket, or `Exception Subscript` | a separate place, with a warning |
| equal tokens with different time stamps | takes one at random, in state spaces, too | takes the latest that is available; `replay` accepts any |
| a timed multi-set on an input arc that is computed, with a delay: ``if c then 1`n@+1 else empty`` | takes tokens before their time, but only at times that come about otherwise: its clock does not stop for it | `unsupported-timed-input`; with the delay 0 it is taken |
| one token with a time stamp at a place of a fusion set: `3@+2` | "Mismatch in fusion group initial marking", also where it is the only place | `fusion-mismatch` |
| a timed net in which nothing can occur any more | its clock may advance to a time that it has noted for tokens that are gone | keeps the time of the last step |
| state spaces of timed nets, 4.0.0 | restores time stamps relative to the time of the node (those of 3.0.3 are right) | restores them correctly |
| top-level names that its state-space sources use | the state space tool cannot be entered | a warning (`state-space-name`) |
| an operator `cmp`, `time`, `not` or `ref` that is infix at top level | accepts the net, and cannot compile the code that it generated | a warning (`engine-infix`) |
| a socket that is the only place instance of a fusion set | the state space tool cannot be entered (`ExnDuringExecution`) | a warning (`state-space-fusion`) |
| a generator `Random.rand (a, b)` | gives the same numbers in each run: they depend on `a` and `b` alone | draws from the random numbers of the run, which `--seed` chooses |
| identifiers of the file with other characters than letters, digits, `_` and `'`; those of places that begin with `P` | accepts the net, and cannot compile it, or not enter the state space tool | a warning (`engine-id`) |

Of 1,700 generated transitions whose arcs and guards share variables (`--bindings`), 980 are refused by the engine, and all of these are refused or warned of here. Of the 720 that it accepts, 57 are refused here (`unbound-variable`):
it cannot compile the code that it makes of them, as was seen for each.

Of 263 such transitions that the engine accepts, each asked alone (`--uncompiled`), it could not compile the code of 60, of which 54 are refused or warned of here. Of the other six three take a sum of five or more summands from a
place with a clock, and three have an equation for a variable that has its value already. Of none that it compiled `check` says that it cannot; of some it says that it may be unable to, since CPN Tools takes one of several orders that cost the same.

Of 1,458 nets with the idioms of published models, changed so that they stay well-typed mostly (`--altered`), 1,450 verdicts were the same (three had no answer, and one was a fault of the engine); of
1,235 runs 1,199 were possible here, 23 depend on chance, and in 13 the engine is wrong. Of 70 state spaces 57 were the same, of eleven there was nothing to compare,
one depends on chance, and one net changes an array, which the engine does not restore. Four verdicts differed: three of initial markings of a fusion set with time stamps, which are the same now, and
one of a computed timed multi-set on an input arc (`unsupported-timed-input`).

Two more runs of up to 100 steps of each of the 361 nets with idioms (`--idioms --seed 7` and `8`): all verdicts but two faults of the engine were the same; 567 runs were possible here, nine depend on chance,
and in ten the engine is wrong. Of 380 published nets with one text wrapped or changed in other ways (`let`, `case`, `handle`, references, type variables, operators of multi-sets, stamps) 359 verdicts were the same, 17 were faults of the
engine that are warned of, three were of type variables in inscriptions, which are refused now, and one of `open` in an initial marking, which is warned of now; all initial markings and runs were the same.

Other portions of these campaigns (99 altered nets, 70 random nets, 140 nets with idioms, 60 changed published nets, 480 transitions, 8,000 expressions, 600 programs) showed no difference that is not a fault of the engine named here,
or a choice of words in which it tells of a type or an error.

Of 1,000 published nets with one text changed, 157 were accepted by both, with the same initial markings. The verdicts differed for four, all fixed since (reserved words,
an empty declaration); 34 differences were faults of the engine. Of 1,640 random nets in packs (820 for their state spaces, 820 for runs), 1,628 verdicts,
752 whole state spaces and 786 runs were the same. For most of the others the engine cannot compile the code that it generated. In a few it takes too many tokens, does not carry out a reset
arc, finds no order in which it could bind the arcs of a transition, or its state space tool cannot be entered (fusion sets of one place).

Nets that its editor refuses before the engine sees them (two nodes of one name on a page, a place beside a substitution transition that is no socket, a socket whose arcs do
not match the type of the port) are accepted with a warning. An arc without an inscription at a place that is not `UNIT` is refused, since the editor never lets the transition be checked.
"""

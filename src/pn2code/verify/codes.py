"""Diagnostic codes of verification."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

EXPLORER_FAILED = register(
    "explorer-failed",
    "the explorer failed",
    "The compiled explorer was killed, or did not say how it ended. If the system ended it (not enough memory), set a "
    "limit with `--memory`, so that it stops in time and reports what it has seen; otherwise this is a bug in "
    "pn2code.",
)
SWARM_UNAVAILABLE = register(
    "swarm-unavailable",
    "the workers of a swarm are not there",
    "`verify --swarm` has its searches carried out by `dask.distributed`, which `pip install 'pn2code[swarm]'` brings. "
    "With `--scheduler ADDRESS` they are those of a scheduler that has been started elsewhere: it has to be reached "
    "from here, and its workers need the same version of pn2code, and a C compiler.",
)
TIME_OVER = register(
    "time-over",
    "the time of `--max-seconds` was up before the work was done",
    "`--max-seconds` limits the whole command: reading and checking the net, translating it to C, compiling, "
    "exploring, answering and printing. Everything that was still running when the time was up has been ended, "
    "including the C compiler. Answers that are missing because of this are reported as not known (exit code 3). Give "
    "it more time. The compiled net is kept, so a second run needs less.",
    is_answer=True,
)
STATE_ERROR = register(
    "state-error",
    "an inscription raises an exception in a reachable marking",
    "While the state space was computed, an arc inscription, a guard, a delay or a code segment raised an exception "
    "(Overflow, Div, a value outside its colour set, ...), as in a simulation that reaches this marking. CPN Tools "
    "stops its calculation, too. What was seen until then is reported as partial.",
    is_answer=True,
)
OTHER_ORDER = register(
    "other-order",
    "CPN Tools may stop in a reachable marking, where it asks conditions in another order",
    "`verify` has looked at the reachable markings a second time, and computed whatever may raise an exception as soon "
    "as its variables have values, before other conditions are asked. In one of them something raises an exception "
    "that does not here, since another condition ends the question before. Which order CPN Tools takes cannot be told "
    "from the net (`guard-order`), so it is not known whether it stops there, and no answer is a yes. The run leads to "
    "that marking.",
    is_answer=True,
)
BEYOND_ROOM = register(
    "place-unbounded",
    "a place gets more tokens than can be explored",
    "A place was given more room several times, and its multi-set still grows: the place is probably unbounded, and "
    "the state space infinite. Limit the place in the net (a capacity place, a guard), or the exploration "
    "(`--max-states`).",
)
DRAWS_RANDOM = register(
    "state-space-random",
    "the state space of a net that draws random numbers is one of many",
    "A guard, an arc or a code segment draws a random number, reads a file, or asks for the number of steps. The "
    "state space then depends on the numbers drawn, and on the order of exploration: bounds and dead markings are "
    "those of this exploration only. It is the same in CPN Tools. Replace the random function by a free variable over "
    "a small colour set: all its values are then explored.",
)
CHANGES_REFERENCES = register(
    "state-space-references",
    "the values of references are a part of the state",
    "Transitions of the net assign references, and what is possible may depend on them. In pn2code a node is then a "
    "marking with its time and with the values of the references: two nodes may have the same marking, and every "
    "answer is about what a run of the net can do. CPN Tools does not restore references when it goes from one node "
    "to another: its state space of such a net depends on the order of its calculation, and may lack markings that a "
    "simulation reaches, or contain markings that no simulation reaches. Put what must be remembered into a place, "
    "and both agree.",
)
CHANGES_WHILE_SEARCHING = register(
    "state-space-search-effect",
    "references change while bindings are searched for",
    "A guard or an input arc assigns a reference. It is not determined how often such an inscription is evaluated: "
    "CPN Tools does it whenever it checks whether the transition is enabled. So the value of the reference does not "
    "follow from what has occurred, and the net has no state space. Assign references in code segments, or on output "
    "arcs.",
)
REPORT_UNWRITABLE = register(
    "report-unwritable",
    "a report cannot be written",
    "The file that `--report`, `--draw` or `--plot` names cannot be opened or written: the folder is missing, there is "
    "no permission, or the disk is full. The exploration itself is complete, and its result is printed.",
)
GRAPH_NOT_DRAWN = register(
    "graph-not-drawn",
    "the graph of a state space is not drawn",
    "`--draw` draws small state spaces: at most 300 nodes as `.svg`, 2,000 as `.html`, with at most 12 times as many "
    "arcs; larger pictures cannot be followed by eye. It needs the whole graph: no limit was hit, and neither "
    "`--approximate` nor `--no-graph` was given. Everything else that was requested is done. `--plot` shows the "
    "course of a long exploration.",
)
REDUCTION_NOT_POSSIBLE = register(
    "reduction-not-possible",
    "a requested reduction of the state space is not possible for the net",
    "A reduction leaves states out, or treats some as the same, and preserves the answers only for nets that do not "
    "look at the difference. `--reduce time` identifies states that differ only in the model time: no inscription may "
    "read the time, `step()` or the stamps of tokens, and nothing outside the marking (references, random numbers, "
    "files) may have an influence. `--reduce symmetry` exchanges equal parts of the net (page instances with what "
    "belongs to them), or permutes colours: then it looks at all binding elements beforehand, and the net must be "
    "untimed, without code segments and references, over finite colour sets. So does `--reduce partial-order` where "
    "that is possible; elsewhere it goes by transitions, and needs an untimed net in which no inscription draws random "
    "numbers, looks at files or clocks, or asks for the number of steps. The net is explored without the reduction.",
)
SWEEP_NOT_POSSIBLE = register(
    "sweep-not-possible",
    "markings cannot be forgotten while the net is explored",
    "`--sweep` forgets markings that cannot come back. For that some weighted number of tokens must never become "
    "smaller, and become greater now and then; or time must go on (in a net whose times are whole numbers, without "
    "`--reduce time`). Places count of which each change is known exactly, so those whose arcs take or put as many "
    "tokens as a variable says do not. The net is explored without it.",
)
REDUCTION_MISMATCH = register(
    "reduction-mismatch",
    "the compiled net differs from the net on which a reduction rests",
    "In each state the explorer compares the enabled binding elements of the compiled net with those of the unfolded "
    "one, on which the reduction rests. They differ, which is a bug in pn2code. The results do not count.",
)
SPILL_FULL = register(
    "spill-full",
    "the folder of `--spill` is full, or cannot be written",
    "Tables that are larger than memory are kept in files of the folder that `--spill` names. It is full, or cannot "
    "be written: the exploration stops, and what was seen until then is reported as partial.",
)
TRACE_UNWRITABLE = register(
    "dead-trace-unwritable",
    "a trace to a dead marking cannot be written",
    "The run to a dead marking is written into the folder `NET.traces`, or into that of `--traces`. There is no "
    "permission, or the disk is full. The results are not affected. `--most-traces 0` writes no traces.",
)
CONTROL_FAILED = register(
    "controller-check",
    "the supervisor fails a check of its execution scheme",
    "Before a supervisor is generated, the states of the cell as it runs are searched (docs/execution.md): it must "
    "come to rest in each cycle, within a bounded number of firings, whatever the order; a final marking must remain "
    "reachable; no channel may get two messages. `pn2code verify cell.toml` writes the run that shows what is wrong. "
    "`pn2code generate --unchecked` generates the supervisor all the same, and says so in the generated files.",
)
CONTROL_OPEN = register(
    "controller-unchecked",
    "it is not known whether the supervisor keeps to its execution scheme",
    "Not all states of the cell as it runs were seen (`generate` looks at 3,000,000), or there is no C compiler. "
    "The programs are generated, and say that they are not checked. `pn2code verify cell.toml` has no such limits.",
    is_answer=True,
)
CONTROL_BEYOND = register(
    "controller-beyond",
    "this machine cannot look at the states of the cell",
    "Before a supervisor is generated, up to 3,000,000 states of the cell as it runs are searched "
    "(docs/execution.md), whatever time that takes, so that every machine comes to the same program. On this one there "
    "is too little memory, or the search has computed for a quarter of an hour, perhaps in an inscription that has no "
    "end. Nothing is generated, since another machine might generate something else. `pn2code generate --unchecked` "
    "generates the supervisor without the search, and says so in the generated files.",
)
CAPACITY_UNPROVED = register(
    "capacity-unproved",
    "nothing proves how many tokens a place of the supervisor can hold",
    "The size of each array in the generated program is a proven bound: from an invariant of the net's structure, or "
    "from its complete state space. No bound of this place is proven. Declare a bound in cell.toml, `[capacity] place "
    "= n` (the supervisor stops safely when the place gets more), or limit the place in the net.",
)
CAPACITY_LARGE = register(
    "capacity-large",
    "a place can hold more tokens than a program has room for",
    "The size of each array in the generated program is a proven bound, up to 1,048,576 tokens in a place. Limit the "
    "place in the net. If it never really holds so many tokens, declare in cell.toml how many it holds: the "
    "supervisor stops safely when there are more.",
)
CAPACITY_ASSUMED = register(
    "capacity-assumed",
    "nothing proves how many tokens a place can hold",
    "The program was generated with room for some tokens, and stops safely, with the place's name, when there are "
    "more. The head of net.c says which places these are. A cell.toml with `[capacity]` declares bounds.",
)
SHORT_TIMER = register(
    "short-timer",
    "a timer of the supervisor is over before the answer that it waits for can come",
    "A transition of the supervisor sends a command and starts a timer, and the answer ends the wait, or the timer "
    "does. What tools, waits and delays of the robot or device take between command and answer is written in "
    "cell.toml and in the net (moves count as nothing), and it is longer than the timer: in a run the timer is always "
    "first. The state space has the answer in time as well, because a check holds for all durations. Make the timer "
    "longer.",
)
LONG_TIMER = register(
    "long-timer",
    "a timer of the supervisor waits longer for an answer than `reply_timeout_s` permits",
    "A transition of the supervisor sends a command and starts a timer, for the case that no answer comes. But whoever "
    "has got a flag and sends nothing for longer than `reply_timeout_s` stops the cell, so that the timer is never "
    "over then, and what should follow does not. The state space has it all the same, because the net knows no "
    "`reply_timeout_s`. Make `reply_timeout_s` longer than the timer, or the timer shorter.",
)

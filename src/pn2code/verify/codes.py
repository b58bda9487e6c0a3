"""Diagnostic codes of verification."""

from __future__ import annotations

from pn2code.diagnostics.codes import register

EXPLORER_FAILED = register(
    "explorer-failed",
    "the explorer failed",
    "The compiled explorer was killed or did not say how it ended. When the system ended it (not enough memory), give "
    "it a limit with `--memory`, so that it stops in time and tells what it has seen; else this is a bug in pn2code.",
)
TIME_OVER = register(
    "time-over",
    "the time of `--max-seconds` was over before the work was done",
    "`--max-seconds` limits the whole command: reading and checking the net, translating it to C, compiling, "
    "exploring, answering and printing. What was running when the time was over has been ended, the C compiler "
    "included; what is not known because of that is reported as not known (exit code 3). Give it more time. A net that "
    "has been compiled once is kept, so that the second run needs less.",
)
STATE_ERROR = register(
    "state-error",
    "an inscription raises an exception in a reachable marking",
    "While the state space was computed, an arc inscription, a guard, a delay or a code segment raised an exception "
    "(Overflow, Div, a value outside its colour set, ...), as in a simulation that comes there. CPN Tools stops its "
    "calculation likewise. What was seen until then is reported as partial.",
)
BEYOND_ROOM = register(
    "place-unbounded",
    "a place gets more tokens than can be explored",
    "A place was given more room again and again, and its multi-set still grows: the place is probably unbounded, and "
    "the state space infinite. Limit the place in the net (a capacity place, a guard), or the exploration "
    "(`--max-states`).",
)
DRAWS_RANDOM = register(
    "state-space-random",
    "the state space of a net that draws random numbers is one of many",
    "A guard, an arc or a code segment draws a random number, reads a file, or asks for the number of steps. The "
    "state space then depends on the numbers drawn, and on the order of exploration: bounds and dead markings hold for "
    "this exploration only. In CPN Tools it is the same. Replace the random function by a free variable over a small "
    "colour set: all its values are then explored.",
)
CHANGES_REFERENCES = register(
    "state-space-references",
    "what references hold is a part of the state",
    "Transitions of the net assign references, and what is possible may depend on them. For pn2code a node is then a "
    "marking with its time and with what the references hold: two nodes may have the same marking, and every answer is "
    "about what a run of the net can do. CPN Tools does not restore references when it goes from one node to another: "
    "its state space of such a net depends on the order of its calculation, and may lack markings that a simulation "
    "reaches, or have ones that no simulation reaches. Put what is to be remembered into a place, and both agree.",
)
CHANGES_WHILE_SEARCHING = register(
    "state-space-search-effect",
    "references change while bindings are searched for",
    "A guard or an input arc assigns a reference. How often such an inscription is evaluated is not determined: CPN "
    "Tools does it whenever it wants to know whether the transition is enabled. So what the reference holds does not "
    "follow from what has occurred, and the net has no state space. Assign references in code segments, or on "
    "output arcs.",
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
    "arcs; more cannot be followed by eye. It needs the whole graph: no limit was hit, no `--approximate`, no "
    "`--no-graph`. Everything else that was asked for is done. `--plot` draws how a long exploration went.",
)
REDUCTION_NOT_POSSIBLE = register(
    "reduction-not-possible",
    "a reduction of the state space that was asked for does not fit the net",
    "A reduction leaves states out, or takes some for the same, and keeps the answers only for nets that do not look "
    "at the difference. `--reduce time` takes states for the same that differ only in how late it is: no inscription "
    "may read the time, `step()` or the stamps of tokens, and nothing outside the marking (references, random numbers, "
    "files) may decide. `--reduce partial-order` and `--reduce symmetry` look at all binding elements before: the net "
    "has to be untimed, without code segments and references, over finite colour sets. The exploration goes on without "
    "the reduction.",
)
REDUCTION_MISMATCH = register(
    "reduction-mismatch",
    "the compiled net does not do what a reduction was told that it does",
    "In each state the explorer compares the enabled binding elements of the compiled net with those of the unfolded "
    "one, on which the reduction rests. They differ: this is a bug in pn2code. Nothing that was found counts.",
)
SPILL_FULL = register(
    "spill-full",
    "the folder of `--spill` is full, or cannot be written",
    "Tables that are larger than memory lie in files of the folder that `--spill` names. It is full, or cannot be "
    "written: the exploration stops, and what was seen until then is reported as partial.",
)
TRACE_UNWRITABLE = register(
    "dead-trace-unwritable",
    "a trace to a dead marking cannot be written",
    "The run to a dead marking is written into the current folder, or into that of `--traces`: there is no permission, "
    "or the disk is full. What was found is not affected. `--most-traces 0` wants no traces.",
)
CONTROL_FAILED = register(
    "controller-check",
    "the supervisor fails a check of its execution scheme",
    "Before a supervisor is generated, the states of the cell as it runs are searched (docs/execution.md): it must "
    "come to rest in each cycle, within a bounded number of firings, whatever the order; a final marking must stay "
    "within reach; no channel may get two messages. `pn2code verify cell.toml` writes the run that shows what is "
    "wrong. `pn2code generate --unchecked` generates it all the same, and says so in the generated files.",
)
CONTROL_OPEN = register(
    "controller-unchecked",
    "it is not known whether the supervisor keeps to its execution scheme",
    "The states of the cell as it runs were not all seen (the limits of `generate` are small), or there is "
    "no C compiler. The programs are generated, and say that they are not checked. `pn2code verify cell.toml` has no "
    "limits of its own.",
)
CAPACITY_UNPROVED = register(
    "capacity-unproved",
    "nothing proves how many tokens a place of the supervisor can hold",
    "The arrays of the generated program are as large as a bound that is proven: by an invariant of the net's "
    "structure, or by its complete state space. No bound of this place is proven. Declare a bound in cell.toml, "
    "`[capacity] place = n`: the supervisor stops safely when the place gets more; or limit the place in the net.",
)
CAPACITY_LARGE = register(
    "capacity-large",
    "a place can hold more tokens than a program has room for",
    "The arrays of the generated program are as large as a bound that is proven, up to 1,048,576 tokens in a place. "
    "Limit the place in the net. If it never really holds so many, declare in cell.toml how many: the supervisor stops "
    "safely when there are more.",
)
CAPACITY_ASSUMED = register(
    "capacity-assumed",
    "nothing proves how many tokens a place can hold",
    "The program was generated with room for some tokens, and stops safely, with the place's name, when there are "
    "more. The head of net.c says which places these are. A cell.toml with `[capacity]` declares bounds.",
)

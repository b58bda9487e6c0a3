"""Diagnostic codes of the translation of robot pages to scripts."""

from pn2code.diagnostics.codes import register

NOT_SEQUENTIAL = register(
    "robot-not-sequential",
    "a robot's part of the net is not a sequential program",
    "A robot script is one thread of control. The places of a robot must be: places that together always hold exactly "
    "one token, which every transition of the robot moves (the position in the program); places that always hold "
    "exactly one token, which is only replaced (variables); and channels (files). The message names the element that "
    "does not fit, e.g. a transition that puts two tokens, or a place whose tokens accumulate.",
)
UNSUPPORTED_PROGRAM = register(
    "unsupported-robot-program",
    "a robot page uses something that scripts cannot do",
    "For example an inhibitor or reset arc, a multi-set inscription with a coefficient other than 1, a variable that "
    "nothing binds (a free choice; `[sensors]` in cell.toml says who decides it), or guards on several messages of "
    "which only some have come.",
)
UNSUPPORTED_TIME = register(
    "unsupported-robot-time",
    "a robot page uses model time in a way that scripts cannot",
    "A delay on the control token, which represents the position in the program, becomes a `wait`. Other tokens of a "
    "robot cannot wait: data have no time stamps, the program begins at the start (no `@` in its initial marking), "
    "arcs have delays (`@+`) but no stamps (`@`), nothing is taken before its time (`@+` on an input arc), and a "
    "transition with commands has no delay as well, because the commands take their own time: let one transition "
    "carry them out and another one wait.",
)
UNSUPPORTED_EXPRESSION = register(
    "unsupported-robot-expression",
    "an expression cannot be translated to the script language",
    "Scripts have integers, reals, Booleans, strings, poses, lists of these, arithmetic, comparisons, conditionals and "
    "field selection. Functions of the net are inlined. Of lists there are `[a, b]`, `a :: l`, the patterns `[]` and "
    "`a :: l`, `hd`, `tl`, `length`, `null`, `List.nth`, `rev` and `^^`; one transition for each item goes along a "
    "list. A list that is put into a place whose items have bounds (a range, a subset) is made of variables of this "
    "colour set and of items that are written out, with `::`, `^^`, `rev`, `tl` of a variable, and `if` between such "
    "lists: of others a script cannot ask whether all their items are in it. Functions that take functions (`map`, "
    "`sort`), references, exceptions, recursion, trigonometry and random numbers belong on the supervisor's pages.",
)
UNSUPPORTED_COLSET = register(
    "unsupported-robot-colset",
    "a robot page uses a colour set that scripts do not have",
    "Places of a robot may hold units, booleans, integers, times, reals, strings, enumerations, and "
    "records and products of these. A record of six reals named x y z rx ry rz is a pose. There may be lists of "
    "booleans, integers, times, reals, strings, enumerations and poses (x y z rx ry rz in this order); lists of "
    "lists, units, products and other records belong on the supervisor's pages.",
)
CHOICE = register(
    "robot-choice",
    "two transitions of a robot may be enabled together",
    "A net chooses freely, but a script follows the documented order: priority first, then the order in the file. If "
    "this is not intended, add guards that exclude each other, e.g. `k = 1` and `k = 2`; if it is, accept the warning "
    'in cell.toml: `[[accept]]` with `warning = "robot-choice"`, `elements` (both transitions) and a `reason`.',
)
PRIMITIVE = register(
    "robot-primitive",
    "a robot primitive is used in a way that is not a command",
    "Primitives are the functions named in `[primitives]` of cell.toml. Moves and measurements take a pose, "
    "`move_axes` takes a joint position, `move_circular` two poses, `tool` and `move_home` take unit, `wait` takes a "
    "number of seconds. They are called in code segments only. A device has no arm: it can `wait` and do `tool` "
    "actions.",
)

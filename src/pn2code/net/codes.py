"""Diagnostic codes of linking, checking and flattening."""

from pn2code.diagnostics.codes import register

SUBPAGE_UNKNOWN = register(
    "subpage-unknown",
    "a substitution transition stands for a page that does not exist",
    "The substitution transition names its page by id, and the file has no page of that id.",
)
PAGE_RECURSION = register(
    "page-recursion",
    "a page contains itself",
    "A page's substitution transitions may not lead back to the page, directly or through other pages: the net would "
    "be infinite.",
)
PORT_UNASSIGNED = register(
    "port-unassigned",
    "a port has no socket",
    "A port place of a page is not assigned to a place next to the substitution transition. As in CPN Tools it is "
    "then a separate ordinary place, which is rarely intended. If the port has a socket at another substitution "
    "transition of the page, this is a warning: the engine of CPN Tools cannot give the marking of such a net "
    "(`Exception Subscript raised when checking marking`), stops its simulation after a few steps, and does not enter "
    "the state-space tool.",
)
SOCKET_UNASSIGNED = register(
    "socket-unassigned",
    "a place that is connected to a substitution transition is not a socket",
    "A place that has an arc to a substitution transition should be assigned to a port of the page that the "
    "transition stands for. The editor of CPN Tools refuses the net otherwise; in pn2code the arc has no meaning.",
)
SOCKET_ARCS = register(
    "socket-arcs",
    "the arcs of a socket do not match the type of its port",
    "A socket of an input port has an arc to the substitution transition, that of an output port an arc from it, that "
    "of an I/O port both (or one with two heads). Otherwise the editor of CPN Tools refuses the net; in pn2code only "
    "the assignment of the port counts.",
)
NAME_NOT_UNIQUE = register(
    "name-not-unique",
    "two nodes of a page, or two pages, have the same name",
    "The editor of CPN Tools refuses a net in which two places or two transitions of a page, or two pages, have the "
    "same name (`name not unique`). It compares the names as it sends them to its engine: cut at the first character "
    "that is not a letter, digit, blank, `_` or `'`. pn2code distinguishes such nodes by a number after the name.",
)
PORT_ASSIGNMENT = register(
    "port-assignment",
    "a port assignment cannot be used",
    "An assignment pairs a port place of the subpage with a place beside the substitution transition. One that names "
    "something else is ignored, but CPN Tools refuses one between a place beside the transition and something that is "
    "not on the subpage; if a port is assigned twice, the last assignment counts, as in CPN Tools.",
)
PORT_COLSET = register(
    "port-colset",
    "port and socket have different colour sets",
    "A port and its socket are one place, so they need the same colour set.",
)
PORT_INITIAL = register(
    "port-initial",
    "the initial marking of a port is not used",
    "A port and its socket are one place with one initial marking: the socket's, as in CPN Tools.",
)
FUSION_MISMATCH = register(
    "fusion-mismatch",
    "places of a fusion set differ",
    "All places of a fusion set are one place, so they need the same colour set and the same "
    "initial marking. Like CPN Tools pn2code compares the tokens with their time stamps, not the texts; but `3` and "
    "1`3, a token and a multi-set, differ, and so do multi-sets with and without time stamps. One token with a time "
    "stamp (`3@+2`) CPN Tools accepts at no place of a fusion set. Where pn2code cannot say what an initial marking is "
    "(it depends on chance, or raises an exception), it warns.",
)
NET_EMPTY = register(
    "net-empty",
    "nothing can happen in a net",
    "The net has no transitions, or no places. It is well-formed, but every answer about it is idle: its only marking "
    "is the initial one. Substitution transitions are no transitions of their own: the transitions of their pages are.",
)
FUSION_MEMBER = register(
    "fusion-member",
    "a fusion set and its places do not agree",
    "A fusion set lists a place that does not exist or that does not name the set, or a place names a fusion set "
    "that does not list it or does not exist. As in CPN Tools, what the place says decides: it belongs to the set that "
    "it names, if that exists, and to no other.",
)
SUBSTITUTION_INSCRIPTION = register(
    "substitution-inscription",
    "an inscription of a substitution transition has no effect",
    "A substitution transition stands for a page and never fires itself, so its guard, delay, "
    "priority and code segment and its arcs' inscriptions mean nothing.",
)
UNSUPPORTED_CHANNEL = register(
    "unsupported-channel",
    "synchronous channels of CPN Tools are not supported",
    "CPN Tools 4 can synchronise transitions over channels (`ch.!x`, `ch.?y`), an experimental feature, which its "
    "engine refuses without an extension. Merge the transitions, or use a place between them.",
)
DECLARATION_EMPTY = register(
    "declaration-empty",
    "a declaration declares nothing",
    "`globref` declares a reference with an initial value. One without a value declares nothing, and CPN Tools skips "
    "it, too. A declaration in CPN ML that is empty, or only a comment, is refused by CPN Tools.",
)
DECLARATION_UNREAD = register(
    "declaration-not-read",
    "CPN Tools could not read a declaration",
    "The file contains the text of a declaration that CPN Tools itself did not understand (`errordecl`), usually one "
    "in the old syntax of Design/CPN. It declares nothing until it is entered again.",
)
PORT_DIRECTION = register(
    "port-direction",
    "a port is used against its direction",
    "The transitions of a page only take tokens from an input port, and only put tokens into an output port; a port "
    "that is used in both ways must be an I/O port. CPN Tools runs such a net all the same.",
)
MONITOR_NODE = register(
    "monitor-node",
    "a monitor watches something that does not exist",
    "A monitor names the places and transitions that it watches by id. One that does not exist (any more) is skipped.",
)
PORT_IDLE = register(
    "port-idle",
    "a port has no arc on its page",
    "No transition of the page puts tokens into the port place or takes any from it. CPN Tools accepts that without a "
    "word; mostly an arc was forgotten, or leads to another place of a similar name.",
)
PLACE_IDLE = register(
    "place-idle",
    "a place has no arc",
    "No transition puts tokens into the place, takes any from it or looks at it, nor does any with a place that is the "
    "same by a port or a fusion set. CPN Tools accepts that without a word; mostly an arc was forgotten, or leads to "
    "another place of a similar name.",
)
UNSUPPORTED_DECLARATION = register(
    "unsupported-declaration",
    "a kind of declaration is not supported",
    "The declaration block has an element that is not a colour set, variable, reference or CPN ML "
    "text: a channel, or a declaration that CPN Tools itself could not read and kept as raw text.",
)
UNSUPPORTED_EXCEPTION = register(
    "unsupported-exception",
    "an exception of a function may be met in another call of it",
    "Each call of a function makes the exceptions that it declares anew, so that a handler in one call does not handle "
    "what another call has raised. In pn2code there is one for all calls. Where a call may meet the exception of "
    "another one (the function calls itself, or gives away a function that raises it), the net is refused.",
)
UNSUPPORTED_TIMED_INPUT = register(
    "unsupported-timed-input",
    "this form of timed input inscription is not supported",
    "On input arcs pn2code understands sums of `coefficient`value` with `@+` or `@++` delays, and `if`, `case`, `let` "
    "and calls of functions that give multi-sets with the delay 0. With another delay CPN Tools takes what is computed "
    "before its time, but only at times that come about otherwise, which the net does not tell. Constants of timed "
    "multi-sets have the times of their declaration. Neither is supported there, nor are absolute time stamps `@`, "
    "which CPN Tools refuses.",
)
PLACE_COLSET = register(
    "place-colset",
    "the colour set of a place is not declared",
    "The type inscription of a place must be the name of a declared colour set. A place without "
    "one has UNIT, which must then be declared too.",
)
NEIGHBOUR_WRONG = register(
    "neighbour-wrong",
    "a transition is connected to a place with an error",
    "What the inscriptions between a transition and a place may be depends on the place. CPN Tools does not check a "
    "transition before the places beside it are right; pn2code checks what it can.",
)
ARC_EMPTY = register(
    "arc-empty",
    "an arc has no inscription",
    "Arcs need an inscription that says which tokens they move; only at places of colour set UNIT does an empty one "
    "mean 1`(). The editor of CPN Tools never lets a transition with such an arc be checked, so the net cannot run "
    "there, and there is no message.",
)
ARC_IGNORED = register(
    "arc-inscription-ignored",
    "the inscription of an inhibitor or reset arc has no effect",
    "Inhibitor arcs test that a place has no tokens, and reset arcs empty it. An inscription means nothing there.",
)
ARC_AS = register(
    "arc-as-pattern",
    "an arc inscription has a pattern with `as`",
    "pn2code understands `x as pattern` on an input arc of an untimed place, where x is bound to the whole token. CPN "
    "Tools 4.0.0 reports `syntax error` and refuses the net. Write the pattern without `x as` and `_`, with a "
    "variable for each part, and repeat the pattern on output arcs; or write `x` and take it apart in the guard.",
)
UNBOUND_VARIABLE = register(
    "unbound-variable",
    "a variable of a transition gets no value",
    "Each variable of a transition is bound by an input arc whose inscription (or a summand of "
    "it) is a pattern with the variable, by a guard equation `variable = expression`, by "
    "enumeration if its colour set has at most 100 values, or by the output of the code segment. "
    "Function calls, arithmetic and `if` on an input arc only test, and so do summands whose "
    "coefficient contains a variable.",
)
FREE_VARIABLE = register(
    "free-variable",
    "a variable is bound by no input arc",
    "A variable of a colour set with at most 100 values need not be bound: where it is on output arcs alone, CPN Tools "
    "draws one of the values in a simulation, and a state space has an arc for each; where a guard or a function on "
    "an input arc uses it, all values are tried. That is how a choice of the environment is written, such as what a "
    "sensor says on the page of a robot. In a supervisor there is nobody who chooses: the program takes the first "
    "value that is possible, always the same. There the variable is mostly missing on an input arc.",
)
DECLARATION_INSIDE = register(
    "declaration-in-inscription",
    "an inscription declares something other than a value",
    "CPN Tools looks for the variables of an arc inscription, a guard or a priority by itself, and of declarations it "
    "knows `val` only: at `let fun f x = x + 1 in f n end` it ends with `InternalError: Illegal FunDec`, and the page "
    "cannot be checked. In code segments, time inscriptions of transitions and initial markings all declarations but "
    "`open` are possible: there it ends with `Uncaught Exception: Compile`.",
)
LOCAL_NAME = register(
    "local-name-of-variable",
    "CPN Tools takes a local name for a variable of the net",
    "CPN Tools goes by the names in an arc inscription or a guard: in `List.exists (fn n => n > 2) l` it sees the "
    "variable `n` of the net, if there is one, although the `n` is that of `fn`. So it is with `case` and `handle`, "
    "with an earlier `val` of the same `let`, and with the last part of `Int.max`. The transition then has that "
    "variable, too: without a value from elsewhere CPN Tools tries all values of a small colour set, so that the "
    "transition has as many bindings that do the same, and it refuses a large one (`unbound-variable`). pn2code does "
    "as CPN Tools does.",
)
ENGINE_ORDER = register(
    "engine-order",
    "it is not known whether CPN Tools finds an order in which variables get values",
    "CPN Tools refuses a transition for whose variables it finds no order in which tokens, equations and small colour "
    "sets give them values. pn2code makes the same search, but gives it up where a transition has very many summands "
    "and conditions. It accepts such a transition.",
)
GUARD_REPEATS = register(
    "guard-equation-repeats",
    "a guard equation has a variable twice on one side",
    "CPN Tools looks for a side of a guard equation that binds variables. If neither side is a pattern with variables "
    "and one of them has a variable twice, as in `[x * x = 4]`, it ends with `InternalError: fun get_vids`, and the "
    "page cannot be checked. `[x * x = 4 andalso true]`, `[x * x <= 4]` and `[x * x = y]` are accepted. pn2code "
    "accepts and tests all of them.",
)
CODE_OUTPUT_BOUND = register(
    "code-output-bound",
    "an output of a code segment is bound already",
    "Variables in `output (..)` of a code segment get their values from its action, so they may "
    "not occur in the guard or on input arcs.",
)
NET_TOO_LARGE = register(
    "net-too-large",
    "the net has too many page instances",
    "Each substitution transition makes an instance of its page, and pages nest, so a small file "
    "can describe an enormous net. pn2code refuses nets with more elements than it could ever "
    "run.",
)
SUMMANDS_SHARE = register(
    "summands-share-variables",
    "summands of one arc share variables, and each has others of its own",
    "CPN Tools binds all variables of an arc at the same time. Of several summands that share a variable without a "
    "value it uses only one to bind; the others are only tested. For 1`(a, b) ++ 1`(a, c) it reports `No complete "
    "binding sequence found`. If the shared variable gets its value from another arc or a guard, the arc is accepted, "
    "and so is 1`(a, b) ++ 1`(b, a), whose second summand has no variable of its own.",
)
BINDING_CIRCLE = register(
    "binding-circle",
    "variables need each other's values",
    "CPN Tools tries all values of a variable only where nothing could give it one. In the guard [c = d] each side "
    "could give the other its value, so that neither is tried, and it reports `No complete binding sequence found` "
    "unless one of them has a value from an input arc or another guard. The same happens for [c = next c], and for a "
    "variable that is in a pattern and in its own coefficient: (size c)`c.",
)
ARCS_SHARE = register(
    "arcs-share-variables",
    "CPN Tools cannot bring together the variables of two arcs from one place",
    "Its engine keeps variables that arcs and conditions connect in groups, and an arc from a place that has another "
    "arc belongs to the group of that one. It takes the arcs in the order of the file, the last one first, those in "
    "both directions in the end. If an arc begins with a new variable and has one that is known, it says "
    "`InternalError: insert_transvar`, whatever else binds them: at (n, r) and (m, r). If the group has become part of "
    "another one in between, it says `InternalError: ins_compressed`; if the variables are of another group, it takes "
    "them for others, and accepts the transition or not. pn2code accepts such a net: a shared variable has one value.",
)
ENGINE_CODE = register(
    "engine-code",
    "CPN Tools cannot compile the code that it makes of an arc",
    "It writes the arcs from one place as one sum, and the value of each behind its coefficient without the "
    "parentheses: of `h :: t` and `l` it makes 1`h::t ++ 1`l. With `if` it may be compiled, and then means something "
    "else. From a place with a clock it does so with a single arc, too, if the coefficient is not 1: 2`(n + 1). It "
    "accepts the net, and says so only when it is to be simulated. So it is with a tuple or record of which a "
    "component is known before a token is looked for (a constant, or a variable that stands elsewhere, too), if a "
    "component is computed: (n + 1, p), (n, 1 + 1), {a = f n, b = p}. It makes a pattern of it. pn2code takes what is "
    "written.",
)
PATTERN_REPEATS = register(
    "pattern-repeats",
    "a pattern has a variable twice",
    "Of a variable that is twice in the pattern of an input arc, (n, n) or [n, n] or {a = n, b = n}, CPN Tools binds "
    "one, and does not compare the other one: it may take a token whose parts differ, and stop with `Subtract` or an "
    "`InternalError` when the transition occurs, in simulations and in state spaces. An equation of a guard, "
    "p = (n, n), holds there whatever the other one is, so that the transition occurs where it should not. Where the "
    "variable has its value before, from other arcs or equations, it depends on the order in which CPN Tools binds; "
    "there is a warning if it may go wrong. pn2code requires the parts to be equal.",
)
ENGINE_FIELDS = register(
    "engine-field-order",
    "CPN Tools may miss tokens, because the fields of a record are written in another order",
    "Where a component of a record or tuple is known before a token is looked for (a constant, or a variable that an "
    "equation of the guard or another arc gives a value), CPN Tools searches for tokens with that component. If the "
    "arc has the fields in another order than the colour set, {b = j, a = i} with colset R = record a : INT * b : INT, "
    "it takes one component for another: it finds none or some of the tokens, also in state spaces, or it cannot "
    "compile the code that it makes. pn2code finds all of them. Written in the order of the colour set both find the "
    "same.",
)
INITIAL_EFFECT = register(
    "initial-marking-effect",
    "an initial marking changes a reference",
    "CPN Tools evaluates initial markings when it checks a net and again when it makes the initial state, places in an "
    "order of its own and those of fusion sets once more. A marking that counts in a reference, 1`(tick ()), is "
    "different each time. pn2code evaluates every initial marking once, in the order of the file.",
)
INITIAL_INSTANCE = register(
    "initial-marking-instance",
    "an initial marking uses the number of the page instance",
    "In arcs, guards, delays and code segments `inst ()` is the number of the page instance. When CPN Tools makes the "
    "initial marking it has another value, the same for all instances of a page: 1 more than the number of instances "
    "of the page of the place that it made before, in an order that depends on how the net was opened and changed. In "
    "pn2code it is the number of the instance there, too.",
)
SPACE_NAME = register(
    "state-space-name",
    "a name of the net hides one that the state-space tool of CPN Tools uses",
    "CPN Tools compiles the sources of its state-space tool after the declarations of the net. A constant, function, "
    "value or colour set whose name these sources use keeps them from compiling: `Exception raised entering state "
    "space tool`. The simulator is not affected, and neither is pn2code.",
)
SPACE_FUSION = register(
    "state-space-fusion",
    "the only place of a fusion set is a socket",
    "CPN Tools cannot enter its state-space tool (`Exception raised entering state space tool`) with a net in which "
    "the only place instance of a fusion set is the socket of a substitution transition. The simulator is not "
    "affected, and neither is pn2code.",
)
ENGINE_ID = register(
    "engine-id",
    "CPN Tools cannot work with an identifier of the file",
    "CPN Tools makes names of its own of the identifiers of places, transitions and pages. With a character that is no "
    "letter, digit, underscore or prime it cannot compile the net that it has accepted (of a page: enter its "
    "state-space tool); nor can it enter this tool where the identifier of a place begins with `P`. Its editor writes "
    "`ID` and a number. pn2code takes any identifier.",
)
ENGINE_INFIX = register(
    "engine-infix",
    "an infix operator has the name of a function that CPN Tools uses itself",
    "CPN Tools makes functions for each colour set (`lt`, `cmp`, `ord`, `legal`, ...), and code for each transition. "
    "After `infix lt` at top level it refuses the enumerations, indexes, products, records and unions that follow; "
    "with `infix cmp`, `time`, `not` or `ref` it accepts the net and cannot compile its transitions.",
)
RESERVED_WORD = register(
    "reserved-word",
    "a reserved word of CPN Tools is declared",
    "CPN Tools reserves some names besides the keywords of Standard ML: `size`, `time`, `ms`, `list`, `color`, "
    "`input`, `Node`, ... It refuses a colour set, variable, value, function, type, constructor, label or exception "
    "with such a name: `Reserved word cannot be used as identifier`. Inside expressions and structures the names may "
    "be used.",
)
NOT_IN_CPN_ML = register(
    "not-in-cpn-ml",
    "a declaration of Standard ML is not one of CPN ML",
    "CPN Tools refuses `open` anywhere in a declaration, `signature`, `datatype a = datatype b`, and an expression "
    "where a declaration is expected.",
)
GUARD_ORDER = register(
    "guard-order",
    "CPN Tools may ask the conditions of a transition in another order, in which one raises an exception",
    "Conditions are asked one after the other, and the first that is false ends the question. In which order CPN Tools "
    "asks cannot be told from the net: with `[length l >= 2, m = hd l]` it computes `hd l` first, and stops with "
    "`Empty` at an empty list, in the simulator and in the state space; with `[length l > 0, hd l > 0]` it does not, "
    "and with `[n > 1, length l > 0, hd l > n]` it does. pn2code asks as soon as the variables have values, in the "
    "order in which the conditions are written. What it finds, also that no exception is raised, holds for this "
    "order. Within `andalso` and `if` the order is that of Standard ML in both.",
)

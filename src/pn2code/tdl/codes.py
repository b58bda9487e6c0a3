"""Diagnostic codes of the robot script language."""

from pn2code.diagnostics.codes import register

SYNTAX = register(
    "tdl-syntax",
    "the script does not follow the grammar",
    "The message says what was found and what could stand there. docs/tdl.md has the grammar."
    " Frequent causes: `=` instead of `:=` in an assignment, a missing `then` or `loop`, a "
    "block without its `end if` or `end loop`.",
)
NESTING = register(
    "tdl-nesting",
    "the script is nested too deeply",
    "Expressions may be nested 100 levels deep and blocks 40 levels. Use a variable or a "
    "procedure.",
)
DUPLICATE = register(
    "tdl-duplicate",
    "a name is declared twice",
    "Files, constants, variables and procedures share one set of names; labels have a separate set in each body.",
)
RESERVED = register(
    "tdl-reserved",
    "a name of the language is declared again",
    "The names of the built-in functions and of the types cannot be used for other things: `var abs : int` is an "
    "error.",
)
UNKNOWN_NAME = register(
    "tdl-unknown-name",
    "a name is not declared",
    "Every variable, constant and procedure is declared before `begin`: `var n : int`.",
)
UNKNOWN_FILE = register(
    "tdl-unknown-file",
    "a file is not declared",
    "Every shared file is declared at the top with its direction and type: `input flag "
    '"flag.robcad" : int`.',
)
FILE_DIRECTION = register(
    "tdl-file-direction",
    "a file is used against its direction",
    "A file has exactly one writer. A script reads, clears and waits for its `input` files "
    "and writes its `output` files, never the other way round.",
)
FILE_VALUES = register(
    "tdl-file-values",
    "a message has the wrong number of values",
    "`read F into a, b` and `write F a, b` name one variable or value for each type in the declaration of `F`.",
)
NOT_A_VARIABLE = register(
    "tdl-not-a-variable",
    "a name cannot be used like this",
    "For example a constant cannot be assigned, a procedure has no value, and a file's "
    "message must be read into a variable first.",
)
TYPE = register(
    "tdl-type",
    "a value has the wrong type",
    "The message says which type was found and which is expected, e.g. a condition must be `bool`.",
)
UNIT = register(
    "tdl-unit",
    "units do not fit",
    "Lengths, angles, times and speeds cannot be mixed, and a plain number is none of them: "
    "`p.x + 100` is a mistake, `p.x + 100 mm` is right. Multiplying by a plain number keeps "
    "the unit, dividing like by like removes it: `p.x / 1 mm`.",
)
UNKNOWN_UNIT = register(
    "tdl-unknown-unit",
    "there is no such unit",
    "Units are mm, cm, m, deg, rad, s, ms, min, mm/s, m/s, and %.",
)
UNKNOWN_TYPE = register(
    "tdl-unknown-type",
    "there is no such type",
    "Types are int, real, bool, string, pose, length, angle, time, speed; files also have the"
    " type signal.",
)
UNKNOWN_FUNCTION = register(
    "tdl-unknown-function",
    "there is no such function",
    "Expressions can call the built-in functions of docs/tdl.md; procedures are called with "
    "`call`.",
)
ARGUMENTS = register(
    "tdl-arguments",
    "a function has the wrong number of arguments",
    "`pose` takes six: x, y, z (lengths), rx, ry, rz (angles). The others are listed in docs/tdl.md.",
)
UNKNOWN_FIELD = register(
    "tdl-unknown-field",
    "there is no such field",
    "A pose has the fields x, y, z, rx, ry, rz; other values have none.",
)
UNKNOWN_FRAME = register(
    "tdl-unknown-frame",
    "there is no such frame",
    "Frames are `world` (absolute), `tool` (an increment in the tool frame as it is when the move begins), and those "
    "of `[frames]` in cell.toml.",
)
FRAME = register(
    "tdl-frame",
    "a move cannot be made in this frame",
    "`move $joint` goes to an absolute pose; only `move $linear` and `move $circular` can be incremental "
    "(`in tool`). HOME and `axes(...)` are joint positions, which have no frame.",
)
EXTERNAL = register(
    "tdl-external",
    "a move and external axes do not go together",
    "`move $external with $track rail = 1200 mm` moves external axes alone; other moves can move them together with "
    "the arm: `move $linear p in seam with $turntable plate = 30 deg`. On `move $joint home` they stand still.",
)
UNKNOWN_MOTION = register(
    "tdl-unknown-motion",
    "there is no such motion",
    "Motions are `$joint` (point to point, all axes together), `$linear` (the TCP on a straight line) and `$circular` "
    "(the TCP on an arc).",
)
VIA = register(
    "tdl-via",
    "a pose on the way is missing, or is no use",
    "`move $circular END via POSE` goes on the arc from where the TCP is through the position of POSE to END. "
    "`move $linear END via P, Q with $blend = 20 mm` goes on lines from pose to pose, with corners that are rounded "
    "within 20 mm of them. Joint moves go by way of no pose.",
)
SPEED = register(
    "tdl-speed",
    "a speed is out of range",
    "A joint speed is a fraction of the configured speed, above 0 % and at most 100 %. A linear speed is above zero, "
    "and a duration is not negative.",
)
UNKNOWN_LABEL = register(
    "tdl-unknown-label",
    "a label is missing",
    "`goto L` needs a label `L:` in the same body (program or procedure).",
)
UNUSED_LABEL = register(
    "tdl-unused-label",
    "a label is never used",
    "No `goto` leads to the label; remove it.",
)
UNREACHABLE = register(
    "tdl-unreachable",
    "a statement can never be reached",
    "It comes after an `exit`, `goto`, `stop` or `return`, or after a `loop` without `exit`, and no label leads to "
    "it.",
)
EXIT = register(
    "tdl-exit",
    "`exit` outside a loop",
    "`exit` leaves the innermost `loop` or `while`; to end a procedure use `return`.",
)
RECURSION = register(
    "tdl-recursion",
    "procedures call each other in a circle",
    "Procedures share the program's variables and have none of their own, so recursion has no"
    " use; it is refused.",
)
WAIT_NOTHING = register(
    "tdl-wait-nothing",
    "a wait can never end",
    "While a script waits, only files change, so the condition of `wait until` must ask for one: `wait until "
    "filled(F)`.",
)
UNASSIGNED = register(
    "tdl-unassigned",
    "a variable may be read before it has a value",
    "On some path from the beginning no statement assigns it. Give it a value where it is "
    "declared: `var n : int := 0`.",
)
UNUSED = register(
    "tdl-unused",
    "something declared is never used",
    "A variable that is assigned but never read, a constant, a file or a procedure that "
    "nothing uses.",
)
CONSTANT = register(
    "tdl-constant",
    "the value of a constant is not known before the script runs",
    "Constants are made of literals and of constants declared before them.",
)

"""Diagnostic codes of `cell.toml`, the partition and its channels."""

from pn2code.diagnostics.codes import register

CELL_FILE = register(
    "cell-file",
    "cell.toml cannot be read",
    "The cell description is missing, is not readable, or is not TOML. The message gives the line and column "
    "of the first mistake as the TOML parser reports it.",
)
CELL_KEY = register(
    "cell-key",
    "a key of cell.toml is missing or not known",
    "Each section of cell.toml has a fixed set of keys, see docs/cell.md. A key that is not known is an error rather "
    "than silently ignored, because a misspelt `reply_timeout_s` would otherwise leave the cell without its timeout.",
)
CELL_VALUE = register(
    "cell-value",
    "a value of cell.toml has the wrong type or range",
    "The message says which value was found and what is expected, e.g. a number of seconds above zero.",
)
SENSOR_BLIND = register(
    "sensor-blind",
    "a sensor looks at a place where no part can ever stand",
    "`sees` of a sensor names a place of cell.toml. Parts come into the cell where their kind has `at`, and where a "
    "primitive creates them; if none comes near that place, and no tool takes any, the sensor says `false` each time.",
)
INPUT = register(
    "input-file",
    "the input files that were given do not fit the cell",
    "`--input` names a folder with the files of all `[[input]]` entries of cell.toml, or one file, if there is one "
    "entry. A file is missing, or its text is not a token of its place (the message gives line and column), or the "
    "cell reads no files.",
)
INPUT_MISSING = register(
    "input-missing",
    "an input file of the cell is not there",
    "`file` of an `[[input]]` entry names a file beside cell.toml, which the supervisor reads when it starts. Another "
    "program may write it before the run; what is said until then is about the initial marking that the place has in "
    "the net.",
)
CELL_UNKNOWN_PAGE = register(
    "cell-unknown-page",
    "cell.toml names a page instance that the net does not have",
    "`instance` is the name of a substitution transition of the top page (or a path such as `Line/Robot1`). "
    "Owners own all transitions of the page instance below it.",
)
CELL_UNKNOWN_PLACE = register(
    "cell-unknown-place",
    "cell.toml names a place that the net does not have",
    "A place is given by its name, or by as much of its path (`Top.Supervisor.Finished`) as makes it unique.",
)
CELL_UNKNOWN_LAYOUT = register(
    "cell-unknown-layout",
    "there is no such layout in cell.toml",
    "Layouts are the sections `[layouts.NAME]`; each replaces some values of the file for one run.",
)
CELL_OWNER = register(
    "cell-owner",
    "a transition has no owner, or two",
    "Every transition of the net must lie on the page instance of exactly one owner: the supervisor or one robot.",
)
CELL_FINAL = register(
    "cell-final",
    "a final place cannot show that the supervisor has finished",
    "`final` of [supervisor] lists places of the supervisor: the cell has finished when one of them holds a token. "
    "The supervisor sees neither the places of a robot nor the contents of a channel, so a place of a robot or a "
    "channel cannot be final. Nor can a place with a timed colour set: its token may lie in the future. If no "
    "transition of the supervisor puts a token into the place, there is a warning: the "
    "cell never ends there.",
)
PRIMITIVE_ENTRY = register(
    "primitive-entry",
    "an entry of [primitives] does not fit the net",
    "Each entry of [primitives] names a function of the net whose type is that of its command, see the table in "
    "docs/cell.md. An entry that names no function is an error, because the calls of the function that was meant "
    "would be missing from the scripts.",
)
PRIMITIVE_AXIS = register(
    "primitive-axis",
    "a robot is told to move what belongs to another one",
    "External axes (`track`, `turntable` of an entry of [primitives]) and frames that turn with a turntable belong to "
    "the robot in whose table they are. Only its own script moves them, so that where they stand is known when a move "
    "begins.",
)
PRIMITIVE_TOOL = register(
    "primitive-tool",
    "what is said of a tool that robots change does not fit the primitives",
    "`tools` of a robot in cell.toml lists the tools of `[tools]` that it may couple: their TCPs, masses and shapes "
    "are part of what is planned and checked for this robot. Only these can its script couple and uncouple. "
    "`does` of a tool names the actions of [primitives] for which it is needed.",
)
PRIMITIVE_UNNAMED = register(
    "primitive-unnamed",
    "a call in a robot's code segment is no command and has no effect",
    "A script carries out the primitives that the code segments of its page call, and computes values with pure "
    "functions. A call of a function that no entry of [primitives] names, and whose value nobody uses, would silently "
    "be missing from the script. So would a call of a function that is declared among the primitives, that is, in a "
    "block of declarations with `primitive` in its name. Such a function that nobody calls is only a warning, because "
    "nothing is missing from any script.",
)
PRIMITIVE_MISPLACED = register(
    "primitive-misplaced",
    "a primitive is used where no robot carries it out",
    "The functions of [primitives] are commands: a robot or device carries them out where a code segment of its own "
    "page calls them. In a transition of the supervisor, a guard, an arc inscription, a delay, an initial marking or "
    "a constant they do nothing.",
)
CHANNEL_DIRECTION = register(
    "channel-direction",
    "a channel needs exactly one writer and one reader",
    "A place that two owners share becomes a file: one owner puts tokens (output arcs only), the other takes them "
    "(input arcs only). Test arcs (both directions), inhibitor and reset arcs, or a third owner would need a lock that "
    "shared files do not have. A value that the supervisor sets and that others look at can be a register "
    '(`kind = "register"`, docs/cookbook.md, `A value that several read`).',
)
REGISTER = register(
    "register",
    "a place is no register",
    "A `[[channel]]` of kind `register` is a value that the supervisor sets and that robots and devices look at. Its "
    "place holds exactly one token from the start. Each transition of the supervisor that uses it takes this token and "
    "puts one; each of a robot or device puts back what it has taken, or looks with a test arc. Nothing else may use "
    "the place: no inhibitor or reset arc, no time stamps, no input file (docs/protocol.md, Registers).",
)
CHANNEL_UNDECLARED = register(
    "channel-undeclared",
    "a shared place has no channel in cell.toml",
    "Each place shared by two owners needs a `[[channel]]` entry that gives its file and kind (data or flag).",
)
CHANNEL_NOT_SHARED = register(
    "channel-not-shared",
    "a channel's place is not shared by two owners",
    "The place of a `[[channel]]` entry must be touched by exactly two owners.",
)
CHANNEL_INITIAL = register(
    "channel-initial",
    "a channel must be empty initially",
    "Channel files hold `0` when the cell starts, so the place must have no initial marking.",
)
CHANNEL_TIMED = register(
    "channel-timed",
    "the colour set of a channel is timed",
    "A message is seen as soon as it is written, so it cannot carry a time stamp in the future. Use an untimed colour "
    "set for the channel, and put delays on the writer's or the reader's own places.",
)
CHANNEL_LIMIT = register(
    "channel-limit",
    "a cell has more channels, robots or values in a message than a supervisor can carry",
    "A supervisor has room for 128 channels and 64 robots and devices, a message for 64 scalars. Split a large "
    "message into two channels, or a large cell into two with a supervisor each.",
)
UNSUPPORTED_CHANNEL_COLSET = register(
    "unsupported-channel-colset",
    "the colour set of a channel or input cannot be written as one line of scalars",
    "Messages are lines of scalars: unit, bool, int, time, real, string, enumerations, indexes, products and records "
    "of these, lists of all that, and products and records with such lists. Unions, lists of lists, and lists in the "
    "elements of lists are no messages, and input files have no lists.",
)

CELL_MISSING = register(
    "file-missing",
    "a file is missing",
    "The file or folder given on the command line does not exist.",
)
ACCEPT_UNNEEDED = register(
    "accept-unneeded",
    "cell.toml accepts a warning that there is not",
    "An `[[accept]]` entry is about a warning that `check` gives, with exactly the elements that it names. The code or "
    "a name is misspelt, or what was warned of has been mended: then remove the entry, lest it hide the next one.",
    is_answer=True,
)

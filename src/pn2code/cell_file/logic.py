"""The sections on which the generated programs depend, and what is reported of a run."""

from __future__ import annotations

from pn2code.cell_file.devices import DEVICE_AXIS, DEVICE_PLACE
from pn2code.cell_file.keys import Key, Section

NET = Section(
    (
        Key(
            "file",
            "text",
            "The net, a `.cpn`, `.cpnt` or `.pnml` file, relative to the folder of cell.toml.",
            "a file name",
            required=True,
        ),
    )
)
SUPERVISOR = Section(
    (
        Key(
            "instance",
            "text",
            "The substitution transition whose page instance, with all below it, is the supervisor: a name, or a path "
            "such as `Line/Supervisor`.",
            "a substitution transition",
            required=True,
        ),
        Key(
            "final",
            "texts",
            "Places of the supervisor that it marks itself. A token in one of them means that the cell has finished; "
            'several places tell how it ended (`["Finished", "Failed"]`). Without this key the cell never ends.',
            "a list of places",
        ),
        Key(
            "order",
            "text",
            '`"any"`: it must not matter in which order the supervisor fires within a cycle. `"documented"`: where it '
            "matters, the documented order is intended ([execution.md](execution.md), *confluence*).",
            default="any",
            words=("any", "documented"),
        ),
        Key(
            "reply_timeout_s",
            "number",
            "A robot that owes an answer for longer stops the cell.",
            "a number of seconds",
            default=120.0,
            unit="s",
            low=0.0,
            above=True,
            high=1_000_000.0,
        ),
    )
)
STORED = Key(
    "COLSET",
    "text",
    "How reals of this colour set (a colour set of kind real) are kept: `float32` rounds them to single precision "
    "whenever a token is put into a place.",
    default="float64",
    words=("float32", "float64"),
)
VALUE = Key(
    "NAME",
    "scalar",
    "Replaces `val NAME` of the net.",
    "a boolean, number or string",
)
BOUND = Key(
    "PLACE",
    "whole",
    "A declared bound: the greatest number of tokens that the place may hold; the supervisor stops safely when there "
    "are more. See *Capacity*.",
    "a number from 1 to 1000000",
    low=1,
    high=1_000_000,
)
INPUT = Section(
    (
        Key(
            "place",
            "text",
            "The place whose initial marking, one token, is read from a file when the supervisor starts. See *Input "
            "files*.",
            "a place",
            required=True,
        ),
        Key(
            "file",
            "text",
            "The file, beside cell.toml or in the folder of `--input`.",
            "a file name",
            required=True,
        ),
    )
)
REGISTER = "register"
CHANNEL = Section(
    (
        Key(
            "place",
            "text",
            "A place that two programs share: each token in it is a message. Its colour set is not timed, and made of "
            "scalars and of lists of these or of records of these: no union, no list of lists.",
            "a place",
            required=True,
        ),
        Key(
            "file",
            "text",
            "The file of its messages, a name of at most 160 printable bytes ([protocol.md](protocol.md)).",
            "a file name",
            required=True,
        ),
        Key(
            "kind",
            "text",
            '`"data"` is written before `"flag"`. A program that receives a flag of the supervisor owes it an '
            "answer (I8), so a message that is never answered should be data. Without the key a token of one scalar "
            "is a flag, of several, or of a list, data. `check` prints a table of all channels, with what decided "
            'their kind. A `"register"` is a value that the supervisor sets and that robots and devices look at '
            "([protocol.md](protocol.md#registers)); its `file` gives the names of the files, two for each "
            "reader.",
            words=("data", "flag", REGISTER),
        ),
    )
)
DEVICE = Section(
    (
        Key(
            "instance",
            "text",
            "The substitution transition whose page instance is the program of this device: a conveyor, a gauge, an "
            "operator's panel. It has a script like a robot, but no arm: it waits, acts (`tool`), moves its own axes, "
            "reads and writes messages.",
            "a substitution transition",
            required=True,
        ),
        Key(
            "axes",
            "named",
            "What moves of it, by its name, as of a robot: a door, a clamp "
            "([robots.md](robots.md#devices-that-move)).",
            inner=DEVICE_AXIS,
            entry="NAME",
            is_word=True,
        ),
        *DEVICE_PLACE,
    )
)
SENSOR = Section(
    (
        Key(
            "variable",
            "text",
            "A variable on the pages of robots or devices that nothing in the net binds: the script asks this sensor "
            "for its value. Without the key the sensor's name is meant. See *Sensors*.",
            "a variable of the net",
        ),
        Key(
            "file",
            "text",
            "In a run: its values, one a line, over and over.",
            "a file name",
        ),
        Key(
            "default",
            "scalar",
            "What it says each time where there is no such file. With neither, values are drawn at random.",
            "a value of the variable",
        ),
        Key("seed", "whole", "Of what is drawn at random.", "a whole number", default=1),
        Key(
            "sees",
            "text",
            "In a run the sensor, of a truth value, says at the time it is asked: of a name of `[places]`, whether a "
            "part stands there; of one of `[zones]`, whether an arm is in it; of `DEVICE.AXIS`, whether the axis is at "
            "`at`. See *Sensors that see the scene*.",
            "the name of a place, a zone or an axis",
        ),
        Key(
            "part",
            "text",
            "with `sees`: Only a part of this kind, a name of `[parts]`, is seen; without it, any part.",
            "the name of a kind of parts",
        ),
        Key(
            "at",
            "number",
            "with `sees` of an axis: Where that is seen, to 1 mm or 0.1 degrees; m, or degrees of what turns.",
            "a number",
        ),
        Key(
            "says",
            "text",
            "What it tells, in plain words: pages show them where a person may choose it.",
            "a text",
            default="",
        ),
    )
)
ACTION = Key(
    "LABEL", "text", "An action of a tool, whose occurrences are counted.", "a tool action"
)
TRANSITION = Key(
    "LABEL",
    "text",
    "A transition whose occurrences are counted: its path, which then means this transition alone, or else its name or "
    "the end of its path.",
    "a transition",
)
REPORT = Section(
    (
        Key(
            "rows",
            "texts",
            "Channels whose messages stand side by side in `rows.tsv`: the k-th of each in row k.",
            "a list of channels",
        ),
        Key(
            "count",
            "entries",
            "Tool actions that are counted, `label = action`.",
            "a table label = action",
            of=ACTION,
            entry="LABEL",
        ),
        Key(
            "occurrences",
            "entries",
            "Transitions that are counted, `label = transition`.",
            "a table label = transition",
            of=TRANSITION,
            entry="LABEL",
        ),
        Key(
            "failed",
            "texts",
            "Places of `final` that mean that the cell has failed, though the run has come to its end: such an end is "
            "red on pages and on the screen, and a *no* in `report`. An entry that begins with `{` is a condition on "
            'the marking at the end, as in properties: `"{ Mark.Supervisor\'Result 1 = [scrap] }"`.',
            "a list of places and conditions",
        ),
        Key(
            "warn_condition",
            "number",
            "Condition numbers above this are reported as close to a singularity.",
            "a number",
            default=50.0,
            low=0.0,
            above=True,
        ),
    )
)
ACCEPT = Section(
    (
        Key(
            "warning",
            "text",
            "The code of the warning, as it stands in brackets behind the word.",
            "the code of a warning",
            required=True,
        ),
        Key(
            "elements",
            "texts",
            "What the warning is about: all elements that it and its notes name, as `PAGE'NAME` or by name alone "
            "(`check --json` lists them). Of cell.toml its keys. Without the key: one about the whole net.",
            "a list of elements of the net",
        ),
        Key("reason", "text", "Why it is accepted; `report` prints it.", "a text", required=True),
    )
)
PROPERTY = Section(
    (
        Key("name", "text", "How it is called, once in a file.", "a text", required=True),
        Key("says", "text", "What it means, in plain words.", "a text", default=""),
        Key(
            "holds",
            "text",
            "The property itself ([properties.md](properties.md)).",
            "a text",
            required=True,
        ),
        Key(
            "expect",
            "flag",
            "`false`: the property is known to be false, and `verify` is content when it is.",
            default=True,
        ),
        Key("fair", "texts", "Transitions that are treated fairly.", "a list of transitions"),
        Key(
            "about",
            "text",
            '`"net"`: about the closed net alone, not about the programs of the cell.',
            default="cell",
            words=("cell", "net"),
        ),
    )
)

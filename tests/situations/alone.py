"""`--dry-run`, and a net without a cell: the whole net in memory."""

from __future__ import annotations

from helpers.counted import Done, Lab
from situations import situation


def ended(done: Done, code: int, *words: str) -> Done:
    """It has said why, and touched nothing."""
    assert done.code == code and not done.shared.exists(), done
    for word in words:
        assert word in done.error, done
    return done


@situation
def whole_runs(lab: Lab) -> None:
    done = lab.run("rivet.traced", "--dry-run")
    assert done.code == 0 and done.err == "" and not done.shared.exists()
    for robot in (1, 2):
        assert done.out.count(f"supervisor -> robot{robot}  dadosrobo{robot}.robcad: ") == 22
    done = lab.run("odd", "--dry-run", order=2)
    assert done.code == 0 and "robot1 -> supervisor  answer.robcad: 1" in done.out
    assert lab.run("odd", "--dry-run", "-q", order=2).out == ""
    assert lab.run("odd", "--dry-run", order=20).code == 0, "900 firings that repeat nothing"


@situation
def two_messages(lab: Lab) -> None:
    said = "channel-overrun: place `Odd.command` holds 2 messages; command.robcad can hold one"
    ended(lab.run("odd", "--dry-run", order=4), 1, said)


@situation
def values_that_cannot_be_written(lab: Lab) -> None:
    for order, place in ((5, "level"), (8, "big"), (12, "command"), (16, "say")):
        said = f"the token of place `Odd.{place}` cannot be written to {place}.robcad"
        ended(lab.run("odd", "--dry-run", order=order), 1, said)


@situation
def repetitions(lab: Lab) -> None:
    done = ended(
        lab.run("odd", "--dry-run", order=13),
        1,
        "nobody but supervisor can do anything, and it repeats",
    )
    assert done.error.startswith("no end in a final place (`Odd.Done`, ...): ")
    assert '`Odd.Turn` {"n": 50}' in done.error and done.error.count("Odd.Turn") == 3
    done = ended(lab.run("odd", "--dry-run", order=14), 1, "for ever: `Odd.Turn`", ", ...; sensors")
    assert done.error.count("Odd.Turn") == 8
    assert lab.run("odd", "--dry-run", order=19).code == 0, "chance has ended it"
    one = lab.program("odd", "-DODD_FINALS=1U")
    assert "in a final place (`Odd.Done`): " in ended(lab.run(one, "--dry-run", order=13), 1).error
    done = ended(lab.run("odd", "--dry-run", "--max-firings", "40", order=13), 1)
    assert done.error == "no end after 40 firings (--max-firings N allows more)"


@situation
def no_end(lab: Lab) -> None:
    done = ended(lab.run("odd", "--dry-run", order=3), 1)
    assert (
        done.error
        == "deadlock: nothing is enabled, and no final place (`Odd.Done`, ...) holds a token"
    )
    one = lab.program("odd", "-DODD_FINALS=1U")
    assert "no final place (`Odd.Done`) holds" in ended(lab.run(one, "--dry-run", order=3), 1).error
    none = lab.program("odd", "-DODD_FINALS=0U")
    assert lab.run(none, "--dry-run", order=3).code == 0, "it may rest anywhere"
    ended(
        lab.run("odd", "--dry-run", order=1001),
        1,
        "a number is too large (`Overflow`), while firing `Odd.Odd`",
    )


@situation
def time(lab: Lab) -> None:
    done = lab.run("odd", "--dry-run", order=15)
    assert done.code == 0 and "Odd.Late  1" in done.out, "it jumps"
    assert lab.run("odd", "--dry-run", "--time-scale", "1e5", order=15).code == 0, (
        "or is waited for"
    )
    assert lab.run("odd", "--dry-run", "--time-scale", "800", order=15).code == 0, (
        "more than a second"
    )
    for n in (1, 2):  # while it waits for a second at a time
        done = lab.run(
            "odd", "--dry-run", "--time-scale", "1e-3", order=15, failing=f"ppoll:{n}:!2"
        )
        ended(done, 130, "interrupted by signal 2")
    ended(lab.run("odd", "--dry-run", order=7), 130, "interrupted by signal 15")


@situation
def nets_without_a_cell(lab: Lab) -> None:
    for flags in (("-DODD_NO_CHANNELS",), ("-DODD_NO_CHANNELS", "-DODD_OWNERS=66U")):
        program = lab.program("odd", *flags)
        for order in (0, 2, 15, 20):
            done = lab.run(program, order=order)
            assert done.code == 0 and "transitions:\n" in done.out and not done.shared.exists(), (
                flags,
                order,
                done,
            )
    deployed = lab.program("odd.deployed", "-DODD_NO_CHANNELS")
    assert lab.run(deployed, "-v").code == 0
    whole = lab.program("odd", "-DODD_NO_CHANNELS", "-DODD_NO_OWNER", "-DODD_FINALS=0U")
    done = lab.run(whole, "--max-firings", "5", order=13)
    assert (
        done.code == 0
        and "stopped after 5 firings, transitions are still enabled (--max-firings N" in done.out
    )
    assert "still enabled" not in lab.run(whole, "--max-firings", "1").out

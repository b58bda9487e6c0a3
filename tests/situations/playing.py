"""What the net does: errors of its inscriptions, promises that it breaks, and what the supervisor makes of them."""

from __future__ import annotations

from helpers.counted import Done, Lab
from situations import situation

RAISED = {
    0: "no error (`no error`)", 1: "a number is too large (`Overflow`)", 2: "division by zero (`Div`)",
    3: "no rule fits the value (`Match`)", 4: "a value does not fit its pattern (`Bind`)",
    5: "an index is out of range (`Subscript`)", 6: "the list is empty (`Empty`)",
    7: "a value is out of the function's domain (`Domain`)", 8: "a value is not in the colour set (`colour outside",
    9: "the place is full (the head of net.c", 10: "the memory for lists and strings is used up (`memory",
    11: "the recursion is too deep (`recursion", 12: "more tokens are taken than there are (`Subtract`)",
    13: "an exception of the net (`Own`)", 14: "an evaluation does not come to an end (`an evaluation without end`)",
    15: "a model time is beyond 64 bits (`a model time", 16: "a function is not available here (`a function that",
    17: "internal error of the runtime (`internal error`)", 99: "error (`unknown error`)",
}  # fmt: skip
"""By the number of the error: words, and the name of the exception."""
INTERNAL = 17


def nothing_said(done: Done) -> None:
    """I10: no command has been issued."""
    assert {
        p.name: p.read_text() for p in done.shared.glob("*.robcad") if p.read_text() != "0\n"
    } == {}


@situation
def errors_while_it_fires(lab: Lab) -> None:
    for error, words in RAISED.items():
        done = lab.run("odd" if error % 2 else "odd.deployed", order=1000 + error)
        done.stopped(70 if error == INTERNAL else 1, words, "while firing `Odd.Odd`")
        assert done.error.startswith("page `Odd`, transition `odd` (ID7): ")
        nothing_said(done)


@situation
def an_error_that_says_a_value(lab: Lab) -> None:
    for program in ("odd", "odd.deployed"):
        done = lab.run(program, order=900)
        said = "illegal colour 900: it is not in the colour set `INT`, while firing `Odd.Odd`"
        nothing_said(done.stopped(1, said))


@situation
def errors_while_it_searches(lab: Lab) -> None:
    for error in (1, 3, 13, 14):
        done = lab.run("odd.deployed", order=2000 + error).stopped(
            1, "while looking for bindings of `Odd.Odd`"
        )
        assert done.error.startswith("page `Odd`, transition `odd` (ID7): ")
        nothing_said(done)


@situation
def more_tokens_than_a_place_may_hold(lab: Lab) -> None:
    for program in ("odd", "odd.deployed"):
        done = lab.run(program, order=6).stopped(
            1, "place `Odd.Few` is full: it would hold 2 tokens after `Odd.Odd`"
        )
        assert "and its bound is 1 (the head of net.c says why)" in done.error
        nothing_said(done)


@situation
def messages_that_cannot_be_sent(lab: Lab) -> None:
    for order, name, said in (
        (
            4,
            "command",
            "channel-overrun: 2 messages for command.robcad in one cycle; it can hold one",
        ),
        (
            5,
            "level",
            "the token of place `Odd.level` cannot be written to level.robcad: a value is not finite or out",
        ),
        (
            8,
            "big",
            "the token of place `Odd.big` cannot be written to big.robcad: an integer in it does not fit",
        ),
        (
            12,
            "command",
            "the token of place `Odd.command` cannot be written to command.robcad: a value is not finite",
        ),
        (
            16,
            "say",
            "the token of place `Odd.say` cannot be written to say.robcad: a value is not finite or out",
        ),
    ):
        for program in ("odd", "odd.deployed"):
            nothing_said(lab.run(program, order=order).stopped(4, said, f"{name}.robcad"))
        done = lab.run("odd", "--dry-run", order=order)
        assert done.code == 1 and f"{name}.robcad" in done.error and not done.shared.exists()


@situation
def no_end_of_firing(lab: Lab) -> None:
    done = lab.run("odd.deployed", "--max-firings", "7", order=13).stopped(
        1, "no end of firing: after 7 firings"
    )
    assert (
        "`Odd.Turn` is still enabled; a supervisor must come to rest (--max-firings N allows more)"
        in done.error
    )
    lab.run("odd.deployed", "--max-firings", "1").finished()  # as many as there are
    lab.run("odd.deployed", "--max-firings", "1", order=2000 + 3).stopped(1, "no rule fits")
    done = lab.run("odd.deployed", order=20).finished()
    assert "(at most 901 in one cycle)" in done.out


@situation
def memory_for_lists_and_strings(lab: Lab) -> None:
    done = lab.run("odd.deployed", order=9, name=b'"kept"').finished()
    assert "2 firings" in done.out
    lab.run(lab.program("odd.deployed", "-DODD_NO_COLLECT"), order=9).finished()
    done = lab.run("odd.deployed", order=10).stopped(
        1, "the memory for lists and strings is used up"
    )
    assert done.error.endswith("while making room between firings")


@situation
def where_it_ends(lab: Lab) -> None:
    assert " in Odd.Done: 1 firings" in lab.run("odd", order=0).finished().out
    assert " in Odd.Done, Odd.Also: " in lab.run("odd.deployed", order=1).finished().out
    folder = lab.fresh()
    lab.run("odd", "--trace", folder / "t", order=1, folder=folder).finished()
    assert '"final": ["Odd.Done", "Odd.Also"]' in (folder / "t").read_text()


@situation
def traces(lab: Lab) -> None:
    folder = lab.fresh()
    done = lab.run("odd", "--trace", folder / "none" / "t", folder=folder)
    assert (
        done.code == 5
        and done.error == f"cannot write the trace {folder}/none/t: No such file or directory"
    )
    assert not done.shared.exists()

    def at_zero(name: str, limit: int | None = None) -> Done:
        trace = folder / name
        return lab.run(
            "odd",
            "--trace",
            trace,
            "--lockstep",
            "-v",
            folder=folder,
            stdin="step 0\n",
            limit=limit,
        )

    done = at_zero("t").finished()
    assert 'Odd.Odd {"n": 0}' in done.err
    ends = [n + 1 for n, c in enumerate((folder / "t").read_text()) if c == "\n"]
    for whole, end in enumerate([0, *ends[:-1]]):
        # A disk that is full from there on: all files of the cell are shorter.
        again = at_zero(f"t{whole}", max(end + 5, 60))
        assert (again.code, again.error) == (5, f"cannot write the trace {folder}/t{whole}")
        text = (folder / f"t{whole}").read_text()
        assert text.count("\n") == whole and text[-1:] in ("", "\n"), "whole lines only"


@situation
def time_that_cannot_be_told(lab: Lab) -> None:
    done = lab.run("odd", order=11).stopped(
        1, "division by zero (`Div`), while looking for the next time"
    )
    done = lab.run("odd", "--lockstep", order=11, stdin="step 0\nstep 1\n")
    done.stopped(1, "while looking for the next time")
    assert done.out == f"stopped {done.error}\n", "one answer to one command"
    assert lab.run("odd", "--dry-run", order=11).code == 1
    lab.run("odd", order=18).stopped(1, "division by zero (`Div`), while looking for the next time")
    done = lab.run("odd", "--lockstep", order=18, stdin="step 0\nstep 1\n").stopped(
        1, "looking for the next time"
    )
    assert done.out == f"stopped {done.error}\n", "not `idle` first"


@situation
def waiting_for_a_time(lab: Lab) -> None:
    """Model time is 1,000 units away: seconds in lock-step, a millisecond where a second has a million of them."""
    for flags in ((), ("-DODD_REAL_TIME",)):
        program = lab.program("odd", *flags)
        lab.run(program, "--time-scale", "1e6", order=15).finished()
        done = lab.run(
            program, "--lockstep", order=15, stdin="step 0\nstep 999\nstep 500\nstep 1000\n"
        ).finished()
        at = "1000.0" if "1000.0" in done.out else "1000"
        assert [line.split()[:4] for line in done.out.splitlines()] == [
            ["idle", "1", at, "running"], ["idle", "0", at, "running"], ["idle", "0", at, "running"],
            ["idle", "1", "-", "finished"],
        ]  # fmt: skip
        done = lab.run(
            program,
            "--lockstep",
            "--time-scale",
            "1e300",
            order=15,
            stdin="step 0\nstep 1e10\nstep 2e10\n",
        )
        done.finished()

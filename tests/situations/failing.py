"""Calls of the operating system that fail, one after the other, and signals at each phase of a run."""

from __future__ import annotations

import errno
import os

from helpers.counted import Lab, assert_whole
from situations import situation

CALLS = (
    ("pipe", errno.EMFILE, 5), ("fcntl", errno.EINVAL, 5), ("sigaction", errno.EINVAL, 5),
    ("mkdir", errno.EACCES, 5), ("open", errno.EMFILE, 5), ("openat", errno.ENFILE, 5), ("flock", errno.EIO, 5),
    ("ftruncate", errno.EIO, 5), ("pwrite", errno.ENOSPC, 5), ("write", errno.ENOSPC, 5), ("read", errno.EIO, 5),
    ("close", errno.EIO, 5), ("renameat", errno.EDQUOT, 5), ("read", errno.EINTR, 0), ("write", errno.EINTR, 0),
    ("fstat", errno.EIO, 0), ("unlinkat", errno.EACCES, 0), ("inotify_init1", errno.EMFILE, 0),
    ("inotify_add_watch", errno.ENOSPC, 0), ("ppoll", errno.ENOMEM, 0), ("clock_gettime", errno.EINVAL, 0),
)  # fmt: skip
"""The call, its error, and the code of a run that cannot do without it (0: it can)."""
MOST = 14
"""Calls of each name that fail, one in each run."""


@situation
def each_call_fails_once(lab: Lab) -> None:
    """The supervisor says which, and stops, or does without; no file is torn, no temporary one is left."""
    for name, error, code in CALLS:
        codes = set()
        missed = 0
        for number in range(1, MOST):
            done = lab.run("odd.deployed", "-q", order=1, failing=f"{name}:{number}:{error}")
            codes.add(done.code)
            assert_whole(done.shared)
            missed += not done.reached
            if missed == 2:
                break  # there are not so many of these calls; how many, depends on how long it waits
            if done.code == 0:
                assert done.err == "" or done.err.startswith(
                    "warning: no notifications of changes in "
                ), done
                continue
            assert done.code in (code, 2) and os.strerror(error) in done.error, (name, number, done)
            assert done.code != 2 or ".txt: cannot read the input file" in done.error
        assert (code in codes) and codes <= {0, 2, 5}, (name, error, codes)


@situation
def it_writes_less_than_it_should(lab: Lab) -> None:
    done = lab.run("odd.deployed", failing="pwrite:1:=3")
    assert (
        done.code == 5
        and f"cannot write {done.shared}/supervisor.status: No space left on device" in done.error
    )
    done = lab.run("odd.deployed", failing="write@say:1:=0")
    assert (
        done.code == 5
        and f"cannot write {done.shared}/say.robcad: Input/output error" in done.error
    )
    lab.run("odd.deployed", failing="write@say:1:=1")


@situation
def the_last_word_cannot_be_written(lab: Lab) -> None:
    """The run has come to its end, but nobody can know: that is an error."""
    for rule in ("pwrite:2:28", "ftruncate@supervisor.status:3:5"):
        done = lab.run("odd.deployed", failing=rule)
        assert done.code == 5 and f"cannot write {done.shared}/supervisor.status: " in done.error
    done = lab.run("odd.deployed", order=1001, failing="pwrite:2:28")
    assert done.code == 1 and "a number is too large" in done.error, "the first reason counts"


@situation
def a_disk_that_is_full(lab: Lab) -> None:
    for limit in (1, 10):
        done = lab.run("odd.deployed", order=2, limit=limit)
        assert done.code == 5 and "; make room there, or choose another directory" in done.error
        for file in done.shared.glob("*.robcad"):
            assert file.read_text() == "0\n"


@situation
def signals_at_each_phase(lab: Lab) -> None:
    """Asked to stop at some call: it stops safely, or was at its end."""
    for name in (
        "open",
        "openat",
        "read",
        "pwrite",
        "flock",
        "renameat",
        "ppoll",
        "close",
        "write",
        "inotify_init1",
    ):
        for number in (1, 2, 4, 7):
            rule = f"{name}:{number}:!{2 if number % 2 else 15}"
            done = lab.run("odd.deployed", "--reply-timeout", "0.02", order=2, failing=rule)
            if done.code == 3:
                continue  # there are not so many of these calls
            done.stopped(130, "interrupted by signal ")


@situation
def a_second_signal(lab: Lab) -> None:
    for rules in ("ppoll:1:!2,ppoll:1:!15", "openat:5:!2,pwrite:1:!15"):
        lab.run("odd.deployed", order=2, failing=rules).stopped(130, "interrupted by signal 2")
    done = lab.run(
        "odd.deployed", "--poll", "1", "--reply-timeout", "0", order=2, failing="ppoll:9:!15"
    )
    done.stopped(130, "interrupted by signal 15")


@situation
def without_notices(lab: Lab) -> None:
    for rule, words in (
        ("inotify_init1:1:24", "Too many open files"),
        ("inotify_add_watch:1:28", "No space left on device"),
    ):
        done = lab.run("odd.deployed", failing=rule).finished()
        said = (
            f"warning: no notifications of changes in {done.shared} ({words}): polling every 2 ms\n"
        )
        assert done.err == said

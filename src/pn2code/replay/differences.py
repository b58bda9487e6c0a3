"""Two runs side by side: the first difference of their steps, of their messages, and of the poses of their arms; and
how they ended.

    differences(one, other)     # {"step": ..., "message": None, "pose": {...}, "end": None, ...}

Messages are compared channel by channel, since messages on different channels may overtake each other without any
difference for supervisor and robots. The pose of an arm is compared where its program makes a step, in both runs at the
same step, so that a run that was faster is no other run.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from pn2code.replay.arrays import Numbers, unpacked
from pn2code.replay.compare import first_difference, is_cut
from pn2code.replay.course import LONGEST
from pn2code.replay.description import Json
from pn2code.replay.motion import interpolated
from pn2code.robot.transforms import rotation_about

APART_M = 5e-4
"""The TCP, or an axis that slides, stands elsewhere from here on."""
APART_RAD = 1e-3
"""So does a joint."""


_Arms = dict[str, "_Arm"]
_PARTS = {"step": "steps", "message": "messages", "pose": "poses", "end": "end"}


def differences(a: Json, b: Json) -> Json:
    """The first other `step`, `message` and `pose`, and another `end`; null where there is none, or nothing to compare.

    `compared` says which of them could be compared, `same` in a sentence that these are the same (if they are), `notes`
    what else is to be known of the comparison.
    """
    step = first_difference(a, b)
    shared = min(a["course"]["steps"], b["course"]["steps"])
    if step is not None:
        shared = step["alike"]
    arms = _arms(a), _arms(b)
    compared = ["step"]
    if a.get("happenings") and b.get("happenings"):
        compared.append("message")
    if arms[0].keys() & arms[1].keys():
        compared.append("pose")
    if not any(is_cut(run) or run["course"].get("refused") for run in (a, b)):
        compared.append("end")
    parts = [_PARTS[kind] for kind in compared if kind != "end"]
    what = f"{', '.join(parts[:-1])} and {parts[-1]}" if len(parts) > 1 else parts[0]
    return {
        "step": step,
        "message": _first_message(a, b),
        "pose": _first_pose(a, b, arms, shared) if "pose" in compared else None,
        "end": _other_end(a, b) if "end" in compared else None,
        "compared": compared,
        "same": f"both runs have the same {what}",
        "notes": list(_notes(a, b, arms)),
    }


def sentences(found: Json) -> list[str]:
    """The differences in words, a line each, and what is to be known of them."""
    rows = []
    for kind in _PARTS:
        if (one := found[kind]) is None:
            continue
        number = f" {one['step']}" if kind == "step" else ""
        first = "other end" if kind == "end" else f"first other {kind}{number}"
        here, there = map(_short, one["what"])
        rows.append(f"{first}: {here}; in the second run {there}")
    return [*(rows or [found["same"]]), *found["notes"]]


def _short(text: str) -> str:
    """For a terminal: what values and messages say is data, and no commands for it."""
    plain = "".join(c if c.isprintable() else "\ufffd" for c in text[:LONGEST])
    return plain if len(text) <= LONGEST else f"{plain}… ({len(text) - LONGEST:,} more characters)"


def _notes(a: Json, b: Json, arms: tuple[_Arms, _Arms]) -> Iterator[str]:
    for word, run in (("first", a), ("second", b)):
        if is_cut(run):
            n = run["course"]["steps"]
            yield f"steps of the {word} run after the first {n:,} are left out, and not compared"
    if all(arms):
        for name in sorted(arms[0].keys() ^ arms[1].keys()):
            yield f"only one of the runs has the arm {name}"
    if any(run["course"].get("rounded", True) for run in (a, b)):
        yield (
            "values are compared as the page shows them: reals with 12 digits, texts to their first "
            f"{LONGEST:,} characters"
        )


# --- how they ended ------------------------------------------------------------------------------


def _other_end(a: Json, b: Json) -> Json | None:
    """How both runs ended, if that is not the same."""
    what = [_end(run) for run in (a, b)]
    return {"what": what, "t": [a["end"], b["end"]]} if what[0] != what[1] else None


def _end(run: Json) -> str:
    verdict, loop = run["verdict"], run["course"].get("loop")
    text = str(verdict.get("word") or "the run stops without an end")
    if verdict.get("reason"):
        text += f": {verdict['reason']}"
    if final := verdict.get("final"):
        text += f", with a token in {', '.join(sorted(map(str, final)))}"
    if failed := [str(x) for x in verdict.get("failed") or ()]:
        why = [x for x in failed if x not in (final or ())]
        text += f", a failure{': ' if why else ''}{'; '.join(why)}"
    return text if loop is None else f"{text}, repeated from step {loop} on"


# --- messages ------------------------------------------------------------------------------------


def _first_message(a: Json, b: Json) -> Json | None:
    """Of all channels, the message that differs first in time."""
    one, two = _by_channel(a), _by_channel(b)
    if one is None or two is None:
        return None
    found = []
    for channel in dict.fromkeys((*one, *two)):
        left, right = one.get(channel, []), two.get(channel, [])
        at = next(
            (i for i, (m, n) in enumerate(zip(left, right, strict=False)) if m[1] != n[1]),
            min(len(left), len(right)),
        )
        rows = [side[at] if at < len(side) else None for side in (left, right)]
        if any(row is not None for row in rows):
            found.append((min(row[0] for row in rows if row is not None), channel, at + 1, rows))
    if not found:
        return None
    first, channel, number, rows = min(found, key=lambda entry: entry[:2])
    return {
        "channel": channel,
        "number": number,
        "what": [
            "no more message on this channel"
            if row is None
            else f"{channel} {row[1]} at {row[0]:.2f} s"
            for row in rows
        ],
        "t": [first if row is None else row[0] for row in rows],
    }


def _by_channel(run: Json) -> dict[str, list[tuple[float, str]]] | None:
    """By channel, the messages: when, and what in words."""
    happenings = run.get("happenings")
    if not happenings:
        return None
    out: dict[str, list[tuple[float, str]]] = {}
    for m in happenings["messages"]:
        out.setdefault(str(m["channel"]), []).append((float(m["t"]), f"{m['what']}: {m['text']}"))
    return out


# --- poses ---------------------------------------------------------------------------------------


def _first_pose(a: Json, b: Json, arms: tuple[_Arms, _Arms], shared: int) -> Json | None:
    """The first of the shared steps at which the arm whose program makes it stands elsewhere."""
    times = [unpacked(run["course"]["time"]) for run in (a, b)]
    parties = a["happenings"]["parties"]
    owners = a["happenings"]["owners"]
    transition = unpacked(a["course"]["transition"])[:shared].tolist()
    for name in dict.fromkeys((*arms[0], *arms[1])):  # where they stand before anything happens
        if name in arms[0] and name in arms[1]:
            said = _apart(arms[0][name], arms[1][name], (0.0, 0.0))
            if said is not None:
                return {"step": 0, "robot": name, "t": [0.0, 0.0], "what": said}
    for k, t in enumerate(transition):
        name = parties[owners[t]]["name"]
        if name not in arms[0] or name not in arms[1]:
            continue
        at = (float(times[0][k]), float(times[1][k]))
        said = _apart(arms[0][name], arms[1][name], at)
        if said is not None:
            return {"step": k + 1, "robot": name, "t": list(at), "what": said}
    return None


def _arms(run: Json) -> _Arms:
    cell, motion = run.get("cell"), run.get("motion")
    if not cell or not motion or not run.get("happenings"):
        return {}
    return {r["name"]: _Arm(r, motion[r["name"]]) for r in cell["robots"] if r["name"] in motion}


class _Arm:
    """A robot of a description, with its motion."""

    def __init__(self, robot: Json, motion: Json) -> None:
        self.robot = robot
        self._t = unpacked(motion["t"]).astype(float)
        self._q = unpacked(motion["q"]).astype(float).reshape(len(self._t), -1)
        self.slides = {j["moves"] for j in robot["joints"] if j["moves"] >= 0 and j.get("slides")}

    def joints(self, t: float) -> Numbers:
        """The joint position at a moment."""
        return (
            np.asarray(interpolated(self._t, self._q, t))
            if len(self._t)
            else np.array(self.robot["home"])
        )

    def tcp(self, q: Numbers) -> Numbers:
        """Where the TCP is in the world."""
        frames: dict[int, Any] = {0: _matrix(self.robot["base"])}
        for j in self.robot["joints"]:
            at = frames[j["parent"]] @ _matrix(j["frame"])
            if j["moves"] >= 0:
                at = at @ _moved(
                    np.array(j["axis"], float), float(q[j["moves"]]), j.get("slides", False)
                )
            frames[j["child"]] = at
        return np.asarray(frames[self.robot["tcp"]][:3, 3])


def _matrix(rows: list[float]) -> Numbers:
    return np.array(rows, float).reshape(4, 4)


def _moved(axis: Numbers, by: float, slides: bool) -> Numbers:
    out = np.eye(4)
    if slides:
        out[:3, 3] = axis * by
    else:
        out[:3, :3] = rotation_about(axis, by)
    return out


def _apart(a: _Arm, b: _Arm, at: tuple[float, float]) -> list[str] | None:
    """Where an arm stands in both runs, if that is not the same."""
    q = [arm.joints(t) for arm, t in zip((a, b), at, strict=True)]
    points = [arm.tcp(own) for arm, own in zip((a, b), q, strict=True)]
    is_apart = len(q[0]) != len(q[1]) or float(np.linalg.norm(points[0] - points[1])) > APART_M
    if not is_apart:
        limit = np.array([APART_M if i in a.slides else APART_RAD for i in range(len(q[0]))])
        is_apart = bool((np.abs(q[0] - q[1]) > limit).any())
    if not is_apart:
        return None
    return [
        f"{arm.robot['name']} with its TCP at {', '.join(f'{v * 1000:.1f}' for v in p)} mm, "
        f"joints {', '.join(_axis_text(arm, i, float(v)) for i, v in enumerate(own))}, at {t:.2f} s"
        for arm, own, p, t in zip((a, b), q, points, at, strict=True)
    ]


def _axis_text(arm: _Arm, axis: int, value: float) -> str:
    return f"{value * 1000:.1f} mm" if axis in arm.slides else f"{np.degrees(value):.1f}"

"""The text of messages: what C writes and takes is what Python writes and takes, also at the edges of both."""

from __future__ import annotations

import random
import subprocess

from helpers.counted import DEADLINE_S, Lab
from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind
from pn2code.channels import ChannelSpec, Message, Refused
from pn2code.channels.message import compose, parse
from pn2code.channels.scalars import ScalarValue, scalars_of_values
from situations import situation

K = ScalarKind
SCALARS = (
    Scalar(K.UNIT, "UNIT", "UNIT"),
    Scalar(K.UNIT, "named", "U", ("u",)),
    Scalar(K.BOOL, "BOOL", "BOOL"),
    Scalar(K.ENUM, "c", "COLOUR", ("red", "green")),
    Scalar(K.INDEX, "i", "INDEX", low=1, high=3),
    Scalar(K.INT, "n", "RANGE", low=-2, high=8),
    Scalar(K.INT, "INT", "INT"),
    Scalar(K.REAL, "x", "SPAN", low=-1.5, high=2.5),
    Scalar(K.REAL, "REAL", "REAL"),
    Scalar(K.STRING, "s", "STRING"),
    Scalar(K.STRING, "t", "STRING"),
)
"""Those of `cnative/tests/codec_cell.c`."""
ALL = ChannelSpec("all", "all.robcad", SCALARS, "a", "b", ChannelKind.DATA)
TEXT = ChannelSpec("text", "text.robcad", SCALARS[9:], "a", "b", ChannelKind.DATA)
NUMBERED = ChannelSpec("numbered", "", (SCALARS[9], SCALARS[6]), "a", "b", ChannelKind.DATA)
MEASURED = ChannelSpec("measured", "", (SCALARS[9], SCALARS[8]), "a", "b", ChannelKind.DATA)
PAIRS = Scalar(K.LIST, "l", "PAIRS", (), 0, 40, (SCALARS[6], SCALARS[9]))
NUMBERS = Scalar(K.LIST, "o", "NUMBERS", (), 1, None, (SCALARS[5],))
LISTED = ChannelSpec(
    "listed", "", (SCALARS[6], PAIRS, NUMBERS, SCALARS[2]), "a", "b", ChannelKind.DATA
)
CHANNELS = {ALL: 0, TEXT: 1, NUMBERED: 4, MEASURED: 5, LISTED: 6}
"""With their numbers."""
SESSION = "00000001"
GOOD: tuple[ScalarValue, ...] = (1, 1, True, "green", 2, -2, -7, 2.5, 1 / 3, 'a "b" \\', "\x01 z")


def ask(lab: Lab, *questions: str) -> list[str]:
    """What the host `messages` answers."""
    done = subprocess.run(
        [lab.program("codec")], input="".join(q + "\n" for q in questions), capture_output=True, text=True,
        timeout=DEADLINE_S, check=False,
    )  # fmt: skip
    assert done.returncode == 0 and done.stdout.count("\n") == len(questions), done
    return done.stdout.splitlines()


def word(scalar: Scalar, value: ScalarValue) -> str:
    """A value as `messages` reads it; an enumeration also by a position that there is not."""
    if isinstance(value, float):
        return value.hex()
    if scalar.kind is K.STRING:
        assert isinstance(value, str)
        return "x" + value.encode("latin-1").hex()
    if scalar.kind is K.ENUM and isinstance(value, str):
        return str(scalar.names.index(value))
    return str(int(value))


def written(spec: ChannelSpec, values: tuple[ScalarValue, ...], seq: int) -> str:
    return f"write {CHANNELS[spec]} {seq} " + " ".join(
        word(s, v) for s, v in zip(of_each(spec, values), values, strict=True)
    )


def of_each(spec: ChannelSpec, values: tuple[ScalarValue, ...]) -> list[Scalar]:
    """The scalar of each value."""
    found = scalars_of_values(spec.scalars, values)
    assert found is not None
    return found


LISTS: tuple[tuple[ScalarValue, ...], ...] = (
    (1, 0, 1, 5, True),
    (-1, 2, 3, "a b", 4, "", 2, -2, 8, False),
    (0, 1, 0, '"', 3, 0, 0, 0, False),
)


@situation
def lists_are_written_alike(lab: Lab) -> None:
    cases: list[tuple[ScalarValue, ...]] = [
        *LISTS,
        (1, 0, 0, True),  # one element at least
        (1, 0, 1, 9, True),  # an element out of its range
        *((7, n, *(1, "") * n, 1, 1, True) for n in (29, 30, 31, 40, 41)),
        *((7, 0, n, *(1,) * n, True) for n in (60, 61, 62, 70)),
        (7, 2, 1, "x" * 4020, 2, "", 1, 1, True),
        (7, 2, 1, "x" * 4050, 2, "", 1, 1, True),
    ]
    answers = ask(lab, *(written(LISTED, values, 7) for values in cases))
    for values, answer in zip(cases, answers, strict=True):
        expected = compose(LISTED, values, seq=7, session=SESSION)
        assert answer == ("unwritable" if expected is None else expected.encode("latin-1").hex()), (
            values
        )
    assert answers.count("unwritable") == 10


@situation
def written_alike(lab: Lab) -> None:
    changes: list[tuple[int, ScalarValue]] = [
        (2, False), (3, "red"), (4, 0), (4, 1), (4, 3), (4, 4), (5, 8), (5, 9), (5, -3), (6, -(2**63)), (7, -1.5),
        (7, 2.75), (7, -1.75), (8, 1e300), (8, float("nan")), (8, float("inf")), (8, 1e-9), (8, -0.0), (9, ""),
        (9, "x" * 4000), (9, "x" * 4080), (9, "\x00" * 1100), (10, "x" * 5000),
    ]  # fmt: skip
    cases = [GOOD, *(GOOD[:i] + (v,) + GOOD[i + 1 :] for i, v in changes)]
    answers = ask(lab, *(written(ALL, values, 7) for values in cases))
    for values, answer in zip(cases, answers, strict=True):
        expected = compose(ALL, values, seq=7, session=SESSION)
        assert answer == ("unwritable" if expected is None else expected.encode("latin-1").hex()), (
            values
        )
    assert answers.count("unwritable") > 8


@situation
def longest_messages(lab: Lab) -> None:
    """Line 1 has at most 4,055 bytes, whatever is in it; a `seq` that no reader takes has no room behind it."""
    texts = [
        ("y" * n, z)
        for n in (4049, 4050, 4051, 4052, 4085, 4089, 4090, 4091, 4100)
        for z in ("", "\x01", "zz")
    ]
    texts += [("y" * 4088 + "\x01", "z"), ("y" * 4089 + "\x01", "z")]
    answers = ask(lab, *(written(TEXT, pair, 10**17) for pair in texts))
    for pair, answer in zip(texts, answers, strict=True):
        expected = compose(TEXT, pair, seq=10**17, session=SESSION)
        assert answer == ("unwritable" if expected is None else expected.encode("latin-1").hex())
    assert 0 < answers.count("unwritable") < len(answers)
    (longest,) = ask(lab, written(TEXT, ("y" * 4050, ""), 2**64 - 1))
    assert longest == "unwritable"
    (longest,) = ask(lab, written(TEXT, ("y" * 4050, ""), 10**18 - 1))
    assert len(bytes.fromhex(longest)) == 4095
    for spec, value in ((NUMBERED, -123456789), (MEASURED, 1 / 3)):
        pairs = [("y" * n, value) for n in (4030, 4045, 4060, 4072, 4080, 4084, 4086, 4088)]
        for pair, answer in zip(
            pairs, ask(lab, *(written(spec, p, 1) for p in pairs)), strict=True
        ):
            expected = compose(spec, pair, seq=1, session=SESSION)
            assert answer == (
                "unwritable" if expected is None else expected.encode("latin-1").hex()
            )


@situation
def values_that_no_net_has(lab: Lab) -> None:
    """A constructor that there is not, a kind of scalar that there is not: refused, not written."""
    for position in ("2", "-1", "9223372036854775807"):
        words = written(ALL, GOOD, 1).split()
        words[6] = position
        assert ask(lab, " ".join(words)) == ["unwritable"]
    assert ask(lab, "write 2 1 1") == ["unwritable"]
    assert ask(lab, f"read 2 0 {b'1'.hex()}") == ["refused scalar"]


@situation
def read_alike(lab: Lab) -> None:
    """Files damaged in small ways, and edges: both sides take the same values, and refuse for the same reason."""
    draws = random.Random(3)
    cases: list[tuple[ChannelSpec, bytes]] = [(spec, text) for spec in CHANNELS for text in EDGES]
    good = [(ALL, GOOD)] * 3 + [(TEXT, ("", "b")), (TEXT, ('" \\', "\xff"))]
    good += [(LISTED, values) for values in LISTS]
    while len(cases) < 1500:
        spec, values = draws.choice(good)
        text = compose(
            spec,
            values,
            seq=draws.choice([6, 7, 7, 7, 8]),
            session=draws.choice([SESSION] * 5 + ["x"]),
        )
        assert text is not None
        data = bytearray(text.encode("latin-1"))
        for _ in range(draws.choice([0, 1, 1, 2])):
            at = draws.randrange(len(data))
            match draws.randrange(4):
                case 0:
                    del data[at:]
                    data += b"\n"
                case 1:
                    data[at : at + 1] = bytes([draws.choice(b'0 1\n#.-e"\\\x00\xff\t\rx')])
                case 2:
                    data[at:at] = bytes([draws.choice(b'0 1\n#.-e+"\\')])
                case _:
                    del data[at : at + 1]
        cases.append((spec, bytes(data)))
    answers = ask(lab, *(f"read {CHANNELS[spec]} 6 {data.hex()}".strip() for spec, data in cases))
    for (spec, data), answer in zip(cases, answers, strict=True):
        found = parse(spec, data.decode("latin-1"), session=SESSION, consumed=6)
        if isinstance(found, Message):
            words = [answer.split()[0], answer.split()[1]]
            assert words == ["message", "-" if found.seq is None else str(found.seq)], (
                data,
                answer,
            )
            pairs = zip(of_each(spec, found.scalars), found.scalars, strict=True)
            expected = ["0" if s.kind is K.UNIT else word(s, v) for s, v in pairs]
            assert [canonical(w) for w in answer.split()[2:]] == expected, data
        else:
            reason = f"refused {found.reason.value}" if isinstance(found, Refused) else "empty"
            assert answer == reason, (data, found)
    kinds = {" ".join(a.split()[:2]) for a in answers if a.startswith("refused")}
    assert kinds >= {
        f"refused {w}"
        for w in ("shape", "count", "scalar", "trailer", "checksum", "session", "repeated", "lost")
    }


def canonical(text: str) -> str:
    """A hexadecimal float as Python writes it."""
    return float.fromhex(text).hex() if "0x" in text else text


PLAIN = b'1 1 1 green 2 -2 -7 2.5 0.25 "s" "t"'
EDGES = (
    b"", b"0", b"0\n", b"0 \r\n", b"0\n\n", b"0\nx", b"0\n\nx", b"\n", b"\r\n", b"\n\n", b"0\n# 7 00000001 00000000\n",
    b"1" * 4095, b"1" * 4096, b"1" * 5000, b"1\x002\n", PLAIN, PLAIN + b"\r\n", PLAIN + b"\n\n", PLAIN + b"\n \n",
    PLAIN + b" \t\r\n", b"\t " + PLAIN, PLAIN.replace(b" ", b"\t"), PLAIN + b" 1", PLAIN[:-4],
    *(PLAIN.replace(b"-7", b) for b in (b"9" * 600, b"-9" + b"9" * 18, b"+7", b"-", b"+", b"7.", b"0x7", b"7e2",
                                         b"9223372036854775808", b"-9223372036854775808")),
    *(PLAIN.replace(b"0.25", b) for b in (b"9" * 600, b"1" * 400, b"1e400", b"-1E-400", b"nan", b"inf", b".5", b"5.",
                                          b"1e", b"1e+", b"1e+5", b"1e5x", b"1E-5", b"+1", b".", b"-.e1")),
    *(PLAIN.replace(b"2.5", b) for b in (b"2.6", b"-1.6", b"-1.5")),
    *(PLAIN.replace(b"green", b) for b in (b"gree", b"greens", b"blue", b"2")),
    *(PLAIN.replace(b'"s"', b) for b in (b'"', b'""', b'"s', b's"', b"s", b'"s\\"', b'"\\\\"', b'"\\q"', b'"\\x4"',
                                         b'"\\x4g"', b'"\\xg4"', b'"\\x41"', b'"\\', b'"\\"', b'"\\x', b'"\\y41"',
                                         b'"a b"', b'"a"b"c"', b'"\\ "', b'"\\x41', b'"\\x4\\"')),
    b"1 0 1 5 1", b"1 0", b"1 0 0 1", b"1 00 1 5 1", b"1 -0 1 5 1", b"1 +1 2 \"\" 1 5 1", b"1 1. 2 \"\" 1 5 1",
    b"1 1 2 \"\" 1 5 1", b"1 1 2 \"\" 1 5", b"1 1 2 \"\" 1 5 1 1", b"1 2 2 \"\" 1 5 1", b"1 41 1", b"1 40 1",
    b"1 999 1", b"1 9999 1", b"1 99999 1", b"1 0 9999 1", b"1 0 10000 1",
    b"1 x 1", b"1 0 2 5 1", b"1 0 1 9 1", b"1 0 61 5", b"1 0 99 5", b"1 31 1", b"1 30 " + b"1 \"\" " * 30 + b"1 5 1",
    b"1 31 " + b"1 \"\" " * 31 + b"1 5 1", b"1 0 60 " + b"1 " * 60 + b"1", b"1 0 61 " + b"1 " * 61 + b"1",
    b"2" + PLAIN[1:], b"1 u" + PLAIN[3:], b"1 1 true" + PLAIN[5:],
    *(PLAIN + b"\n" + b for b in (
        b"#", b"# 7", b"# 7 00000001", b"# 7 00000001 0000000", b"# 7 00000001 000000000", b"# 7 00000001 0000000g",
        b"## 7 00000001 00000000", b"x 7 00000001 00000000", b"# +7 00000001 00000000", b"# 7x 00000001 00000000",
        b"# 1234567890123456789 00000001 00000000", b"# 123456789012345678 00000001 00000000",
        b"# 7 0123456789abcdef 00000000", b"# 7 0123456789abcde 00000000", b"# 7 00000001 00000000 more",
        b"# 7 00000001 0000000A", b"# 7.5 00000001 00000000", b"# x 00000001 00000000",
    )),
)  # fmt: skip
"""Whole files."""


@situation
def questions_that_are_none(lab: Lab) -> None:
    """The host of the codec is asked by programs: it ends at a question that makes no sense."""
    for line in (
        "",
        "write",
        "write 0",
        "read 7 1 30",
        "write 0 1 1",
        "write 3 1 1",
        "read 3 0 30",
    ):
        done = subprocess.run(
            [lab.program("codec")],
            input=line + "\n",
            capture_output=True,
            text=True,
            timeout=DEADLINE_S,
            check=False,
        )
        assert (done.returncode, done.stdout) == (2, ""), line
    assert ask(lab, "read 0 0") == ["refused shape"]


@situation
def more_values_than_a_message_may_have(lab: Lab) -> None:
    """The reader of scalars writes nothing behind its memory, whatever the tables say."""
    done = subprocess.run(
        [lab.program("scalars")], input="many " + "1 " * 65 + "\nmany " + "1 " * 64 + "\n", capture_output=True,
        text=True, timeout=DEADLINE_S, check=False,
    )  # fmt: skip
    expected = "refused 129 `1` is one value too many\nrefused 129 found 64 values where 65 are"
    assert done.stdout.startswith(expected), done

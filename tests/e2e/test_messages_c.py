"""The codecs of both sides on random colour sets: the compiled one of a generated cell_config.c, and the robots' one.

They write the same bytes, read the same values, and refuse the same files for the same reasons.
"""

from __future__ import annotations

import math
import random
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.cell.divide import divide
from pn2code.cell.load import load
from pn2code.cell.partition import Partition
from pn2code.cell.scalars import LEAST_ROOM, Scalar, ScalarKind
from pn2code.channels.message import Message, Refused, compose, parse, specs_of
from pn2code.channels.scalars import ScalarValue
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.verify.controller.codec import MOST_SEQ, SESSION, Codec, codec
from pn2code.verify.controller.messages import longest

pytestmark = pytest.mark.cc

CHANNELS = 90
PAYLOAD = 64 * LEAST_ROOM - 41
"""Bytes of line 1 where no message has more values."""
SIMPLE = (
    "unit", "bool", "int", "int with ~3..4", "int with 0..0", "real", "real with ~1.5..2.5", "string",
    "with red | green | blue | e1", "index ph with 0..5", "intinf", "int with 1..9",
)  # fmt: skip


def declarations(chance: random.Random) -> tuple[str, list[str]]:
    """Colour sets of all kinds, and the names of those of the channels."""
    lines, names = [], [f"S{i}" for i in range(len(SIMPLE))]
    for name, kind in zip(names, SIMPLE, strict=True):
        lines.append(f"colset {name} = {kind.replace('ph', 'p' + name)};")
    size = dict.fromkeys(names, 1)
    has_list: set[str] = set()
    while len(names) < CHANNELS:
        name, parts = f"C{len(names)}", chance.choices(names, k=chance.choice([1, 2, 3, 3, 6, 8]))
        if chance.random() < 0.4:
            if parts[0] in has_list:
                continue  # no message holds a list of lists
            size[name] = 1
            has_list.add(name)
            bounds = chance.choice(["", "", " with 0..2", " with 1..3", " with 0..40"])
            if bounds == " with 1..3":
                size[name] += size[parts[0]]
            lines.append(f"colset {name} = list {parts[0]}{bounds};")
            names.append(name)
            continue
        size[name] = sum(size[p] for p in parts)
        if size[name] > LEAST_ROOM:
            continue
        if has_list.intersection(parts):
            has_list.add(name)
        text = (
            "product " + " * ".join(parts)
            if len(parts) > 1 and chance.random() < 0.5
            else "record " + " * ".join(f"f{i} : {p}" for i, p in enumerate(parts))
        )
        lines.append(f"colset {name} = {text};")
        names.append(name)
    return "\n  ".join(lines), names


def cell(folder: Path, text: str, names: list[str]) -> Partition:
    """A supervisor that passes a token of each of these declared colour sets on to a robot."""
    used = ["  page Top"]
    sup, rob, toml = ["  page Sup"], ["  page Rob"], []
    for i, name in enumerate(names):
        used.append(f"    place p{i} : {name}")
        sup += [f"    place p{i} port out : {name}", f"    place a{i} : {name}", f"    trans s{i}"]
        sup += [f"      in a{i} : v{i}", f"      out p{i} : v{i}"]
        rob += [f"    place p{i} port in : {name}", f"    place b{i} : {name}", f"    trans r{i}"]
        rob += [f"      in p{i} : v{i}", f"      out b{i} : v{i}"]
        toml.append(f'[[channel]]\nplace = "p{i}"\nfile = "p{i}.txt"\nkind = "flag"')
    ports = ", ".join(f"p{i} -> p{i}" for i in range(len(names)))
    used += [f"    subst Supervisor = Sup ({ports})", f"    subst Robot = Rob ({ports})"]
    variables = "\n  ".join(f"var v{i} : {name};" for i, name in enumerate(names))
    net = "\n".join(["net cell", "  standard", f"  {text}", f"  {variables}", *used, *sup, *rob])
    (folder / "cell.cpn").write_bytes(cpn(net))
    head = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\n[devices.robot1]\ninstance = "Robot"\n'
    (folder / "cell.toml").write_text(head + "\n".join(toml))
    d = Diagnostics()
    config, flat = load(folder / "cell.toml", d), front.load(folder / "cell.cpn", d)
    assert config is not None and flat is not None, [str(i) for i in d]
    partition = divide(flat, config, d)
    assert partition is not None, [str(i) for i in d]
    return partition


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Partition, Codec]]:
    d = Diagnostics()
    partition = cell(tmp_path_factory.mktemp("cell"), *declarations(random.Random(11)))
    with codec(partition, d) as compiled:
        assert compiled is not None, [str(i) for i in d]
        yield partition, compiled


def number(scalar: Scalar, chance: random.Random) -> ScalarValue:
    edges: list[float] = [0, 1, -1, 2**63 - 1, -(2**63), 2**31]
    edges += [x + e for x in (scalar.low, scalar.high) if x is not None for e in (-1, 0, 0, 0, 1)]
    if scalar.kind is not ScalarKind.REAL:
        return max(-(2**63), min(2**63 - 1, int(chance.choice([*edges, chance.randrange(-9, 9)]))))
    some = struct.unpack("<d", chance.randbytes(8))[0]
    rounded = struct.unpack("<f", struct.pack("<f", chance.uniform(-2, 3)))[0]
    odd = [math.inf, -math.inf, math.nan, 1.7976931348623157e308, 5e-324, 0.0]
    return float(chance.choice([*edges, some, rounded, rounded, *odd, chance.uniform(-1e4, 1e4)]))


def value(scalar: Scalar, chance: random.Random) -> ScalarValue:
    """Mostly one of the colour set, sometimes one beyond its edge."""
    match scalar.kind:
        case ScalarKind.UNIT:
            return 1
        case ScalarKind.BOOL:
            return chance.random() < 0.5
        case ScalarKind.ENUM:
            return chance.choice(scalar.names)
        case ScalarKind.STRING:
            size = chance.choice([0, 0, 1, 3, 3, 20, 600, PAYLOAD // 4, PAYLOAD - 2, PAYLOAD - 1])
            plain = chance.random() < 0.5
            return "".join(chr(120 if plain else chance.randrange(256)) for _ in range(size))
        case _:
            return number(scalar, chance)


def values_of(scalars: tuple[Scalar, ...], chance: random.Random) -> tuple[ScalarValue, ...]:
    """Of a message, whose lists have any length, sometimes an impossible one."""
    found: list[ScalarValue] = []
    for s in scalars:
        if s.kind is ScalarKind.LIST:
            most = 4 if s.high is None else s.high
            length = chance.choice([0, 0, 1, 1, 2, 3, int(most), int(most) + 1])
            found.append(length)
            for _ in range(length):
                found += values_of(s.elements, chance)
        else:
            found.append(value(s, chance))
    return tuple(found)


def is_legal(scalars: tuple[Scalar, ...], values: Iterator[ScalarValue]) -> bool:
    """Whether all numbers are in their ranges, and all lists as long as they may be."""
    legal = True
    for s in scalars:
        v = next(values)
        if s.kind in (ScalarKind.INT, ScalarKind.INDEX, ScalarKind.LIST):
            legal &= s.low is None or v >= s.low  # type: ignore[operator]
            legal &= s.high is None or v <= s.high  # type: ignore[operator]
        if s.kind is ScalarKind.LIST:
            for _ in range(int(v)):
                legal &= is_legal(s.elements, values)
    return legal


def test_both_sides_write_the_same(both: tuple[Partition, Codec]) -> None:
    partition, compiled = both
    specs, chance = specs_of(partition), random.Random(1)
    messages = [
        (i, chance.choice([1, 7, MOST_SEQ]), values_of(spec.scalars, chance))
        for i, spec in enumerate(specs)
        for _ in range(40)
    ]
    expected = [compose(specs[i], v, seq=n, session=SESSION) for i, n, v in messages]
    found = compiled.write(messages)
    for message, file, text in zip(messages, found, expected, strict=True):
        assert file == (None if text is None else text.encode("latin-1")), message[:2]
    assert {f is None for f in found} == {True, False}
    # What is written is read, by both sides, as it was written.
    written = [(m, f) for m, f in zip(messages, found, strict=True) if f is not None]
    reads = compiled.read([(i, n - 1, f) for (i, n, _), f in written])
    for ((i, n, values), file), read in zip(written, reads, strict=True):
        assert (read.what, read.seq, read.scalars) == ("message", n, values)
        again = parse(specs[i], file.decode("latin-1"), session=SESSION, consumed=n - 1)
        assert again == Message(specs[i].name, values, n)
    assert any(values in ((0,), (False,)) for (_, _, values), _ in written)


def test_both_sides_read_the_same(both: tuple[Partition, Codec]) -> None:
    """Whole files, and files damaged in small ways."""
    partition, compiled = both
    specs, chance = specs_of(partition), random.Random(2)
    files: list[tuple[int, int, bytes]] = []
    while len(files) < 4000:
        i = chance.randrange(len(specs))
        values = values_of(specs[i].scalars, chance)
        text = compose(
            specs[i],
            values,
            seq=chance.choice([6, 7, 7, 7, 8]),
            session=chance.choice([SESSION] * 5 + ["9"]),
        )
        data = bytearray((text or "0\n").encode("latin-1"))
        for _ in range(chance.choice([0, 1, 1, 2])):
            at = chance.randrange(len(data)) if data else 0
            match chance.randrange(5):
                case 0:
                    del data[at:]
                case 1:
                    data[at : at + 1] = bytes([chance.choice(b'0 1\n#.-e\x00\xff\t\rx"\\')])
                case 2:
                    data[at:at] = bytes([chance.choice(b'0 1\n#.-e+"\\')])
                case 3:
                    data = data[: data.find(b"\n") + 1]  # written by hand
                case _:
                    del data[at : at + 1]
        files.append((i, 6, bytes(data)))
    kinds: set[str] = set()
    for (i, consumed, data), read in zip(files, compiled.read(files), strict=True):
        found = parse(specs[i], data.decode("latin-1"), session=SESSION, consumed=consumed)
        what = "empty" if found is None else "message"
        if isinstance(found, Refused):
            what = f"refused {found.reason.value}"
        assert read.what == what, (data, found)
        if isinstance(found, Message):
            assert (read.seq, read.scalars) == (found.seq, found.scalars), data
        kinds.add(what)
    reasons = ("shape", "count", "scalar", "trailer", "checksum", "session", "repeated", "lost")
    assert kinds == {"empty", "message", *(f"refused {r}" for r in reasons)}


def test_a_bound_that_colour_sets_prove_is_one(both: tuple[Partition, Codec]) -> None:
    partition, compiled = both
    specs, chance = specs_of(partition), random.Random(3)
    proven = 0
    for i, (channel, spec) in enumerate(zip(partition.channels, specs, strict=True)):
        most = longest(partition.net.places[channel.place].colset, spec.room)
        if most is None:
            continue
        proven += 1
        for _ in range(20):
            values = values_of(spec.scalars, chance)
            text = compose(spec, values, seq=1, session=SESSION)
            legal = is_legal(spec.scalars, iter(values)) and len(values) <= spec.room
            assert (text is not None) == legal
            assert text is None or len(text.split("\n")[0]) <= most
            assert compiled.write([(i, 1, values)]) == [None if text is None else text.encode()]
    assert proven > 5


def test_messages_have_room_for_what_their_colour_sets_hold(tmp_path: Path) -> None:
    """One list with a longest length makes room for as many values in all channels; both sides know how many."""
    lists = "colset R = list REAL with 0..200;\n  colset B = list BOOL;"
    partition = cell(tmp_path, lists, ["R", "B", "STRING"])
    specs, d = specs_of(partition), Diagnostics()
    assert {(spec.room, spec.max_bytes) for spec in specs} == {(201, 201 * 64)}
    with codec(partition, d) as compiled:
        assert compiled is not None, [str(i) for i in d]
        for length in (0, 1, 63, 64, 99, 100, 199, 200, 201, 999, 1000, 1024):
            tokens = (length, *[0.5] * length), (length, *[True] * length), ("x" * 64 * length,)
            for i, values in enumerate(tokens):
                text = compose(specs[i], values, seq=1, session=SESSION)
                assert (text is not None) == (length <= 200)
                assert compiled.write([(i, 1, values)]) == [text.encode() if text else None]
                by_hand = " ".join(
                    f'"{v}"' if isinstance(v, str) else str(float(v)) for v in values
                )
                file = text or f"{by_hand.replace('.0', '')}\n"
                found = parse(specs[i], file, session=SESSION, consumed=0)
                (read,) = compiled.read([(i, 0, file.encode())])
                assert (read.what == "message") == isinstance(found, Message) == (length <= 200)
                assert text is None or read.scalars == values


@pytest.mark.parametrize("beyond", [0, 1])
def test_the_longest_message(both: tuple[Partition, Codec], beyond: int) -> None:
    """With the largest number that line 2 can have, it still fits a file."""
    partition, compiled = both
    i = next(
        k
        for k, c in enumerate(partition.channels)
        if partition.net.places[c.place].colset.name == "S7"
    )
    spec = specs_of(partition)[i]
    size = spec.max_payload - 2 + beyond
    (file,) = compiled.write([(i, MOST_SEQ, ("x" * size,))])
    assert (file is None) == (beyond > 0)
    if file is not None:
        assert len(file) == spec.max_bytes - 1
        (read,) = compiled.read([(i, MOST_SEQ - 1, file)])
        assert read.scalars == ("x" * size,)

"""Small random cells: a supervisor of a few transitions and two devices, some of which make no sense at all."""

from __future__ import annotations

from random import Random

DEVICES = 2


def random_cell(random: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    lines = ["net cell", "  standard", "  val P_HIGH = 100;", "  var k: INT;", "  page Top"]
    numbers = range(1, DEVICES + 1)
    for i in numbers:
        lines += [f"    place f{i} : INT", f"    place d{i} : INT"]
    ports = ", ".join(f"f{i} -> f{i}, d{i} -> d{i}" for i in numbers)
    lines.append(f"    subst Supervisor = Sup ({ports})")
    lines += [f"    subst D{i} = P{i} (f -> f{i}, d -> d{i})" for i in numbers]
    lines += _supervisor(random)
    for i in numbers:
        lines += _device(random, i)
    channels = "".join(
        f'[[channel]]\nplace = "{c}{i}"\nfile = "{c}{i}.robcad"\nkind = "flag"\n'
        for i in numbers
        for c in "fd"
    )
    devices = "".join(f'[devices.D{i}]\ninstance = "D{i}"\n' for i in numbers)
    head = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    return "\n".join(lines) + "\n", head + channels + devices


def _supervisor(random: Random) -> list[str]:
    places = [f"L{i}" for i in range(random.randint(3, 5))]
    lines = ["  page Sup"]
    for i in range(1, DEVICES + 1):
        lines += [f"    place f{i} port out : INT", f"    place d{i} port in : INT"]
    lines += [f"    place {p}" + " = 1" * (p == "L0") for p in places]
    lines.append("    place Finished")
    lines += ["    trans Ask", "      in L0 : ()", "      out L1 : ()"]
    lines += [f"      out f{i} : {random.randint(1, 2)}" for i in range(1, DEVICES + 1)]
    for n in range(random.randint(2, 5)):
        urgent = " priority P_HIGH" * random.choice([True, False])
        device = n + 1 if n < DEVICES else random.randint(1, DEVICES)
        hears = n < DEVICES or random.random() < 0.5
        guard = f" guard [k = {random.randint(1, 2)}]" * (hears and random.random() < 0.4)
        lines.append(f"    trans T{n}{urgent}{guard}")
        lines.append(f"      in {random.choice(places[1:])} : ()")
        if hears:
            lines.append(f"      in d{device} : k")
        lines.append(f"      out {random.choice([*places, 'Finished', 'Finished'])} : ()")
        if random.random() < 0.15:
            lines.append(f"      out f{random.randint(1, DEVICES)} : 1")
    return lines


def _device(random: Random, i: int) -> list[str]:
    lines = [f"  page P{i}", "    place f port in : INT", "    place d port out : INT"]
    lines += ["    place Waiting = 1", "    place Told : INT", "    trans Accept"]
    lines += ["      in Waiting : ()", "      in f : k", "      out Told : k"]
    for n in range(random.randint(1, 3)):
        urgent = " priority P_HIGH" * (random.random() < 0.3)
        guard = f" guard [k = {random.randint(1, 2)}]" * (random.random() < 0.5)
        lines += [f"    trans B{n}{urgent}{guard}", "      in Told : k", "      out Waiting : ()"]
        if n == 0 or random.random() < 0.8:
            lines.append(f"      out d : {random.randint(1, 2)}")
    return lines

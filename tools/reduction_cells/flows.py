"""Random cells in which parts flow through devices: most come to their end, and nothing in them goes round."""

from __future__ import annotations

from random import Random


def flow(r: Random, *, many: bool = False) -> tuple[str, str]:
    """The net and the cell.toml of a supervisor that feeds some parts to one to three devices; or `many` to one."""
    devices = 1 if many else r.choice([1, 2, 2, 3])
    parts = r.choice([1, 2, 2, 3]) if devices < 3 else r.choice([1, 2])
    parts = r.choice([4, 5, 6]) if many else parts
    numbers = range(1, devices + 1)
    lines = [
        "net cell",
        "  standard",
        "  val P_HIGH = 100;",
        "  fun act () = ();",
        "  colset SAID = int with 1..2;",
    ]
    lines += ["  var k, j: SAID;", "  var n: INT;", "  page Top"]
    has_data = [r.random() < 0.3 for _ in numbers]
    speaks_data = [r.random() < 0.2 for _ in numbers]
    for i in numbers:
        lines += [
            f"    place {c}{i} : SAID" for c in _channels(has_data[i - 1], speaks_data[i - 1])
        ]
    ports = [
        f"{c}{i} -> {c}{i}" for i in numbers for c in _channels(has_data[i - 1], speaks_data[i - 1])
    ]
    lines.append(f"    subst Supervisor = Sup ({', '.join(ports)})")
    for i in numbers:
        own = ", ".join(f"{c} -> {c}{i}" for c in _channels(has_data[i - 1], speaks_data[i - 1]))
        lines.append(f"    subst D{i} = P{i} ({own})")
    lines += _supervisor(r, parts, has_data, speaks_data)
    for i in numbers:
        lines += _device(r, i, has_data[i - 1], speaks_data[i - 1])
    return "\n".join(lines) + "\n", _toml(numbers, has_data, speaks_data)


def _channels(has_data: bool, speaks_data: bool) -> list[str]:
    return ["f", "d", *(["p"] if has_data else []), *(["q"] if speaks_data else [])]


def _toml(numbers: range, has_data: list[bool], speaks_data: list[bool]) -> str:
    text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]\n'
    text += 'order = "documented"\n'
    text += '[primitives]\nact = { command = "tool", action = "act", duration_s = 0.5 }\n'
    for i in numbers:
        for c in _channels(has_data[i - 1], speaks_data[i - 1]):
            kind = "data" if c in "pq" else "flag"
            text += f'[[channel]]\nplace = "{c}{i}"\nfile = "{c}{i}.txt"\nkind = "{kind}"\n'
    return text + "".join(f'[devices.D{i}]\ninstance = "D{i}"\n' for i in numbers)


def _urgent(r: Random) -> str:
    return " priority P_HIGH" * (r.random() < 0.3)


def _supervisor(r: Random, parts: int, has_data: list[bool], speaks_data: list[bool]) -> list[str]:
    numbers = range(1, len(has_data) + 1)
    lines = ["  page Sup"]
    for i in numbers:
        for c in _channels(has_data[i - 1], speaks_data[i - 1]):
            lines.append(f"    place {c}{i} port {'out' if c in 'fp' else 'in'} : SAID")
        lines += [f"    place Free{i} = 1", f"    place Busy{i}", f"    place Tray{i}"]
    counts = r.random() < 0.6
    lines += [
        f"    place Feeder = {parts}",
        "    place Done",
        "    place Aborted",
        "    place Finished",
    ]
    lines.append(f"    place Left : INT = 1`{parts}")
    for i in numbers:
        lines += [f"    trans Send{i}{_urgent(r)}"]
        source = "Feeder" if i == 1 or r.random() < 0.2 else f"Tray{i - 1}"
        lines += [f"      in {source} : ()"]
        lines += [f"      in Free{i} : ()"] if r.random() < 0.95 else [f"      both Free{i} : ()"]
        lines += [f"      out f{i} : {r.randint(1, 2)}", f"      out Busy{i} : ()"]
        lines += [f"      out p{i} : {r.randint(1, 2)}"] * has_data[i - 1]
        is_split = r.random() < 0.4
        for said in (1, 2) if is_split else (0,):
            guard = f" guard [k = {said}]" if said else ""
            lines += [f"    trans Heard{i}x{said}{_urgent(r)}{guard}", f"      in Busy{i} : ()"]
            lines += [f"      in d{i} : k", f"      out Free{i} : ()"]
            lines += [f"      in q{i} : j"] * speaks_data[i - 1]
            is_out = i == len(has_data) or (said == 2 and r.random() < 0.7)
            lines += ["      out Done : ()"] if is_out else [f"      out Tray{i} : ()"]
            lines += ["      in Left : n", "      out Left : n - 1"] * is_out
            lines += ["      out Aborted : ()"] * (said == 2 and r.random() < 0.3)
    if r.random() < 0.4:
        lines += [f"    trans Drop{_urgent(r)}", "      both Aborted : ()", "      in Feeder : ()"]
        lines += ["      in Left : n", "      out Left : n - 1", "      out Done : ()"]
    lines += [
        f"    trans End{_urgent(r)}",
        "      in Left : 0" if counts else f"      in Done : {parts}`()",
    ]
    return [*lines, "      out Finished : ()"]


def _device(r: Random, i: int, has_data: bool, speaks_data: bool) -> list[str]:
    lines = [f"  page P{i}"]
    for c in _channels(has_data, speaks_data):
        lines.append(f"    place {c} port {'in' if c in 'fp' else 'out'} : SAID")
    steps = r.randint(0, 2)
    lines += [
        "    place Waiting = 1",
        "    place Told : SAID",
        *(f"    place S{n} : SAID" for n in range(steps)),
    ]
    lines += ["    trans Accept", "      in Waiting : ()", "      in f : k", "      out Told : k"]
    lines += ["      in p : j"] * (has_data and r.random() < 0.5)
    takes_later = has_data and lines[-1] != "      in p : j"
    at = "Told"
    for n in range(steps):
        lines += [
            f"    trans Step{n}{' code action act ()' * (r.random() < 0.5)}",
            f"      in {at} : k",
        ]
        lines += [f"      out S{n} : {r.choice(['k', 'k', 'j'])}"]
        at = f"S{n}"
    lines += [
        "    trans Fetch",
        f"      in {at} : k",
        "      in p : j",
        "      out Told2 : k",
    ] * takes_later
    if takes_later:
        lines.insert(lines.index("    place Waiting = 1"), "    place Told2 : SAID")
        at = "Told2"
    if steps and r.random() < 0.1:  # it may go round for ever
        lines += ["    trans Back", f"      in {at} : k", "      out Told : k"]
    is_split = r.random() < 0.3
    for said in (1, 2) if is_split else (0,):
        guard = f" guard [k = {said}]" if said else ""
        if said == 2 and r.random() < 0.15:
            continue
        lines += [
            f"    trans Say{said}{_urgent(r)}{guard}",
            f"      in {at} : k",
            "      out Waiting : ()",
        ]
        lines += [f"      out d : {r.choice(['k', '1', '2', 'j'])}"]
        lines += ["      out q : k"] * speaks_data
    return lines

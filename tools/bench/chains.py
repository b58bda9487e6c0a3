"""The family `chain`: robots that hand parts on to each other, and tell each other so themselves.

The supervisor tells the first one to begin, and hears from it when the second one has taken the part, and from the last
one when a part is done, which it answers. In between robot i tells i + 1 that a part is there, and i + 1 tells i that
it has taken it. What the supervisor says is `data`, since nobody owes it an answer soon.
"""

from __future__ import annotations

HEAD = """
net family
  standard
  colset SAID = int with 1..2;
  fun work () = ();
  var k: SAID;
  var n: INT;
  page Top
"""
SUPERVISOR = """
  page Supervisor
    place begin port out : SAID
    place taken port in : SAID
    place done port in : SAID
    place fetched port out : SAID
    place Feeder = {parts}
    place Left : INT = 1`{parts}
    place Free = 1
    place Given
    place Under
    place Finished
    trans Give
      in Feeder : ()
      in Free : ()
      out begin : 1
      out Given : ()
      out Under : ()
    trans Taken
      in Given : ()
      in taken : k
      out Free : ()
    trans Done
      in Under : ()
      in done : k
      in Left : n
      out Left : n - 1
      out fetched : 1
    trans End
      in Left : 0
      in Free : ()
      out Finished : ()
"""


def channels(size: int) -> list[tuple[str, int, int]]:
    """Name, writer, reader; 0 is the supervisor."""
    found = [("begin", 0, 1), ("taken", 1, 0), ("done", size, 0), ("fetched", 0, size)]
    for i in range(1, size):
        found += [(f"there{i}", i, i + 1), (f"took{i}", i + 1, i)]
    return found


def _robot(i: int, size: int) -> str:
    mine = [(name, "out" if w == i else "in") for name, w, r in channels(size) if i in (w, r)]
    lines = [f"  page R{i}", *(f"    place {name} port {way} : SAID" for name, way in mine)]
    lines += ["    place Ready = 1", "    place Held", "    place Worked"]
    lines += ["    place Offered"]
    lines += ["    trans Take", "      in Ready : ()", "      out Held : ()"]
    lines += (
        ["      in begin : k"]
        if i == 1
        else [f"      in there{i - 1} : k", f"      out took{i - 1} : 1"]
    )
    lines += ["    trans Work code action work ()", "      in Held : ()", "      out Worked : ()"]
    lines += ["    trans Offer", "      in Worked : ()"]
    offer, gone = ("done", "fetched") if i == size else (f"there{i}", f"took{i}")
    lines += [f"      out {offer} : 1", "      out Offered : ()"]
    lines += [
        "    trans Gone",
        "      in Offered : ()",
        f"      in {gone} : k",
        "      out Ready : ()",
    ]
    lines += ["      out taken : 1"] if i == 1 else []
    return "\n".join(lines)


def net(size: int, parts: int) -> str:
    """The net, as `helpers.netbuilder` reads it; two robots at least."""
    top = [f"    place {name} : SAID" for name, _, _ in channels(size)]
    for i in range(size + 1):
        mine = ", ".join(f"{name} -> {name}" for name, w, r in channels(size) if i in (w, r))
        top.append(f"    subst {f'R{i}Page = R{i}' if i else 'Supervisor = Supervisor'} ({mine})")
    pages = [
        SUPERVISOR.strip("\n").format(parts=parts),
        *(_robot(i, size) for i in range(1, size + 1)),
    ]
    return HEAD + "\n".join([*top, *pages]) + "\n"


def toml(size: int) -> str:
    """The cell."""
    text = '[net]\nfile = "cell.cpn"\n\n[supervisor]\ninstance = "Supervisor"\n'
    text += 'final = ["Finished"]\norder = "documented"\n'
    for name, _, _ in channels(size):
        kind = "data" if name in ("begin", "fetched") else "flag"
        text += f'\n[[channel]]\nplace = "{name}"\nfile = "{name}.txt"\nkind = "{kind}"\n'
    text += '\n[primitives]\nwork = { command = "tool", action = "work", duration_s = 2.0 }\n'
    return text + "".join(f'\n[devices.r{i}]\ninstance = "R{i}Page"\n' for i in range(1, size + 1))

"""Random cells that pass lists to a device and back."""

from __future__ import annotations

from random import Random

ONE = """
net cell
  standard
  colset ROW = list INT;
  colset BATCH = list ELEMENT;
  val long = "012345678901234567890123456789012345678901234567890123456789012345678901234567890123456789";
  var k: INT;
  var l: BATCH;
  page Top
    place batch : BATCH
    place done : INT
    subst Supervisor = Sup (batch -> batch, done -> done)
    subst Device = Dev (batch -> batch, done -> done)
  page Sup
    place batch port out : BATCH
    place done port in : INT
    place Ready = 1
    place Asked
    place Finished : INT
    trans Ask
      in Ready : ()
      out batch : VALUE
      out Asked : ()
    trans Finish
      in Asked : ()
      in done : k
      out Finished : k
  page Dev
    place batch port in : BATCH
    place done port out : INT
    place Waiting = 1
    place Over : INT
    trans Accept
      in Waiting : ()
      in batch : l
      out Over : length l
    trans Answer
      in Over : k
      out Waiting : ()
      out done : k
"""
ONE_TOML = """
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
[[channel]]
place = "batch"
file = "batch.txt"
[[channel]]
place = "done"
file = "done.txt"
[devices.device]
instance = "Device"
"""

VALUES = {
    "INT": ["0", "~5", "1073741823", "7"],
    "SMALL": ["0", "3", "9"],
    "BOOL": ["true", "false"],
    "STRING": ['""', r'"a b"', r'"\"\\"', r'"\000\255"', '"0"'],
    "COLOUR": ["red", "green"],
}


def cell(random: Random) -> tuple[str, str, int]:
    """The net, the cell.toml, and how many exchanges there are.

    Each exchange sends a record with one to three lists and other values; the device gives them back in reverse.
    """
    rounds = random.randint(2, 4)
    fields = [random.choice(list(VALUES)) for _ in range(random.randint(1, 3))]
    lines = ["net cell", "  standard", "  colset SMALL = int with 0..9;"]
    lines += ["  colset COLOUR = with red | green;"]
    for i, of in enumerate(fields):
        bounds = random.choice(["", " with 0..4"])
        lines.append(f"  colset L{i} = list {of}{bounds};")
        lines.append(f"  var l{i}: L{i};")
    names = [f"l{i}" for i in range(len(fields))]
    parts = [f"L{i}" for i in range(len(fields))] + ["INT"]
    lines.append("  colset ALL = product " + " * ".join(parts) + ";")
    lines.append("  var n: INT;")
    for i, of in enumerate(fields):
        cases = [
            f"{n} = [" + ", ".join(random.choices(VALUES[of], k=random.randint(0, 4))) + "]"
            for n in range(rounds)
        ]
        body = " | ".join(f"f{i} {case}" for case in cases)
        lines.append(f"  fun {body} | f{i} _ = [];")
    values = ", ".join(f"f{i} n" for i in range(len(fields)))
    taken = ", ".join(names)
    came = ", ".join(f"l{i} = rev (f{i} n)" for i in range(len(fields)))
    back = ", ".join(f"rev l{i}" for i in range(len(fields)))
    lines.append(
        f"""
  page Top
    place out : ALL
    place back : ALL
    subst Supervisor = Sup (out -> out, back -> back)
    subst Device = Dev (out -> out, back -> back)
  page Sup
    place out port out : ALL
    place back port in : ALL
    place Rounds : INT = 1`0
    place Asked : INT
    place Finished : ALL
    trans Ask
      in Rounds : n
      out Asked : n
      out out : ({values}, n)
    trans Again guard [n < {rounds - 1}, {came}]
      in Asked : n
      in back : ({taken}, n)
      out Rounds : n + 1
    trans Finish guard [n >= {rounds - 1}, {came}]
      in Asked : n
      in back : ({taken}, n)
      out Finished : ({taken}, n)
  page Dev
    place out port in : ALL
    place back port out : ALL
    place Waiting = 1
    place Held : ALL
    trans Accept
      in Waiting : ()
      in out : ({taken}, n)
      out Held : ({taken}, n)
    trans Answer
      in Held : ({taken}, n)
      out Waiting : ()
      out back : ({back}, n)
"""
    )
    toml = ONE_TOML.replace("batch", "out").replace("done", "back")
    return "\n".join(lines), toml, rounds

"""A cell of any number of robots in a row: the supervisor sends each its task, some of them at the same time.

folder = many_robots(tmp_path, 6, together=2)
"""

from __future__ import annotations

from pathlib import Path

from helpers.netbuilder import cpn

HEAD = """
net many
  standard
  colset POSE = record x:REAL * y:REAL * z:REAL * rx:REAL * ry:REAL * rz:REAL;
  fun moveJoint (p : POSE) = ();
  fun moveLinear (p : POSE) = ();
  fun moveHome () = ();
  fun at (y, z) : POSE = {x = 900.0, y = y, z = z, rx = 180.0, ry = 0.0, rz = 0.0};
  var n : INT;
"""


def many_robots(folder: Path, count: int, together: int) -> Path:
    """Writes the cell; its folder."""
    numbers = range(1, count + 1)
    net = [HEAD.strip("\n"), "  page Top"]
    net += [f"    place {c}{i} : INT" for i in numbers for c in "fd"]
    ports = ", ".join(f"{c}{i} -> {c}{i}" for i in numbers for c in "fd")
    net.append(f"    subst Supervisor = Sup ({ports})")
    net += [f"    subst Robot{i} = Rob{i} (f -> f{i}, d -> d{i})" for i in numbers]
    net += [
        "  page Sup",
        f"    place Free = {together}",
        "    place Finished",
    ]
    for i in numbers:
        net += [
            f"    place f{i} port out : INT",
            f"    place d{i} port in : INT",
            f"    place Open{i} : INT = 1`{i}",
            f"    place Busy{i} : INT",
            f"    place Ready{i}",
            f"    trans Send{i}",
            "      in Free : ()",
            f"      in Open{i} : n",
            f"      out f{i} : n",
            f"      out Busy{i} : n",
            f"    trans Got{i}",
            f"      in Busy{i} : n",
            f"      in d{i} : n",
            "      out Free : ()",
            f"      out Ready{i} : ()",
        ]
    net += [
        "    trans Finish",
        *(f"      in Ready{i} : ()" for i in numbers),
        "      out Finished : ()",
    ]
    for i in numbers:
        y = f"{1500.0 * (i - 1):.1f}"
        goes = f"moveJoint (at ({y}, 900.0)); moveLinear (at ({y}, 800.0)); moveHome ()"
        net += [
            f"  page Rob{i}",
            "    place f port in : INT",
            "    place d port out : INT",
            "    place Waiting = 1",
            "    place Told : INT",
            "    trans Accept",
            "      in Waiting : ()",
            "      in f : n",
            "      out Told : n",
            f"    trans Work code input (n) action ({goes})",
            "      in Told : n",
            "      out d : n",
            "      out Waiting : ()",
        ]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpn").write_bytes(cpn("\n".join(net) + "\n"))
    (folder / "cell.toml").write_text(_toml(count), encoding="utf-8")
    return folder


def _toml(count: int) -> str:
    channels = "".join(
        f'[[channel]]\nplace = "Top.{c}{i}"\nfile = "{c}{i}.robcad"\nkind = "flag"\n'
        for i in range(1, count + 1)
        for c in "fd"
    )
    robots = "".join(
        f"""[robots.robot{i}]
instance = "Robot{i}"
model = "{("gp25", "kr120_r2500", "irb6700_200_260")[i % 3]}"
base = {{ x = {-0.2 if i % 3 == 0 else -0.8}, y = {1.5 * (i - 1)} }}
home = {[[0, 0, 0, 0, -90, 0], [0, -110, 110, 0, 90, 0], [0, -20, 20, 0, 90, 0]][i % 3]}
"""
        for i in range(1, count + 1)
    )
    return f"""
[net]
file = "cell.cpn"
[supervisor]
instance = "Supervisor"
final = ["Finished"]
order = "documented"
{channels}
[primitives]
moveJoint = {{ command = "move_joint" }}
moveLinear = {{ command = "move_linear", frame = "world" }}
moveHome = {{ command = "move_home" }}
{robots}
[motion]
linear_speed = 0.2
"""

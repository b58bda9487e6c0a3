"""`make monitor` of a net that draws random numbers: what is enabled is drawn again, and is the same."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.pipeline import generate
from pn2code.toolchain import build

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

NET = """
    net Luck
      standard
      var n : INT;
      place A : INT = 3`1
      place B : INT
      trans T guard [n < 20 andalso discrete(0, 9) > 0]
        in A : n
        out A : n + discrete(1, 3)
      trans U priority 10 guard [discrete(0, 9) > 5 andalso n < 20]
        in A : n
        out A : n + 1
      trans Late guard [n >= 20]
        in A : n
        out B : n
"""


def test_no_false_alarm(tmp_path: Path) -> None:
    d = Diagnostics()
    made = generate(write(NET, tmp_path / "luck.cpn"), d)
    assert made is not None, [str(e) for e in d.errors]
    folder = tmp_path / "luck"
    for file in made.files:
        path = folder / file.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(file.text, encoding="utf-8")
    for name in ("supervisor.traced", "supervisor.monitor"):
        assert build.build(folder, made.files, d, target=name) is not None, [str(e) for e in d]
        done = subprocess.run(
            [folder / name, "-q", "--trace", tmp_path / name],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
    plain, monitored = (
        (tmp_path / n).read_text() for n in ("supervisor.traced", "supervisor.monitor")
    )
    assert plain == monitored
    assert plain.count("Top.T") > 2 and plain.count("Top.U") > 2

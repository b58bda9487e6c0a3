"""What `pn2code contest` loads before it begins: where a processor is hardly to be had, this is what takes its time."""

import subprocess
import sys
import threading

from pn2code.base.late import Late


def _loaded(program: str) -> set[str]:
    found = subprocess.run(
        [sys.executable, "-c", f"{program}\nimport sys\nprint(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(found.stdout.split())


def test_numbers_and_linear_programs_are_loaded_when_they_are_wanted() -> None:
    assert not _loaded("import pn2code.cli.contest") & {"numpy", "scipy", "scipy.optimize"}
    orders = "from pn2code.symbolic.order import orders\norders(2, [{0: 1}], [{1: 1}])"
    assert {"numpy", "scipy.sparse.csgraph"} <= _loaded(orders)


def test_several_threads_may_want_the_same_modules_first() -> None:
    program = """
import threading
from pn2code.base.late import Late
names = ["numpy", "scipy.optimize", "scipy.sparse.csgraph", "scipy.sparse", "numpy", "scipy.linalg"]
wanted = ["array", "linprog", "connected_components", "csr_array", "zeros", "solve"]
begin, found = threading.Barrier(len(names)), []
def load(name, attribute):
    begin.wait()
    found.append(getattr(Late(name), attribute))
threads = [threading.Thread(target=load, args=x) for x in zip(names, wanted)]
[t.start() for t in threads]
[t.join() for t in threads]
assert len(found) == len(names), found
"""
    assert "scipy.optimize" in _loaded(program)


def test_a_module_has_what_it_has_now() -> None:
    late = Late("threading")
    assert late.Lock is threading.Lock
    assert late.active_count() == threading.active_count()

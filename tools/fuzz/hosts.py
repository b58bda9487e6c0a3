"""`./dev fuzz --hosts N`: random nets with references, exceptions, strings, lists and time, in all hosts.

    python -m tools.fuzz.hosts [--hosts 2000] [--seed 0] [--sanitize]

About 25 nets are compiled together (`helpers.hosts`); `--seed` is the number of the first such file. Explorer, walks,
simulator, supervisor (`--dry-run`) and its monitor must do what the token game does.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))  # as pytest does: the tests' helpers

from helpers.compiled import QUICK
from helpers.explored import SANITIZERS
from helpers.hosts import Hosts
from helpers.unions import Outcome

SIZE = 30
MOST_FAILURES = 10


def main() -> int:
    """Compare many nets; 1 when one differs."""
    parser = argparse.ArgumentParser(prog="python -m tools.fuzz.hosts", description=__doc__)
    parser.add_argument("--hosts", type=int, default=2000, help="so many nets")
    parser.add_argument("--seed", type=int, default=0, help="the first file; further ones follow")
    parser.add_argument("--sanitize", action="store_true", help="compile with sanitizers")
    given = parser.parse_args()
    done, failures, number = Outcome(), 0, given.seed
    with tempfile.TemporaryDirectory(prefix="pn2code-hosts-") as folder:
        hosts = Hosts.open(Path(folder) / "hosts", SANITIZERS if given.sanitize else QUICK)
        while done.nets < given.hosts and failures < MOST_FAILURES:
            try:
                done.add(hosts.compare(number, SIZE))
            except Exception as failure:  # whatever it is, it is told with its number
                failures += 1
                print(f"hosts: file {number}: {type(failure).__name__}: {failure}", flush=True)
            number += 1
    print(
        f"hosts: files {given.seed} to {number - 1}: {done}; steps {dict(hosts.steps)}; {failures} differ"
    )
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())

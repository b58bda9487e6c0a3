"""`./dev oracle --PART ...`: each part is a module of this folder that has a `main`, which is given the rest.

Without a part, all of them in turn.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from tools.oracle.engine import NoOracleError, program

HERE = Path(__file__).parent


def parts() -> list[str]:
    """The names of the parts."""
    known = sorted(HERE.glob("*.py"))
    return [
        p.stem
        for p in known
        if "\ndef main(" in p.read_text(encoding="utf-8") and p.stem != "__main__"
    ]


def main(arguments: list[str]) -> int:
    """The exit code: 0 when nothing differs from the engine."""
    known = parts()
    if arguments and arguments[0].removeprefix("--") not in known:
        print(f"oracle: the parts are {', '.join('--' + p for p in known)}", file=sys.stderr)
        return 2
    try:
        program()
        chosen = (
            [(arguments[0].removeprefix("--"), arguments[1:])]
            if arguments
            else [(p, []) for p in known]
        )
        return max(
            [importlib.import_module(f"tools.oracle.{name}").main(rest) for name, rest in chosen],
            default=0,
        )
    except NoOracleError as reason:
        print(f"oracle: {reason}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

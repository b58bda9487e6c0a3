"""The process that is fuzzed: reads paths of nets from the standard input, takes each the whole way, answers.

    python -m tools.fuzz.worker [--memory MB] [--seconds S]

The answer is `ok accepted`, `ok rejected` or `bad` with a traceback as JSON. A net that uses more than S seconds of the
processor ends the process with a traceback on the standard error output; memory is limited.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import resource
import signal
import sys
import traceback
from pathlib import Path

from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics, render
from pn2code.drawing import html, svg
from pn2code.emission.c import emit
from pn2code.lowering.nets.net import lower
from pn2code.ml.core.dump import dump_program
from pn2code.monitors import kinds
from pn2code.net import front
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.evaluation.evaluate import Limits
from pn2code.semantics.game import report
from pn2code.semantics.game.token_game import Game, GameError

LIMITS = Limits(steps=50_000, depth=20_000)


def whole_way(path: Path) -> bool:
    """Everything that pn2code does with a net; whether it was accepted. Any exception is a bug."""
    d = Diagnostics()
    examined = front.examine(path, d, compute=compute)
    _say(d)
    if examined.document is not None:
        for page in examined.document.pages[:3]:
            svg.draw_page(examined.document, page)
        html.draw_net(examined.document, html.Facts(path.stem))
    flat = examined.flat
    if flat is None:
        assert d.has_errors, "no net, but no error either"
        return False
    assert not d.has_errors, "a net in spite of errors"
    dump_program(flat.program)
    if examined.document is not None:
        kinds.resolve(examined.document, flat, Diagnostics())
    try:
        game = Game(flat, limits=LIMITS)
        report.marking_text(flat, game.marking)
        for _ in range(3):
            game.advance()
            enabled = game.enabled()
            report.enabled_text(flat, game.marking.time, enabled)
            if not enabled:
                break
            game.fire(enabled[0])
    except GameError as error:
        error.report(d)
    partition = divide(flat, None, d)
    if partition is not None:
        net = lower(partition, {}, d)
        if net is not None:
            for _file in emit(net, "fuzz"):
                pass
        else:
            assert d.has_errors, "nothing lowered, but no error either"
    _say(d)
    return True


def _say(d: Diagnostics) -> None:
    for form in ("full", "concise"):
        render.report(d.sorted(), form)
    for item in d.sorted():
        json.dumps(render.as_json(item))


def main() -> int:
    """Answer until the input ends."""
    parser = argparse.ArgumentParser(prog="tools.fuzz.worker")
    parser.add_argument("--memory", type=int, default=1024, help="MB")
    parser.add_argument(
        "--seconds", type=float, default=10.0, help="of the processor, for each net"
    )
    options = parser.parse_args()
    bound = options.memory * 1024 * 1024
    resource.setrlimit(resource.RLIMIT_DATA, (bound, bound))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    faulthandler.enable()
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    faulthandler.register(signal.SIGPROF, chain=True)
    for line in sys.stdin:
        signal.setitimer(signal.ITIMER_PROF, options.seconds)
        try:
            accepted = whole_way(Path(line.strip()))
        except BaseException:
            answer = "bad " + json.dumps(traceback.format_exc())
        else:
            answer = "ok accepted" if accepted else "ok rejected"
        signal.setitimer(signal.ITIMER_PROF, 0)
        print(answer, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""The live view as a run sees it: a server beside it, which is told what happens, and may say that it shall stop.

    with LiveView(port) as live:
        print(live.address, live.stop_address)
        run_cell(path, options, d, [live], ready=live.ready, interrupted=live.interrupted)

Whatever becomes of the server, the run goes on.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from pn2code.base.closing import Closing
from pn2code.diagnostics import Diagnostics
from pn2code.live.described import describe
from pn2code.live.handing import Handing
from pn2code.live.hearing import Hearing
from pn2code.live.server import Cell, Start
from pn2code.live.tap import Tap
from pn2code.net.source import read
from pn2code.robot.transforms import Array
from pn2code.run.choices import choices_of
from pn2code.run.hand import Hand
from pn2code.web.guard import new_token
from pn2code.web.serving import listening, url

if TYPE_CHECKING:
    from pn2code.run.engine import Engine
    from pn2code.run.prepare import Prepared

WHO = "the live page"
_BUILDING_S = 20.0
"""How long the run waits for the server to take the description; after that it takes it while the cell runs."""
_END_S = 6.0


PATIENCE_S = 15.0


def patience_of(reply_timeout_s: float) -> float:
    """How long a person has for an answer: so long that asking alone does not stop the cell."""
    return min(PATIENCE_S, reply_timeout_s / 2) if reply_timeout_s > 0 else PATIENCE_S


class LiveView(Closing):
    """An observer of a run (`run.observer.Observer`) with a server.

    Args:
        port: of the page; 0 takes any that is free. `PortTaken` when it cannot be had.
        speed: seconds of the run in a second of the wall clock.
        may_act: whether people with a token of its own may interfere with the run (`lend`).
    """

    def __init__(self, port: int, speed: float = 1.0, *, may_act: bool = False) -> None:
        self._speed = speed
        self._tap: Tap | None = None
        self._hand: Hand | None = None
        with ExitStack() as stack:
            on, found = stack.enter_context(listening(port))
            token, stop_token = new_token(), new_token()
            self.act_token = new_token() if may_act else ""
            number = on.fileno()
            self._process = subprocess.Popen(
                # -P: what lies in the current folder is no module of the server.
                [sys.executable, "-P", "-m", "pn2code.live.server", str(number)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                pass_fds=(number,),
            )
        self.address = url(found, token)
        self.stop_token = stop_token
        assert self._process.stdin is not None and self._process.stdout is not None
        self._hearing = Hearing(self._process.stdout.fileno())
        self._handing = Handing(self._process.stdin.fileno())
        self._handing.give(Start(found, token, stop_token, self.act_token))

    @property
    def stop_address(self) -> str:
        """The address of a page that may stop the cell."""
        return f"{self.address}#stop={self.stop_token}"

    @property
    def act_address(self) -> str:
        """The address of a page that may interfere with the run."""
        return f"{self.address}#act={self.act_token}"

    def lend(self, prepared: Prepared, patience: float | None) -> Hand:
        """A hand in the run for those who have the token.

        Args:
            prepared: what will run.
            patience: how long a person has for an answer, s; None: see `patience_of`.
        """
        partition, config = prepared.generated.partition, prepared.config
        programs = {name: program for name, (_, program) in prepared.scripts.items()}
        channels = {
            p.name: tuple(
                PurePath(c.file).stem
                for c in partition.channels
                if partition.owners[c.writer].name == p.name
            )
            for p in config.programs
        }
        if patience is None:
            patience = patience_of(config.supervisor.reply_timeout_s)
        choices = choices_of(config, partition.net, programs)
        self._hand = Hand(choices, channels, self._hearing, patience)
        return self._hand

    @property
    def has_failed(self) -> bool:
        """Whether the server has ended by itself."""
        return self._handing.is_broken or self._process.poll() is not None

    def ready(self, prepared: Prepared) -> None:
        """What will run; nothing runs yet, so this may wait."""
        partition, config = prepared.generated.partition, prepared.config
        document = read(Path(partition.net.file), Diagnostics(), drawn=True)
        if document is None:  # the file has changed meanwhile
            return
        near = prepared.robot_cell.scene.warning_clearance
        described = describe(prepared.generated, prepared.robot_cell, document, self._speed)
        if self._hand is not None:
            described["hand"] = self._hand.described()
        if not self._handing.finish(_BUILDING_S):
            return  # the server does not read: nothing is told
        self._handing.give(Cell(partition, config, near, described))
        self._handing.finish(_BUILDING_S)
        self._tap = Tap(self._handing, prepared.robot_cell, dict(config.report.count))

    def interrupted(self) -> str:
        """Who wants the run to stop; "": nobody."""
        return WHO if self._hearing.is_stopping() else ""

    def begun(self, engine: Engine) -> None:
        """The run begins."""
        if self._tap is not None:
            self._tap.begun(engine)

    def advanced(self, engine: Engine) -> None:
        """Time has moved."""
        if self._tap is not None:
            self._tap.advanced(engine)

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """The arms stood like this."""
        if self._tap is not None:
            self._tap.sampled(engine, t, joints)

    def ended(self, engine: Engine) -> None:
        """The run is over."""
        if self._tap is not None:
            self._tap.ended(engine)

    def close(self) -> None:
        """Ends the server, after the pages have heard of the end."""
        for stream in (self._process.stdin, self._process.stdout):
            assert stream is not None
            with suppress(OSError):
                stream.close()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

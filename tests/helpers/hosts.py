"""All hosts on the same random nets, each next to the token game: explorer, walks, simulator, supervisor, monitor.

The nets are those of `helpers.random_references`: references of all forms, exceptions, strings, lists, time. `check`
compares whole graphs net by net, as `helpers.unions` does; then the nets of the union that raise no exception alone
play together (there are as many picks as nets), and the traces of the other hosts must be occurrence sequences for the
token game.
"""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path

from helpers.compiled import lowered
from helpers.explored import LIBRARY, Explorers, wide
from helpers.netbuilder import flat
from helpers.random_references import referring
from helpers.unions import Outcome, Part, check
from pn2code.base.resources import cnative_folder
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.emission.supervisor import emit
from pn2code.semantics.evaluation.files import Files
from pn2code.trace.replay import replay
from pn2code.verify.exploring.programs import Sizes

HOSTS = {
    "simulate": (),
    "supervisor": ("-DPN_TRACE",),
    "monitor": ("-DPN_TRACE", "-DPN_MONITOR"),
}
FIRINGS = 150
ROOM = 512
"""Different tokens that a place can hold."""


@dataclass(frozen=True, slots=True)
class Hosts:
    """The explorer and the other hosts, compiled once; each finds a net in a shared library when it starts."""

    explorers: Explorers
    steps: Counter[str] = field(default_factory=Counter)

    @staticmethod
    def open(folder: Path, flags: tuple[str, ...]) -> Hosts:
        """Compile them."""
        return Hosts.beside(Explorers.open(folder, flags))

    @staticmethod
    def beside(made: Explorers) -> Hosts:
        """Compile the others into the folder of an explorer."""
        source = cnative_folder() / "src"
        host = made.host
        common = [f for f in host.glob("pn_*.o") if f.name != "pn_channel_files.o"]
        stub = host / "cell.c"
        stub.write_text("char pn_net[1];\nchar pn_cell[1];\n")
        compile_in = made._run
        compile_in(host, "-shared", "cell.c", "-o", "libcell.so")
        for name, more in HOSTS.items():
            own = sorted(source.glob("simulate/*.c" if name == "simulate" else "supervisor/*.c"))
            room = host / f"{name}.objects"
            room.mkdir()
            for part in own:  # one by one: what was compiled before is remembered
                compile_in(room, *more, "-c", str(part))
            objects = [str(f) for f in (*sorted(room.glob("*.o")), *common)]
            if name != "simulate":
                objects += [str(host / f"{part}.o") for part in ("port_posix", "pn_channel_files")]
            library = "libcell.so" if name != "simulate" else LIBRARY
            compile_in(
                host, *more, "-rdynamic", *objects, f"-L{host}", f"-l:{library}", "-lm", "-o", name
            )
        return Hosts(made)

    def compare(self, number: int, size: int) -> Outcome:
        """One union in all hosts.

        Raises:
            AssertionError: they differ.
        """
        union = referring(number, size)
        done = check(self.explorers, union)
        whole = flat(union.text())
        fine = [i for i in range(size) if Part(whole, i).space is not None]
        together = re.sub(r"(fusion Pick : UNIT = )1`", rf"\g<1>{size}`", union.text(*fine))
        self.steps.update(self._play(together, number))
        return done

    def _play(self, text: str, number: int) -> dict[str, int]:
        """The steps that each host made, which have been repeated."""
        steps: dict[str, int] = {}
        net = flat(text)
        start = wide(Sizes.start(net, {}), 0)
        rooms = {p.name: ROOM for p in net.places}
        folder = self.explorers.build(net, replace(start, room=rooms), "together")
        d = Diagnostics()
        partition = divide(net, None, d)
        assert partition is not None
        found = re.search(r'\.digest = "(\w+)"', (folder / "net.c").read_text())
        assert found is not None
        emitted = emit(
            partition,
            name=net.name,
            reply_timeout_s=0.0,
            digest=found[1],
            version="test",
            compiled=lowered(net)[0],
        )
        (config,) = (f for f in emitted if f.path == "cell_config.c")
        (folder / "cell_config.c").write_text(config.text)
        self.explorers._run(folder, "-shared", "net.c", "cell_config.c", "-o", "libcell.so")
        for name in HOSTS:
            trace = folder / f"{name}.trace.jsonl"
            trace.unlink(missing_ok=True)
            options = ["--steps", str(FIRINGS), "--seed", str(number + 1)]
            if name != "simulate":
                options = ["--dry-run", "--max-firings", str(FIRINGS)]
            done = subprocess.run(
                [str(self.explorers.host / name), *options, "--trace", str(trace)],
                capture_output=True,
                text=True,
                check=False,
                timeout=600,
                cwd=folder,
                env={"LD_LIBRARY_PATH": str(folder), "ASAN_OPTIONS": "detect_leaks=0"},
            )
            said = f"union {number}, {name}: code {done.returncode}: {done.stderr[-1500:]}"
            assert "Sanitizer" not in done.stderr and "runtime error" not in done.stderr, said
            assert done.returncode >= 0 and "monitor: " not in done.stderr.replace(
                "monitor: every step", ""
            ), said
            result = replay(trace, net, {}, files=Files(None))
            assert result.ok, f"{said}\nreplay: step {result.steps + 1}: {result.why}"
            steps[name] = result.steps
        return steps

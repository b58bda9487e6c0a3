"""What `verify` draws besides its report: the graph of a small state space, how the exploration of a large one went.

with Pictures(Path("graph.html"), None) as pictures:
    found = explore(net, storage, limits, d, pictures.options(options))
    pictures.write(net, found, d)
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from errno import ENOSPC
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from pn2code.base.whole_file import whole_file
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.flat import FlatNet
from pn2code.verify.codes import GRAPH_NOT_DRAWN
from pn2code.verify.exploring.explore import ExploreOptions
from pn2code.verify.exploring.result import Exploration
from pn2code.verify.report.writing import unwritten

GRAPH_KINDS = (".svg", ".html")
PLOT_KINDS = (".svg", ".png")
MOST_SVG, MOST_HTML = 300, 5000
"""Nodes in a picture; with a page around it more can be found."""
_MOST_ARCS = 12
"""Times as many arcs."""
_PACE = 0.02


class Pictures:
    """Draws what was asked for; what cannot be drawn is said, and nothing else is lost.

    Args:
        graph: a file with an ending of `GRAPH_KINDS` for the graph; None: not wanted.
        plot: a file with an ending of `PLOT_KINDS` for the course of the exploration; None: not wanted.
    """

    def __init__(self, graph: Path | None, plot: Path | None) -> None:
        from pn2code.verify.report.plots import Record

        self._graph = graph
        self._plot = plot
        self._record = Record()
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def __enter__(self) -> Self:
        try:
            self._folder = tempfile.TemporaryDirectory(prefix="pn2code-") if self._graph else None
        except OSError:
            self._folder = None  # which is said when there would be a picture
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._folder is not None:
            self._folder.cleanup()

    @property
    def _lines(self) -> Path | None:
        """The explorer's file."""
        return Path(self._folder.name) / "graph.jsonl" if self._folder else None

    @property
    def _most(self) -> int:
        """Nodes in a picture."""
        return MOST_SVG if self._graph and self._graph.suffix.lower() == ".svg" else MOST_HTML

    def options(self, options: ExploreOptions) -> ExploreOptions:
        """Those given, and what the pictures need."""
        if self._plot is not None:
            options = replace(
                options, pace=_PACE, progress=_both(options.progress, self._record.add)
            )
        return replace(options, graph=self._lines, graph_limit=self._most if self._graph else None)

    def write(self, net: FlatNet, found: Exploration, d: Diagnostics) -> None:
        """Writes the files.

        Args:
            net: the net.
            found: its state space, explored with these options.
            d: is told what is not drawn, and why.
        """
        for path, write in ((self._graph, self._write_graph), (self._plot, self._write_plot)):
            if path is None:
                continue
            try:
                write(path, net, found, d)
            except OSError as problem:
                unwritten(path, problem, d)

    def _write_graph(self, path: Path, net: FlatNet, found: Exploration, d: Diagnostics) -> None:
        why, hint = self._why_no_picture(found)
        if why:
            d.warning(GRAPH_NOT_DRAWN, f"`{path}` is not drawn: {why}", Origin(net.file), hint=hint)
            return
        from pn2code.verify.report import graph, graph_page, graph_svg

        if self._lines is None or not self._lines.exists():
            raise OSError(ENOSPC, f"no room for the graph in `{tempfile.gettempdir()}`")
        whole = graph.read(net, self._lines)
        how = f"reduced by {', '.join(found.reductions)}" if found.reductions else ""
        if path.suffix.lower() == ".svg":
            text = graph_svg.picture(whole, f"{net.name} ({how})" if how else net.name)
        else:
            said = "Not the whole graph: {}. Nodes, components and home markings are those of what is left."
            text = graph_page.page(net, whole, [said.format(how)] if how else [])
        with whole_file(path) as beside:
            beside.write_text(text, encoding="utf-8")

    def _why_no_picture(self, found: Exploration) -> tuple[str, str]:
        """Why there is no picture, and what to do; "" when there is one."""
        smaller = "a smaller space: `--set NAME=VALUE`, `--reduce`; `--plot` draws how the exploration went"
        if found.approximation is not None:
            return "the markings are not stored with `--approximate` or `--swarm`", "leave it out"
        if not found.complete:
            return "the exploration is not complete", smaller
        if found.nodes > self._most or found.arcs > self._most * _MOST_ARCS:
            size = f"{found.nodes:,} nodes and {found.arcs:,} arcs"
            most = f"at most {self._most:,} nodes and {self._most * _MOST_ARCS:,} arcs can be seen"
            page = found.nodes <= MOST_HTML and self._most < MOST_HTML
            return f"{size}, {most}", "an .html file takes more" if page else smaller
        if found.sweep is not None:
            return (
                "markings were forgotten on the way (`--sweep`)",
                "`--no-sweep`, and more `--memory`",
            )
        if found.graph is None and (self._lines is None or not self._lines.exists()):
            return "the graph is not known with `--no-graph`", "leave it out"
        return "", ""

    def _write_plot(self, path: Path, net: FlatNet, found: Exploration, d: Diagnostics) -> None:
        from pn2code.verify.report.plots import plot

        with whole_file(path) as beside:
            plot(self._record, found, net.name, beside)


def _both(
    first: Callable[[Mapping[str, Any]], None], second: Callable[[Mapping[str, Any]], None]
) -> Callable[[Mapping[str, Any]], None]:
    def report(said: Mapping[str, Any]) -> None:
        first(said)
        second(said)

    return report

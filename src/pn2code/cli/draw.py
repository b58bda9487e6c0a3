"""`pn2code draw`: the pages of a net as their author laid them out, as SVG or HTML."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from pn2code import registers
from pn2code.base.os_reason import os_reason
from pn2code.base.progress_line import told
from pn2code.base.whole_file import whole_file
from pn2code.base.writable import why_file_unwritable, why_folder_unwritable
from pn2code.cell.codes import INPUT_MISSING
from pn2code.cell.locate import locate
from pn2code.cli.options import (
    DEFAULT_SEED,
    OUTPUT_FLAGS,
    Exit,
    Format,
    FormatOption,
    InputOption,
    NetArgument,
    SeedOption,
    SetOption,
    parse_values,
    print_diagnostics,
    stop,
)
from pn2code.cli.traces_there import traces_there
from pn2code.diagnostics import Diagnostics, Origin, Severity
from pn2code.diagnostics.suggestions import nearest
from pn2code.drawing import raster
from pn2code.drawing.codes import DRAW_ARRANGED, DRAW_OUTPUT, DRAW_PAGE, DRAW_TRACE
from pn2code.input_files import begin
from pn2code.net import front
from pn2code.reading.document import Document, RawPage
from pn2code.semantics.evaluation.constants import compute

if TYPE_CHECKING:
    from pn2code.drawing.state import State
    from pn2code.drawing.svg import Overlay, Problem
    from pn2code.net.flat import FlatNet
    from pn2code.verify.report.trace_frames import TraceFrame

EPILOG = """Examples:

  pn2code draw net.cpn -o net.html

  pn2code draw net.cpn -o net.svg --page Sender --marking

  pn2code draw net.cpn -o pages/

  pn2code draw net.cpn -o net.pdf

  pn2code draw net.cpn --trace net.dead-40.trace.jsonl -o steps.html
"""

_AROUND = 300
"""Steps before and after the chosen one that are told in an HTML file."""
_HTML = (".html", ".htm")


def draw(
    net: NetArgument,
    output: Annotated[
        str,
        typer.Option(
            *OUTPUT_FLAGS,
            metavar="FILE|DIR|-",
            help="Where to write: FILE.svg, FILE.png, FILE.pdf, FILE.html (all pages, linked), DIR/ (an SVG "
            "for each page), or - (an SVG on stdout).",
        ),
    ],
    page: Annotated[
        str | None, typer.Option("--page", metavar="P", help="Draw only this page (name or id).")
    ] = None,
    marking: Annotated[
        bool,
        typer.Option(
            "--marking", help="Show the initial marking, and which transitions are enabled in it."
        ),
    ] = False,
    trace: Annotated[
        Path | None,
        typer.Option(
            "--trace", metavar="FILE", help="Show the marking after the steps of this trace."
        ),
    ] = None,
    step: Annotated[
        int | None,
        typer.Option(
            "--step",
            metavar="N",
            min=0,
            help="Show the marking after this step of the trace (default: the last step).",
        ),
    ] = None,
    instance: Annotated[
        int | None,
        typer.Option(
            "--instance", metavar="N", min=1, help="Show the marking of this instance of the page."
        ),
    ] = None,
    inputs: InputOption = None,
    settings: SetOption = [],  # noqa: B006 - typer reads the default only
    seed: SeedOption = DEFAULT_SEED,
    form: FormatOption = Format.FULL,
) -> None:
    """Draw the pages of a net. Elements with errors are red."""
    d = Diagnostics()
    kind = _kind(output, form)
    _check_output(Path(output), kind, form)
    found = locate(net, d)
    if found is None:
        stop(d, form)
    path, config = found
    values = {**(config.values if config else {}), **parse_values(settings)}
    with told("reading the net"):
        examined = front.examine(path, d, values, drawn=True, compute=compute)
        if not d.has_errors:
            examined, config = registers.examined(examined, config, d)
    document = examined.document
    if document is None or not document.pages:
        stop(d, form)
    pages = _chosen(document, page, form)
    state: State | None = None
    frames: list[TraceFrame] = []
    chosen = last = 0
    storage = config.storage if config else {}
    if step is not None and trace is None:
        _refuse(DRAW_TRACE, "`--step` needs `--trace`", "add --trace FILE", form)
    if inputs is not None and (trace is not None or not marking):
        _refuse(
            DRAW_TRACE,
            "`--input` needs `--marking`: a trace says itself what the places begin with",
            "leave out --input, or draw with --marking alone",
            form,
        )
    flat = examined.flat
    if flat is not None and not d.has_errors and trace is None and marking:
        flat = begin(flat, config, d, given=inputs).net
        if inputs is not None and d.has_errors:
            stop(d, form)
    if flat is not None and not d.has_errors:
        if trace is not None:
            around = _AROUND if kind == "html" else 0
            frames, chosen, last = _frames(flat, storage, trace, step, around, form)
            state = next(m.state for m in frames if m.number == chosen)
        elif marking:
            state = _state(flat, storage, seed, form)
    if instance is not None:
        _check_instance(state, pages, instance, form)
    drawing = _Drawing(document, pages, _problems(d), state, instance)
    files: dict[str, str | bytes]
    with told("drawing"):
        if kind == "html" and frames:
            files = {output: drawing.steps(path, frames, chosen, last, trace)}
        else:
            files = drawing.made(kind, output, path)
    if kind == "-":
        sys.stdout.write(str(files[output]))
    else:
        _write({Path(name): made for name, made in files.items()}, form)
    drawing.note_arranged(d)
    _report(d, marking or trace is not None, form)


def _kind(output: str, form: Format) -> str:
    """What `-o` asks for: "html", "svg", ".png", ".pdf", "folder" or "-"."""
    path = Path(output)
    if output == "-":
        return "-"
    if output.endswith(("/", "\\")) or path.is_dir():
        return "folder"
    suffix = path.suffix.lower()
    if suffix in raster.KINDS:
        missing = raster.why_not(suffix)
        if missing:
            hint = f"{raster.INSTALL} brings it, or draw an .svg and convert it"
            _refuse(DRAW_OUTPUT, f"a `{suffix}` file needs {missing}, which is missing", hint, form)
        return suffix
    if suffix not in (*_HTML, ".svg"):
        wrong = f"`{suffix}` is no format of drawings" if suffix else f"`{output}` has no extension"
        hint = "use .svg, .png, .pdf or .html, or a folder with `/` at the end"
        _refuse(DRAW_OUTPUT, wrong, hint, form)
    return "svg" if suffix == ".svg" else "html"


def _check_output(output: Path, kind: str, form: Format) -> None:
    """Leaves where the drawing could not be written; folders that are missing are made."""
    if kind == "-":
        return
    is_folder = kind == "folder"
    why = (
        why_folder_unwritable(output)
        if is_folder
        else why_file_unwritable(output, makes_folders=True)
    )
    if why:
        hint = "give another file or folder with -o"
        _refuse(DRAW_OUTPUT, f"cannot write `{output}`: {why}", hint, form)


def _refuse(code: str, message: str, hint: str, form: Format) -> NoReturn:
    """Leave with a message about the command line."""
    d = Diagnostics()
    d.error(code, message, Origin("command line"), hint=hint)
    print_diagnostics(d.sorted(), form)
    raise typer.Exit(Exit.USAGE)


def _chosen(document: Document, wanted: str | None, form: Format) -> list[RawPage]:
    """The pages to draw."""
    if wanted is None:
        return list(document.pages)
    name = " ".join(wanted.split())
    found = [p for p in document.pages if p.name == name]
    found = found or [p for p in document.pages if p.id == name]
    found = found or [p for p in document.pages if p.name.lower() == name.lower()]
    if found:
        return found
    names = [p.name for p in document.pages]
    close = nearest(name, names, cutoff=0.5)
    listed = ", ".join(f"`{n}`" for n in names[:12]) + (", ..." if len(names) > 12 else "")
    hint = f"did you mean `{close}`?" if close else f"the pages are {listed}"
    _refuse(DRAW_PAGE, f"there is no page `{wanted}`", hint, form)


def _check_instance(
    state: State | None, pages: Sequence[RawPage], instance: int, form: Format
) -> None:
    """`--instance` needs a marking, and a page that has so many instances."""
    if state is None:
        _refuse(DRAW_PAGE, "`--instance` needs `--marking` or `--trace`", "add one of them", form)
    if len(pages) > 1:
        _refuse(DRAW_PAGE, "`--instance` needs `--page`", "say which page is meant", form)
    numbers = state.instances(pages[0])
    if instance not in numbers:
        most = max(numbers, default=0)
        hint = f"its instances are numbered 1 to {most}" if most else "it has no instance"
        _refuse(DRAW_PAGE, f"page `{pages[0].name}` has no instance {instance}", hint, form)


def _state(flat: FlatNet, storage: Mapping[str, str], seed: int, form: Format) -> State:
    """The initial marking, at the first time at which something is enabled."""
    from pn2code.cli.nets import playing  # the token game is needed for this only
    from pn2code.drawing.state import State, enabled_in
    from pn2code.semantics.game.token_game import Game

    with playing(form):
        game = Game(flat, storage, seed=seed)
        marking = game.advance_time(game.marking)
        return State(flat, marking, enabled_in(game, marking))


def _frames(
    flat: FlatNet,
    storage: Mapping[str, str],
    trace: Path,
    step: int | None,
    around: int,
    form: Format,
) -> tuple[list[TraceFrame], int, int]:
    """The wanted step of a trace (the last one) with some around it, its number, and how many steps there are."""
    from pn2code.cli.nets import playing
    from pn2code.trace.script import Trace, TraceRefusedError
    from pn2code.verify.report.trace_frames import follow

    try:
        last = sum(1 for _ in Trace.open(trace, flat, is_shown=True).steps())
        chosen = last if step is None else step
        if chosen > last:
            hint = f"its steps are numbered from 1 to {last}; 0 is the start"
            _refuse(DRAW_TRACE, f"`{trace}` has no step {step}", hint, form)
        with playing(form):
            found = list(follow(flat, storage, trace, lambda n: abs(n - chosen) <= around))
    except TraceRefusedError as refused:
        _refuse(DRAW_TRACE, f"`{trace}`: {refused}", "it must be a trace of this net", form)
    except OSError as problem:
        _refuse(
            DRAW_TRACE,
            f"`{trace}`: {os_reason(problem)}",
            traces_there(trace, "give a file that can be read"),
            form,
        )
    return found, chosen, last


def _problems(d: Diagnostics) -> dict[str, list[Problem]]:
    """Errors by the element they are about; those about none have the key ""."""
    from pn2code.drawing.svg import Problem

    found: dict[str, list[Problem]] = {}
    for error in d.errors:
        problem = Problem(error.message, error.origin.part)
        found.setdefault(error.origin.element_id, []).append(problem)
    return found


class _Drawing:
    """What is drawn, in the different forms."""

    def __init__(
        self,
        document: Document,
        pages: list[RawPage],
        problems: dict[str, list[Problem]],
        state: State | None,
        instance: int | None,
    ) -> None:
        from pn2code.drawing.svg import Overlay

        self.document = document
        self.pages = pages
        self.base = Overlay(problems=problems)
        self.state = state
        self.instance = instance

    def overlay(self, page: RawPage) -> Overlay:
        """What is drawn over the first (or chosen) instance of a page."""
        if self.state is None:
            return self.base
        number = self.instance or self.state.shown_first(page)
        return self.state.overlay(page, number, self.base)

    def svg(self) -> str:
        """One SVG with everything."""
        from pn2code.drawing.picture import picture

        return picture(self.document, [(p, self.overlay(p)) for p in self.pages])

    def files(self) -> dict[str, str]:
        """One SVG a page, by file name; they link to each other."""
        from pn2code.drawing.files import file_stems
        from pn2code.drawing.svg import Links, page_svg

        stems = file_stems(p.name for p in self.pages)
        names = {p.id: f"{stem}.svg" for p, stem in zip(self.pages, stems, strict=True)}
        links = Links(lambda identity: names.get(identity, ""))
        return {names[p.id]: page_svg(self.document, p, self.overlay(p), links) for p in self.pages}

    def made(self, kind: str, output: str, path: Path) -> dict[str, str | bytes]:
        """The files of a kind, by name."""
        if kind == "html":
            return {output: self.html(path)}
        if kind == "folder":
            return {str(Path(output) / name): text for name, text in self.files().items()}
        if kind == ".png":
            return {output: raster.png(self.svg())}
        if kind == ".pdf":
            return {output: raster.pdf(list(self.files().values()))}
        return {output: self.svg()}

    def html(self, path: Path) -> str:
        """One HTML file."""
        from dataclasses import replace

        from pn2code.drawing.html import Facts, counted, draw_net

        remark = ", ".join(
            counted(n, thing)
            for n, thing in (
                (len(self.pages), "page"),
                (sum(len(p.places) for p in self.pages), "place"),
                (sum(len(p.transitions) for p in self.pages), "transition"),
            )
        )
        figures = {p.id: [("", self.overlay(p))] for p in self.pages}
        if self.state is not None and self.instance is None:
            figures = {p.id: self.state.figures(p, self.base) for p in self.pages}
        shown = replace(self.document, pages=tuple(self.pages))
        return draw_net(shown, Facts(path.name, remark, self.base.problems), figures)

    def steps(
        self, path: Path, frames: list[TraceFrame], chosen: int, last: int, trace: Path | None
    ) -> str:
        """One HTML file with the steps of a trace."""
        from pn2code.verify.answers.lasso import read_loop
        from pn2code.verify.report.steps_page import steps_page

        loop = None if trace is None else read_loop(trace)
        return steps_page(self.document, self.pages, frames, chosen, last, path.name, loop)

    def note_arranged(self, d: Diagnostics) -> None:
        """A note for each page whose positions are ours."""
        from pn2code.drawing.positions import needs_arranging

        for page in self.pages:
            if needs_arranging(page) and self.document.tool != "text":  # a text has none
                d.note(
                    DRAW_ARRANGED,
                    f"page `{page.name}` has no usable positions and is arranged automatically",
                    page.origin,
                )


def _write(files: Mapping[Path, str | bytes], form: Format) -> None:
    """Write the files; folders that are missing are made."""
    for path, drawn in files.items():
        data = drawn.encode("utf-8") if isinstance(drawn, str) else drawn
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with whole_file(path) as beside:
                beside.write_bytes(data)
        except OSError as problem:
            hint = "give another file or folder with -o"
            _refuse(DRAW_OUTPUT, f"cannot write `{path}`: {os_reason(problem)}", hint, form)


def _report(d: Diagnostics, marking: bool, form: Format) -> None:
    """What is said at the end; the marking of a net with errors is not known, which is an error then."""
    if marking and d.has_errors:
        print_diagnostics(d.sorted(), form)
        print("drawn without the marking: the net has errors", file=sys.stderr)
        raise typer.Exit(Exit.MODEL)
    if form is not Format.FULL:
        print_diagnostics(d.sorted(), form)
        return
    print_diagnostics(i for i in d.sorted() if i.code == INPUT_MISSING)
    for item in d.sorted():
        if item.severity is Severity.NOTE and item.code == DRAW_ARRANGED:
            print(f"note: {item.message}", file=sys.stderr)
    if d.has_errors:
        n = len(d.errors)
        print(
            f"the net has {n} error{'s' * (n != 1)}, shown in red; `pn2code check` explains",
            file=sys.stderr,
        )

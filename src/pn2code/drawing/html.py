"""A net as one HTML file: all pages, linked along the hierarchy. It can be read without scripts and without a network.

Substitution transitions and their tags lead to the page they stand for, port tags to the sockets, fusion tags to the
list of the set's members, bread crumbs and the tree of pages to pages, the search box to places and transitions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field

from pn2code.base import resources
from pn2code.base.frozen import frozen
from pn2code.drawing import text
from pn2code.drawing.geometry import Box
from pn2code.drawing.scene import build
from pn2code.drawing.shapes import Scene
from pn2code.drawing.svg import MARGIN, Links, Overlay, Problem, figure, svg_attributes
from pn2code.drawing.text import escape
from pn2code.reading.document import (
    Document,
    RawBlock,
    RawColset,
    RawDeclaration,
    RawGlobref,
    RawPage,
    RawUse,
    RawVar,
)

_MOST_PATHS = 6
_MOST_TREE = 2000

Figures = Sequence[tuple[str, Overlay]]
"""The figures of a page: caption ("" for none) and what is drawn over the page."""


@frozen
class Facts:
    """What is said about the net as a whole.

    Args:
        title: the name of the net.
        remark: one line below it.
        problems: what is wrong beside the pages, by id of a declaration; "" for what has no place at all.
    """

    title: str
    remark: str = ""
    problems: Mapping[str, Sequence[Problem]] = field(default_factory=dict)


def draw_net(document: Document, facts: Facts, figures: Mapping[str, Figures] | None = None) -> str:
    """The HTML file of a net.

    Args:
        document: the net.
        facts: its title.
        figures: by page id; without it each page is drawn once, plainly.
    """
    return _Writer(document, facts, figures or {}).html()


class _Writer:
    def __init__(self, document: Document, facts: Facts, figures: Mapping[str, Figures]) -> None:
        self.document = document
        self.facts = facts
        self.figures = figures
        self.pages = {p.id: p for p in document.pages}
        self.number = {p.id: i for i, p in enumerate(document.pages, 1)}
        self.anchors: dict[str, str] = {}
        for page in document.pages:
            for k, node in enumerate(page.nodes, 1):
                self.anchors.setdefault(node.id, f"page-{self.number[page.id]}-{k}")
        self.subpages = {
            p.id: [
                t.substitution.subpage
                for t in p.transitions
                if t.substitution and t.substitution.subpage in self.pages
            ]
            for p in document.pages
        }
        self.parents: dict[str, list[tuple[RawPage, str]]] = {p.id: [] for p in document.pages}
        self.sockets: dict[str, list[str]] = {}
        for page in document.pages:
            for t in page.transitions:
                if t.substitution and t.substitution.subpage in self.pages:
                    self.parents[t.substitution.subpage].append((page, t.id))
                    for port, socket in t.substitution.portsock:
                        self.sockets.setdefault(port, []).append(socket)
        self.members: dict[str, list[str]] = {}
        for page in document.pages:
            for place in page.places:
                if place.fusion:
                    self.members.setdefault(place.fusion, []).append(place.id)
        self.fusion_number = {name: i for i, name in enumerate(sorted(self.members), 1)}
        self.fusion_of = {i: name for name, ids in self.members.items() for i in ids}
        self.page_of = {n.id: p for p in document.pages for n in p.nodes}
        self.names = {n.id: n.name for p in document.pages for n in p.nodes}

    def html(self) -> str:
        """Everything."""
        folder = resources.templates_folder() / "html"
        style = (folder / "net.css").read_text(encoding="utf-8")
        script = (folder / "net.js").read_text(encoding="utf-8")
        title = escape(self.facts.title)
        rows = [
            "<!DOCTYPE html>",
            '<html lang="en">',
            "<head>",
            '<meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{title}</title>",
            f"<style>\n{style}</style>",
            "</head>",
            "<body>",
            "<nav>",
            f"<h1>{title}</h1>",
            f"<p>{escape(self.facts.remark)}</p>" if self.facts.remark else "",
            '<input id="search" type="search" placeholder="Find a name ( / )" aria-label="Find a name">',
            '<div class="zoom"><button data-zoom="0.8" title="Smaller">−</button> '
            '<button data-zoom="1" title="As in CPN Tools">100 %</button> '
            '<button data-zoom="1.25" title="Larger">+</button></div>',
            "<h2>Pages</h2>",
            *self.tree(),
        ]
        rows.append('<ul><li><a href="#declarations">Declarations</a></li>')
        if self.members:
            rows.append('<li><a href="#fusion">Fusion sets</a></li>')
        rows.append("</ul>")
        rows += ["<h2>Places and transitions</h2>", *self.index(), "</nav>", "<main>"]
        for page in self.document.pages:
            rows += self.section(page)
        rows += self.declarations()
        rows += self.fusions()
        rows += ["</main>", f"<script>\n{script}</script>", "</body>", "</html>", ""]
        return "\n".join(row for row in rows if row) + "\n"

    def to_page(self, identity: str) -> str:
        """The address of a page."""
        return f"#page-{self.number[identity]}" if identity in self.number else ""

    def link(self, identity: str) -> str:
        """A link to a page, as HTML."""
        return f'<a href="{self.to_page(identity)}">{escape(self.pages[identity].name)}</a>'

    def element(self, identity: str) -> str:
        """A link to an element, as HTML."""
        page = self.page_of[identity]
        return (
            f'<a href="#{self.anchors[identity]}">{escape(self.names[identity])}</a> '
            f"<span>on {escape(page.name)}</span>"
        )

    def tree(self) -> list[str]:
        """The tree of pages from the prime pages down; a page below itself is not followed."""
        rows: list[str] = []
        roots = [p.id for p in self.document.pages if not self.parents[p.id]]
        seen: set[str] = set()

        def show(identity: str, above: tuple[str, ...]) -> None:
            if len(rows) > _MOST_TREE:
                return
            rows.append(f"<li>{self.link(identity)}")
            seen.add(identity)
            below = [s for s in self.subpages[identity] if s not in above]
            counted = dict.fromkeys(below)
            if counted:
                rows.append("<ul>")
                for subpage in counted:
                    show(subpage, (*above, subpage))
                    if below.count(subpage) > 1 and rows[-1] == "</li>":
                        rows[-1] = (
                            rows[-1].removesuffix("</li>") + f" × {below.count(subpage)}</li>"
                        )
                rows.append("</ul>")
            rows.append("</li>")

        rows.append("<ul>")
        for root in roots:
            show(root, (root,))
        for page in self.document.pages:  # pages that contain themselves have no root
            if page.id not in seen:
                show(page.id, (page.id,))
        rows.append("</ul>")
        return rows

    def index(self) -> list[str]:
        """All places and transitions by name."""
        found = sorted(self.anchors, key=lambda i: (self.names[i].lower(), self.names[i], i))
        rows = [f"<li>{self.element(i)}</li>" for i in found]
        return ['<ul id="names">', *rows, "</ul>"]

    def paths(self, identity: str) -> list[list[str]]:
        """Ways from prime pages down to a page, at most a few."""
        found: list[list[str]] = []
        todo = [[identity]]
        while todo and len(found) < _MOST_PATHS:
            path = todo.pop(0)
            above = dict.fromkeys(p.id for p, _ in self.parents[path[0]] if p.id not in path)
            if not above:
                found.append(path)
            elif len(todo) < 100 * _MOST_PATHS:
                todo += [[p, *path] for p in above]
        return found

    def section(self, page: RawPage) -> list[str]:
        """A page: heading, bread crumbs, figures."""
        rows = [
            f'<section id="page-{self.number[page.id]}">',
            f"<h2>{escape(page.name)}</h2>",
        ]
        for path in self.paths(page.id):
            if len(path) > 1:
                steps = [self.link(p) for p in path[:-1]]
                rows.append(f'<p class="path">{" › ".join(steps)} › {escape(page.name)}</p>')
        uses = self.parents[page.id]
        if len(uses) > 1:
            listed = ", ".join(self.element(t) for _, t in uses)
            rows.append(f'<p class="path">stands behind {listed}</p>')
        scene = build(self.document, page)
        if scene.arranged and self.document.tool != "text":  # a text has no positions
            rows.append(
                '<p class="note">The file has no usable positions: arranged automatically.</p>'
            )
        for k, (caption, overlay) in enumerate(self.figures.get(page.id) or [("", Overlay())]):
            rows += self.figure(scene, caption, overlay, first=k == 0)
        rows.append("</section>")
        return rows

    def figure(self, scene: Scene, caption: str, overlay: Overlay, *, first: bool) -> list[str]:
        """One drawing of a page; only the first has the anchors."""
        links = Links(
            page=self.to_page,
            element=(lambda i: self.anchors.get(i, "")) if first else (lambda i: ""),
            tag=self.behind_tag,
        )
        body, box = figure(scene, overlay, links)
        box = box.grown(MARGIN)
        rows = ["<figure>"]
        if caption:
            rows.append(f"<figcaption>{escape(caption)}</figcaption>")
        if overlay.problems:
            rows += self.problems(scene, overlay)
        rows.append(
            '<div class="sheet" tabindex="0" role="group" '
            f'aria-label="Drawing of {escape(scene.name)}">'
            f'<svg xmlns="http://www.w3.org/2000/svg" {svg_attributes(box)} '
            f'style="--w:{_pixels(box)}px" role="group" aria-label="{escape(scene.name)}">'
        )
        return [*rows, *body, "</svg></div>", "</figure>"]

    def problems(self, scene: Scene, overlay: Overlay) -> list[str]:
        """The messages about elements of the page, as a list to unfold."""
        owner = {line.id: line.title.split(":")[0] for line in scene.lines}
        rows = []
        for i in [s.id for s in scene.shapes] + list(owner):
            where = self.element(i) if i in self.page_of else escape(owner.get(i, i))
            rows += [f"<li>{where}: {escape(m.message)}</li>" for m in overlay.problems.get(i, ())]
        if not rows:
            return []
        head = f"<summary>{counted(len(rows), 'error')} on this page, in red</summary>"
        return [f'<details class="errors">{head}<ul>', *rows, "</ul></details>"]

    def behind_tag(self, kind: str, identity: str) -> str:
        """Where the tag of a port or of a fusion place leads."""
        if kind == "fusion":
            name = self.fusion_of.get(identity)
            return f"#fusion-{self.fusion_number[name]}" if name is not None else ""
        sockets = [s for s in self.sockets.get(identity, ()) if s in self.anchors]
        return f"#{self.anchors[sockets[0]]}" if kind == "port" and sockets else ""

    def declarations(self) -> list[str]:
        """The declarations as CPN ML, with what is wrong in them."""
        rows = ['<section id="declarations">', "<h2>Declarations</h2>"]
        rows += [
            f'<p class="errors">{escape(p.message)}</p>' for p in self.facts.problems.get("", ())
        ]

        def show(block: RawBlock, level: int) -> None:
            if block.name:
                rows.append(f"<h{level}>{escape(block.name)}</h{level}>")
            for item in block.items:
                if isinstance(item, RawBlock):
                    show(item, min(level + bool(block.name), 6))
                    continue
                rows.append(f"<pre>{escape(declaration_text(item))}</pre>")
                rows.extend(
                    f'<p class="errors">{escape(p.message)}</p>'
                    for p in self.facts.problems.get(item.id, ())
                )

        show(self.document.globbox, 3)
        rows.append("</section>")
        return rows

    def fusions(self) -> list[str]:
        """The fusion sets with their members."""
        if not self.members:
            return []
        rows = ['<section id="fusion">', "<h2>Fusion sets</h2>", "<dl>"]
        for name, number in self.fusion_number.items():
            listed = ", ".join(self.element(i) for i in self.members[name])
            rows.append(f'<dt id="fusion-{number}">{escape(name)}</dt><dd>{listed}</dd>')
        return [*rows, "</dl>", "</section>"]


def declaration_text(item: RawDeclaration) -> str:
    """A declaration about as it is written in CPN Tools."""
    match item:
        case RawColset():
            timed = " timed" if item.timed else ""
            shown = item.layout_text or f"colset {item.name} = {_definition(item)}{timed};"
            return "\n".join(text.lines(shown))
        case RawVar():
            return f"var {', '.join(item.names)} : {item.type};"
        case RawGlobref():
            return f"globref {item.name} = {item.text.text};"
        case RawUse():
            return f"use {item.text.text};"
        case _:
            return "\n".join(text.lines(item.text.text))


def _definition(item: RawColset) -> str:
    """The right-hand side of a colour set that the file gives in pieces."""
    if item.fields:
        sign = " + " if item.kind == "union" else " * "
        parts = sign.join(f"{name}{':' if of else ''}{of}" for name, of in item.fields)
        return f"{item.kind} {parts}"
    names = (" * " if item.kind == "product" else " | " if item.kind == "enum" else " ").join(
        item.ids
    )
    kind = {"enum": "with", "alias": ""}.get(item.kind, item.kind)
    texts = f" with {' .. '.join(t.text for t in item.texts)}" if item.texts else ""
    return f"{kind} {names}{texts}".strip()


def counted(n: int, thing: str) -> str:
    """A number with its noun."""
    return f"{n} {thing}" if n == 1 else f"{n} {thing}s"


def _pixels(box: Box) -> int:
    return max(1, round(box.width))

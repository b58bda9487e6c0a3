"""Pages made of the templates in `templates/html`."""

from __future__ import annotations

import re
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from pn2code.base.resources import templates_folder

_TICKED = re.compile(r"`([^`]+)`")


def script(name: str) -> Markup:
    """A file of `templates/html` as the content of a `script` element."""
    return Markup((templates_folder() / "html" / name).read_text(encoding="utf-8"))


def ticked(text: str) -> Markup:
    """A sentence in which names stand between backticks, with these as code."""
    return Markup(_TICKED.sub(r"<code>\1</code>", str(escape(text))))


def page(template: str, styles: tuple[str, ...], **values: Any) -> str:
    """A page as text; names, values and inscriptions are strangers' texts: all that is no `Markup` is escaped.

    Args:
        template: its file.
        styles: files of style sheets, which become `css`, in their order.
        values: by name all that the template asks for.

    Raises:
        jinja2.UndefinedError: the template asks for something else.
    """
    folder = templates_folder() / "html"
    env = Environment(
        loader=FileSystemLoader(folder),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    env.filters["ticked"] = ticked
    css = "".join((folder / name).read_text(encoding="utf-8") for name in styles)
    return env.get_template(template).render(css=Markup(css), **values)

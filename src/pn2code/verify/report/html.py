"""Pages made of the templates in `templates/html`."""

from __future__ import annotations

from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from pn2code.base.resources import templates_folder


def script(name: str) -> Markup:
    """A file of `templates/html` as the content of a `script` element."""
    return Markup((templates_folder() / "html" / name).read_text(encoding="utf-8"))


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
    css = "".join((folder / name).read_text(encoding="utf-8") for name in styles)
    return env.get_template(template).render(css=Markup(css), **values)

"""The one Jinja environment of all emitters. Raw model text enters a template only through one of its filters.

"a*/b"  | c_comment   ->  a* /b
"a\"b"  | c_string    ->  "a\"b"
0.1     | c_float     ->  0.1
"""

from __future__ import annotations

import math
from contextlib import suppress
from functools import cache

from jinja2 import Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined
from jinja2.bccache import Bucket

from pn2code.base.private_folder import private_folder
from pn2code.base.resources import templates_folder


def c_comment(text: str) -> str:
    """Text for inside `/* ... */`: neither begins nor ends a comment, one line, no trigraph, no backslash."""
    line = " ".join(text.replace("\\", "/").split())
    for pair in ("*/", "/*", "??"):
        while pair in line:
            line = line.replace(pair, f"{pair[0]} {pair[1]}")
    return line


def c_comment_line(text: str) -> str:
    """The same for a line that begins with blanks, which stay."""
    return " " * (len(text) - len(text.lstrip(" "))) + c_comment(text)


def _in_string(byte: int) -> str:
    if byte in b'"?\\':
        return f"\\{chr(byte)}"  # `?`: no trigraphs
    # Three digits cannot swallow a digit that follows.
    return chr(byte) if 0x20 <= byte < 0x7F else f"\\{byte:03o}"


_IN_STRING = {byte: _in_string(byte) for byte in range(256)}


def c_string(text: str) -> str:
    """A C string literal of the text's UTF-8 bytes."""
    return f'"{text.encode("utf-8").decode("latin-1").translate(_IN_STRING)}"'


def c_float(value: float) -> str:
    """A C constant that is exactly this double."""
    if not math.isfinite(value):
        raise ValueError(f"{value} has no C constant")
    return repr(float(value))


def c_int(value: int) -> str:
    """A C constant of type int64_t; the smallest number has no literal of its own."""
    if not -(2**63) <= value < 2**63:
        raise ValueError(f"{value} does not fit 64 bits")
    return "INT64_MIN" if value == -(2**63) else f"INT64_C({value})"


def c_bool(value: bool) -> str:
    """`true` or `false`."""
    return "true" if value else "false"


class _Cache(FileSystemBytecodeCache):
    """Keeps compiled templates, where there is room for them."""

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Without room, or where others may not write, the template is compiled again by the next command."""
        with suppress(OSError):
            super().dump_bytecode(bucket)


@cache
def environment() -> Environment:
    """Strict: an unknown name in a template is an error, not an empty string."""
    folder = private_folder()
    env = Environment(
        loader=FileSystemLoader(templates_folder()),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        bytecode_cache=_Cache(str(folder), "%s.template") if folder else None,
    )
    for function in (c_comment, c_comment_line, c_string, c_float, c_int, c_bool):
        env.filters[function.__name__] = function
    return env


def render(template: str, **values: object) -> str:
    """The text of `templates/<template>` with these values."""
    return environment().get_template(template).render(**values)

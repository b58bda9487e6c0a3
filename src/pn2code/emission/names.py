"""C identifiers for things of the net. Nothing else makes identifiers.

A name is a readable stem plus a prefix or suffix that says what it is (`POSE_t`, `ml_rotate`,
`Robot1_Accept_fire`), so that names of the net never meet those of C, of the runtime, or of each other; what
is left of clashes gets a number. Characters that C does not know become `_`; accented letters lose their accent.

Example: the places `Buffer A` and `Buffer-A` of page `Top` become `Buffer_A` and `Buffer_A_2`.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Hashable
from functools import lru_cache

_KEYWORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline int long
    register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while
    _Alignas _Alignof _Atomic _Bool _Complex _Generic _Imaginary _Noreturn _Static_assert _Thread_local alignas
    alignof bool complex imaginary noreturn static_assert thread_local true false asm typeof constexpr nullptr
    and and_eq bitand bitor compl not not_eq or or_eq xor xor_eq class new delete this template namespace
    operator private public
    NULL EOF errno stdin stdout stderr assert offsetof unix linux i386 INFINITY NAN HUGE_VAL
"""
_OWN = "main b m cx marking binding self sink user moves before mark is_kept is_done"

KEYWORDS = frozenset(_KEYWORDS.split())
"""Keywords of C and C++, and macros of the headers in use."""

RESERVED = KEYWORDS | frozenset(_OWN.split())
"""These, and the names that generated functions use themselves."""

_PREFIXES = ("pn_", "PN_", "sim_", "SIM_", "NET_")
"""Of the runtime, and of the simulator, which is compiled in one piece with the net."""
_TYPES = """
    size_t ptrdiff_t wchar_t max_align_t off_t ssize_t fpos_t float_t double_t locale_t time_t clock_t sig_atomic_t
    int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t intptr_t uintptr_t intmax_t uintmax_t
    net_marking_t net_successor_t begin_net_successor
"""
"""Of the headers, and of every net."""

_MAX_STEM = 48


@lru_cache(maxsize=4096)
def stem(text: str, reserved: frozenset[str] = RESERVED) -> str:
    """A readable C identifier for a name of the net: never empty, never reserved, at most 48 characters.

    `x'` gives `x_prime`, `É` gives `E`, `1a` gives `n1a`, `int` gives `int_`.
    """
    decomposed = unicodedata.normalize("NFKD", text.replace("'", "_prime"))
    kept = "".join(
        c if c.isascii() and (c.isalnum() or c == "_") else "_"
        for c in decomposed
        if not unicodedata.combining(c)
    )
    words = [w for w in kept.split("_") if w]
    name = "_".join(words)[:_MAX_STEM].rstrip("_") or "unnamed"
    if name[0].isdigit():
        name = f"n{name}"
    is_of_host = name == "sim" or name.startswith(_PREFIXES)
    return f"{name}_" if name in reserved or is_of_host else name


class Scope:
    """Distinct identifiers in one C scope; the same key always gets the same name."""

    def __init__(self, outer: Scope | None = None) -> None:
        self._outer = outer
        self._names: dict[Hashable, str] = {}
        self._used: set[str] = set()

    def _is_used(self, name: str) -> bool:
        return name in self._used or (self._outer is not None and self._outer._is_used(name))

    def name(self, key: Hashable, text: str, pattern: str = "{}") -> str:
        """The name of `key`: the stem of `text` put into `pattern`, with a number if that is taken."""
        if key in self._names:
            return self._names[key]
        base = stem(text)
        candidate, n = pattern.format(base), 2
        while self._is_used(candidate):
            candidate, n = pattern.format(f"{base}_{n}"), n + 1
        self._names[key] = candidate
        self._used.add(candidate)
        return candidate

    def name_of_type(self, key: Hashable, text: str) -> str:
        """A name of which nobody else has the type, either: neither `POSE_slot` nor `POSE_slot_t`."""
        if key not in self._names:
            name, n = stem(text), 2
            while self._is_used(name) or self._is_used(f"{name}_t"):
                name, n = stem(f"{stem(text)}_{n}"), n + 1
            self._names[key] = name
            self.reserve(name, f"{name}_t")
        return self._names[key]

    def reserve(self, *names: str) -> None:
        """Names that are not to be given."""
        self._used.update(names)


class Members(Scope):
    """Distinct names for the members of one struct: only keywords are in the way."""

    def name(self, key: Hashable, text: str, pattern: str = "{}") -> str:
        """As in every scope."""
        plain = stem(text, KEYWORDS)
        if key not in self._names and not self._is_used(plain):
            self._names[key] = plain
            self._used.add(plain)
            return plain
        return super().name(key, text, pattern)


class Names:
    """The file-level names of one net. `read`: the values that printed code looks at."""

    def __init__(self) -> None:
        self.read: set[str] = set()
        self._scope = Scope()
        self._scope.reserve(*_TYPES.split())

    def type(self, key: str) -> str:
        """`POSE_t`."""
        return self._scope.name(("type", key), key, "{}_t")

    def tag(self, key: str) -> str:
        """The struct, union or enum tag of a type: `POSE`."""
        return self.type(key).removesuffix("_t")

    def cell(self, key: str) -> str:
        """The type of a list's cells: `POSES_cell_t`."""
        return self._scope.name(("cell", key), key, "{}_cell_t")

    def constructor(self, type_key: str, constructor: str) -> str:
        """`CMD_joint`."""
        return self._scope.name(
            ("constructor", type_key, constructor), f"{self.tag(type_key)}_{constructor}"
        )

    def table(self, key: str) -> str:
        """The descriptor of a colour set: `s_POSE`; of a type without one: `s_type_POSE`."""
        return self._scope.name(("table", key), key, "s_{}")

    def number(self, key: str, pattern: str) -> str:
        """`number_of_PH`, `colour_of_PH`: functions that number the colours of a colour set."""
        return self._scope.name((pattern, key), key, pattern)

    def function(self, key: str, hint: str) -> str:
        """`ml_rotate`."""
        return self._scope.name(("function", key), hint, "ml_{}")

    def value(self, key: str, hint: str) -> str:
        """`val_pitch`."""
        return self._scope.name(("value", key), hint, "val_{}")

    def value_read(self, key: str, hint: str) -> str:
        """The same, where code looks at it."""
        name = self.value(key, hint)
        self.read.add(name)
        return name

    def transition(self, index: int, name: str) -> str:
        """`Robot1_Accept`: the instance path without the prime page."""
        return self._scope.name(("transition", index), _path(name))

    def page_transition(self, index: int, page: str, short: str) -> str:
        """`MoveBoth_Command`: what all instances of a page have in common."""
        return self._scope.name(("page transition", index), f"{page}_{short}")

    def page_places(self, page: str, paths: tuple[str, ...]) -> str:
        """`MoveBoth_places`: the struct of the places of a page."""
        return self._scope.name_of_type(("page places", page, paths), f"{page}_places")

    def instance(self, path: str, struct: str) -> str:
        """`s_in_Supervisor_Approach_Move_both`: the places of a page instance."""
        return self._scope.name(("instance", path, struct), _path(path), "s_in_{}")

    def kept(self, key: str, kind: str) -> str:
        """`POSE_slot`, `POSE_array_64`: what holds the tokens of a place of a colour set."""
        return self._scope.name_of_type(("kept", key, kind), f"{key}_{kind}")

    def multiset(self, index: int, name: str) -> str:
        """`s_at_Robot1_Waiting`."""
        return self._scope.name(("multiset", index), _path(name), "s_at_{}")

    def place(self, index: int, name: str) -> str:
        """The place's member of the marking, also the stem of its functions: `Robot1_Waiting`."""
        return self._scope.name(("place", index), _path(name))


def _path(name: str) -> str:
    return "_".join(name.split(".")[1:]) or name


def label(text: str) -> str:
    """A struct member for a record label; components of tuples become `c1`, `c2`, ..."""
    return f"c{text}" if text.isdigit() else stem(text, KEYWORDS)

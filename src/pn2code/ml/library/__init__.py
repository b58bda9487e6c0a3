"""The utility library of SML/NJ, as far as it can be written in CPN ML: structures and functors that a net may use.

Each has a file `NAME.sml` here, or is made by a functor that has one (`MADE`). A net's text that mentions a name gets
its declarations in front of it, and those of the names that they mention. What SML/NJ has in structures of the Basis
library besides is in `more/NAME.sml`, whose structure `NAME` opens the other; it comes when one of its own functions is
mentioned: `List.mapi`. Signatures that stand for several structures (`ORD_MAP`) are in `signatures/NAME.sml`.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def _slices_of(vectors: str, whole: str, element: str) -> str:
    """The declaration of slices of vectors of one type of elements."""
    text = (FOLDER / "VectorSlice.sml").read_text(encoding="ascii")
    text = text.replace("Vector.", f"{vectors}.").replace("VectorSlice", f"{vectors}Slice")
    types = f"type elem = {element}\n    type vector = {whole}\n"
    return text.replace(
        "datatype 'a slice = Slice of 'a vector", f"{types}    datatype slice = Slice of vector"
    )


def _byte_arrays() -> str:
    """The declaration of slices of arrays of bytes."""
    text = (FOLDER / "ArraySlice.sml").read_text(encoding="ascii")
    types = "type elem = Word8.word\n    type array = Word8Array.array\n    type vector = Word8Vector.vector\n"
    for old, new in (
        ("structure ArraySlice", "structure Word8ArraySlice"),
        ("datatype 'a slice = Slice of 'a array", f"{types}    datatype slice = Slice of array"),
        ("Vector.fromList", "Word8Vector.fromList"),
        ("VectorSlice.", "Word8VectorSlice."),
    ):
        text = text.replace(old, new)
    return text


def _words(name: str, big: bool) -> str:
    """The declaration of words of 32 bits in vectors and arrays of bytes."""
    order = "rev bytes" if big else "bytes"
    return f"""structure {name} = struct
    val bytesPerElem = 4
    val isBigEndian = {str(big).lower()}
    fun word bytes =
        List.foldr (fn (byte, sum) => Word32.+ (Word32.* (sum, 0w256), Word32.fromInt (Word8.toInt byte))) 0w0 ({order})
    fun read (size, byte) i =
        if i < 0 orelse i > size div 4 - 1 then raise Subscript
        else word (List.tabulate (4, fn k => byte (4 * i + k)))
    fun subVec (bytes, i) = read (Word8Vector.length bytes, fn k => Word8Vector.sub (bytes, k)) i
    fun subArr (bytes, i) = read (Word8Array.length bytes, fn k => Word8Array.sub (bytes, k)) i
    fun subVecX at = subVec at
    fun subArrX at = subArr at
    fun update (bytes, i, value) =
        if i < 0 orelse i > Word8Array.length bytes div 4 - 1 then raise Subscript
        else
            let fun parts (0, _) = nil
                  | parts (n, rest) =
                    Word8.fromInt (Word32.toInt (Word32.mod (rest, 0w256))) :: parts (n - 1, Word32.div (rest, 0w256))
                fun ordered bytes = {order}
                val made = Word8Vector.fromList (ordered (parts (4, value)))
            in Word8Array.copyVec {{src = made, dst = bytes, di = 4 * i}} end
end"""


def _reals(kind: str) -> str:
    """The declaration of vectors or arrays of reals."""
    whole = kind.lower()
    vectors = "" if kind == "Vector" else "    type vector = real Vector.vector\n"
    return (
        f"structure Real64{kind} = struct\n    open {kind}\n    type elem = real\n"
        f"    type {whole} = real {kind}.{whole}\n{vectors}end"
    )


def _table(name: str, key: str, hashed: str, same: str = "op =") -> str:
    """The declaration of hash tables with keys of one type."""
    return (
        f"structure {name} = struct\n    structure Key = struct type hash_key = {key}\n"
        f"        val hashVal : {key} -> word = {hashed}\n        val sameKey : {key} * {key} -> bool = {same} end\n"
        f"    open HashTable\n    type 'a hash_table = ({key}, 'a) HashTable.hash_table\n"
        f"    fun mkTable (hint, missing) = HashTable.mkTable ({hashed}, {same}) (hint, missing)\n"
        "    fun inDomain table key = isSome (find table key)\nend"
    )


_KEYS = {
    "Int": "struct type ord_key = int val compare = Int.compare end",
    "Word": "struct type ord_key = word val compare = Word.compare end",
    "Atom": "struct type ord_key = Atom.atom val compare = Atom.compare end",
}
_OTHER_FUNCTORS = {
    f"{kind}{what}Fn": f"List{what}Fn"
    for kind in ("Binary", "RedBlack", "Splay")
    for what in ("Map", "Set")
}
_STRUCTURES = (
    *(
        "IntBinaryMap",
        "IntListMap",
        "IntRedBlackMap",
        "IntBinarySet",
        "IntListSet",
        "IntRedBlackSet",
    ),
    *("WordRedBlackMap", "WordRedBlackSet", "AtomMap", "AtomBinaryMap", "AtomRedBlackMap"),
    *("AtomSet", "AtomBinarySet", "AtomRedBlackSet"),
)
MADE: dict[str, str] = {
    **{
        name: f"functor {name} (K : ORD_KEY) = struct structure Made = {functor} (K) open Made end"
        for name, functor in _OTHER_FUNCTORS.items()
    },
    "CharVectorSlice": _slices_of("CharVector", "string", "char"),
    "Word8VectorSlice": _slices_of("Word8Vector", "Word8Vector.vector", "Word8.word"),
    "Word8ArraySlice": _byte_arrays(),
    "PackWord32Big": _words("PackWord32Big", True),
    "PackWord32Little": _words("PackWord32Little", False),
    "Real64Vector": _reals("Vector"),
    "Real64Array": _reals("Array"),
    "IntHashTable": _table("IntHashTable", "int", "Word.fromInt"),
    "WordHashTable": _table("WordHashTable", "word", "fn (key : word) => key"),
    "AtomTable": _table("AtomTable", "Atom.atom", "Atom.hash", "Atom.sameAtom"),
    **{
        name: f"structure {name} = List{name[-3:]}Fn ({_KEYS[next(k for k in _KEYS if name.startswith(k))]})"
        for name in _STRUCTURES
    },
}
"""What is made of a functor: name -> its declaration."""


@cache
def names() -> frozenset[str]:
    """All names of the library."""
    return frozenset({*MADE, *(path.stem for path in FOLDER.glob("*.sml"))})


@cache
def signatures() -> frozenset[str]:
    """Names of signatures that are declared for themselves; nets have colour sets of such names (`QUEUE`)."""
    return frozenset(path.stem for path in (FOLDER / "signatures").glob("*.sml"))


_MODULES = re.compile(r"\b(?:functor|include|signature|structure)\b")
"""What a text has in it that can name a signature."""


def _any_of(known: frozenset[str]) -> re.Pattern[str]:
    return re.compile(rf"\b(?:{'|'.join(sorted(known, key=len, reverse=True))})\b(?!')")


@cache
def _pattern() -> re.Pattern[str]:
    return _any_of(names())


@cache
def _signature_pattern() -> re.Pattern[str]:
    return _any_of(signatures())


@cache
def _more() -> dict[str, re.Pattern[str]]:
    """Name of a structure that has more -> where a text mentions it."""
    found = {}
    for path in sorted((FOLDER / "more").glob("*.sml")):
        text = path.read_text(encoding="ascii")
        own = re.findall(r"^    (?:fun|structure|val) (\w+)", text, re.MULTILINE)
        members = "|".join(sorted(set(own), key=len, reverse=True))
        named = "|".join(re.findall(r"^structure ([\w']+)", text, re.MULTILINE))
        found[path.stem] = re.compile(rf"\b(?:{named})\s*\.\s*(?:{members})\b(?!')")
    return found


@lru_cache(maxsize=64)
def mentioned(text: str) -> tuple[str, ...]:
    """Names of the library in a text, each once, in order; structures that have more as `more/NAME`.

    It is asked for each declaration of a text, and the texts of a net are many.
    """
    more = [f"more/{name}" for name, pattern in _more().items() if pattern.search(text)]
    named = _pattern().findall(text)
    if _MODULES.search(text):
        named += _signature_pattern().findall(text)
    return (*more, *dict.fromkeys(named))


@cache
def declaration(name: str) -> str:
    """The declaration of a name."""
    if name in MADE:
        return MADE[name]
    folder = FOLDER / "signatures" if name in signatures() else FOLDER
    return (folder / f"{name}.sml").read_text(encoding="ascii")


@cache
def declared(name: str) -> tuple[str, ...]:
    """What its declaration declares: itself, and what stands beside it."""
    found = re.findall(
        r"^(?:fun|val|exception|structure|functor|signature) ([\w']+)",
        declaration(name),
        re.MULTILINE,
    )
    return tuple(dict.fromkeys(found))

"""Every built-in function is compiled: as an operation of the runtime, by a few lines of IR, or as CPN ML."""

from __future__ import annotations

import pytest

from pn2code.ir.operations import OPS
from pn2code.lowering import prelude
from pn2code.lowering.expressions.builtins import Builtins
from pn2code.ml.core.types import TCon, TFun, TRecord, TVar, Type
from pn2code.ml.library.builtins import BUILTINS

LACKING: dict[str, str] = {}
"""Built-in functions that the compiler does not have, and why."""

FILES = sorted(
    {p.name.removesuffix(".sml").removesuffix(".real") for p in prelude.FOLDER.glob("*.sml")}
    | {"Word8", "Word32", "Word64", "Int64"}
)


def test_nothing_is_lacking() -> None:
    missing = {
        name
        for name, info in BUILTINS.items()
        if not info.unsupported
        and not Builtins.is_primitive(name)
        and not prelude.exists(name)
        and not prelude.exists(name, real_time=True)
    }
    assert missing == LACKING.keys()


@pytest.mark.parametrize("structure", FILES)
@pytest.mark.parametrize("real_time", [False, True])
def test_types_are_at_least_as_general(structure: str, real_time: bool) -> None:
    for name, info in BUILTINS.items():
        if prelude.function_name(name)[0] != structure or Builtins.is_primitive(name):
            continue
        found = prelude.find(name, real_time)
        if found is not None:
            own = prelude.representation(found[1].type)
            wanted = prelude.representation(info.type(real_time))
            assert _covers(own, wanted, {}), f"{name}: {own} is not as general as {wanted}"


@pytest.mark.parametrize("structure", FILES)
def test_operations_have_a_form_in_c(structure: str) -> None:
    file = prelude.find(f"{structure}.", False) or next(
        found for name in BUILTINS if (found := prelude.find(name, False)) is not None
    )
    for builtin in file[0].primitives.values():
        assert builtin.name in OPS or Builtins.is_primitive(builtin.name)


def test_symbols_do_not_clash() -> None:
    seen: dict[int, str] = {}
    for structure in FILES:
        if structure == "Colour":
            continue
        for name in BUILTINS:
            if prelude.function_name(name)[0] == structure:
                found = prelude.find(name, False)
                if found is not None:
                    for symbol in found[0].symbols.values():
                        assert seen.setdefault(symbol.uid, symbol.name) == symbol.name
                    break


def _covers(general: Type, special: Type, known: dict[int, Type]) -> bool:
    """Whether a type is an instance of another."""
    match general, special:
        case TVar(index=i), _:
            return known.setdefault(i, special) == special
        case TCon(name=a, args=x), TCon(name=b, args=y):
            return a == b and all(_covers(p, q, known) for p, q in zip(x, y, strict=True))
        case TFun(), TFun():
            return _covers(general.argument, special.argument, known) and _covers(
                general.result, special.result, known
            )
        case TRecord(fields=x), TRecord(fields=y):
            return [n for n, _ in x] == [n for n, _ in y] and all(
                _covers(p, q, known) for (_, p), (_, q) in zip(x, y, strict=True)
            )
    return False

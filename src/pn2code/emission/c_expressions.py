"""IR expressions -> C text, with parentheses where precedence (or a reader of mixed operators) needs them."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.emission.c_literals import c_big, c_bytes, c_integer
from pn2code.emission.c_types import Types
from pn2code.emission.environment import c_float
from pn2code.emission.names import Scope, label
from pn2code.ir import nodes as ir
from pn2code.ir import operations
from pn2code.ir.nodes import Ir, IrType, Rep
from pn2code.ir.operations import OPS, Call, Compared, Infix, Literal, Prefix
from pn2code.ir.printed import is_nil

_PRIMARY, _POSTFIX, _UNARY, _CONDITIONAL = 17, 16, 14, 3


@frozen
class PackedPlace:
    """A packed place as statements see it.

    Args:
        colours: how many.
        colour_of: the function that makes a colour of its number.
        is_pure: always the same values are in the colour set.
        kind: stem of the functions of all places that are alike, which are given its table; "": it has its own.
    """

    colours: int
    colour_of: str
    is_pure: bool
    kind: str = ""


class Expressions:
    """Prints the expressions of one C function.

    Args:
        binding: how the transition's binding is reached ("b->" or "b."), if there is one.
    """

    def __init__(self, types: Types, real_time: bool, scope: Scope, binding: str = "") -> None:
        self._types = types
        self._names = types.names
        self._real_time = real_time
        self._scope = scope
        self._binding = binding
        self.variables: tuple[str, ...] = ()
        self.place_names: tuple[str, ...] = ()
        self.tokens: tuple[str, ...] = ()
        self.holders: tuple[str, ...] = ()
        self.kept: tuple[str, ...] = ()
        self.multisets: tuple[str, ...] = ()
        self.slots: frozenset[int] = frozenset()
        self.packed: tuple[PackedPlace | None, ...] = ()
        self.functions: dict[str, ir.Function] = {}
        self.int_bits = 31
        self.needs_context: frozenset[str] = frozenset()
        self.global_hints: dict[str, str] = {}

    def local(self, local: ir.Local) -> str:
        """The C name of a local."""
        return self._scope.name(local.uid, local.hint)

    def text(self, e: Ir) -> str:
        """The expression as a C expression that can stand on its own."""
        return self._print(e)[0]

    def inside(self, e: Ir, precedence: int) -> str:
        """The expression as an operand of an operator of this precedence."""
        text, own = self._print(e)
        return text if own > precedence else f"({text})"

    def condition(self, e: Ir) -> str:
        """As an operand of `&&`, `||` or `?:`: anything with an operator gets parentheses."""
        return self.inside(e, _UNARY - 1)

    def address(self, e: Ir) -> str:
        """A pointer to the value: of the object that holds it, or of a temporary."""
        if self._is_object(e):
            return f"&{self.inside(e, _UNARY)}"
        is_zero = (
            isinstance(e, ir.Op) and e.name == "zero" and e.type.rep in (Rep.STRUCT, Rep.UNION)
        )
        if is_zero or isinstance(e, ir.MakeStruct | ir.MakeUnion):
            return f"&{self.text(e)}"  # a compound literal is an object
        return f"({self._types.name(e.type)}[]){{ {self.text(e)} }}"

    def _is_object(self, e: Ir) -> bool:
        match e:
            case ir.GlobalUse(type=t) | ir.Use(type=t):
                return t.rep is not Rep.UNIT  # which has no variable
            case ir.Bound() | ir.TokenValue():
                return True
            case ir.Member(record=inner):
                return self._is_object(inner)
            case ir.Argument(value=inner):
                if self._is_unsafe(e):
                    return False
                return self._is_boxed(e) or self._is_object(inner)
            case ir.Head(list=inner):
                return not is_nil(inner)
        return False

    def _is_boxed(self, e: ir.Argument) -> bool:
        definition = self._types.definitions[e.value.type.name]
        assert isinstance(definition, ir.UnionDef)
        return definition.constructors[e.tag][2]

    def _is_unsafe(self, e: ir.Argument) -> bool:
        """Whether there may be nothing behind the pointer, after an error."""
        return not e.is_tested and self._is_boxed(e)

    def _constructor(self, t: IrType, tag: int) -> tuple[str, str]:
        """The enumerator of a constructor, and the member of the union that holds its argument."""
        definition = self._types.definitions[t.name]
        if isinstance(definition, ir.EnumDef):
            return self._names.constructor(t.name, definition.constructors[tag]), ""
        assert isinstance(definition, ir.UnionDef)
        name = definition.constructors[tag][0]
        return self._names.constructor(t.name, name), label(name)

    # --- one method per shape ------------------------------------------------------------------

    def _print(self, e: Ir) -> tuple[str, int]:
        match e:
            case ir.Const():
                return self._constant(e)
            case ir.Use(type=t) if t.rep is Rep.UNIT:
                return "PN_UNIT", _PRIMARY
            case ir.Use(local=local):
                return self.local(local), _PRIMARY
            case ir.GlobalUse(type=t) if t.rep is Rep.UNIT:
                return "PN_UNIT", _PRIMARY
            case ir.GlobalUse(name=name):
                return self._names.value_read(name, self.global_hints.get(name, name)), _PRIMARY
            case ir.Bound(index=index):
                return f"{self._binding}{self.variables[index]}", _POSTFIX
            case ir.TokenValue(place=place, index=index) if self.packed and self.packed[place]:
                return self.token(place, index), _PRIMARY
            case ir.TokenValue(place=place) if place in self.slots:
                return f"{self.tokens[place]}value", _POSTFIX
            case ir.TokenValue(place=place, index=index):
                return f"{self.tokens[place]}token[{self.local(index)}].value", _POSTFIX
            case ir.PlaceTokens(place=place, table=table):
                text = f"explore_tokens(cx, {self.multisets[place]}, &{self._names.table(table)}, marking)"
                return text, _POSTFIX
            case ir.PlaceTotal(place=place):
                return f"(int64_t)pn_multiset_total({self.multisets[place]}, marking)", _UNARY
            case ir.Now(type=t):
                return ("cx->now.real" if t.rep is Rep.REAL else "cx->now.integer"), _POSTFIX
            case ir.FunCall():
                return self._call(e), _POSTFIX
            case ir.Op():
                return self._op(e)
            case ir.Member():
                return self._member(e), _POSTFIX
            case ir.MakeStruct():
                return self._struct(e), _POSTFIX
            case ir.EnumValue(tag=tag, type=t):
                return self._constructor(t, tag)[0], _PRIMARY
            case ir.MakeUnion():
                return self._union(e), _POSTFIX
            case ir.IsTag():
                return self._is_tag(e)
            case ir.Argument():
                _, member = self._constructor(e.value.type, e.tag)
                text = f"{self.inside(e.value, _UNARY)}.as.{member}"
                if self._is_unsafe(e):
                    zero = self._types.zero(e.type)
                    return f"(({text} != NULL) ? *{text} : {zero})", _POSTFIX
                return (f"(*{text})" if self._is_boxed(e) else text), _POSTFIX
            case ir.Select():
                then, otherwise = (self.inside(x, _CONDITIONAL) for x in (e.then, e.otherwise))
                return f"{self.condition(e.condition)} ? {then} : {otherwise}", _CONDITIONAL
            case ir.Head(list=inner):
                if is_nil(inner):  # nobody comes here
                    return self._types.zero(e.type), _POSTFIX
                return f"{self.inside(inner, _UNARY)}->head", _POSTFIX
            case ir.Tail(list=inner):
                if is_nil(inner):
                    return "NULL", _PRIMARY
                return f"{self.inside(inner, _UNARY)}->tail", _POSTFIX
            case ir.IsNil(list=inner):
                if is_nil(inner):
                    return "true", _PRIMARY
                return f"{self.inside(inner, operations.EQUALITY)} == NULL", operations.EQUALITY
            case ir.Ok():
                return "pn_ok(cx)", _POSTFIX
            case ir.HasError(name=""):
                return "pn_is_exception(cx)", _POSTFIX
            case ir.NewRef(value=inner):
                size = self._types.name(inner.type)
                return f"pn_ref_new(cx, {self.address(inner)}, sizeof({size}))", _POSTFIX
            case ir.AddressOf(name=name):
                text = self._names.value_read(name, self.global_hints.get(name, name))
                return f"&{text}", _UNARY
            case ir.Contents(reference=inner, type=t):
                pointer, zero = self.inside(inner, _UNARY - 1), self._types.zero(t)
                return f"({pointer} != NULL) ? *{pointer} : {zero}", _CONDITIONAL
            case ir.HasPacket():
                return "cx->exception != NULL", operations.EQUALITY
            case ir.Packet(type=t):
                return f"*(const {self._types.name(t)} *)cx->exception", _UNARY
            case ir.HasError(name=name):
                return f"pn_is_raised(cx, {c_bytes(name)})", _POSTFIX

    def call(self, place: int, verb: str, *operands: str) -> str:
        """A call of a function of an untimed place that is an array or packed."""
        packed = self.packed[place] if self.packed else None
        if packed and packed.kind:
            name, first = packed.kind, [self.multisets[place]]
            first += ["m"] if verb != "check" else []
        elif packed:
            name, first = self.place_names[place], ["m"] if verb != "check" else []
        else:
            name, first = self.kept[place], [self.holders[place]]
            first += [self.multisets[place]] if verb == "add" else []
        context = ["cx"] if verb.startswith(("add", "check")) else []
        return f"{name}_{verb}({', '.join([*context, *first, *operands])})"

    def token(self, place: int, index: ir.Local) -> str:
        """The variable that holds the token of a packed place that a loop looks at."""
        return self._scope.name(("token", place, index.uid), f"{self.place_names[place]}_token")

    def _constant(self, e: ir.Const) -> tuple[str, int]:
        match e.type.rep:
            case Rep.UNIT:
                return "PN_UNIT", _PRIMARY
            case Rep.BOOL:
                return ("true" if e.value else "false"), _PRIMARY
            case Rep.REAL:
                assert isinstance(e.value, (int, float))
                text = c_float(float(e.value))
            case Rep.STRING:
                return f"PN_STRING({c_bytes(str(e.value))})", _POSTFIX
            case Rep.CHAR:
                return f"{e.value}U", _PRIMARY
            case Rep.BIG:
                assert isinstance(e.value, int)
                return c_big(e.value), _POSTFIX
            case _:
                assert isinstance(e.value, int)
                text = c_integer(e.value)
        return text, _UNARY if text.startswith("-") else _PRIMARY

    def _call(self, e: ir.FunCall) -> str:
        function = self.functions[e.function]
        arguments = [self.text(a) for a in e.arguments]
        if e.function in self.needs_context:
            arguments.insert(0, "cx")
        return f"{self._names.function(e.function, function.hint)}({', '.join(arguments)})"

    def _member(self, e: ir.Member) -> str:
        record, arrow = self.inside(e.record, _UNARY), "."
        is_boxed = isinstance(e.record, ir.Argument) and self._is_boxed(e.record)
        if is_boxed and not self._is_unsafe(e.record):  # type: ignore[arg-type]  # it is an argument where it is boxed
            record, arrow = record[2:-1], "->"  # (*p).x is p->x
        definition = self._types.definitions[e.record.type.name]
        assert isinstance(definition, ir.StructDef)
        is_time = dict(definition.fields).get(e.label) == ir.TIME
        suffix = (".real" if e.type.rep is Rep.REAL else ".integer") if is_time else ""
        return f"{record}{arrow}{label(e.label)}{suffix}"

    def time(self, e: Ir | None) -> str:
        """A time as `pn_time_t`."""
        if e is None:
            return "PN_NO_TIME"
        if isinstance(e, ir.Now):
            return "cx->now"
        return f"{'pn_time_real' if e.type.rep is Rep.REAL else 'pn_time_int'}({self.text(e)})"

    def _struct(self, e: ir.MakeStruct) -> str:
        definition = self._types.definitions[e.type.name]
        assert isinstance(definition, ir.StructDef)
        types = dict(definition.fields)
        parts = []
        for name, value in e.fields:
            text = self.time(value) if types[name] == ir.TIME else self.text(value)
            parts.append(f".{label(name)} = {text}")
        return f"({self._types.name(e.type)}){{ {', '.join(parts)} }}"

    def _union(self, e: ir.MakeUnion) -> str:
        tag, member = self._constructor(e.type, e.tag)
        parts = [f".tag = {tag}"]
        if e.argument is not None:
            definition = self._types.definitions[e.type.name]
            assert isinstance(definition, ir.UnionDef)
            value = self.text(e.argument)
            if definition.constructors[e.tag][2]:
                size = self._types.name(e.argument.type)
                value = f"pn_arena_copy(cx, {self.address(e.argument)}, sizeof({size}))"
            parts.append(f".as.{member} = {value}")
        return f"({self._types.name(e.type)}){{ {', '.join(parts)} }}"

    def _is_tag(self, e: ir.IsTag) -> tuple[str, int]:
        t = e.value.type
        tag, member = self._constructor(t, e.tag)
        if t.rep is Rep.ENUM:
            return f"{self.inside(e.value, operations.EQUALITY)} == {tag}", operations.EQUALITY
        value = self.inside(e.value, _UNARY)
        definition = self._types.definitions[t.name]
        assert isinstance(definition, ir.UnionDef)
        test = f"{value}.tag == {tag}"
        if definition.constructors[e.tag][2]:
            return f"({test}) && ({value}.as.{member} != NULL)", operations.AND
        return test, operations.EQUALITY

    # --- operations ----------------------------------------------------------------------------

    def _op(self, e: ir.Op) -> tuple[str, int]:
        if e.name == "zero":
            return self._types.zero(e.type), _POSTFIX
        if e.name == "list.nil":
            return "NULL", _PRIMARY
        if e.name in ("=", "same"):
            return self._equality(e, "==")
        if e.name == "Colset.all":
            own, layout = (self._names.table(k) for k in (e.table, f"type {e.type}"))
            return f"pn_colset_all(cx, &{own}, &{layout})", _POSTFIX
        if e.name == "Bool.not":
            return self._negation(e.arguments[0])
        if e.name in operations.CONTAINED:
            a, b = e.arguments
            return self._op(ir.Op(operations.CONTAINED[e.name], (b, a), e.type, e.table))
        arguments = e.arguments[::-1] if e.name in operations.SWAPPED else e.arguments
        match operations.form_of(e.name, self.int_bits):
            case Literal(text=text):
                return text, _PRIMARY
            case Infix(operator=operator, precedence=precedence):
                return self._infix(operator, precedence, arguments), precedence
            case Prefix(operator="IS_NIL"):
                return self._print(ir.IsNil(arguments[0]))
            case Prefix(operator=operator):
                return f"{operator}{self.inside(arguments[0], _UNARY)}", _UNARY
            case Compared(function=function, operator=operator):
                parts = [f"&{self._names.table(e.table)}"] if e.table else []
                parts += [self.address(a) if e.table else self.text(a) for a in arguments]
                return f"{function}({', '.join(parts)}) {operator} 0", operations.RELATION
            case Call() as call:
                return self._function(call, e, arguments)

    def _function(self, call: Call, e: ir.Op, arguments: tuple[Ir, ...]) -> tuple[str, int]:
        parts = ["cx"] if call.context else []
        if call.table:
            parts.append(f"&{self._names.table(e.table)}")
        for i, a in enumerate(arguments):
            parts.append(self.address(a) if i in call.pointers else self.text(a))
        if not call.function:
            return self._print(arguments[0])
        text = f"{call.function}({', '.join(parts)})"
        if call.order:
            # `order` is LESS, EQUAL, GREATER: 0, 1, 2.
            return f"({self._types.name(e.type)})(1 + {text})", _UNARY
        return text, _UNARY if text.startswith("!") else _POSTFIX

    def _infix(self, operator: str, precedence: int, arguments: tuple[Ir, ...]) -> str:
        left, right = arguments
        if precedence in (operations.AND, operations.OR):
            first = (
                self.inside(left, precedence - 1)
                if self._is_same(left, operator)
                else self.condition(left)
            )
            return f"{first} {operator} {self.condition(right)}"
        # The left operand needs parentheses only if it binds less tightly; the right one also if as tightly.
        return f"{self.inside(left, precedence - 1)} {operator} {self.inside(right, precedence)}"

    @staticmethod
    def _is_same(e: Ir, operator: str) -> bool:
        form = OPS.get(e.name) if isinstance(e, ir.Op) else None
        return isinstance(form, Infix) and form.operator == operator

    def _negation(self, e: Ir) -> tuple[str, int]:
        """Not, put into the comparison where that is exact."""
        match e:
            case ir.IsNil(list=inner) if not is_nil(inner):
                return f"{self.inside(inner, operations.EQUALITY)} != NULL", operations.EQUALITY
            case ir.Op(name="=" | "same"):
                return self._equality(e, "!=")
            case ir.IsTag() if e.value.type.rep is Rep.ENUM:
                text, precedence = self._is_tag(e)
                return text.replace(" == ", " != "), precedence
            case ir.Op(name="Bool.not", arguments=(inner,)):
                return self._print(inner)
        return f"!{self.inside(e, _UNARY)}", _UNARY

    def _equality(self, e: ir.Op, operator: str) -> tuple[str, int]:
        a, b = e.arguments
        negation = "!" if operator == "!=" else ""
        precedence = _UNARY if negation else _POSTFIX
        match a.type.rep:
            case Rep.INT | Rep.BOOL | Rep.CHAR | Rep.ENUM | Rep.REF:
                if isinstance(b, ir.Const) and isinstance(b.value, bool):
                    wanted = b.value == (operator == "==")
                    return self._print(a) if wanted else self._negation(a)
                # C reads `a == b < c` as intended, but compilers warn of it, and people stumble.
                x, y = (self.inside(v, operations.RELATION) for v in (a, b))
                return f"{x} {operator} {y}", operations.EQUALITY
            case Rep.REAL if e.name == "same":
                test = f"pn_real_order({self.text(a)}, {self.text(b)}) {operator} 0"
                return test, operations.EQUALITY
            case Rep.REAL:
                return f"{negation}pn_real_equal({self.text(a)}, {self.text(b)})", precedence
            case Rep.BIG:
                return f"{negation}pn_big_equal({self.text(a)}, {self.text(b)})", precedence
            case Rep.STRING:
                return f"{negation}pn_string_equal({self.text(a)}, {self.text(b)})", precedence
            case Rep.UNIT:
                return ("false" if negation else "true"), _PRIMARY
            case _:
                table = self._names.table(e.table)
                function = "pn_same" if e.name == "same" else "pn_equal"
                text = f"{negation}{function}(&{table}, {self.address(a)}, {self.address(b)})"
                return text, precedence

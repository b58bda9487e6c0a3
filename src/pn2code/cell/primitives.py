"""The functions that are commands of robots: every entry of `[primitives]` fits the net, every call is carried out.

A script has the commands that the net's code segments call, and nothing else of them. So a call that is no command and
gives no value would vanish from the script without a word: it is an error here. In a robot's or device's code segment

* a primitive, called directly or by a function, is a command;
* any other function is pure, and its result is used;
* a function that is declared among the primitives, but that no entry names, is called by nobody.

Elsewhere (guards, arcs, delays, initial markings, constants, and all pages of the supervisor) no primitive is called.

    check_primitives(partition, config, d)
"""

from __future__ import annotations

from dataclasses import dataclass, field

from pn2code.cell import codes
from pn2code.cell.config import CellConfig, CommandName, Primitive
from pn2code.cell.named_elsewhere import TURNING
from pn2code.cell.partition import Owner, OwnerKind, Partition
from pn2code.cell.pose_types import pose_types
from pn2code.cell.primitive_types import (
    RECORDS,
    TAKES,
    carries_nothing,
    fits,
    moves_at_speed,
    other_commands,
    result_of,
    takes_any_pose,
    taking,
)
from pn2code.cell.reach import Reach, bound
from pn2code.cell.unused_values import expressions_of, gives_back, unused_in, values_of
from pn2code.diagnostics import Diagnostics, Span
from pn2code.diagnostics.suggestions import nearest
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import UNIT, TFun
from pn2code.net.flat import CodeSegment, FlatTransition
from pn2code.robot.commands import CHANGES


def check_primitives(partition: Partition, config: CellConfig, d: Diagnostics) -> None:
    """Reports entries of `[primitives]` that do not fit the net, and calls that no script would carry out."""
    checker = _Checker(partition, config, d)
    checker.entries()
    checker.tools()
    checker.calls()


@dataclass(slots=True)
class _Checker:
    partition: Partition
    config: CellConfig
    d: Diagnostics
    reach: Reach = field(init=False)
    primitives: dict[int, Primitive] = field(default_factory=dict)
    unnamed: dict[int, core.Symbol] = field(default_factory=dict)
    """functions in a block of primitives that no entry names"""
    idle: set[int] = field(default_factory=set)
    """functions beside primitives that give back what they get, and that no entry names"""
    called: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        program = self.partition.net.program
        self.reach = Reach(program)
        for t in self.partition.net.transitions:
            self.reach.add_locals(*(e for _, e in expressions_of(t)))
        for name, primitive in self.config.primitives.items():
            symbol = program.globals.get(name)
            if symbol is not None and isinstance(symbol.type, TFun):
                self.primitives[symbol.uid] = primitive
        self._blocks()

    def _blocks(self) -> None:
        """Looks for functions that stand among the primitives."""
        net = self.partition.net
        functions: list[tuple[str, core.Symbol, core.Exp]] = []
        for declaration in net.program.declarations:
            if isinstance(declaration, core.RecBind | core.ValBind):
                block = net.blocks.get(declaration.span.source.origin, "")
                functions += [
                    (block, s, e) for s, e in bound(declaration) if isinstance(s.type, TFun)
                ]
        beside = {block for block, symbol, _ in functions if symbol.uid in self.primitives}
        for block, symbol, body in functions:
            if symbol.uid in self.primitives:
                continue
            if "primitive" in block.lower():
                self.unnamed[symbol.uid] = symbol
            elif block in beside and gives_back(body):
                self.idle.add(symbol.uid)

    # --- entries -----------------------------------------------------------------------------------

    def entries(self) -> None:
        """Each entry names a function of the net, of the type that its command needs."""
        program = self.partition.net.program
        functions = [n for n, s in program.globals.items() if isinstance(s.type, TFun)]
        missing = [s.name for s in self.unnamed.values()]
        for name, primitive in self.config.primitives.items():
            at = self.config.locator.origin("primitives", name)
            symbol = program.globals.get(name)
            if symbol is None:
                near = nearest(name, missing, functions)
                self.d.error(
                    codes.PRIMITIVE_ENTRY,
                    f"the net has no function `{name}`",
                    at,
                    hint=f"did you mean `{near}`?"
                    if near
                    else "declare it in the net, or remove the entry",
                )
            elif not fits(symbol.type, primitive):
                takes = taking(primitive)
                self.d.error(
                    codes.PRIMITIVE_ENTRY,
                    f"`{name}` has type `{symbol.type}`, but a function for `{primitive.command}` has type "
                    f"`{takes}`",
                    at,
                    notes=[text for word, text in RECORDS.items() if word in takes],
                    hint=other_commands(symbol.type),
                )
            elif (
                "POSE" in TAKES[primitive.command]
                and takes_any_pose(symbol.type)
                and len(types := pose_types(self.partition.net)) > 1
            ):
                listed = " and ".join(f"`{t}`" for t in types)
                self.d.error(
                    codes.PRIMITIVE_ENTRY,
                    f"`{name}` takes a value of any type, and the net has poses of {len(types)} types, {listed}",
                    at,
                    hint=f"give its argument the colour set of the poses: `fun {name} (p : POSE) = ...`",
                )
            elif primitive.speed is not None and moves_at_speed(symbol.type, primitive):
                what = _WHERE.get(primitive.command, "pose")
                self.d.error(
                    codes.PRIMITIVE_ENTRY,
                    f"`{name}` takes a speed, and the entry has one, too",
                    self.config.locator.origin("primitives", name, "speed"),
                    hint=f"remove `speed`, or let the function take the {what} alone",
                )
            # Primitives have types of functions.
            elif primitive.command == "wait" and symbol.type.argument != UNIT:  # type: ignore[union-attr]
                if primitive.duration_s:
                    self.d.error(
                        codes.PRIMITIVE_ENTRY,
                        f"`{name}` takes a number of seconds, and the entry has one, too",
                        self.config.locator.origin("primitives", name, "duration_s"),
                        hint="remove `duration_s`, or let the function take nothing",
                    )
            elif primitive.command == "wait":
                if not primitive.duration_s:
                    self.d.error(
                        codes.PRIMITIVE_ENTRY,
                        f"`{name}` takes no number of seconds, and the entry has no `duration_s`",
                        at,
                        hint="add `duration_s = ...` to the entry, or let the function take the seconds",
                    )
            elif primitive.is_linear and not primitive.frame:
                self.d.error(
                    codes.PRIMITIVE_ENTRY,
                    f"`primitives.{name}.frame` is missing",
                    at,
                    hint='add `frame = "world"` if the poses are absolute, `frame = "tool"` if they are increments '
                    "in the tool frame, or the name of a frame of `[frames]`",
                )

    def tools(self) -> None:
        """The actions that tools do are those of primitives."""
        known = {p.action for p in self.config.primitives.values() if p.action}
        for name, actions in self.config.tools_do.items():
            for action in actions:
                if action not in known:
                    near = nearest(action, known)
                    self.d.error(
                        codes.PRIMITIVE_TOOL,
                        f"tool `{name}` does action `{action}`, which no entry of [primitives] has",
                        self.config.locator.origin("tools", name, "does"),
                        hint=f"did you mean `{near}`?"
                        if near
                        else "name the `action` of an entry, or remove it",
                    )

    # --- calls -------------------------------------------------------------------------------------

    def calls(self) -> None:
        """Whatever is called on the pages of the owners."""
        net = self.partition.net
        for t, index in zip(net.transitions, self.partition.transition_owner, strict=True):
            owner = self.partition.owners[index]
            for part, e in expressions_of(t):
                if index and part == "code segment":
                    assert t.code is not None
                    self._code(t, owner, t.code)
                else:
                    self._elsewhere(e, f"{part} of transition `{t.short}`", t, owner)
        for place in net.places:
            if place.initial is not None:
                self._elsewhere(place.initial[0], f"initial marking of place `{place.short}`")
        for declaration in net.program.declarations:
            if isinstance(declaration, core.ValBind) and not isinstance(
                declaration.value.type, TFun
            ):
                self._elsewhere(declaration.value, "declaration of a constant")
        for symbol in self.unnamed.values():
            if symbol.uid not in self.called:
                # Nothing is lost as long as nobody calls it.
                self.d.warning(
                    codes.PRIMITIVE_UNNAMED,
                    f"`{symbol.name}` is declared among the primitives, but [primitives] does not name it",
                    self._declared(symbol),
                    hint=f"add `{symbol.name} = {{ command = ... }}` to [primitives] of {self.config.path.name}, or "
                    "move the declaration to another block",
                )

    def _declared(self, symbol: core.Symbol) -> Span:
        body = self.reach.body(symbol)
        assert body is not None, "a function has a body"
        return body.span

    def _elsewhere(
        self,
        e: core.Exp,
        where: str,
        t: FlatTransition | None = None,
        owner: Owner | None = None,
    ) -> None:
        """No primitive is called here."""
        for symbol, span in self.reach.everything(e).values():
            if symbol.uid not in self.primitives and symbol.uid not in self.unnamed:
                continue
            self.called.add(symbol.uid)
            through = "" if span.text == symbol.name else f", through `{span.text}`,"
            on = f" on page `{t.page}`" if t is not None else ""
            whose = f" of the {owner.phrase}" if owner is not None and owner.index else ""
            if owner is not None and not owner.index:
                whose = " of the supervisor"
            what = (
                "a primitive of the robots"
                if symbol.uid in self.primitives
                else "among the primitives"
            )
            self.d.error(
                codes.PRIMITIVE_MISPLACED,
                f"`{symbol.name}` is {what}, but is used{through} in the {where}{on}{whose}, where no robot "
                "carries it out",
                span,
                hint=self._advice(symbol, owner),
            )

    def _advice(self, symbol: core.Symbol, owner: Owner | None) -> str:
        pages = self._pages(symbol)
        listed = " or ".join(f"`{p}`" for p in pages)
        if owner is not None and owner.index:
            return "call it in the code segment of a transition of this page"
        belongs = f"call it in a code segment on page {listed}" if pages else "remove the call"
        if symbol.uid in self.unnamed:
            return f"move its declaration to another block if it is no command of a robot; if it is, {belongs}"
        return f"{belongs}; let the supervisor send a message to the robot that carries it out"

    def _pages(self, symbol: core.Symbol) -> list[str]:
        """The robots' pages that call it; all pages of robots and devices where none does."""
        calling: dict[str, None] = {}
        every: dict[str, None] = {}
        net = self.partition.net
        for t, owner in zip(net.transitions, self.partition.transition_owner, strict=True):
            if owner:
                every[t.page] = None
                if t.code is not None and symbol.uid in self.reach.everything(t.code.action):
                    calling[t.page] = None
        return list(calling or every)

    def _code(self, t: FlatTransition, owner: Owner, code: CodeSegment) -> None:
        """A code segment of a robot or device, with the functions that it calls."""
        where = f"the code segment of transition `{t.short}` of {owner.phrase}"
        self._lost(code.action, where, [] if code.outputs else [code.action])
        for symbol, _ in self.reach.everything(code.action).values():
            body = self.reach.body(symbol)
            if symbol.uid not in self.primitives and body is not None:
                self._lost(body, where, [])
            primitive = self.primitives.get(symbol.uid)
            if primitive is not None:
                self._of_robot(symbol, primitive, owner, t, code)

    def _of_robot(
        self,
        symbol: core.Symbol,
        primitive: Primitive,
        owner: Owner,
        t: FlatTransition,
        code: CodeSegment,
    ) -> None:
        """External axes, and frames that turn with one, are those of the robot that is told."""
        own = self.config.external_axes(owner.name)
        section = "devices" if owner.kind is OwnerKind.DEVICE else "robots"
        for axis, slides in primitive.along:
            if axis not in own or (own[axis] not in TURNING) is not slides:
                kind = "track" if slides else "turntable"
                if owner.kind is OwnerKind.DEVICE:
                    kind = "axis"
                self.d.error(
                    codes.PRIMITIVE_AXIS,
                    f"`{symbol.name}` moves {kind} `{axis}`, which {owner.phrase} does not have",
                    code.action.span,
                    notes=[f"it is called in the code segment of transition `{t.short}`"],
                    hint=f"add `[{section}.{owner.name}.axes.{axis}]` to {self.config.path.name}, or name another axis "
                    f"in `primitives.{symbol.name}`",
                )
        known = (*self.config.tcps(owner.name), *self.config.tools(owner.name))
        if primitive.tcp and primitive.tcp not in known:
            self.d.error(
                codes.PRIMITIVE_AXIS,
                f"`{symbol.name}` moves tool frame `{primitive.tcp}`, which {owner.phrase} does not have",
                code.action.span,
                notes=[f"it is called in the code segment of transition `{t.short}`"],
                hint=f"add `[robots.{owner.name}.tcps.{primitive.tcp}]` to {self.config.path.name}, or a tool of that "
                f"name to `tools` of `[robots.{owner.name}]`",
            )
        changed = primitive.handling
        if (
            changed is not None
            and changed.effect in CHANGES
            and owner.kind is OwnerKind.ROBOT
            and changed.part not in self.config.tools(owner.name)
        ):
            self.d.error(
                codes.PRIMITIVE_TOOL,
                f"`{symbol.name}` {changed.effect} tool `{changed.part}`, which {owner.phrase} does not change",
                code.action.span,
                notes=[f"it is called in the code segment of transition `{t.short}`"],
                hint=f'add "{changed.part}" to `tools` of `[robots.{owner.name}]` in {self.config.path.name}',
            )
        plate = self.config.turns_with(primitive.frame or "")
        if plate and plate.split(".")[0] != owner.name:
            self.d.error(
                codes.PRIMITIVE_AXIS,
                f"`{symbol.name}` moves in frame `{primitive.frame}`, which turns with `{plate}`, but {owner.phrase} "
                "does not command that turntable",
                code.action.span,
                notes=[f"it is called in the code segment of transition `{t.short}`"],
                hint="let the robot that has the turntable move in this frame, or give the others poses in a frame "
                "that stands",
            )

    def _lost(self, e: core.Exp, where: str, unused: list[core.Exp]) -> None:
        """Reports what no script carries out; `unused`: expressions inside whose values nobody wants."""
        self.called.update(s.uid for s, _ in self.reach.uses(e) if s.uid in self.unnamed)
        for symbol, span in self.reach.uses(e):
            if symbol.uid in self.primitives or self.reach.body(symbol) is None:
                continue
            if symbol.uid in self.unnamed:
                problem = "is declared among the primitives, but [primitives] does not name it"
            elif symbol.uid in self.idle:
                problem = "stands among the primitives and returns its argument, but [primitives] does not name it"
            elif self._acts(symbol):
                continue
            elif isinstance(symbol.type, TFun) and carries_nothing(result_of(symbol.type)):
                problem = "is no primitive, calls none, and gives no value"
            else:
                continue
            near = nearest(symbol.name, self.config.primitives)
            self.d.error(
                codes.PRIMITIVE_UNNAMED,
                f"`{symbol.name}` {problem}: its call would be missing from the script",
                span,
                notes=[f"it is called in {where}"],
                hint=f"add `{symbol.name} = {{ command = ... }}` to [primitives] of {self.config.path.name}"
                + (f" (there is an entry `{near}`)" if near else ""),
            )
        for x in [*unused, *unused_in(e)]:
            self._unused_value(x, where)

    def _unused_value(self, e: core.Exp, where: str) -> None:
        """A value that nobody wants: whatever was called for it must have been a command."""
        for x in values_of(e):
            if (
                isinstance(x, core.Apply)
                and not carries_nothing(x.type)
                and not any(
                    s.uid in self.primitives or s.uid in self.unnamed or s.uid in self.idle
                    for s, _ in self.reach.everything(x).values()
                )
            ):
                self.d.error(
                    codes.PRIMITIVE_UNNAMED,
                    "the result of this call is not used, and it is no command: it would be missing from the script",
                    x.span,
                    notes=[f"it is called in {where}"],
                    hint="use its result, name the function in [primitives] if it is a command, or remove the call",
                )

    def _acts(self, symbol: core.Symbol) -> bool:
        """Whether a function is made of primitives."""
        return any(s.uid in self.primitives for s in self.reach.from_symbol(symbol))


_WHERE: dict[CommandName, str] = {
    "move_axes": "joint position",
    "move_external": "position of the axis",
}

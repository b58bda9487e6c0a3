"""Lowering: the programs that come out, as dumps, and what is refused."""

from __future__ import annotations

from textwrap import dedent

from helpers.compiled import lowered
from helpers.netbuilder import flat
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.dump import dump
from pn2code.lowering.nets.net import DEFAULT_CAPACITY


def dumped(text: str, only: str, **options: object) -> str:
    net, d = lowered(flat(text), **options)  # type: ignore[arg-type]
    assert net is not None, [(e.code, e.message) for e in d.errors]
    return dump(net, only)


def net_with(declarations: str, body: str) -> str:
    return (
        "net Cell\n  standard\n"
        + "".join(f"  {line}\n" for line in dedent(declarations).strip().splitlines())
        + "".join(f"  {line}\n" for line in dedent(body).strip().splitlines())
    )


def function(text: str, call: str, only: str) -> str:
    """The dump of a function that one output arc calls."""
    body = f"place P : INT = 1`1\nplace Q : INT\ntrans T\n  in P : n\n  out Q : {call}"
    return dumped(net_with(f"{text}\nvar n: INT;", body), only)


def test_a_transition() -> None:
    text = dumped(
        net_with(
            "var n: INT;",
            """
            place Buffer : INT = 1`1
            place Out : INT
            trans Pick guard [n > 0]
              in Buffer : n
              out Out : 2`n
            """,
        ),
        "Pick",
    )
    assert text == dedent(
        """\
        transition 0 Top.Pick   (ID16) owner 0 priority 1000
          variables n: int
          reads Top.Buffer
          touches Top.Buffer, Top.Out
          affects Top.Pick
          search names Top.Buffer, binding
          fire names Top.Buffer, Top.Out, table of Top.Buffer, table of Top.Out, binding
          enumerate
            for i_1 in Top.Buffer   -- Buffer: n (ID21)
              bind n = Top.Buffer[i_1]
              unless (n Int.> 0): next   -- guard [n > 0]
              yield
          fire direct
            take Top.Buffer 1 ` n found   -- Buffer: n (ID21)
            put Top.Out 2 ` n legal   -- Out: 2`n (ID23)
        """
    )


def test_guards_are_tested_as_early_as_possible() -> None:
    text = dumped(
        net_with(
            "var n, m: INT;",
            """
            place A : INT
            place B : INT
            trans T guard [m > 1, n > 0, n < m]
              in A : n
              in B : m
            """,
        ),
        "Top.T",
    )
    order = [
        line.strip().split("   ")[0]
        for line in text.splitlines()
        if "for " in line or "unless" in line
    ]
    assert order == [
        "for i_1 in Top.A",
        "unless (n Int.> 0): next",
        "for i_2 in Top.B",
        "unless (m Int.> 1): next",
        "unless (n Int.< m): next",
    ]


def test_demands_on_one_place_are_tested_together() -> None:
    body = "place A : INT\ntrans T\n  in A : n\n  in A : 1`(n + 1)"
    text = dumped(net_with("var n: INT;", body), "Top.T")
    assert "unless there is: next\n        take Top.A 1 ` n" in text
    single = dumped(net_with("var n: INT;", "place A : INT\ntrans T\n  in A : n"), "Top.T")
    assert "unless there is" not in single


def test_tuple_parameters_are_passed_apart_and_units_left_out() -> None:
    text = function("fun f ((a, b), ()) = a + b : int", "f ((n, 2), ())", "f")
    assert "function f/1(a1" in text or "function f/1(a, b" in text
    assert "unit" not in text.splitlines()[0]


def test_self_tail_calls_become_loops() -> None:
    text = function("fun f (0, s) = s | f (k, s) = f (k - 1, s + k)", "f (n, 0)", "f")
    assert text.splitlines()[0].endswith("loops context")
    assert "again(" in text
    other = function("fun g 0 = 0 | g k = 1 + g (k - 1)", "g n", "g")
    assert other.splitlines()[0].endswith("recursive context")


def test_polymorphic_functions_are_specialised() -> None:
    declarations = "fun swap (a, b) = (b, a)\nfun use n = #1 (swap (true, n)) + #2 (swap (n, 2))"
    text = function(declarations, "use n", "swap")
    assert text.count("function swap/") == 2


def test_functions_passed_as_arguments_are_followed() -> None:
    text = function("fun twice f x = f (f x)", "twice (fn y => y + n) 3", "twice")
    # What the passed function captures is a parameter.
    assert text.splitlines()[0] == "function twice/1(n: int, x: int): int context"


def test_functions_as_values() -> None:
    """A list of functions: a union of them, with what they captured, and one function that applies."""
    text = function(
        "fun every k = [fn x => x + k, Int.abs]", "foldl (fn (f, s) => f s) n (every 3)", ""
    )
    assert "union int_to_int = fn of @int | Int.abs" in text
    applied = text[text.index("function apply int_to_int(f: int_to_int, x: int): int") :]
    assert "if f is #0" in applied
    assert "return (x Int.+ f#0)" in applied
    assert "else" in applied


def test_known_functions_are_no_values() -> None:
    text = function("fun pick f = f", "(pick (fn x => x + 1)) n", "")
    assert "union" not in text
    assert "apply" not in text


def test_a_local_reference_is_a_variable_unless_it_is_a_value() -> None:
    counted = function(
        "fun f n = let val r = ref n in while !r < 9 do r := !r + 1; !r end", "f n", ""
    )
    assert "ref(" not in counted
    kept = function(
        "fun f n = let val r = ref n in fn () => !r end",
        "f n () + hd (map (fn g => g ()) [f n])",
        "",
    )
    assert "ref(" in kept


def test_exceptions_without_a_value_go_by_name() -> None:
    plain = function("exception E fun f n = if n > 1 then raise E else n", "f n handle E => 0", "")
    assert "union exn" not in plain
    assert "raise E" in plain
    carried = function("exception E of int fun f n = raise E n", "f n handle E k => k", "")
    assert "union exn" in carried
    assert "raise value" in carried


def test_multisets_of_output_arcs_are_taken_apart() -> None:
    text = function("fun f n = n", "if n > 1 then 1`n ++ 2`(n + 1) else empty", "Top.T")
    assert "put Top.Q 1 ` n" in text
    assert "put Top.Q 2 ` (n Int.+ 1)" in text
    assert "put all" not in text


def test_capacity() -> None:
    text = net_with("", "place A : INT = 1`1\nplace B : INT")
    net, _ = lowered(flat(text), capacity={"B": 7})
    assert net is not None
    assert [p.capacity for p in net.places] == [DEFAULT_CAPACITY, 7]
    many = net_with("colset MANY = int with 1..500;", "place A : MANY = MANY.all()")
    net, _ = lowered(flat(many))
    assert net is not None
    assert net.places[0].capacity == 1000


def early(declarations: str, delay: str, option: str = "false") -> str:
    """A net with a delay on an input arc."""
    time = "5.0" if option == "true" else "5"
    return (
        f"net Cell\n  standard\n  option realtimestamp {option}\n  colset JOB = int timed;\n  {declarations}\n"
        f"  var n: JOB;\n  place P : JOB = 1`1@{time}\n"
        f"  place Q : INT = 1`1\n  trans T\n    in P : n{delay}\n    in Q : n\n"
    )


def test_delays_of_input_arcs() -> None:
    net, _ = lowered(flat(early("val d = 3", "@+d")))
    assert net is not None
    assert net.places[0].early == (3,)
    assert net.transitions[0].thresholds == ()
    net, _ = lowered(flat(early("", "@+(n + 1)")))
    assert net is not None
    assert net.places[0].early == ()
    assert any(isinstance(n, ir.Threshold) for n in ir_nodes(net.transitions[0].thresholds))


def test_computed_delays_with_a_real_clock() -> None:
    net, _ = lowered(flat(early("fun f n = Real.fromInt n", "@++(f n)", "true")))
    assert net is not None
    assert any(isinstance(n, ir.Threshold) for n in ir_nodes(net.transitions[0].thresholds))


def test_all_of_a_subset_without_countable_values_is_left_to_the_runtime() -> None:
    declarations = "fun pos n = n > 0\ncolset POS = subset INT by pos;\nvar n: INT;"
    body = "place P : INT = 1`1\nplace Q : INT\ntrans T\n  in P : n\n  out Q : length (POS.all ())"
    net, _ = lowered(flat(net_with(declarations, body)))
    assert net is not None  # it raises CPN'Error there


def test_storage_names_a_real_colour_set() -> None:
    net, d = lowered(
        flat(net_with("", "place A : INT")), storage={"INT": "float32", "NONE": "float32"}
    )
    assert net is None
    assert [e.code for e in d.errors] == ["storage-colour-set", "storage-colour-set"]

"""Lists of records on a robot's page: a list of the script for each field, and what is asked of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.robots import Cell

EXTRA = """
colset KIND = with scratch | burn;
colset SPOT = int with 0..9;
colset DEFECT = record spot : SPOT * kind : KIND;
colset DEFECTS = list DEFECT with 0..3;
colset PAIR = product INT * KIND;
colset PAIRS = list PAIR;
colset ODD = record X : REAL * Y : REAL * Z : REAL * RX : REAL * RY : REAL * RZ : REAL;
colset ODDS = list ODD;
colset INNER = list INT;
colset DEEP = record name : STRING * inner : INNER;
colset DEEPS = list DEEP;
var ds, rest, es : DEFECTS;
var d : DEFECT;
var i : SPOT;
var c : KIND;
var ps : PAIRS;
"""


def cell(folder: Path, page: str, channels: tuple[str, ...] = ()) -> Cell:
    own = next((x.split()[2] for x in channels if x.split()[2] != "INT"), "INT")
    return Cell(folder, page, channels, extra=f"{EXTRA}var x : {own};\n")


def words(text: str) -> str:
    return " ".join(text.split())


def held(put: str, guard: str = "", colset: str = "DEFECTS", out: str = "y : n") -> str:
    return f"""
    place Idle = 1
    place Held : {colset}
    trans Accept
      in Idle
      in x : ds
      out Held : ds
    trans Go{guard}
      in Held : {put}
      out {out}
      out Idle
    """


def test_a_list_of_records_is_gone_along(tmp_path: Path) -> None:
    page = """
    place Idle = 1
    place Todo : DEFECTS
    trans Accept
      in Idle
      in x : ds
      out Todo : ds
    trans Next
      in Todo : {spot = i, kind = c} :: rest
      out Todo : rest
      out y : if c = burn then i else 0
    trans Over
      in Todo : []
      out Idle
    """
    found = cell(tmp_path, page, ("x in DEFECTS", "y out INT"))
    assert found.messages == [] and found.ir is not None
    assert 'input  x "x.robcad" : rows(int, word)' in found.text
    body = words(found.body)
    assert "read x into ds_spot, ds_kind" in body
    assert "mark Top.Robot.Accept with ds = each {spot = ds_spot, kind = ds_kind}" in body
    assert "while count_of(todo_spot) <> 0 loop" in body
    assert 'write y if first_of(todo_kind) = "burn" then first_of(todo_spot) else 0' in body
    assert "compute" not in body, "the pattern has seen that there is an item"


@pytest.mark.parametrize(
    ("put", "guard", "expected"),
    [
        ("#spot (hd ds)", "", "compute first_of(ds_spot)"),
        ("#spot (hd ds)", " guard [ds <> []]", ""),
        ("#spot (List.nth (ds, 1))", " guard [length ds > 1]", ""),
        ("#spot (List.nth (rev ds, 1))", "", "item_of(reversed(ds_spot), 1)"),
        ("length (ds ^^ ds)", "", "count_of(joined(ds_spot, ds_spot))"),
        ("if ds = [{spot = 1, kind = burn}] then 1 else 0", "",
         'ds_spot = ints(1) and ds_kind = strings("burn")'),
        ("length ([{spot = 1, kind = burn}] ^^ ds)", "", "count_of(joined(strings(\"burn\"), ds_kind))"),
        ("#spot (hd (ds ^^ [{spot = 1, kind = burn}]))", "",
         "first_of(joined(ds_spot, ints(1)))"),
        ("#spot (hd (List.map (fn {spot = p1, kind = p2} => {kind = p2, spot = p1}) ds ^^ ds))", "",
         "first_of(joined(ds_spot, ds_spot))"),
        ("if null (tl ds) then 1 else 0", "", "compute rest_of(ds_spot)"),
    ],
)  # fmt: skip
def test_functions_do_the_same_to_each_column(
    tmp_path: Path, put: str, guard: str, expected: str
) -> None:
    page = held("ds", guard, out=f"y : {put}")
    found = cell(tmp_path, page, ("x in DEFECTS", "y out INT"))
    assert found.ir is not None, found.messages
    body = words(found.body)
    assert (expected in body) if expected else ("compute" not in body), body


@pytest.mark.parametrize(
    ("put", "asked"),
    [
        ("d :: ds", "count_of(with_first(ds_spot, d_spot)) <= 3"),
        ("{spot = n, kind = burn} :: ds",
         "n >= 0 and n <= 9 and count_of(with_first(ds_spot, n)) <= 3"),
        ("[{spot = n + 1, kind = burn}, d]", "n + 1 >= 0 and n + 1 <= 9"),
        ("[d, d]", ""),
    ],
)  # fmt: skip
def test_items_that_are_written_are_asked(tmp_path: Path, put: str, asked: str) -> None:
    page = f"""
    place Held : DEFECTS = 1`[]
    place Last : DEFECT = 1`{{spot = 0, kind = burn}}
    trans Next
      in x : n
      in Held : ds
      in Last : d
      out Held : {put}
      out Last : d
    """
    found = cell(tmp_path, page, ("x in INT",))
    assert found.ir is not None, found.messages
    body = words(found.body)
    for whole, own in (("held_spot", "ds_spot"), ("last_spot", "d_spot")):
        body = body.replace(whole, own)
    if asked:
        assert f"if not ({asked}) then stop" in body or f"if not {asked} then stop" in body, body
    else:
        assert "stop" not in body, body


def test_items_are_joined_and_chosen_beside_other_values(tmp_path: Path) -> None:
    """It was refused; the script asks of the item where it is taken, and how long the list becomes."""
    page = """
    place Idle = 1
    place Scan : BOTH = 1`(0, [])
    trans Look
      both Idle
      in x : n
      in z : a
      in Scan : (k, ds)
      out Scan : (k + 1, if a then ds ^^ [{spot = n, kind = burn}] else ds)
    """
    extra = f"{EXTRA}colset BOTH = product INT * DEFECTS;\nvar x : INT;\nvar z : BOOL;\n"
    found = Cell(tmp_path, page, ("x in INT", "z in BOOL"), extra=extra)
    assert found.ir is not None, found.messages
    body = words(found.body)
    body = body.replace("scan_x2_spot", "ds_spot")
    chosen = "if a then joined(ds_spot, ints(n)) else ds_spot"
    asked = f"(not a or n >= 0 and n <= 9) and count_of({chosen}) <= 3"
    assert f"if not ({asked}) then stop" in body, body
    found.checked()


def test_items_of_others_stay_unknown(tmp_path: Path) -> None:
    page = """
    place Held : DEFECTS = 1`[]
    trans Next
      in x : ps
      in Held : ds
      out Held : if null ps then ds else tl (rev ds ^^ ds)
    """
    found = cell(tmp_path, page, ("x in PAIRS",))
    assert found.ir is None
    assert "a script cannot ask whether a value is in it" in found.messages[0]


@pytest.mark.parametrize("colset", ["ODDS", "DEEPS"])
def test_what_scripts_do_not_have(tmp_path: Path, colset: str) -> None:
    """Poses whose fields have other names in traces, and lists in lists."""
    page = f"""
    place Idle = 1
    place Held : {colset} = 1`[]
    trans Go
      in x : n
      both Held : []
      both Idle
    """
    found = cell(tmp_path, page, ("x in INT",))
    assert found.ir is None
    assert f"has colour set `{colset}`, which robot scripts do not have" in found.messages[0]


def test_items_of_messages_have_no_units(tmp_path: Path) -> None:
    """Files have a word for each of them, which the script did not read."""
    page = """
    place Idle = 1
    trans Go
      both Idle
      in x : us
      out y : us
    """
    extra = (
        "colset MARKED = record n : INT * mark : UNIT;\ncolset US = list MARKED;\nvar us : US;\n"
    )
    found = Cell(tmp_path, page, ("x in US", "y out US"), extra=f"{extra}var x : US;\n")
    assert found.ir is None
    assert "have a unit among other values" in found.messages[0]


@pytest.mark.parametrize(
    ("put", "expected"),
    [
        ("List.nth (List.map (fn one : DEFECT => #spot one) ds, 0)", "item_of(ds_spot, 0)"),
        ("List.nth (List.map #spot ds, 0)", "item_of(ds_spot, 0)"),
        (
            "#2 (List.nth (List.map (fn {spot = p1, kind = p2} => (p2, p1)) ds, 1))",
            "item_of(ds_spot, 1)",
        ),
        ("length (List.map (fn {kind = p2, ...} : DEFECT => p2) ds)", "count_of(ds_kind)"),
    ],
)
def test_map_picks_fields(tmp_path: Path, put: str, expected: str) -> None:
    page = held("ds", " guard [length ds > 1]", out=f"y : {put}")
    found = cell(tmp_path, page, ("x in DEFECTS", "y out INT"))
    assert found.ir is not None, found.messages
    assert f"write y {expected}" in words(found.body), found.body


@pytest.mark.parametrize(
    "function",
    [
        "fn one : DEFECT => #spot one + 1",
        "fn one : DEFECT => 1",
        "fn one : DEFECT => (1, #spot one)",
    ],
)
def test_map_computes_nothing(tmp_path: Path, function: str) -> None:
    page = held("ds", out=f"y : length (List.map ({function}) ds)")
    found = cell(tmp_path, page, ("x in DEFECTS", "y out INT"))
    assert found.ir is None
    assert "`List.map` of a robot script picks fields of the records" in found.messages[0]


APP = """
    place Idle = 1
    place Held : STOPS
    trans Accept
      in Idle
      in x : ss
      out Held : ss
    trans Go code input (ss); action ({action})
      in Held : ss
      out Idle
    """
STOPS = """
colset STOP = product POSE * INT;
colset STOPS = list STOP;
var ss : STOPS;
"""


def stops(folder: Path, action: str) -> Cell:
    page = APP.format(action=action)
    return Cell(folder, page, ("x in STOPS",), extra=f"{STOPS}var x : STOPS;\n")


def test_commands_for_each_item_are_a_loop(tmp_path: Path) -> None:
    action = "List.app (fn (place, grade) => (moveJoint place; if grade > 2 then moveHome () else ())) ss"
    found = stops(tmp_path, f"{action}; moveHome ()")
    assert found.messages == [] and found.ir is not None
    assert (
        "todo_x1 := ss_1 todo_x2 := ss_2 while count_of(todo_x1) <> 0 loop "
        "move $joint first_of(todo_x1) if first_of(todo_x2) > 2 then move $joint home end if "
        "todo_x1 := rest_of(todo_x1) todo_x2 := rest_of(todo_x2) end loop move $joint home mark"
    ) in words(found.body), found.body


def test_what_fails_in_a_loop_is_computed_there(tmp_path: Path) -> None:
    """Before the command of its item, and again after the loop: what comes later is no reason to leave it out."""
    action = "List.app (fn (place, grade) => if 10 div grade > 2 then moveJoint place else ()) ss"
    last = "if 10 div length ss > 1 then moveHome () else ()"
    found = stops(tmp_path, f"let val part = 10 div length ss in () end; {action}; {last}")
    assert found.ir is not None, found.messages
    body = words(found.body)
    before, loop = body.split("todo_x1 := ss_1", 1)
    assert before.endswith("compute 10 div count_of(ss_1) ")
    assert "loop if 10 div first_of(todo_x2) > 2 then" in loop


def test_commands_for_each_item_are_for_code_segments(tmp_path: Path) -> None:
    page = held("ds", " guard [List.app (fn one : DEFECT => ()) ds = ()]", out="y : 1")
    found = cell(tmp_path, page, ("x in DEFECTS", "y out INT"))
    assert found.ir is None
    assert "`List.app` is for commands" in found.messages[0]


def test_folds_in_code_segments_are_loops(tmp_path: Path) -> None:
    page = """
    place Idle = 1
    trans Go code input (ds) output (n); action (List.foldl add 0 ds)
      both Idle
      in x : ds
      out y : n
    """
    add = "fun add ({spot, kind} : DEFECT, sum) = if kind = burn then sum + spot else sum;\n"
    extra = f"{EXTRA}{add}var x : DEFECTS;\n"
    found = Cell(tmp_path, page, ("x in DEFECTS", "y out INT"), extra=extra)
    assert found.ir is not None, found.messages
    body = words(found.body)
    assert (
        "so_far := 0 todo_spot := ds_spot todo_kind := ds_kind while count_of(todo_spot) <> 0 loop "
        'so_far := if first_of(todo_kind) = "burn" then so_far + first_of(todo_spot) else so_far '
        "todo_spot := rest_of(todo_spot) todo_kind := rest_of(todo_kind) end loop"
    ) in body, found.body
    assert "write y so_far" in body


def test_folds_elsewhere_are_not_supported(tmp_path: Path) -> None:
    page = held("ds", out="y : List.foldl (fn ({spot = p1, ...} : DEFECT, sum) => p1 + sum) 0 ds")
    found = cell(tmp_path, page, ("x in DEFECTS", "y out INT"))
    assert found.ir is None
    assert "a fold along a list is a loop" in found.messages[0]

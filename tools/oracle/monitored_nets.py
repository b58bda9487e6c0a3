# ruff: noqa: E501 - texts of nets and functions
"""Nets that have one run only, each with monitors: what `./dev oracle --monitored` asks the engine about."""

from __future__ import annotations

from collections.abc import Sequence

from helpers.monitors import Spec
from pn2code.base.frozen import frozen


@frozen
class Case:
    """A net, its monitors, and how many steps are made."""

    net: str
    monitors: tuple[Spec, ...]
    steps: int = 40


LOG = {"Logging": "true"}
TIMED = {"Timed": "true", "Logging": "true"}
UNTIMED = {"Timed": "false", "Logging": "true"}
NO_INIT = "fun init (%s) = NONE"
NO_STOP = "fun stop (%s) = NONE"


def size(name: str, place: str) -> Spec:
    """A marking size monitor."""
    return Spec(name, "Marking size", [place], {}, LOG)


def length(name: str, place: str) -> Spec:
    """A list length monitor."""
    return Spec(name, "List length", [place], {}, LOG)


def count(name: str, transition: str) -> Spec:
    """A monitor that counts occurrences."""
    return Spec(name, "Count transition occurrence", [transition], {}, LOG)


def collector(
    name: str, nodes: Sequence[str], pred: str, obs: str, *, init: str = "fun init () = NONE",
    stop: str = "fun stop () = NONE", timed: bool = False,
) -> Spec:  # fmt: skip
    """A data collector."""
    functions = {"Init function": init, "Predicate": pred, "Observer": obs, "Stop": stop}
    return Spec(name, "Data collection", nodes, functions, TIMED if timed else UNTIMED)


def breakpoint_at(name: str, nodes: Sequence[str], pred: str) -> Spec:
    """A breakpoint with a predicate."""
    return Spec(name, "Breakpoint", nodes, {"Predicate": pred})


def user(
    name: str, nodes: Sequence[str], pred: str, obs: str, action: str, init: str, stop: str
) -> Spec:
    """A user-defined monitor."""
    functions = {"Init": init, "Predicate": pred, "Observer": obs, "Action": action, "Stop": stop}
    return Spec(name, "User defined", nodes, functions)


def writer(
    name: str,
    nodes: Sequence[str],
    pred: str,
    obs: str,
    init: str,
    stop: str,
    extension: str = "txt",
) -> Spec:
    """A monitor that writes a file."""
    functions = {"Init": init, "Predicate": pred, "Observer": obs, "Stop": stop}
    return Spec(name, "Write in file", nodes, functions, {"File extension": extension})


def of(function: str, element: str, value: str, other: str) -> str:
    """A function of a binding element as CPN Tools' templates have it."""
    f = f"{function}BindElem"
    return f"fun {function} (bindelem) = let fun {f} ({element}) = {value} | {f} _ = {other} in {f} bindelem end"


COUNTER = """
net Counter
  standard
  globref seen = 0;
  var n: INT;
  colset L = list INT;
  var l : L;
  place P : INT = 1`0
  place Q : INT
  place R : L = 1`[]
  place Done : INT
  trans "Do it" guard [n < 12]
    in P : n
    out P : n + 1
    out Q : if n mod 3 = 0 then 1`n else empty
    in R : l
    out R : n :: l
  trans Take guard [n > 100] priority 10
    in Q : n
    out Done : n
"""
T = "Top'Do_it (1, {l, n})"
MANY = (
    size("Size of Q", "Top.Q"),
    length("Length_R", "Top.R"),
    count("Count", "Top.Do it"),
    count("Never", "Top.Take"),
    collector("Ints", ["Top.Do it"], of("pred", T, "n mod 2 = 0", "false"), of("obs", T, "n * n - 5", "~1")),
    collector("Reals", ["Top.Do it"], of("pred", T, "n > 3", "false"), of("obs", T, "1.0 / Real.fromInt n", "~1.0"),
              init="fun init () = SOME 2.5", stop="fun stop () = SOME ~7.25"),
    collector("Infs", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "IntInf.fromInt n * 100000000000", "0")),
    collector("Marks", ["Top.P", "Top.Q", "Top.R"], "fun pred (Top'P_1_mark : INT ms, Top'Q_1_mark : INT ms, Top'R_1_mark : L ms) = cf (6, Top'Q_1_mark) = 0",
              "fun obs (Top'P_1_mark : INT ms, Top'Q_1_mark : INT ms, Top'R_1_mark : L ms) = hd Top'P_1_mark + 10 * size Top'Q_1_mark + 100 * length (hd Top'R_1_mark)",
              init="fun init (Top'P_1_mark : INT ms, Top'Q_1_mark : INT ms, Top'R_1_mark : L ms) = SOME (size Top'R_1_mark)",
              stop="fun stop (Top'P_1_mark : INT ms, Top'Q_1_mark : INT ms, Top'R_1_mark : L ms) = SOME (hd Top'P_1_mark)"),
    collector("Both", ["Top.Do it", "Top.Q"], "fun pred (bindelem, Top'Q_1_mark : INT ms) = let fun f (Top'Do_it (1, {l, n})) = n < 9 | f _ = false in f bindelem end",
              "fun obs (bindelem, Top'Q_1_mark : INT ms) = let fun f (Top'Do_it (1, {l, n})) = List.foldl op + n Top'Q_1_mark | f _ = ~1 in f bindelem end",
              init="fun init (Top'Q_1_mark : INT ms) = NONE", stop="fun stop (Top'Q_1_mark : INT ms) = NONE"),
    collector("OfOthers", ["Top.Do it"], of("pred", T, "Ints.count () > 2", "false"), of("obs", T, "Real.fromLargeInt (Ints.max ()) + Reals.avrg () + Real.fromLargeInt (Infs.last ())", "0.0")),
    collector("Steps", [], "fun pred () = true", "fun obs () = IntInf.toInt (step ())"),
    collector("Two", ["Top.Do it", "Top.Take"], "fun pred (Top'Do_it (_, {n, ...})) = n >= 6 | pred (Top'Take (1, {n})) = true | pred _ = false",
              "fun obs (Top'Do_it (1, {l, ...})) = length l | obs _ = ~3"),
)  # fmt: skip
STOPS = (
    breakpoint_at("Break", ["Top.Do it"], of("pred", T, "n = 7", "false")),
    count("Count", "Top.Do it"),
    size("SizeQ", "Top.Q"),
    writer("File", ["Top.Do it", "Top.Q"],
           "fun pred (bindelem, Top'Q_1_mark : INT ms) = let fun f (Top'Do_it (1, {l, n})) = n mod 2 = 1 | f _ = false in f bindelem end",
           "fun obs (bindelem, Top'Q_1_mark : INT ms) = let fun f (Top'Do_it (1, {l, n})) = INT.mkstr n ^ \" \" ^ L.mkstr l ^ \" \" ^ INT.mkstr_ms Top'Q_1_mark ^ \"\\n\" | f _ = \"\" in f bindelem end",
           "fun init (Top'Q_1_mark : INT ms) = \"begin \" ^ Int.toString (size Top'Q_1_mark) ^ \"\\n\"", "fun stop (Top'Q_1_mark : INT ms) = \"end\\n\"", "csv"),
    user("User", ["Top.Do it"], of("pred", T, "n > 1", "false"), of("obs", T, "(n, length l)", "(0, 0)"),
         "fun action (a, b) = seen := !seen + a * b", "fun init () = seen := 5", "fun stop () = seen := !seen + 1"),
    collector("Seen", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "!seen", "0")),
)  # fmt: skip
JOBS = """
net Jobs
  standard
  colset JOB = product INT * INT timed;
  colset U = unit timed;
  colset Q = list JOB;
  var i, t : INT;
  var q : Q;
  place Next : JOB = 1`(1, 0)@1
  place Queue : Q = 1`[]
  place Free : U = 1`()
  place Busy : JOB
  place Done : JOB
  trans Arrive guard [i <= 5]
    in Next : (i, t)
    out Next : (i + 1, 0)@+10
    in Queue : q
    out Queue : q ^^ [(i, IntInf.toInt (time ()))]
  trans Start priority 1
    in Queue : (i, t) :: q
    out Queue : q
    in Free : ()
    out Busy : (i, t)@+13
  trans End
    in Busy : (i, t)
    out Free : ()
    out Done : (i, t)
"""
JOBS_MONITORS = (
    length("Queue length", "Top.Queue"),
    size("DoneSize", "Top.Done"),
    size("BusySize", "Top.Busy"),
    count("Ends", "Top.End"),
    collector("Delay", ["Top.Start"], of("pred", "Top'Start (1, {i, q, t})", "true", "false"),
              of("obs", "Top'Start (1, {i, q, t})", "IntInf.toInt (time ()) - t", "~1")),
    collector("RealDelay", ["Top.End"], of("pred", "Top'End (1, {i, t})", "i > 1", "false"),
              of("obs", "Top'End (1, {i, t})", "Real.fromLargeInt (time ()) / 4.0", "~1.0"), timed=True),
    collector("Utilisation", ["Top.Start", "Top.End", "Top.Busy"], "fun pred (bindelem, Top'Busy_1_mark : JOB tms) = true",
              "fun obs (bindelem, Top'Busy_1_mark : JOB tms) = size Top'Busy_1_mark", init="fun init (Top'Busy_1_mark : JOB tms) = SOME (size Top'Busy_1_mark)",
              stop="fun stop (Top'Busy_1_mark : JOB tms) = SOME (size Top'Busy_1_mark)", timed=True),
    collector("Stamps", ["Top.Next"], "fun pred (Top'Next_1_mark : JOB tms) = true", "fun obs (Top'Next_1_mark : JOB tms) = case Top'Next_1_mark of ((i, _) @ s) :: _ => s + IntInf.fromInt i | _ => ~1",
              init="fun init (Top'Next_1_mark : JOB tms) = NONE", stop="fun stop (Top'Next_1_mark : JOB tms) = NONE", timed=True),
    collector("LateFirst", ["Top.End"], of("pred", "Top'End (1, {i, t})", "i > 4", "false"), of("obs", "Top'End (1, {i, t})", "i * 2", "~1"), timed=True),
    collector("NoneTimed", ["Top.End"], of("pred", "Top'End (1, {i, t})", "i > 40", "false"), of("obs", "Top'End (1, {i, t})", "i * 2", "~1"), timed=True),
)  # fmt: skip
SUB = """
net Sub
  standard
  var n : INT;
  page Top
    place A : INT = 1`1
    place B : INT
    place C : INT = empty
    subst Left = Work (I -> A, O -> B)
    subst Right = Work (I -> B, O -> C)
  page Work
    place I port in : INT
    place M : INT
    place O port out : INT
    trans Get priority 1
      in I : n
      out M : n
    trans Put priority 2
      in M : n
      out O : n + 10
"""
SUB_MONITORS = (
    count("LeftGets", "Top/Left.Get"),
    count("RightGets", "Top/Right.Get"),
    size("LeftM", "Top/Left.M"),
    size("RightI", "Top/Right.I"),
    size("TopB", "Top.B"),
    collector("Gets", ["Top/Left.Get", "Top/Right.Get"], "fun pred (Work'Get (inst, {n})) = true | pred _ = false", "fun obs (Work'Get (inst, {n})) = 100 * inst + n | obs _ = ~1"),
    collector("Right only", ["Top/Right.Put"], "fun pred (Work'Put (2, {n})) = true | pred _ = false", "fun obs (Work'Put (i, {n})) = 100 * i + n | obs _ = ~1"),
    collector("Marks", ["Top/Left.M", "Top/Right.M"], "fun pred (Work'M_1_mark : INT ms, Work'M_2_mark : INT ms) = true", "fun obs (Work'M_1_mark : INT ms, Work'M_2_mark : INT ms) = size Work'M_1_mark + 2 * size Work'M_2_mark",
              init="fun init (Work'M_1_mark : INT ms, Work'M_2_mark : INT ms) = NONE", stop="fun stop (Work'M_1_mark : INT ms, Work'M_2_mark : INT ms) = NONE"),
)  # fmt: skip
WRONG = (
    collector("TypeOfObs", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, '"a"', '"b"')),
    collector("TypeOfPred", ["Top.Do it"], of("pred", T, "n", "0"), of("obs", T, "n", "0")),
    collector("TypeOfInit", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "n", "0"), init="fun init () = SOME 1.5"),
    collector("Unbound", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "nn", "0")),
    collector("Syntax", ["Top.Do it"], "fun pred (bindelem) = let in", of("obs", T, "n", "0")),
    collector("Variables", ["Top.Do it"], of("pred", "Top'Do_it (1, {n})", "true", "false"), of("obs", T, "n", "0")),
    collector("OtherName", ["Top.Do it"], of("pred", "Top'Doit (1, {l, n})", "true", "false"), of("obs", T, "n", "0")),
    breakpoint_at("BreakInt", ["Top.Do it"], of("pred", T, "n", "0")),
    length("NoList", "Top.P"),
    collector("TimedInUntimed", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "n", "0"), timed=True),
    collector("Good", ["Top.Do it"], of("pred", T, "n mod 4 = 0", "false"), of("obs", T, "n", "0")),
    collector("MarkType", ["Top.P"], "fun pred (Top'P_1_mark : INT tms) = true", "fun obs (Top'P_1_mark : INT tms) = 1", init=NO_INIT % "x", stop=NO_STOP % "x"),
    user("ActionType", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "n", "0"), "fun action (x : string) = ()", "fun init () = ()", "fun stop () = ()"),
    writer("FileInt", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "n", "0"), 'fun init () = ""', 'fun stop () = ""'),
    collector("RealInit", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "n", "0"), init="fun init () = NONE : int option", stop="fun stop () = SOME 4"),
    collector("Polymorphic", ["Top.Do it"], "fun pred (bindelem) = true", "fun obs (bindelem) = 3"),
    collector("NoMatch", ["Top.Do it"], of("pred", T, "true", "false"), "fun obs (Top'Do_it (1, {l, n})) = n"),
)  # fmt: skip
CASES: dict[str, Case] = {
    "many": Case(COUNTER, MANY),
    "stops": Case(COUNTER, STOPS),
    "empty": Case(COUNTER, (Spec("Empty", "Place content break point", ["Top.Q"], {}, {"If is empty": "false"}), count("Count", "Top.Do it"))),
    "enabled": Case(COUNTER.replace("n > 100", "n > 5"), (Spec("Enabled", "Transition enabled break point", ["Top.Take"], {}, {"If is enabled": "true"}), count("Count", "Top.Do it"))),
    "disabled": Case(COUNTER, (Spec("Not", "Transition enabled break point", ["Top.Do it"], {}, {"If is enabled": "false"}), count("Count", "Top.Do it"))),
    "jobs": Case(JOBS, JOBS_MONITORS, 60),
    "real time": Case(
        JOBS.replace("standard", "standard\n  option realtimestamp true")
        .replace("IntInf.toInt (time ())", "floor (time () * 2.0)").replace("(1, 0)@1", "(1, 0)@1.5"),
        (length("Queue length", "Top.Queue"), size("DoneSize", "Top.Done"), count("Ends", "Top.End"),
         collector("T", ["Top.End"], "fun pred _ = true", "fun obs (Top'End (_, {i, t})) = time () + 0.5 | obs _ = 0.0", timed=True)), 60),
    "sub": Case(SUB, SUB_MONITORS),
    "wrong": Case(COUNTER, WRONG),
    "raises": Case(COUNTER, (collector("Raises", ["Top.Do it"], of("pred", T, "true", "false"), of("obs", T, "100 div (n - 3)", "0")), count("Count", "Top.Do it"))),
}  # fmt: skip

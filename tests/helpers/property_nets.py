"""Small nets with properties whose truth is known from thinking about them: `(text, true?)`, perhaps with a number."""

from __future__ import annotations

Row = tuple[str, bool] | tuple[str, bool, float]

# Two processes, one semaphore.
MUTEX = """
    net Mutex
      standard
      colset P = with a | b;
      var p : P;
      place Idle : P = 1`a ++ 1`b
      place Want : P
      place Crit : P
      place Free : UNIT = 1`()
      trans Ask
        in Idle : p
        out Want : p
      trans Enter
        in Want : p
        in Free : ()
        out Crit : p
      trans Leave
        in Crit : p
        out Free : ()
        out Idle : p
"""
MUTEX_ROWS: list[Row] = [
    ("deadlock free", True),
    ("bound Crit <= 1", True, 1),
    ("bound Want <= 1", False, 2),
    ("bound 1 <= Idle <= 2", False),
    ("always tokens(Crit) = 1 || tokens(Free) = 1", True),
    ("mutex { cf (a, Mark.Top'Crit 1) > 0 }, { cf (b, Mark.Top'Crit 1) > 0 }", True),
    ("mutex Want, Crit", False),
    ("always tokens(Idle, Want, Crit) = 2", True),
    ("always tokens(Want, Crit) < tokens(Idle, Free)", False),
    ("always { Mark.Top'Idle 1 ++ Mark.Top'Want 1 ++ Mark.Top'Crit 1 == 1`a ++ 1`b }", True),
    ("ctl AG ({ contains (Mark.Top'Want 1) [a] } -> EF { contains (Mark.Top'Crit 1) [a] })", True),
    ("ctl AG ({ contains (Mark.Top'Want 1) [a] } -> AF { contains (Mark.Top'Crit 1) [a] })", False),
    ("ctl AG EF initial", True),
    ("ctl EG tokens(Crit) = 0", False),
    ("ctl A[tokens(Crit) = 0 U enabled(Enter)]", True),
    ("ctl E[tokens(Idle) >= 1 U tokens(Want) = 2]", True),
    ("ctl E[tokens(Idle) = 2 U tokens(Want) = 2]", False),
    ("ltl G F fires(Enter)", True),
    ("ltl G ({ contains (Mark.Top'Want 1) [a] } -> F { contains (Mark.Top'Crit 1) [a] })", False),
    ("ltl tokens(Crit) = 0 U fires(Enter)", True),
    ("ltl G (fires(Enter) -> X !enabled(Enter))", True),
    ("ltl G (fires(Ask) -> X fires(Enter))", False),
    ("every fires(Enter) is followed by fires(Leave) within 2 firings", True, 2),
    ("every fires(Enter) is followed by fires(Leave) within 1 firings", False),
    ("every tokens(Crit) = 1 is followed by tokens(Free) = 1", True),
    ("always tokens(Free) = 1", False),
    ("ltl F G tokens(Crit) = 0", False),
    ("never enabled(Leave)", False),
]

# The same, each with a transition of its own, so that fairness can tell them apart.
TURNS = """
    net Turns
      standard
      page Top
        place Free : UNIT = 1`()
        subst Left = Proc (Lock -> Free)
        subst Right = Proc (Lock -> Free)
      page Proc
        place Lock port io : UNIT
        place Want : UNIT = 1`()
        place Crit : UNIT
        trans Enter
          in Want : ()
          in Lock : ()
          out Crit : ()
        trans Leave
          in Crit : ()
          out Lock : ()
          out Want : ()
"""
TURNS_ROWS: list[Row] = [
    ("ltl G F fires(Proc'Enter 1)", False),
    ("ltl G F fires(Proc'Enter 1) assuming weak all", False),
    ("ltl G F fires(Proc'Enter 1) assuming strong Proc'Enter 1", True),
    ("ltl G F fires(Proc'Enter 1) assuming strong Proc'Enter 2", False),
    ("ltl G F fires(Proc'Enter 1) && G F fires(Proc'Enter 2) assuming strong all", True),
    ("ltl G F fires(Proc'Enter 1) || G F fires(Proc'Enter 2)", True),
    ("every tokens(Proc'Want 1) = 1 is followed by tokens(Proc'Crit 1) = 1", False),
    (
        "every tokens(Proc'Want 1) = 1 is followed by tokens(Proc'Crit 1) = 1 assuming strong all",
        True,
    ),
    ("every fires(Proc'Enter 2) is followed by fires(Proc'Leave 2) within 1 firings", True, 1),
    ("mutex Proc'Crit 1, Proc'Crit 2", True),
    ("mutex Proc'Crit 1, Proc'Want 2", False),
    ("reachable tokens(Proc'Crit 1) = 1 && tokens(Proc'Crit 2) = 1", False),
    ("ltl F G fires(Proc'Enter 1)", False),
    ("reachable dead", False),
    ("bound Top'Free <= 0", False),
]

# Philosophers who take the left stick first.
DINNER = """
    net Dinner
      standard
      colset PH = index ph with 1..3;
      colset CS = index cs with 1..3;
      var p : PH;
      fun left (ph(i)) = 1`cs(i);
      fun right (ph(i)) = 1`cs(if i = 3 then 1 else i + 1);
      place Think : PH = PH.all()
      place Half : PH
      place Eat : PH
      place Sticks : CS = CS.all()
      trans Left
        in Think : p
        in Sticks : left p
        out Half : p
      trans Right
        in Half : p
        in Sticks : right p
        out Eat : p
      trans Down
        in Eat : p
        out Think : p
        out Sticks : left p ++ right p
"""
DINNER_ROWS: list[Row] = [
    ("deadlock free", False),
    ("deadlock free except tokens(Half) = 3", True),
    ("deadlock free except { Mark.Top'Half 1 == PH.all () }", True),
    ("reachable dead", True),
    ("reachable tokens(Eat) = 2", False),
    ("bound Eat <= 1", True, 1),
    ("never tokens(Think) = 0 && tokens(Eat) = 1", True),
    ("never tokens(Half) = 1 && tokens(Eat) = 1", False),
    ("ctl AG EF initial", False),
    ("ctl EG !dead", True),
    ("ctl AF dead", False),
    ("ctl AG (tokens(Half) = 3 <-> dead)", True),
    ("ctl EX<Left> EX<Left> EX<Left> dead", True),
    ("ctl AX<Right> tokens(Eat) = 1", True),
    ("ltl F dead || G F fires(Down)", True),
    ("ltl G F fires(Left)", False),
    ("ltl G !dead -> G F fires(Down)", True),
    ("ltl F dead assuming strong all", False),
    ("every fires(Right) is followed by fires(Down)", True),
    ("every fires(Left) is followed by fires(Right) within 3 firings", False),
    ("ctl AX<Left> dead", False),
    ("always enabled(Left)", False),
    ("reachable enabled(Down) && dead", False),
]

# A buffer of two, messages numbered modulo three.
BUFFER = """
    net Buffer
      standard
      colset NO = int with 0..2;
      colset NOS = list NO;
      var n, k : NO;  var q : NOS;
      fun next n = (n + 1) mod 3;
      fun inOrder (x :: y :: r) = y = next x andalso inOrder (y :: r)
        | inOrder _ = true;
      place Next : NO = 1`0
      place Queue : NOS = 1`[]
      place Want : NO = 1`0
      trans Put guard [length q < 2]
        in Next : n
        out Next : next n
        in Queue : q
        out Queue : q ^^ [n]
      trans Get
        in Queue : k :: q
        out Queue : q
        in Want : k
        out Want : next k
"""
BUFFER_ROWS: list[Row] = [
    ("always { List.all inOrder (Mark.Top'Queue 1) }", True),
    ("always { List.all (fn q => length q <= 2) (Mark.Top'Queue 1) }", True),
    ("always { List.all (fn q => length q < 2) (Mark.Top'Queue 1) }", False),
    ("deadlock free", True),
    ("ctl AG (enabled(Put) || enabled(Get))", True),
    ("ctl AG enabled(Put)", False),
    ("every fires(Put) is followed by fires(Get) within 2 firings", True, 2),
    ("every fires(Put) is followed by fires(Get) within 1 firings", False, 2),
    ("every enabled(Get) is followed by fires(Get) within 2 firings", True, 2),
    ("ltl G (fires(Put) -> X F fires(Get))", True),
    ("ltl G (fires(Put) -> X fires(Get))", False),
    ("ltl G F fires(Put) && G F fires(Get)", True),
    ("ltl F G { Mark.Top'Queue 1 <> [[]] }", False),
    ("reachable { Mark.Top'Queue 1 = [[2, 0]] }", True),
    ("reachable { Mark.Top'Queue 1 = [[2, 1]] }", False),
    ("reachable dead", False),
    ("bound Next <= 0", False),
    ("ltl G F { Mark.Top'Queue 1 = [[]] }", False),
]

# It counts down and ends; a token may also be lost.
ENDING = """
    net Ending
      standard
      var n : INT;
      place Count : INT = 1`4
      place Done
      place Lost : INT
      trans Down guard [n > 0]
        in Count : n
        out Count : n - 1
      trans Stop
        in Count : 0
        out Done
      trans Lose guard [n = 2]
        in Count : n
        out Lost : n
"""
ENDING_ROWS: list[Row] = [
    ("deadlock free", False),
    ("deadlock free except tokens(Done) = 1", False),
    ("deadlock free except tokens(Done) = 1 || tokens(Lost) = 1", True),
    ("ctl AF dead", True),
    ("ctl AF tokens(Done) = 1", False),
    ("ctl EF tokens(Done) = 1", True),
    ("ctl AG (dead -> AX false)", True),
    ("ctl EX true && AG (EX true || dead)", True),
    ("ltl F dead", True),
    ("ltl F tokens(Done) = 1", False),
    ("ltl F (tokens(Done) = 1 || tokens(Lost) = 1)", True),
    ("ltl G (tokens(Lost) = 1 -> G dead)", True),
    ("ltl X X X X fires(Stop)", False),
    ("ltl F (dead && X dead)", True),
    ("every fires(Down) is followed by dead within 3 firings", False, 4),
    ("every fires(Down) is followed by dead within 4 firings", True, 4),
    ("every fires(Down) is followed by fires(Stop) within 9 firings", False),
    ("always { List.all (fn n => n >= 0 andalso n <= 4) (Mark.Top'Count 1) }", True),
    ("ctl EG !dead", False),
    ("reachable tokens(Done) = 1 && tokens(Lost) = 1", False),
    ("ltl G !fires(Lose)", False),
]

# A lamp and a switch with priorities, inhibitor and reset arcs.
LAMP = """
    net Lamp
      standard
      colset C = with red | green;
      var c : C;
      val P_HIGH = 100;
      place Calls : C
      place Off : UNIT = 1`()
      place On : UNIT
      place Room : UNIT = 3`()
      trans Call
        in Room : ()
        out Calls : red
      trans Light priority P_HIGH
        both Calls : c
        in Off : ()
        out On : ()
      trans Clear
        in On : ()
        out Off : ()
        reset Calls
        out Room : ()
      trans Rest
        inhibit Calls
        both Off : ()
"""
LAMP_ROWS: list[Row] = [
    ("always tokens(On) = 1 || tokens(Off) = 1", True),
    ("ltl G (fires(Call) -> X (fires(Light) || tokens(On) = 1))", True),
    ("always tokens(Calls) >= 1 -> enabled(Light) || tokens(On) = 1", True),
    ("always enabled(Call) -> tokens(Room) >= 1", True),
    ("always tokens(Room) >= 1 -> enabled(Call)", False),
    ("ctl AG AF enabled(Rest)", True),
    ("ctl AG AF !enabled(Rest)", False),
    ("ctl AG (enabled(Rest) <-> tokens(Calls) = 0 && tokens(Off) = 1)", True),
    ("ltl G F fires(Rest)", False),
    ("bound Calls <= 3", True, 3),
    ("bound Room <= 1", False),
    ("never tokens(On) = 1 && tokens(Calls) = 2", False),
    ("reachable dead", False),
    ("mutex Calls, On", False),
]

# A belt and a gate with delays.
BELT = """
    net Belt
      standard
      colset PART = int with 1..3 timed;
      colset GATE = unit timed;
      var p : PART;
      place Store : PART = 1`1@0 +++ 1`2@5 +++ 1`3@9
      place Moving : PART
      place Gate : GATE = ()@0
      place Out : PART
      trans Load
        in Store : p
        out Moving : p @+ 4
      trans Pass
        in Moving : p
        in Gate : ()
        out Gate : () @+ 3
        out Out : p
"""
BELT_ROWS: list[Row] = [
    ("every fires(Load) is followed by fires(Pass) within 4 time", True),
    ("every fires(Load) is followed by fires(Pass) within 3 time", False),
    ("every fires(Load) is followed by tokens(Moving) = 0 within 4 time", False),
    ("every fires(Load) is followed by tokens(Moving) = 0 within 8 time", True, 8),
    ("deadlock free except tokens(Out) = 3", True),
    ("deadlock free", False),
    ("bound Moving <= 1", False, 2),
    ("always { List.all (fn x @ t => t <= ModelTime.time () + 4) (Mark.Top'Moving 1) }", True),
    ("reachable { time () = 13 andalso size (Mark.Top'Out 1) = 3 }", True),
    ("reachable { time () > 13 }", False),
    ("ltl F tokens(Out) = 3", True),
    ("ltl G (tokens(Moving) >= 1 -> X tokens(Moving) = 0)", False),
    ("reachable tokens(Moving) = 3", False),
    ("never tokens(Out) = 3", False),
    ("every fires(Pass) is followed by fires(Load) within 9 time", False),
]

# Two readers or one writer.
LIBRARY_NET = """
    net Reading
      standard
      colset R = index r with 1..2;
      var reader : R;
      place Away : R = R.all()
      place Reads : R
      place Writes : UNIT
      place Desk : UNIT = 2`()
      trans Come
        in Away : reader
        in Desk : ()
        out Reads : reader
      trans Go
        in Reads : reader
        out Away : reader
        out Desk : ()
      trans Write
        in Desk : 2`()
        out Writes : ()
      trans Finish
        in Writes : ()
        out Desk : 2`()
"""
LIBRARY_ROWS: list[Row] = [
    ("mutex Reads, Writes", True),
    ("bound Reads <= 2", True, 2),
    ("bound Reads <= 1", False),
    (
        "always { size (Mark.Top'Desk 1) + size (Mark.Top'Reads 1) + 2 * size (Mark.Top'Writes 1) = 2 }",
        True,
    ),
    ("every enabled(Write) is followed by fires(Write)", False),
    ("every enabled(Write) is followed by fires(Write) assuming strong Write", False),
    ("ltl G F enabled(Write) -> G F fires(Write)", False),
    ("ltl G F enabled(Write) -> G F fires(Write) assuming strong Write", True),
    ("ltl G F enabled(Write) -> G F fires(Write) assuming weak Write", False),
    ("every fires(Write) is followed by fires(Finish) within 1 firings", True, 1),
    ("ctl AG EF tokens(Writes) = 1", True),
    ("ctl AG AF tokens(Writes) = 1", False),
    ("ctl E[tokens(Writes) = 0 W enabled(Finish)]", True),
    ("ctl A[tokens(Writes) = 0 R tokens(Reads) = 0]", True),
    ("ctl A[tokens(Writes) = 1 R tokens(Reads) = 0]", False),
    ("reachable dead", False),
    ("ctl AF tokens(Writes) = 1", False),
    ("ltl G F fires(Come)", False),
]

OWN: dict[str, tuple[str, list[Row]]] = {
    "mutex": (MUTEX, MUTEX_ROWS),
    "turns": (TURNS, TURNS_ROWS),
    "dinner": (DINNER, DINNER_ROWS),
    "buffer": (BUFFER, BUFFER_ROWS),
    "ending": (ENDING, ENDING_ROWS),
    "lamp": (LAMP, LAMP_ROWS),
    "belt": (BELT, BELT_ROWS),
    "reading": (LIBRARY_NET, LIBRARY_ROWS),
}

_MODELS = "corpus/nets/cpn-io+cpn-js/sample-cpn-models"
SHARED: dict[str, list[Row]] = {
    "mcc/DatabaseWithMutex-COL-02.pnml": [
        ("deadlock free", True),
        ("ctl AG EF initial", True),
        ("bound Mutex <= 2", True, 2),
        ("bound updating <= 1", False, 2),
        ("every fires(Acquire) is followed by fires(Release)", True),
        ("every fires(Acquire) is followed by fires(Release) within 1 firings", False),
    ],
    "mcc/LamportFastMutEx-COL-2.pnml": [
        ("bound P_CS_21 <= 1", True, 1),
        ("deadlock free", True),
        ("reachable tokens(P_CS_21) = 2", False),
        ("ctl AG EF tokens(P_CS_21) = 1", True),
        ("ctl AG AF tokens(P_CS_21) = 1", True),
        ("ltl G F { cf (C_pid_1, Mark.LamportFastMutEx_COL_2'P_CS_21) = 1 }", False),
    ],
    "mcc/Philosophers-COL-000005.pnml": [
        ("deadlock free", False),
        ("deadlock free except tokens(Catch1) = 5 || tokens(Catch2) = 5", True),
        ("bound Eat <= 2", True, 2),
        ("bound Eat <= 1", False),
        ("never { contains (Mark.Philosophers_COL_000005'Eat) [Id1, Id2] }", True),
        ("never { contains (Mark.Philosophers_COL_000005'Eat) [Id1, Id3] }", False),
        ("ctl AG EF initial", False),
        ("ltl F dead || G F fires(End)", True),
    ],
    "mcc/TokenRing-COL-005.pnml": [
        ("deadlock free", True),
        ("bound State <= 6", True, 6),
        ("bound State <= 5", False),
        ("ctl AG EF initial", False),
    ],
    f"{_MODELS}/DistributedDataBase/DistributedDataBase.cpn": [
        ("always tokens(Passive) = 1 || tokens(Active) = 1", True),
        ("mutex Passive, Active", True),
        ("bound Waiting <= 1", True, 1),
        ("deadlock free", True),
        ("ctl AG EF initial", True),
        ("every tokens(Waiting) = 1 is followed by tokens(Passive) = 1", True),
        ("every fires(Update_and_Send_Messages) is followed by initial within 7 firings", True, 7),
        ("every fires(Update_and_Send_Messages) is followed by initial within 6 firings", False, 7),
        ("ltl G F { cf (d 1, Mark.Top'Waiting) = 1 }", False),
        ("ltl G F { cf (d 1, Mark.Top'Waiting) = 1 } assuming strong all", False),
    ],
    f"{_MODELS}/ResourceAllocation/ResourceAllocation_OG.cpn": [
        ("deadlock free", True),
        ("bound Top'R <= 1", True, 1),
        ("bound B <= 1", False, 2),
        ("ltl G F fires(T2)", True),
        ("ltl G F fires(T1)", False),
        ("ltl G F fires(T1) assuming weak T1", False),
        ("ctl AG EF initial", True),
    ],
    f"{_MODELS}/SimpleProtocol/SimpleProtocol_OG.cpn": [
        ("deadlock free", False),
        ("reachable dead", True),
        ("ctl AG EF dead", True),
        ("ltl F dead", False),
        ("always { hd (Mark.Top'NextSend) <= hd (Mark.Top'NextRec) }", True),
        ("always { hd (Mark.Top'NextRec) <= hd (Mark.Top'NextSend) + 1 }", False),
        ("every fires(Send_Packet) is followed by fires(Receive_Packet)", False),
    ],
    f"{_MODELS}/DiningPhilosophers/DiningPhilosophers_ASKCTL.cpn": [
        ("deadlock free", False),
        ("ctl EF dead", True),
        ("ctl AF dead", False),
        ("mutex Outside, Eat", True),
        ("ctl AG EF enabled(Take_Chopsticks)", False),
    ],
}
"""Nets by others, read where they are."""

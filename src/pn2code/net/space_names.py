"""Top-level names of a net that keep the state-space tool of CPN Tools from loading.

Its sources are compiled after the declarations of the net, and use names that these may have hidden: with a constant
`left` of an enumeration, the variables `left` in its sources become that constant. The net simulates all the same. The
names were found by experiment, each declared before each of the sources that has it; those that cannot be declared at
all (`reserved_words`) are not among them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.ml.core.terms import DatatypeDec, ExceptionDec, Program, RecBind, ValBind
from pn2code.net.codes import SPACE_NAME
from pn2code.net.uses import pattern_variables

_CONSTRUCTORS = """
Action All AllReachable AlreadyProcesed ArcCount ArcDescriptor ArcFilterGen ArcLimit ArcToBE ArcToTI
Arcs ArcsInPath BEToArc BEToTI BEsDead BEsDead' BEsFairness BEsLive BEsLive' BEsStrictlyLive BTT_st
Bind BindingLimit CalculateOccGraph CalculateSccGraph ColorSearch CompTimeLimit CreationTime
DataRecFields DeadMarking DeadMarkings DeadMarkingsGen DeadTIs DeadTIsGen DeleteStateSpace DestNode
EntireGraphCalculated EqualUntimed EqualsUntimed EvalAllArcs EvalAllNodes EvalAllSccs EvalArcs
EvalNodes EvalSccs ExcAvlLookup FairnessGen FairnessProperties FirstConstructor FirstItem Freq
FromTransSeq FullProc FullyProcessed GenOG GenerateEntryF GenerateHeaderF GenerateHeadingF
HomeMarking HomeMarking' HomeMarkingExists HomeMarkings HomeMarkingsGen HomePredicate HomeSpace
HomeSpace' IllegalName InArcs InNodes InitNode InitScc InitialHomeMarking IntegerBounds
IntegerBoundsGen InternalError LastTotalCalc ListDeadMarkings ListDeadTIs ListDeadlocks ListFairTIs
ListHomeMarkings ListHomeScc ListImpartialTIs ListJustTIs ListLiveTIs ListProcDeadlocks LiveTIs
LiveTIsGen LowerInteger LowerMultiSet LowerTimedMultiSet Match MaxEnab MinimalHomeSpace
MultiSetBounds MultiSetBoundsGen Net NewCalcStat NextArcNum NextInspectTime NextNodeNum NextStopTime
NoOfArcs NoOfNodes NoOfSecs NoOfVarsToEncode NoPathExists NodeCount NodeDescriptor NodeFilterGen
NodeLimit NodeNames NodeToScc Noderefs NodesInPath OGSimStatetoOG OGStatetoSim OGdatarec
OGdatarecfield OGrapgh OUT OccurrenceTime OnlyThisList Option OutArcs OutNodes PageNames PartProc
PlaceInsts Pred PredAllArcs PredAllNodes PredAllSccs PredArcs PredNodes PredSccs ProcNodePred
Processed Reachable Reachable' SccComptime SccDestNode SccGraphCalculated SccListDeadMarkings
SccNoOfNodes SccNodesInPath SccOutArcs SccOutNodes SccReachable SccReachable' SccSourceNode
SccTerminal SccToArcs SccToNodes SccTrivial SearchAllArcs SearchAllNodes SearchAllSccs SearchArcs
SearchNodes SearchReachableSccs SearchSccs SearchSubgraphCycles SearchSubgraphSccs SelectNextNode
SourceNode StandardInspectionReport StandardReport StartTime StateCreationTime Statistics
StatisticsGen StopCritSatisfied StripTime TIsDead TIsDead' TIsFairness TIsLive TIsLive' Terminal
TerminationTime ToProcess TotalTime TransInstLimit TrivialSubgraphScc UnProc UpperInteger
UpperMultiSet UpperTimedMultiSet abs allNodes allOGrecs allPredecessorEdges allSuccessorEdges arc
arccountstr arcinfo arcinfos arcs arcsflat assigned bf bindings bindlimit_reached calcstat cands
code code1 code2 code_storage code_storage2 code_temp code_temp2 concat copy_code_list count
creationtime cur_elem curtod decl declerr destnoderef div dstinfo dstnode edgeStmts elements elm
elms emptybind errmsg errstr exn exnName explode extpat fid fieldlist fieldname fieldsref first
firstBTT firstinst firstmlno firstnoderef firsttri flatten foldr freq from fullid func funname
funpostfix fusgrid fusion hd hdvar i2 implode inarcs included init_code_list innerrec innodes
insertstaterec inst_conns instlist instmlno instno internalid intpat is_port istimed it item key
kind left length lst map maxfunpatterns mem mkst_Arc mkst_BE mkst_Node mkst_PI mkst_TI mkstr_ms
mlnoslist msreflist mymlno n1 n2 name newDFI newarc newarccount newarcnum newcand newnodelist
newnodenum next_time nil no_bindings no_of_tokens nodecountstr nodeinfos noderef nodes
nodesWithoutPredecessors nodesWithoutSuccessors nodesflat nonlocalfus num_of_insts o ogpath outarcs
outnodes outtimed page pagename partfuncount patterncount patternetc pgglobfuschng pgmlno pgname
pgno pgstr place place_id places pldescrs pli plidescr plitype pllist plmlno plmlnostr plname pltree
port portinstances portmlid prime ps recname recreflist refstore remdupl rest result rev right root root1
root2 root_bf root_key root_left root_left_bf root_left_right root_left_right_bf root_right
root_right_bf root_right_left root_right_left_bf rootrec scc scc'comp sccsWithoutSuccessors secs
siminst simplace socketid socketinst srcinfo srcnode srcnoderef start st_Arc st_ArcDescrRef st_BE st_Node
st_NodeDescrRef st_PI st_PI0 st_PI1 st_TI st_TI0 st_TI1 staterec stlst stmt stopcritsatisfied
stringreparcref stringrepberef stringrepmarkref stringrepnoderef stringreppiref stringreptiref
sub_pages super_pages surrpgglobfus surrports tab1 tab2 tabel targetinfo temp terminationtime text
thistimestr thistree times tl tlvars to tod topOGdatarec topOGdatarecfield totalarccountstr
totalnodecountstr totaltimestr trans_list transid transinsts transitions trlist trmlno trname trstr
tsurrpgglobfus tsurrports typeerr typestr unchngrecs use userArcFilter userNodeFilter useractionfun
userfilterfun userpredfun userpredicate valOf varlist varlists vars value wasthere withcode withtime
"""
CONSTRUCTORS = frozenset(_CONSTRUCTORS.split())
"""As constants of enumerations, constructors of unions, index names, exceptions."""
_VALUES = """
abs concat div exnName explode flatten foldr hd implode length map mem mkstr_ms o remdupl rev tl tod
use valOf
"""
VALUES = frozenset(_VALUES.split())
"""As values and functions, unless they can be used like those that they hide."""
_STRUCTURES = """
Bind CalcStat Char Date Inst Int Int32 List ListUtils Mark Misc OGSet OS Output PI String TI TMS TextIO
Time
"""
STRUCTURES = frozenset(_STRUCTURES.split())
"""As colour sets, each of which is a structure."""


def warn(program: Program, origins: Mapping[str, Origin], d: Diagnostics) -> None:
    """Warn of such names.

    Args:
        program: the declarations of the net.
        origins: of the colour sets, by name.
        d: gets the warnings.
    """
    for what, name, origin in _declared(program, origins):
        d.warning(
            SPACE_NAME,
            f"the {what} `{name}` hides a name that the state-space tool of CPN Tools uses: the tool cannot be entered "
            "with this net"
            + (
                ", unless it has the type of what it hides" if what in ("value", "function") else ""
            ),
            origin,
            hint="give it another name if the net is to be analysed there, too",
        )


def _declared(program: Program, origins: Mapping[str, Origin]) -> Iterator[tuple[str, str, Origin]]:
    """What is declared with such a name: the kind of thing, the name, where."""
    for name, origin in origins.items():
        if name in STRUCTURES:
            yield "colour set", name, origin
    for dec in program.declarations:
        match dec:
            case DatatypeDec(name, _, constructors):
                at = dec.span.origin if dec.span is not None else origins.get(name)
                for constructor, _ in constructors:
                    if constructor.name in CONSTRUCTORS and at is not None:
                        yield "constant", constructor.name, at
            case ExceptionDec(constructor):
                if constructor.name in CONSTRUCTORS:
                    yield "exception", constructor.name, dec.span.origin
            case ValBind(pattern):
                for symbol in pattern_variables(pattern):
                    if symbol.name in VALUES and program.globals.get(symbol.name) == symbol:
                        yield "value", symbol.name, dec.span.origin
            case RecBind(bindings):
                for symbol, _ in bindings:
                    if symbol.name in VALUES and program.globals.get(symbol.name) == symbol:
                        yield "function", symbol.name, dec.span.origin

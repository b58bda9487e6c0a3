"""What the engine of CPN Tools has in scope besides what pn2code knows: names only, so that a use is refused by name.

Its own inner parts, the compiler of SML/NJ, the parts of the state-space tool; nobody needs them in a net, and a net
may give their names to something of its own. `./dev oracle --library` finds what is missing here.
"""

from __future__ import annotations

_STRUCTURES = """
A ANSITerm Absyn Access Ast Backend BasicControl BasicTypes BigBitArray BigWord8Array BinPrimIO Bindings
Binfile Bits BuchiHashFunction ByteArray CM CMB CPN'Array CPN'AstLib CPN'AvlTree CPN'Bitstring CPN'CSTable
CPN'CodeGen CPN'ColorSets CPN'ConfidenceInterval CPN'CreateMonitor CPN'Decl CPN'Dep CPN'GnuplotScript
CPN'HashCommon CPN'IMSTable CPN'IO CPN'ITSV CPN'IUSV CPN'Id CPN'IdTable CPN'InstTable CPN'Int CPN'IntKey
CPN'IntListKey CPN'IntListTable CPN'IntTable CPN'List CPN'MS CPN'Misc CPN'MonitorAux CPN'MonitorTable
CPN'MonitorTemplate CPN'Options CPN'OrderCommon CPN'PTnet CPN'PageTable CPN'PerfOptions CPN'Place CPN'PlaceSim
CPN'PlaceTable CPN'Places CPN'Profile CPN'RS CPN'RTSV CPN'RUSV CPN'Real CPN'RefTable CPN'Reference
CPN'ReferenceSim CPN'References CPN'RepTable CPN'Response CPN'SerializerCommon CPN'SimGlue
CPN'StandardMonitors CPN'String CPN'StringTable CPN'SymTable CPN'SyntaxCheck CPN'SyntaxDatatypes
CPN'SyntaxErrors CPN'SyntaxTables CPN'TMS CPN'Transition CPN'TransitionTable CPN'Tree CPN'UnitTime
CPN'VarTable ComBackDDDStorageFifoCache ComBackDDDStorageHeuristicCache ComBackDDDStorageRandomCache
CommsLayer CompInfo CompileExn Compiler CompilerDep CompilerPPTable ComplexNumber Control Control_Print
CoreSym Counter CpnML CpnMLSys DEBUG DynamicEnv Either EncodeDecodeFunctions EntityEnv EnvRef Environment
ErrorMsg Estimator ExtExecute ExternalPartition FLINT FastSymbol FifoQueue FixedInt Fixity Fn FormatComb
GNUPlot GenModIdMap GenericSock Graph Hash31ToHash31 Hash32ToHash31 Hash62ToHash31 Hash64ToHash31
HashIntToHash31 HashTableRep HashWord8Vector I IntInfKey IntKey JavaExecute LargeArray LargeDynamicArray
LargeHashTable Lazy MLParser MaxMemory MemoryLimit MemoryLimit2 MessagingLayer MinimalCompiler ModuleId
ModuleUtil Modules NetDB NetProtDB NetServDB O'S OSDep PLTLSyntax PPType PQRS PTNetHashFunction
PTNetHashFunction2 PackReal64Big PackReal64Little PackWord16Big PackWord16Little
PersMap PersStamps PickMod PickleSymPid Precedence PrettyPrint PrettyPrintNew PrimOpId
PrintHooks PrintUtil ProbLibBasics ProbLibDist Profiling R RS RSPrio RandomQueue RandomValues
Real64ArraySlice Real64VectorSlice RealArray RealArraySlice RealNumber RealVector RealVectorSlice
Ref Regression Rehash S SML90 SMLNJVersion SQLDump Signals SimpleURef SmlFile Source SourceMap Stack Stamps
StandardArray StaticEnv Stats StringKey SymPath Symbol SymbolHashTable SymbolicEnv SysWord TestTools Text
TextPrimIO Types TypesUtil UTF8 Unify UnixSignals UnixSock UnpickMod UnpickleSymPid Unsafe VarCon
WordStringHashTable
"""
_VALUES = """
BindFailure BindFailureGenAll BindFatalFailure BoundGroup CPN'Cancel CPN'CancelManBind CPN'CancelPickBind
CPN'Stop CPN'app CPN'bootstrap CPN'build CPN'concat CPN'debug CPN'debug_exn CPN'dec CPN'dynArrayToList
CPN'getMLidentifierPrefix CPN'hd CPN'idebug CPN'inc CPN'inst CPN'map CPN'nth CPN'parse_coderegion
CPN'report_timing CPN'save_debug_info CPN'start_timing CPN'stop_timing CPN'term_debug CPN'tl
CPN'underlineSpaces CPN'use Compile ConfidenceIntervalExn IllegalName
IntInfToRealExn NotValidDirExn RealToIntInfExn UnsupportedArch all_expr beta_pert delay
dynArray gen_mkstr_ms get_ran hashId hashInt hashIntList hashString illegal_msg_ms import importE input_ms
input_tms mkstr mkstr_tms model_time name null_str ogpath output_ms output_tms problibrandom rcsid ready reset
rmipath sort_int_list sort_tms start_time tlegal tleq tlt tod tsub
"""
_MEMBERS = """
BinIO.StreamIO : canInput closeIn closeOut endOfStream filePosIn filePosOut flushOut getBufferMode getPosOut
BinIO.StreamIO : getReader getWriter input input1 inputAll inputN mkInstream mkOutstream output output1
BinIO.StreamIO : setBufferMode setPosOut
CPN'Random : init
IO : TerminatedStream
LargeReal : class compareReal fromDecimal toDecimal
LibBase : banner failure version
ListUtils : sort_int_list
Misc : ::=
Misc.A : app fold map revapp revfold
Misc.I : *= += -=
Misc.I : app fold revapp revfold
Misc.R : *= += -=
Misc.S : left right
ModelTime : model_time name ready start_time
OS : syserror
OS.IO : Poll
OS.IO.Kind : device dir file pipe socket symlink tty
Posix.Error : acces again badf badmsg busy canceled child deadlk dom errorMsg errorName exist fault fbig
Posix.Error : fromWord inprogress intr inval io isdir loop mfile mlink msgsize nametoolong nfile nodev noent
Posix.Error : noexec nolck nomem nospc nosys notdir notempty notsup notty nxio perm pipe range rofs spipe srch
Posix.Error : syserror toWord toobig xdev
Posix.FileSys : A_EXEC A_READ A_WRITE O_RDONLY O_RDWR O_WRONLY
Posix.FileSys.O : all allSet anySet append clear dsync excl flags fromWord intersect noctty nonblock rsync
Posix.FileSys.O : sync toWord trunc
Posix.FileSys.S : all allSet anySet clear flags fromWord intersect irgrp iroth irusr irwxg irwxo irwxu isgid
Posix.FileSys.S : isuid iwgrp iwoth iwusr ixgrp ixoth ixusr toWord
Posix.FileSys.ST : atime ctime dev gid ino isBlk isChr isDir isFIFO isLink isReg isSock mode mtime nlink size
Posix.FileSys.ST : uid
Posix.IO : F_RDLCK F_UNLCK F_WRLCK O_RDONLY O_RDWR O_WRONLY SEEK_CUR SEEK_END SEEK_SET
Posix.IO.FD : all allSet anySet clear cloexec flags fromWord intersect toWord
Posix.IO.FLock : flock len ltype pid start whence
Posix.IO.O : all allSet anySet append clear dsync flags fromWord intersect nonblock rsync sync toWord
Posix.Process : K_SAME_GROUP W_ANY_CHILD W_SAME_GROUP
Posix.Process.W : all allSet anySet clear flags fromWord intersect toWord untraced
Posix.Signal : abrt alrm bus chld cont fpe fromWord hup ill int kill pipe quit segv stop term toWord tstp ttin
Posix.Signal : ttou usr1 usr2
Posix.SysDB.Group : gid members name
Posix.SysDB.Passwd : gid home name shell uid
Posix.TTY : b0 b110 b1200 b134 b150 b1800 b19200 b200 b2400 b300 b38400 b4800 b50 b600 b75 b9600 compareSpeed
Posix.TTY : fieldsOf getcc getcflag getiflag getlflag getoflag speedToWord termios wordToSpeed
Posix.TTY.C : all allSet anySet clear clocal cread cs5 cs6 cs7 cs8 csize cstopb flags fromWord hupcl intersect
Posix.TTY.C : parenb parodd toWord
Posix.TTY.CF : getispeed getospeed setispeed setospeed
Posix.TTY.I : all allSet anySet brkint clear flags fromWord icrnl ignbrk igncr ignpar inlcr inpck intersect
Posix.TTY.I : istrip ixoff ixon parmrk toWord
Posix.TTY.L : all allSet anySet clear echo echoe echok echonl flags fromWord icanon iexten intersect isig
Posix.TTY.L : noflsh toWord tostop
Posix.TTY.O : all allSet anySet clear flags fromWord intersect opost toWord
Posix.TTY.TC : drain flow flush getattr getpgrp iflush ioff ioflush ion oflush ooff oon sadrain saflush sanow
Posix.TTY.TC : sendbreak setattr setpgrp
Posix.TTY.V : cc eof eol erase intr kill min nccs quit start stop sub susp time update
Random : fromString toString
Real : class compareReal fromDecimal toDecimal
SMLTime : scan
SMLofNJ : ANTIQUOTE QUOTE
SMLofNJ.Internals : clearSigTbl initSigTbl prHook resetSigTbl resetTimers
SMLofNJ.Internals.CleanUp : AtExit AtExportFn AtExportML AtInit AtInitFn addCleaner atAll clean removeCleaner
SMLofNJ.Internals.GC : getHeapSize getPageFaults
SMLofNJ.Internals.ProfControl : UNIT compileIndex current getQuantum getTimeArray getTimingMode majorGCIndex
SMLofNJ.Internals.ProfControl : minorGCIndex numPredefIndices otherIndex profMode profileOff profileOn reset
SMLofNJ.Internals.ProfControl : runTimeIndex spaceProfRegister spaceProfiling units
SMLofNJ.Internals.TDP : active_monitors active_plugins idk_entry_point idk_non_tail_call idk_tail_call mode
SMLofNJ.Internals.TDP : reserve reset with_monitors
SMLofNJ.SysInfo : BEOS MACOS OS2 UNIX UNKNOWN WIN32 getHeapSuffix
SMLofNJ.Weak : strong'
Socket : NO_RECVS NO_RECVS_OR_SENDS NO_SENDS
Socket.AF : fromString list toString
Socket.SOCK : dgram fromString list stream toString
TMS : delay input_tms mkstr_tms output_tms sort_tms tcf tlegal tleq tlt tsub
TMS.ModelTime : add cmp col fromInt fromIntInf fromString leq lt maketime mkstr model_time mult name null
TMS.ModelTime : null_str ready start_time sub time toReal toString
TextIO : getInstream getOutstream getPosOut mkInstream mkOutstream setInstream setOutstream
TextIO : setPosOut
TextIO.StreamIO : canInput closeIn closeOut endOfStream filePosIn filePosOut flushOut getBufferMode getPosOut
TextIO.StreamIO : getReader getWriter input input1 inputAll inputLine inputN mkInstream mkOutstream output
TextIO.StreamIO : output1 outputSubstr setBufferMode setPosOut
Time : scan
"""

ENGINE_STRUCTURES: frozenset[str] = frozenset(_STRUCTURES.split())
"""Structures of which nothing is known here."""

ENGINE_VALUES: frozenset[str] = frozenset(_VALUES.split())
"""Names of its top level."""


def _members() -> frozenset[str]:
    rows = (line.split(" : ", 1) for line in _MEMBERS.strip().splitlines())
    return frozenset(f"{structure}.{name}" for structure, names in rows for name in names.split())


ENGINE_MEMBERS: frozenset[str] = _members()
"""Qualified names of what the library has, in structures that are there otherwise."""

"""Functions of the SML/NJ library that are there in CPN Tools but not in pn2code, by structure.

A net that mentions one is accepted with a warning; a run stops where it is applied. Nothing is known of their types but
that they are functions. Lines that begin with `==` give the reason.
"""

from __future__ import annotations

ABSENT_TABLE = """
== other programs and the parts of the operating system behind them are not reached
Unix : W_EXITSTATUS W_SIGNALED W_STOPPED binInstreamOf binOutstreamOf execute executeInEnv exit fromStatus
Unix : kill reap streamsOf textInstreamOf textOutstreamOf
Posix.IO : close dup dup2 dupfd fsync getfd getfl getlk lseek mkBinReader mkBinWriter mkTextReader
Posix.IO : mkTextWriter pipe readArr readVec setfd setfl setlk setlkw writeArr writeVec
Posix.SysDB : getgrgid getgrnam getpwnam getpwuid
Posix.FileSys : access chdir chmod chown closedir creat createf devToWord fchmod fchown fdToIOD fdToWord
Posix.FileSys : fpathconf fstat ftruncate getcwd inoToWord iodToFD link lstat mkdir mkfifo opendir openf
Posix.FileSys : pathconf readdir readlink rename rewinddir rmdir stat symlink umask unlink utime wordToDev
Posix.FileSys : wordToFD wordToIno
Posix.ProcEnv : ctermid environ getegid getenv geteuid getgid getgroups getlogin getpgrp getpid getppid getuid
Posix.ProcEnv : gidToWord isatty setgid setpgid setsid setuid sysconf time times ttyname uidToWord uname
Posix.ProcEnv : wordToGid wordToUid
Posix.Process : K_GROUP K_PROC W_CHILD W_EXITSTATUS W_GROUP W_SIGNALED W_STOPPED alarm exec exece execp exit
Posix.Process : fork fromStatus kill pause pidToWord sleep wait waitpid waitpid_nh wordToPid
== sockets to other programs are not opened
Socket : accept acceptNB bind close connect connectNB familyOfAddr ioDesc listen recvArr recvArr' recvArrFrom
Socket : recvArrFrom' recvArrFromNB recvArrFromNB' recvArrNB recvArrNB' recvVec recvVec' recvVecFrom
Socket : recvVecFrom' recvVecFromNB recvVecFromNB' recvVecNB recvVecNB' sameAddr sameDesc select sendArr
Socket : sendArr' sendArrNB sendArrNB' sendArrTo sendArrTo' sendArrToNB sendArrToNB' sendVec sendVec'
Socket : sendVecNB sendVecNB' sendVecTo sendVecTo' sendVecToNB sendVecToNB' shutdown sockDesc
Socket.Ctl : getATMARK getBROADCAST getDEBUG getDONTROUTE getERROR getKEEPALIVE getLINGER getNREAD
Socket.Ctl : getOOBINLINE getPeerName getRCVBUF getREUSEADDR getSNDBUF getSockName getTYPE setBROADCAST
Socket.Ctl : setDEBUG setDONTROUTE setKEEPALIVE setLINGER setOOBINLINE setRCVBUF setREUSEADDR setSNDBUF
NetHostDB : addr addrType addrs aliases fromString getByAddr getByName getHostName name scan toString
INetSock : any fromAddr toAddr
INetSock.TCP : getNODELAY setNODELAY socket socket'
INetSock.UDP : socket socket'
== files of bytes are not read or written; those of text are, see `--files`
BinIO : canInput closeIn closeOut endOfStream flushOut getInstream getOutstream getPosOut input input1
BinIO : inputAll inputN lookahead mkInstream mkOutstream openAppend openIn openOut output output1 setInstream
BinIO : setOutstream setPosOut
OS.IO : compare hash infoToPollDesc isIn isOut isPri kind poll pollDesc pollIn pollOut pollPri pollToIODesc
OS.FileSys : compare fileId hash readLink setTime tmpName
== the clock of the computer is not read, so that runs can be repeated
Timer : checkCPUTimes checkGCTime
== pn2code does not have this part of the library
IEEEReal : fromString getRoundingMode scan setRoundingMode toString
SMLofNJ : exnHistory exportFn exportML getAllArgs getArgs getCmdName shiftArgs
SMLofNJ.Cont : callcc capture escape isolate throw
SMLofNJ.Internals.GC : doGC messages
SMLofNJ.IntervalTimer : getIntTimer setIntTimer tick
SMLofNJ.SysInfo : getHostArch getOSKind getOSName getOSVersion getTargetArch hasMultiprocessing
SMLofNJ.SysInfo : hasSoftwarePolling
SMLofNJ.Weak : strong weak weak'
"""

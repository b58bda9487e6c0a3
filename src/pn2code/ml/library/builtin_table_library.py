# ruff: noqa: E501  (tables: one entry a line)
"""The rest of the SML Basis library, and what exists in CPN Tools but cannot run here: tables as in `builtin_table`.

A line `== reason` flags the entries below it as unsupported: nets that use them are accepted with a warning, and a run
stops where one is applied. `==` alone ends that.
"""

LIBRARY_TABLE = """
-- numbers
Int.fmt : StringCvt.radix -> int -> string ; digits to a base, with ~ for minus
Int.scan : StringCvt.radix -> ('a -> (char * 'a) option) -> 'a -> (int * 'a) option ; reads a number from a stream
IntInf.fmt : StringCvt.radix -> IntInf.int -> string ; digits to a base, with ~ for minus
IntInf.scan : StringCvt.radix -> ('a -> (char * 'a) option) -> 'a -> (IntInf.int * 'a) option ; reads a number from a stream
IntInf.sameSign : IntInf.int * IntInf.int -> bool ; whether the signs are equal
IntInf.divMod : IntInf.int * IntInf.int -> IntInf.int * IntInf.int ; div and mod; raises Div
IntInf.quotRem : IntInf.int * IntInf.int -> IntInf.int * IntInf.int ; quot and rem; raises Div
IntInf.log2 : IntInf.int -> int ; binary logarithm, rounded down; raises Domain
IntInf.precision : int option ; NONE
IntInf.minInt : IntInf.int option ; NONE
IntInf.maxInt : IntInf.int option ; NONE
IntInf.orb : IntInf.int * IntInf.int -> IntInf.int ; bitwise or (two's complement)
IntInf.xorb : IntInf.int * IntInf.int -> IntInf.int ; bitwise exclusive or
IntInf.andb : IntInf.int * IntInf.int -> IntInf.int ; bitwise and
IntInf.notb : IntInf.int -> IntInf.int ; bitwise negation
IntInf.<< : IntInf.int * word -> IntInf.int ; shifted left
IntInf.~>> : IntInf.int * word -> IntInf.int ; shifted right, rounding down
Real.radix : int ; 2
Real.precision : int ; 53
Real.maxFinite : real ; the largest finite number
Real.minPos : real ; the smallest positive number
Real.minNormalPos : real ; the smallest positive normal number
Real.*+ : real * real * real -> real ; a * b + c
Real.*- : real * real * real -> real ; a * b - c
Real.?= : real * real -> bool ; equal, or one is not a number
Real.unordered : real * real -> bool ; whether one is not a number
Real.signBit : real -> bool ; whether the sign is minus (also of ~0.0)
Real.sameSign : real * real -> bool ; whether the sign bits are equal
Real.copySign : real * real -> real ; the first with the sign of the second
Real.isNormal : real -> bool ; neither zero, subnormal, infinite nor nan
Real.toManExp : real -> {man : real, exp : int} ; mantissa and exponent to base 2
Real.fromManExp : {man : real, exp : int} -> real ; the number from them
Real.split : real -> {whole : real, frac : real} ; whole part and fraction
Real.realMod : real -> real ; the fraction
Real.nextAfter : real * real -> real ; the next number in the direction of the second
Real.checkFloat : real -> real ; the same; raises Overflow for infinite, Div for nan
Real.toLargeInt : IEEEReal.rounding_mode -> real -> IntInf.int ; rounded
Real.toInt : IEEEReal.rounding_mode -> real -> int ; rounded; raises Overflow, Domain
Real.toLarge : real -> real ; the same
Real.fromLarge : IEEEReal.rounding_mode -> real -> real ; the same
Real.fmt : StringCvt.realfmt -> real -> string ; formatted; raises Size
Real.scan : ('a -> (char * 'a) option) -> 'a -> (real * 'a) option ; reads a number from a stream
Bool.scan : ('a -> (char * 'a) option) -> 'a -> (bool * 'a) option ; reads true or false from a stream

-- strings
String.maxSize : int ; 16777215
String.collate : (char * char -> order) -> string * string -> order ; lexicographic by another order
String.toString : string -> string ; escaped as in a literal
String.fromString : string -> string option ; reads a text with escapes up to what is not one
String.toCString : string -> string ; escaped as in a literal of C
String.fromCString : string -> string option ; reads a text with escapes of C
Char.minChar : char ; code 0
Char.maxChar : char ; code 255
Char.maxOrd : int ; 255
Char.contains : string -> char -> bool ; whether it is in the string
Char.notContains : string -> char -> bool ; whether it is not
Char.isAscii : char -> bool ; code below 128
Char.isCntrl : char -> bool ; a control character
Char.isGraph : char -> bool ; printable and no blank
Char.isPrint : char -> bool ; printable
Char.fromString : string -> char option ; the first character, perhaps an escape
Char.scan : ('a -> (char * 'a) option) -> 'a -> (char * 'a) option ; reads a character, perhaps an escape
Char.toCString : char -> string ; escaped as in a literal of C
Char.fromCString : string -> char option ; the first character, perhaps an escape of C
StringCvt.padLeft : char -> int -> string -> string ; at least so long
StringCvt.padRight : char -> int -> string -> string ; at least so long
StringCvt.skipWS : ('a -> (char * 'a) option) -> 'a -> 'a ; behind white space
StringCvt.dropl : (char -> bool) -> ('a -> (char * 'a) option) -> 'a -> 'a ; behind such characters
StringCvt.takel : (char -> bool) -> ('a -> (char * 'a) option) -> 'a -> string ; the first such characters
StringCvt.splitl : (char -> bool) -> ('a -> (char * 'a) option) -> 'a -> string * 'a ; both
StringCvt.scanString : ((int -> (char * int) option) -> int -> ('a * int) option) -> string -> 'a option ; scans a string
Substring.full : string -> substring ; all of it
Substring.all : string -> substring ; all of it
Substring.substring : string * int * int -> substring ; from, length; raises Subscript
Substring.extract : string * int * int option -> substring ; from, length or to the end; raises Subscript
Substring.slice : substring * int * int option -> substring ; a part of it; raises Subscript
Substring.string : substring -> string ; its text
Substring.base : substring -> string * int * int ; text around, from, length
Substring.size : substring -> int ; number of characters
Substring.isEmpty : substring -> bool ; whether there is none
Substring.sub : substring * int -> char ; character; raises Subscript
Substring.getc : substring -> (char * substring) option ; first and rest
Substring.first : substring -> char option ; first
Substring.triml : int -> substring -> substring ; without so many on the left
Substring.trimr : int -> substring -> substring ; without so many on the right
Substring.concat : substring list -> string ; joined
Substring.concatWith : string -> substring list -> string ; joined with a separator
Substring.explode : substring -> char list ; its characters
Substring.isPrefix : string -> substring -> bool ; whether it begins so
Substring.isSuffix : string -> substring -> bool ; whether it ends so
Substring.isSubstring : string -> substring -> bool ; whether it contains that
Substring.compare : substring * substring -> order ; lexicographic
Substring.collate : (char * char -> order) -> substring * substring -> order ; lexicographic by another order
Substring.splitl : (char -> bool) -> substring -> substring * substring ; the first such characters, the rest
Substring.splitr : (char -> bool) -> substring -> substring * substring ; the rest, the last such characters
Substring.splitAt : substring * int -> substring * substring ; the first n, the rest; raises Subscript
Substring.dropl : (char -> bool) -> substring -> substring ; without the first such characters
Substring.dropr : (char -> bool) -> substring -> substring ; without the last such characters
Substring.takel : (char -> bool) -> substring -> substring ; the first such characters
Substring.taker : (char -> bool) -> substring -> substring ; the last such characters
Substring.position : string -> substring -> substring * substring ; before and from the first occurrence on
Substring.span : substring * substring -> substring ; from the first's start to the second's end; raises Span
Substring.translate : (char -> string) -> substring -> string ; each character by a string
Substring.tokens : (char -> bool) -> substring -> substring list ; parts between separators, without empty ones
Substring.fields : (char -> bool) -> substring -> substring list ; parts between separators
Substring.app : (char -> unit) -> substring -> unit ; for its effect
Substring.foldl : (char * 'a -> 'a) -> 'a -> substring -> 'a ; folded from the left
Substring.foldr : (char * 'a -> 'a) -> 'a -> substring -> 'a ; folded from the right

-- lists, options
ListPair.zipEq : 'a list * 'b list -> ('a * 'b) list ; pairs; raises UnequalLengths
ListPair.mapEq : ('a * 'b -> 'c) -> 'a list * 'b list -> 'c list ; each pair; raises UnequalLengths
ListPair.appEq : ('a * 'b -> unit) -> 'a list * 'b list -> unit ; for its effect; raises UnequalLengths
ListPair.allEq : ('a * 'b -> bool) -> 'a list * 'b list -> bool ; whether all have it and the lengths are equal
ListPair.foldlEq : ('a * 'b * 'c -> 'c) -> 'c -> 'a list * 'b list -> 'c ; from the left; raises UnequalLengths
ListPair.foldrEq : ('a * 'b * 'c -> 'c) -> 'c -> 'a list * 'b list -> 'c ; from the right; raises UnequalLengths
Option.compose : ('a -> 'b) * ('c -> 'a option) -> 'c -> 'b option ; the first after the second, if any
Option.composePartial : ('a -> 'b option) * ('c -> 'a option) -> 'c -> 'b option ; the first after the second, if any

-- what CPN Tools has at top level besides
Misc.a_cmp : ('a * 'a -> bool) -> 'a * 'a -> order ; a three-way comparison from `less`
Misc.makelist : ('a -> string) -> 'a list -> string ; the text of a list, `[a,b]`
Misc.split : int * 'a list * 'a list -> 'a list * 'a list ; the rest behind n elements, and those before (in front: the third, reversed)
Misc.isSubstring : string -> string -> bool ; whether the second contains the first
Misc.basename : string -> string ; what follows the last `/` that is not at the end
Misc.time_of_day : unit -> real ; 0.0 here: runs can be repeated

-- vectors and arrays
Vector.maxLen : int ; 16777215
Vector.fromList : 'a list -> 'a vector ; the elements
Vector.tabulate : int * (int -> 'a) -> 'a vector ; f 0 .. f (n-1); raises Size
Vector.length : 'a vector -> int ; number of elements
Vector.sub : 'a vector * int -> 'a ; element, from 0; raises Subscript
Vector.update : 'a vector * int * 'a -> 'a vector ; a copy with another element; raises Subscript
Vector.concat : 'a vector list -> 'a vector ; joined
Vector.app : ('a -> unit) -> 'a vector -> unit ; for its effect
Vector.appi : (int * 'a -> unit) -> 'a vector -> unit ; for its effect, with the index
Vector.map : ('a -> 'b) -> 'a vector -> 'b vector ; each element
Vector.mapi : (int * 'a -> 'b) -> 'a vector -> 'b vector ; each element, with the index
Vector.foldl : ('a * 'b -> 'b) -> 'b -> 'a vector -> 'b ; folded from the left
Vector.foldr : ('a * 'b -> 'b) -> 'b -> 'a vector -> 'b ; folded from the right
Vector.foldli : (int * 'a * 'b -> 'b) -> 'b -> 'a vector -> 'b ; folded from the left, with the index
Vector.foldri : (int * 'a * 'b -> 'b) -> 'b -> 'a vector -> 'b ; folded from the right, with the index
Vector.find : ('a -> bool) -> 'a vector -> 'a option ; the first with the property
Vector.findi : (int * 'a -> bool) -> 'a vector -> (int * 'a) option ; the first with the property
Vector.exists : ('a -> bool) -> 'a vector -> bool ; whether one has the property
Vector.all : ('a -> bool) -> 'a vector -> bool ; whether all have the property
Vector.collate : ('a * 'a -> order) -> 'a vector * 'a vector -> order ; lexicographic
Array.maxLen : int ; 16777215
Array.array : int * 'a -> 'a array ; so many of it; raises Size
Array.fromList : 'a list -> 'a array ; the elements
Array.tabulate : int * (int -> 'a) -> 'a array ; f 0 .. f (n-1); raises Size
Array.length : 'a array -> int ; number of elements
Array.sub : 'a array * int -> 'a ; element, from 0; raises Subscript
Array.update : 'a array * int * 'a -> unit ; another element; raises Subscript
Array.vector : 'a array -> 'a vector ; the elements
Array.copy : {src : 'a array, dst : 'a array, di : int} -> unit ; copied from index di on; raises Subscript
Array.copyVec : {src : 'a vector, dst : 'a array, di : int} -> unit ; copied from index di on; raises Subscript
Array.app : ('a -> unit) -> 'a array -> unit ; for its effect
Array.appi : (int * 'a -> unit) -> 'a array -> unit ; for its effect, with the index
Array.modify : ('a -> 'a) -> 'a array -> unit ; each element
Array.modifyi : (int * 'a -> 'a) -> 'a array -> unit ; each element, with the index
Array.foldl : ('a * 'b -> 'b) -> 'b -> 'a array -> 'b ; folded from the left
Array.foldr : ('a * 'b -> 'b) -> 'b -> 'a array -> 'b ; folded from the right
Array.foldli : (int * 'a * 'b -> 'b) -> 'b -> 'a array -> 'b ; folded from the left, with the index
Array.foldri : (int * 'a * 'b -> 'b) -> 'b -> 'a array -> 'b ; folded from the right, with the index
Array.find : ('a -> bool) -> 'a array -> 'a option ; the first with the property
Array.findi : (int * 'a -> bool) -> 'a array -> (int * 'a) option ; the first with the property
Array.exists : ('a -> bool) -> 'a array -> bool ; whether one has the property
Array.all : ('a -> bool) -> 'a array -> bool ; whether all have the property
Array.collate : ('a * 'a -> order) -> 'a array * 'a array -> order ; lexicographic

-- files: only below the folder that the user allows; without one nothing is there and what is written is dropped
TextIO.openIn : string -> TextIO.instream ; opens a file for reading; raises Io
TextIO.openOut : string -> TextIO.outstream ; opens a file for writing, empty; raises Io
TextIO.openAppend : string -> TextIO.outstream ; opens a file for writing at its end; raises Io
TextIO.openString : string -> TextIO.instream ; reads from a text
TextIO.closeIn : TextIO.instream -> unit ; closes
TextIO.closeOut : TextIO.outstream -> unit ; closes
TextIO.input : TextIO.instream -> string ; some characters; "" at the end
TextIO.input1 : TextIO.instream -> char option ; a character
TextIO.inputN : TextIO.instream * int -> string ; so many characters, or all there are
TextIO.inputLine : TextIO.instream -> string option ; a line with its line end
TextIO.inputAll : TextIO.instream -> string ; all that is left
TextIO.canInput : TextIO.instream * int -> int option ; how many characters are there
TextIO.lookahead : TextIO.instream -> char option ; the next character, which stays
TextIO.scanStream : ((int -> (char * int) option) -> int -> ('a * int) option) -> TextIO.instream -> 'a option ; scans
TextIO.endOfStream : TextIO.instream -> bool ; whether all is read
TextIO.output : TextIO.outstream * string -> unit ; writes; raises Io when closed
TextIO.output1 : TextIO.outstream * char -> unit ; writes a character
TextIO.outputSubstr : TextIO.outstream * substring -> unit ; writes
TextIO.flushOut : TextIO.outstream -> unit ; writes what is buffered
TextIO.stdIn : TextIO.instream ; empty
TextIO.stdOut : TextIO.outstream ; the run's output
TextIO.stdErr : TextIO.outstream ; the run's output
OS.Path.parentArc : string ; ..
OS.Path.currentArc : string ; .
OS.Path.fromString : string -> {isAbs : bool, vol : string, arcs : string list} ; parts of a path
OS.Path.toString : {isAbs : bool, vol : string, arcs : string list} -> string ; a path; raises Path
OS.Path.validVolume : {isAbs : bool, vol : string} -> bool ; whether there is no volume
OS.Path.getVolume : string -> string ; none
OS.Path.getParent : string -> string ; the folder around
OS.Path.splitDirFile : string -> {dir : string, file : string} ; folder and file
OS.Path.joinDirFile : {dir : string, file : string} -> string ; the reverse
OS.Path.dir : string -> string ; folder
OS.Path.file : string -> string ; file
OS.Path.splitBaseExt : string -> {base : string, ext : string option} ; path without extension, extension
OS.Path.joinBaseExt : {base : string, ext : string option} -> string ; the reverse
OS.Path.base : string -> string ; path without extension
OS.Path.ext : string -> string option ; extension
OS.Path.mkCanonical : string -> string ; without needless parts
OS.Path.isCanonical : string -> bool ; whether there are none
OS.Path.mkAbsolute : {path : string, relativeTo : string} -> string ; absolute
OS.Path.mkRelative : {path : string, relativeTo : string} -> string ; relative; raises Path
OS.Path.isAbsolute : string -> bool ; whether it begins at the root
OS.Path.isRelative : string -> bool ; whether it does not
OS.Path.isRoot : string -> bool ; whether it is the root
OS.Path.concat : string * string -> string ; the second below the first; raises Path when it is absolute
OS.Path.fromUnixPath : string -> string ; the same
OS.Path.toUnixPath : string -> string ; the same
OS.FileSys.getDir : unit -> string ; the present folder: / is the folder that the user allows
OS.FileSys.chDir : string -> unit ; another present folder; raises SysErr
OS.FileSys.mkDir : string -> unit ; makes a folder; raises SysErr
OS.FileSys.rmDir : string -> unit ; removes an empty folder; raises SysErr
OS.FileSys.isDir : string -> bool ; whether it is a folder; raises SysErr
OS.FileSys.isLink : string -> bool ; whether it is a link; raises SysErr
OS.FileSys.fileSize : string -> int ; bytes; raises SysErr
OS.FileSys.remove : string -> unit ; removes a file; raises SysErr
OS.FileSys.rename : {old : string, new : string} -> unit ; another name; raises SysErr
OS.FileSys.access : string * OS.FileSys.access_mode list -> bool ; whether it is there and can be used so
OS.FileSys.fullPath : string -> string ; absolute; raises SysErr
OS.FileSys.realPath : string -> string ; absolute, or relative for a relative one; raises SysErr
OS.FileSys.openDir : string -> OS.FileSys.dirstream ; the names in a folder; raises SysErr
OS.FileSys.readDir : OS.FileSys.dirstream -> string option ; the next name
OS.FileSys.rewindDir : OS.FileSys.dirstream -> unit ; from the start again
OS.FileSys.closeDir : OS.FileSys.dirstream -> unit ; closes
OS.Process.success : OS.Process.status ; all is well
OS.Process.failure : OS.Process.status ; it is not
OS.Process.isSuccess : OS.Process.status -> bool ; whether all is well
OS.Process.getEnv : string -> string option ; NONE
OS.Process.sleep : Time.time -> unit ; does nothing
OS.errorMsg : OS.syserror -> string ; what was wrong
OS.errorName : OS.syserror -> string ; its name
CommandLine.name : unit -> string ; cpn
CommandLine.arguments : unit -> string list ; none
Output.getSimOutputDir : unit -> string ; output
Output.getModelDir : unit -> string ; .
Output.getTopOutputDir : unit -> string ; output
Output.getRepOutputDir : unit -> string ; output
Output.initSimOutputDir : unit -> unit ; makes the folder `output`
Output.initTopOutputDir : unit -> unit ; makes the folder `output`
Output.initRepOutputDir : unit -> unit ; makes the folder `output`
Output.myConcat : string * string -> string ; OS.Path.concat
CPN'PerfReport.selectUntimedStats : 'a -> unit ; nothing: which statistics a report of CPN Tools shows
CPN'PerfReport.selectTimedStats : 'a -> unit ; nothing: which statistics a report of CPN Tools shows

-- wall clocks stand still here, so that runs can be repeated
Time.zeroTime : Time.time ; no time
Time.now : unit -> Time.time ; zeroTime here: runs can be repeated
Time.fromReal : real -> Time.time ; from seconds; raises Time
Time.toReal : Time.time -> real ; in seconds
Time.fromSeconds : IntInf.int -> Time.time ; from seconds
Time.fromMilliseconds : IntInf.int -> Time.time ; from milliseconds
Time.fromMicroseconds : IntInf.int -> Time.time ; from microseconds
Time.fromNanoseconds : IntInf.int -> Time.time ; from nanoseconds
Time.toSeconds : Time.time -> IntInf.int ; in seconds
Time.toMilliseconds : Time.time -> IntInf.int ; in milliseconds
Time.toMicroseconds : Time.time -> IntInf.int ; in microseconds
Time.toNanoseconds : Time.time -> IntInf.int ; in nanoseconds
Time.+ : Time.time * Time.time -> Time.time ; sum
Time.- : Time.time * Time.time -> Time.time ; difference
Time.< : Time.time * Time.time -> bool ; earlier
Time.<= : Time.time * Time.time -> bool ; not later
Time.> : Time.time * Time.time -> bool ; later
Time.>= : Time.time * Time.time -> bool ; not earlier
Time.compare : Time.time * Time.time -> order ; three-way comparison
Time.toString : Time.time -> string ; seconds with three decimals
Time.fmt : int -> Time.time -> string ; seconds with so many decimals
Time.fromString : string -> Time.time option ; from seconds
Timer.startRealTimer : unit -> Timer.real_timer ; a timer
Timer.totalRealTimer : unit -> Timer.real_timer ; a timer
Timer.checkRealTimer : Timer.real_timer -> Time.time ; zeroTime here
Timer.startCPUTimer : unit -> Timer.cpu_timer ; a timer
Timer.totalCPUTimer : unit -> Timer.cpu_timer ; a timer
Timer.checkCPUTimer : Timer.cpu_timer -> {usr : Time.time, sys : Time.time} ; zeroTime here

-- bytes, and what CPN Tools sends
Byte.byteToChar : Word8.word -> char ; the character of that code
Byte.charToByte : char -> Word8.word ; its code
Byte.bytesToString : Word8Vector.vector -> string ; the characters
Byte.stringToBytes : string -> Word8Vector.vector ; the codes
Word8Vector.maxLen : int ; 16777215
Word8Vector.length : Word8Vector.vector -> int ; number of bytes
Word8Vector.sub : Word8Vector.vector * int -> Word8.word ; byte; raises Subscript
Word8Vector.fromList : Word8.word list -> Word8Vector.vector ; the bytes
Word8Vector.concat : Word8Vector.vector list -> Word8Vector.vector ; joined
ConnManagementLayer.stringEncode : string -> Word8Vector.vector ; the codes of the characters
ConnManagementLayer.stringDecode : Word8Vector.vector -> string ; the characters
ConnManagementLayer.integerEncode : int -> Word8Vector.vector ; the characters of its text
ConnManagementLayer.integerDecode : Word8Vector.vector -> int ; the reverse

-- the SML/NJ library's generator; here all draw from the run's own stream
Random.rand : int * int -> Random.rand ; a generator
Random.randInt : Random.rand -> int ; any int
Random.randNat : Random.rand -> int ; an int that is not negative
Random.randReal : Random.rand -> real ; 0 <= x < 1
Random.randRange : int * int -> Random.rand -> int ; between the two, inclusive

== sockets to other programs are opened by `simulate --sockets` only
ConnManagementLayer.openConnection : string * string * int -> unit ; connects: name, host, port
ConnManagementLayer.acceptConnection : string * int -> unit ; waits for a connection: name, port
ConnManagementLayer.closeConnection : string -> unit ; closes a connection
ConnManagementLayer.send : string * 'a * ('a -> Word8Vector.vector) -> unit ; sends a value
ConnManagementLayer.receive : string * (Word8Vector.vector -> 'a) -> 'a ; waits for a value
ConnManagementLayer.canreceive : string -> bool ; whether there is something to receive

== other programs are not run, and a net does not end the run
OS.Process.system : string -> OS.Process.status ; runs a command
OS.Process.exit : OS.Process.status -> 'a ; ends the run
OS.Process.terminate : OS.Process.status -> 'a ; ends the run
OS.Process.atExit : (unit -> unit) -> unit ; for its effect at the end

== a run is one simulation; `simulate --replications N` makes several
CPN'Replications.nreplications : int -> unit ; so many simulations

== the clock of the computer is not read, so that runs can be repeated
OS.FileSys.modTime : string -> Time.time ; when a file was changed
==
"""

"""The table of built-in functions: `name : type ; meaning`, one a line (read by `builtins`)."""

TABLE = """
-- polymorphic equality
= : ''a * ''a -> bool ; structural equality (lists in order; reals by value, NaN is not equal to itself)
<> : ''a * ''a -> bool ; not equal

-- int: checked, 31 bits as in CPN Tools; everything beyond raises Overflow
Int.+ : int * int -> int ; sum
Int.- : int * int -> int ; difference
Int.* : int * int -> int ; product
Int.~ : int -> int ; negation
Int.abs : int -> int ; absolute value
Int.div : int * int -> int ; quotient rounded down; raises Div
Int.mod : int * int -> int ; remainder with the sign of the divisor; raises Div
Int.quot : int * int -> int ; quotient rounded towards zero; raises Div
Int.rem : int * int -> int ; remainder with the sign of the dividend; raises Div
Int.< : int * int -> bool ; less
Int.<= : int * int -> bool ; less or equal
Int.> : int * int -> bool ; greater
Int.>= : int * int -> bool ; greater or equal
Int.min : int * int -> int ; the smaller
Int.max : int * int -> int ; the larger
Int.sign : int -> int ; ~1, 0 or 1
Int.sameSign : int * int -> bool ; whether both are below zero, or none is
Int.compare : int * int -> order ; three-way comparison
Int.toString : int -> string ; decimal, with ~ for minus
Int.fromString : string -> int option ; after blanks, an optional sign and digits; the rest is ignored
Int.toInt : int -> int ; the same
Int.fromInt : int -> int ; the same
Int.toLarge : int -> IntInf.int ; the same number
Int.fromLarge : IntInf.int -> int ; the same number; raises Overflow
Int.maxInt : int option ; SOME 1073741823
Int.minInt : int option ; SOME ~1073741824
Int.precision : int option ; SOME 31

-- IntInf.int: unbounded
IntInf.+ : IntInf.int * IntInf.int -> IntInf.int ; sum
IntInf.- : IntInf.int * IntInf.int -> IntInf.int ; difference
IntInf.* : IntInf.int * IntInf.int -> IntInf.int ; product
IntInf.~ : IntInf.int -> IntInf.int ; negation
IntInf.abs : IntInf.int -> IntInf.int ; absolute value
IntInf.div : IntInf.int * IntInf.int -> IntInf.int ; quotient rounded down; raises Div
IntInf.mod : IntInf.int * IntInf.int -> IntInf.int ; remainder with the sign of the divisor; raises Div
IntInf.quot : IntInf.int * IntInf.int -> IntInf.int ; quotient rounded towards zero; raises Div
IntInf.rem : IntInf.int * IntInf.int -> IntInf.int ; remainder with the sign of the dividend; raises Div
IntInf.< : IntInf.int * IntInf.int -> bool ; less
IntInf.<= : IntInf.int * IntInf.int -> bool ; less or equal
IntInf.> : IntInf.int * IntInf.int -> bool ; greater
IntInf.>= : IntInf.int * IntInf.int -> bool ; greater or equal
IntInf.min : IntInf.int * IntInf.int -> IntInf.int ; the smaller
IntInf.max : IntInf.int * IntInf.int -> IntInf.int ; the larger
IntInf.sign : IntInf.int -> int ; ~1, 0 or 1
IntInf.compare : IntInf.int * IntInf.int -> order ; three-way comparison
IntInf.pow : IntInf.int * int -> IntInf.int ; power
IntInf.toString : IntInf.int -> string ; decimal, with ~ for minus
IntInf.fromString : string -> IntInf.int option ; as Int.fromString
IntInf.toInt : IntInf.int -> int ; the same number; raises Overflow
IntInf.fromInt : int -> IntInf.int ; the same number
IntInf.toLarge : IntInf.int -> IntInf.int ; the same
IntInf.fromLarge : IntInf.int -> IntInf.int ; the same

-- real: IEEE double
Real.+ : real * real -> real ; sum
Real.- : real * real -> real ; difference
Real.* : real * real -> real ; product
Real./ : real * real -> real ; quotient (by zero: inf or nan, no exception)
Real.~ : real -> real ; negation
Real.abs : real -> real ; absolute value
Real.< : real * real -> bool ; less
Real.<= : real * real -> bool ; less or equal
Real.> : real * real -> bool ; greater
Real.>= : real * real -> bool ; greater or equal
Real.== : real * real -> bool ; equal
Real.!= : real * real -> bool ; not equal
Real.min : real * real -> real ; the smaller
Real.max : real * real -> real ; the larger
Real.sign : real -> int ; ~1, 0 or 1; raises Domain for nan
Real.compare : real * real -> order ; three-way comparison
Real.rem : real * real -> real ; remainder, sign of the dividend
Real.fromInt : int -> real ; the same number
Real.fromLargeInt : IntInf.int -> real ; nearest real
Real.floor : real -> int ; rounded down; raises Overflow, Domain
Real.ceil : real -> int ; rounded up
Real.round : real -> int ; nearest, half to even
Real.trunc : real -> int ; rounded towards zero
Real.realFloor : real -> real ; rounded down
Real.realCeil : real -> real ; rounded up
Real.realRound : real -> real ; nearest, half to even
Real.realTrunc : real -> real ; rounded towards zero
Real.isNan : real -> bool ; not a number
Real.isFinite : real -> bool ; neither infinite nor nan
Real.posInf : real ; positive infinity
Real.negInf : real ; negative infinity
Real.toString : real -> string ; 12 significant digits, SML form: 0.333333333333, 1E~05, ~1.5, 2.0
Real.fromString : string -> real option ; after blanks, a number; the rest is ignored

Math.pi : real ; 3.14159265358979...
Math.e : real ; 2.71828182845904...
Math.sqrt : real -> real ; square root
Math.sin : real -> real ; sine (radians)
Math.cos : real -> real ; cosine
Math.tan : real -> real ; tangent
Math.asin : real -> real ; arc sine
Math.acos : real -> real ; arc cosine
Math.atan : real -> real ; arc tangent
Math.atan2 : real * real -> real ; angle of the point (x, y), given (y, x)
Math.exp : real -> real ; e to the power
Math.pow : real * real -> real ; power
Math.ln : real -> real ; natural logarithm
Math.log10 : real -> real ; decimal logarithm
Math.sinh : real -> real ; hyperbolic sine
Math.cosh : real -> real ; hyperbolic cosine
Math.tanh : real -> real ; hyperbolic tangent

-- bool, references, general
Bool.not : bool -> bool ; negation
Bool.toString : bool -> string ; true or false
Bool.fromString : string -> bool option ; after blanks, true or false
Ref.ref : 'a -> 'a ref ; a new reference
Ref.! : 'a ref -> 'a ; contents
Ref.:= : 'a ref * 'a -> unit ; assignment
Ref.+= : int ref * int -> unit ; add to the contents
Ref.-= : int ref * int -> unit ; subtract from the contents
Ref.*= : int ref * int -> unit ; multiply the contents
Ref.::= : 'a list ref * 'a -> unit ; put in front of the contents
Ref.inc : int ref -> unit ; add one
Ref.dec : int ref -> unit ; subtract one
General.o : ('b -> 'c) * ('a -> 'b) -> 'a -> 'c ; composition
General.before : 'a * unit -> 'a ; the first operand
General.ignore : 'a -> unit ; the value is thrown away
General.exnName : exn -> string ; name of the exception
General.exnMessage : exn -> string ; text of the exception
TextIO.print : string -> unit ; writes to the standard output

-- string and char: 8-bit characters
String.^ : string * string -> string ; concatenation
String.size : string -> int ; number of characters
String.sub : string * int -> char ; character, from 0; raises Subscript
String.substring : string * int * int -> string ; from, length; raises Subscript
String.extract : string * int * int option -> string ; from, length or to the end; raises Subscript
String.concat : string list -> string ; concatenation
String.concatWith : string -> string list -> string ; with a separator
String.str : char -> string ; of one character
String.explode : string -> char list ; the characters
String.implode : char list -> string ; from characters
String.map : (char -> char) -> string -> string ; each character
String.translate : (char -> string) -> string -> string ; each character by a string
String.tokens : (char -> bool) -> string -> string list ; parts between separators, without empty ones
String.fields : (char -> bool) -> string -> string list ; parts between separators
String.isPrefix : string -> string -> bool ; whether the second begins with the first
String.isSuffix : string -> string -> bool ; whether the second ends with the first
String.isSubstring : string -> string -> bool ; whether the second, which is not empty, contains the first
String.compare : string * string -> order ; lexicographic
String.< : string * string -> bool ; lexicographic
String.<= : string * string -> bool ; lexicographic
String.> : string * string -> bool ; lexicographic
String.>= : string * string -> bool ; lexicographic
Char.ord : char -> int ; code
Char.chr : int -> char ; character of a code 0..255; raises Chr
Char.toString : char -> string ; escaped as in a literal
Char.compare : char * char -> order ; by code
Char.< : char * char -> bool ; by code
Char.<= : char * char -> bool ; by code
Char.> : char * char -> bool ; by code
Char.>= : char * char -> bool ; by code
Char.succ : char -> char ; next; raises Chr
Char.pred : char -> char ; previous; raises Chr
Char.isDigit : char -> bool ; 0-9
Char.isAlpha : char -> bool ; a letter (ASCII)
Char.isAlphaNum : char -> bool ; a letter or digit
Char.isSpace : char -> bool ; white space
Char.isUpper : char -> bool ; A-Z
Char.isLower : char -> bool ; a-z
Char.isPunct : char -> bool ; printable, neither letter nor digit nor blank
Char.isHexDigit : char -> bool ; 0-9, a-f, A-F
Char.toUpper : char -> char ; upper case
Char.toLower : char -> char ; lower case

-- option
Option.valOf : 'a option -> 'a ; the value; raises Option
Option.isSome : 'a option -> bool ; whether there is a value
Option.getOpt : 'a option * 'a -> 'a ; the value or a default
Option.map : ('a -> 'b) -> 'a option -> 'b option ; the function's value, if any
Option.mapPartial : ('a -> 'b option) -> 'a option -> 'b option ; the function's option, if any
Option.filter : ('a -> bool) -> 'a -> 'a option ; SOME of it if the predicate holds
Option.join : 'a option option -> 'a option ; one level less
Option.app : ('a -> unit) -> 'a option -> unit ; for its effect

-- list: of the SML library
List.@ : 'a list * 'a list -> 'a list ; append (written ^^)
List.hd : 'a list -> 'a ; first; raises Empty
List.tl : 'a list -> 'a list ; all but the first; raises Empty
List.last : 'a list -> 'a ; last; raises Empty
List.null : 'a list -> bool ; whether empty
List.length : 'a list -> int ; number of elements
List.rev : 'a list -> 'a list ; reversed
List.revAppend : 'a list * 'a list -> 'a list ; the first reversed, then the second
List.nth : 'a list * int -> 'a ; element, from 0; raises Subscript
List.take : 'a list * int -> 'a list ; the first n; raises Subscript
List.drop : 'a list * int -> 'a list ; all but the first n; raises Subscript
List.concat : 'a list list -> 'a list ; appended
List.map : ('a -> 'b) -> 'a list -> 'b list ; each element, from left to right
List.mapPartial : ('a -> 'b option) -> 'a list -> 'b list ; values of those that have one
List.app : ('a -> unit) -> 'a list -> unit ; for its effect, from left to right
List.filter : ('a -> bool) -> 'a list -> 'a list ; those with the property
List.partition : ('a -> bool) -> 'a list -> 'a list * 'a list ; those with and those without
List.find : ('a -> bool) -> 'a list -> 'a option ; the first with the property
List.exists : ('a -> bool) -> 'a list -> bool ; whether one has the property
List.all : ('a -> bool) -> 'a list -> bool ; whether all have the property
List.foldl : ('a * 'b -> 'b) -> 'b -> 'a list -> 'b ; folded from the left
List.foldr : ('a * 'b -> 'b) -> 'b -> 'a list -> 'b ; folded from the right
List.tabulate : int * (int -> 'a) -> 'a list ; f 0 .. f (n-1); raises Size
List.getItem : 'a list -> ('a * 'a list) option ; first and rest, if any
List.collate : ('a * 'a -> order) -> 'a list * 'a list -> order ; lexicographic

-- list: of CPN Tools
List.mem : ''a list -> ''a -> bool ; whether it is an element
List.remdupl : ''a list -> ''a list ; without duplicates; the last occurrence stays
List.rm : ''a -> ''a list -> ''a list ; without its first occurrence
List.rmall : ''a -> ''a list -> ''a list ; without all its occurrences
List.pos : ''a -> ''a list -> int ; position; raises Match
List.contains : ''a list -> ''a list -> bool ; whether all elements of the second are in the first
List.contains_all : ''a list -> ''a list -> bool ; the same, with multiplicities
List.intersect : ''a list -> ''a list -> ''a list ; multi-set intersection
List.union : 'a list -> 'a list -> 'a list ; append
List.listsub : ''a list -> ''a list -> ''a list ; the first without the second; raises Subtract
List.ins : 'a list -> 'a -> 'a list ; appended at the end
List.ins_new : ''a list -> ''a -> ''a list ; appended at the end unless it is there
List.sort : ('a * 'a -> bool) -> 'a list -> 'a list ; sorted by `less`
List.unique_sort : ('a * 'a -> bool) -> 'a list -> 'a list ; sorted by `less`, one of each
List.fmap : ('a -> 'b list) -> 'a list -> 'b list ; mapped and appended
List.mapfilter : ('a -> bool * 'b) ref * 'a list -> 'b list ; the second where the first is true
List.predlist : ('a -> bool) -> 'a list -> bool ; whether one has the property
ListPair.zip : 'a list * 'b list -> ('a * 'b) list ; pairs, as long as the shorter
ListPair.unzip : ('a * 'b) list -> 'a list * 'b list ; the two lists
ListPair.map : ('a * 'b -> 'c) -> 'a list * 'b list -> 'c list ; each pair, as long as the shorter
ListPair.app : ('a * 'b -> unit) -> 'a list * 'b list -> unit ; for its effect
ListPair.all : ('a * 'b -> bool) -> 'a list * 'b list -> bool ; whether all pairs have the property
ListPair.exists : ('a * 'b -> bool) -> 'a list * 'b list -> bool ; whether one pair has the property
ListPair.foldl : ('a * 'b * 'c -> 'c) -> 'c -> 'a list * 'b list -> 'c ; folded from the left
ListPair.foldr : ('a * 'b * 'c -> 'c) -> 'c -> 'a list * 'b list -> 'c ; folded from the right

-- multi-sets: lists in which order does not count
Ms.` : int * 'a -> 'a ms ; n of it; none when n <= 0
Ms.++ : 'a ms * 'a ms -> 'a ms ; sum
Ms.-- : ''a ms * ''a ms -> ''a ms ; difference; raises Subtract when the second is not contained
Ms.** : int * 'a ms -> 'a ms ; n times; empty when n <= 0
Ms.% : bool list * 'a -> 'a ms ; one of it if all are true, else empty
Ms.// : bool list * 'a ms -> 'a ms ; the multi-set if all are true, else empty
Ms.== : ''a ms * ''a ms -> bool ; equal as multi-sets
Ms.!= : ''a ms * ''a ms -> bool ; not equal as multi-sets
Ms.<< : ''a ms * ''a ms -> bool ; contained and not equal
Ms.<<= : ''a ms * ''a ms -> bool ; contained
Ms.>> : ''a ms * ''a ms -> bool ; contains and is not equal
Ms.>>= : ''a ms * ''a ms -> bool ; contains
Ms.cf : ''a * ''a ms -> int ; coefficient
Ms.size : 'a ms -> int ; number of elements
Ms.random : 'a ms -> 'a ; one of them, uniformly; raises Empty
Ms.ext_col : ('a -> 'b) -> 'a ms -> 'b ms ; each element
Ms.ext_ms : ('a -> 'b ms) -> 'a ms -> 'b ms ; each element, summed
Ms.filter : ('a -> bool) -> 'a ms -> 'a ms ; those with the property
Ms.ms_to_col : 'a ms -> 'a ; the only element; raises no_singleton
Ms.ms_to_list : 'a ms -> 'a list ; the elements
Ms.list_to_ms : 'a list -> 'a ms ; the elements
Ms.sort_ms : ('a * 'a -> bool) -> 'a ms -> 'a ms ; sorted by `less`
Ms.legal_ms : ('a -> bool) -> 'a ms -> bool ; whether all are legal
Ms.mkstr_ms : ('a -> string) * ('a * 'a -> bool) -> 'a ms -> string ; its text, given those of the elements

-- time
Time.@ : 'a * time -> 'a timed ; a token with an absolute time stamp
Time.@+ : 'a ms * int -> 'a tms ; stamps: model time + delay
Time.@++ : 'a ms * time -> 'a tms ; stamps: model time + delay
Time.token@+ : 'a * int -> 'a timed ; stamp: model time + delay (an inscription `v @+ d` that is one token)
Time.token@++ : 'a * time -> 'a timed ; stamp: model time + delay
Time.+++ : 'a tms * 'a tms -> 'a tms ; sum
Time.ms : 'a tms -> 'a ms ; without the stamps
Time.time : unit -> time ; model time
Time.step : unit -> IntInf.int ; number of steps so far
ModelTime.fromInt : int -> time ; the same number
ModelTime.fromIntInf : IntInf.int -> time ; the same number
ModelTime.fromString : string -> time option ; as IntInf.fromString or Real.fromString
ModelTime.toString : time -> string ; as IntInf.toString or Real.toString
ModelTime.toReal : time -> real ; nearest real
ModelTime.maketime : string -> time ; as fromString; raises an exception when it is not a time
ModelTime.add : time * time -> time ; sum
ModelTime.sub : time * time -> time ; difference
ModelTime.mult : time * time -> time ; product
ModelTime.lt : time * time -> bool ; less
ModelTime.leq : time * time -> bool ; less or equal
ModelTime.cmp : time * time -> order ; three-way comparison

-- random numbers; parameters out of range raise an exception
Random.bernoulli : real -> int ; 1 with this probability, else 0
Random.binomial : int * real -> int ; number of successes
Random.uniform : real * real -> real ; between the two
Random.discrete : int * int -> int ; between the two, inclusive
Random.normal : real * real -> real ; mean, variance
Random.exponential : real -> real ; rate
Random.poisson : real -> int ; mean
Random.erlang : int * real -> real ; order, rate
Random.chisq : int -> real ; degrees of freedom
Random.student : int -> real ; degrees of freedom
Random.gamma : real * real -> real ; shape, rate
Random.beta : real * real -> real ; the two shapes
Random.weibull : real * real -> real ; shape, scale
Random.rayleigh : real -> real ; scale
"""

COLSET_TABLE = """
-- `cs` is the colour set's type; set_<field>, of_<constructor> and mult have types made from the colour set
base : cs ; some value of the colour set
all : unit -> cs ms ; every value, in order; raises CPN'Error for a colour set without bounds
size : unit -> int ; number of values; raises CPN'Error likewise
ord : cs -> int ; position in the order, from 0; raises CPN'Error likewise
col : int -> cs ; value at a position; raises CPN'Error
ran : unit -> cs ; some value, at random
lt : cs * cs -> bool ; the colour set's order
cmp : cs * cs -> order ; the colour set's order
legal : cs -> bool ; whether it is within the colour set's bounds
illegal_msg : cs -> string ; what is wrong with it
mkstr : cs -> string ; as CPN Tools prints it
mkstr_ms : cs ms -> string ; as CPN Tools prints a multi-set
input : TextIO.instream -> cs ; reads a value as `output` writes it; raises CPN'Error
output : TextIO.outstream * cs -> unit ; writes a value, one a line
input_ms : TextIO.instream -> cs ms ; reads a multi-set as `output_ms` writes it; raises CPN'Error
output_ms : TextIO.outstream * cs ms -> unit ; writes a multi-set
timed.base : cs timed ; in CS'timed, of a timed colour set: some token
timed.all : unit -> cs tms ; raises CPN'Error, as the next ones: stamps have no bounds
timed.size : unit -> int ; raises CPN'Error
timed.ord : cs timed -> int ; raises CPN'Error
timed.col : int -> cs timed ; raises CPN'Error
timed.ran : unit -> cs timed ; raises CPN'Error
timed.lt : cs timed * cs timed -> bool ; by colour, of one colour the later first
timed.cmp : cs timed * cs timed -> order ; by colour, of one colour the later first
timed.legal : cs timed -> bool ; whether the colour is legal
timed.illegal_msg : cs timed -> string ; what is wrong with the colour
timed.mkstr : cs timed -> string ; as CPN Tools prints a token, `v@7`
timed.mkstr_ms : cs tms -> string ; as CPN Tools prints a timed multi-set
timed.input : TextIO.instream -> cs timed ; reads a token
timed.output : TextIO.outstream * cs timed -> unit ; writes a token
timed.input_ms : TextIO.instream -> cs tms ; reads a timed multi-set
timed.output_ms : TextIO.outstream * cs tms -> unit ; writes a timed multi-set
mult : cs ; PRODUCT, RECORD: all combinations of the elements of multi-sets
set : cs ; set_<field>: PRODUCT, RECORD: a copy with another value of a component: `name` is "Colset.set_<label>"
of : cs ; of_<constructor>: UNION: whether the value is made by it: `name` is "Colset.of_<name>"
"""

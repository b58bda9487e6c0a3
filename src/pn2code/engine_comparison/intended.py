# ruff: noqa: E501 - a text
"""Where pn2code does not follow the engine of CPN Tools, and why: the part of the report that is written by hand."""

TEXT = """\
Inscriptions and expressions also differ in the following, each on purpose:

* **A constant inside a list, a nested tuple or a union in an input inscription** (`four :: x :: nil`): the engine rebinds the name
  and then ends with `Subtract`; here the constant is compared, as at the top of a tuple.
* **A real constant in an input inscription**: the engine cannot compile it; here it is compared. In `fun`, `case`, `fn`, `val` it is refused, as in SML.
* **`x as pattern` on an arc** is a syntax error in the engine; here it is accepted, with a warning.
* **A priority below zero** is accepted by the engine's check, but its simulator cannot start; here it is accepted, with a warning.
* **`intinf with 1..3`** is refused by the engine, which expects bounds of type `int`; here it is accepted, with a warning.
* **An `ml` declaration that is empty, or only a comment**, is refused by the engine; here it gives a warning.
* **A negative zero** makes a state of its own: the two zeros are equal, and one token of a place, but an inscription can tell them apart
  (`1.0 / x`, `Real.toString x`), so that markings which differ in the sign are two nodes. The engine has one for both. `Math.atan2`, `asin`, `atan`,
  `sinh` and `tanh` heed the signs of zeros; in the engine `Math.atan 0.0` is always `~0.0`, and of the others none is.
* **`Math.pow`, `exp`, `sinh`, `cosh`, `tanh`** are exact to some ten digits in SML/NJ (`Math.pow (3.0, ~1.0)` is 0.333333333353), and are not numbers
  outside the range of the processor (`Math.tanh 1E10`, `Math.sin 1E300`); here they are those of C. So are `Real.rem` of numbers of very different size,
  `Real.toManExp` and `fromManExp` of zero and of non-finite numbers, and `Real.toLargeInt` of zero.
* **`null`** tests a list, with a warning; in the engine it is the time 0, which hides the test.
* **`inst ()`**, the number of the page instance, is in arcs, guards, delays and code segments what it is in the engine's simulator, and so it is in functions that they call.
  The engine's state-space tool has the number of another instance when a transition occurs (in a guard the right one), so that its graphs of such nets differ. In initial markings
  the engine has what it noted when it made the place before: the number of instances of that place's page, and 1. So it is the same for all instances of a page, mostly 2 in a net
  without hierarchy, and depends on the order in which its editor has sent the pages; here it is the number of the instance, and `check` warns. Constants, references and bounds of
  colour sets that ask for it (`val n = inst ()`) have 1, as in the engine when it opens the net, with a warning (`declaration-instance`): it has what it looked at last when it checks
  the declaration again. Values that hold a function which asks (`val f = [inst]`), functions of structures that do, predicates of subsets and priorities are refused
  (`unsupported-function`), and so is a function that is used after a name in it has been declared again.
* **A variable whose name is none of CPN ML** (`n-1`, `1n`) is accepted by the engine as long as nothing uses it; here it is refused. So are two transitions
  of one id, whose arcs cannot be told apart.
* **Initial markings that change references** are evaluated once each, in the order of the file; the engine evaluates them when it checks the net
  and again at the start, in an order of its own. `check` warns of them.
* **A subset's list that is computed** (`subset INT with values`) is refused by the engine; here it is accepted, with a warning.
* **The values of an `intinf` with bounds** are listed from the lowest by `CS.all ()`; the engine lists them from the highest.
* **`Vector.update`** notices an index beyond the end; `IntInf.div` and similar functions raise `Div` for 0 by 0; `IntInf.pow (1, ~1)` is 1, in the engine 0; so it is with an
  `IntInf.xorb` that is ~(2^30), ~(2^60), ...: `IntInf.xorb (1073741823, ~1)`.
* **Undetermined type variables** after the value restriction (`val f = rev o rev`) become `unit`; in SML/NJ each becomes a new type.
* **`ListMergeSort.sort`** and `ArrayQSort.sort` keep the order of equal elements; the engine's may exchange them.
* **`gamma` and `beta`** of parameters that are not above zero raise `Gamma` and `Beta`; the engine has some number, or draws without end. All other
  distributions raise the same exceptions for the same parameters.
* **`%#0g` of `Format.format`** shows the point (`2.50000`), which is missing in the engine (`250000`).
* **`CS.col` of a union at positions below zero** may give the last constant constructor in the engine; here it raises `CPN'Error`.
* **`DynamicArray.subArray`** gives a part of an array; in the engine it raises `Subscript` or `Size`. `DynamicArray.collate` of equal arrays is `EQUAL`, in the engine `LESS`.
* **`Word32.toInt (Word32.fromInt n)`** raises `Overflow` for n below zero, as `Word32.toInt` of such a word does; the engine's compiler makes nothing
  of the two, and gives n (and ~1 of `Word32.toInt (Word.toLargeX 0wx7FFFFFFF)`). A structure declared inside `let` is accepted, and so are `op List.@` and a blank in `# [1, 2]`.
* **`Word64.min`** is the smaller one; in the engine it is the larger one. `Word64.scan` takes no sign, and no blank after `0w`, as that of the other
  words; the engine takes both. `Int64.fromString` reads numbers of 64 bits; the engine raises `Overflow` above 2,147,483,647.
* **`Real.nextAfter`** works; SML/NJ raises `Fail`. `String.fromCString` reads up to the first character that it cannot read; SML/NJ gives `NONE`.
* **Exceptions that functions declare** are new ones in each call; here there is one for all calls, and a net in which a call may meet the exception of
  another one is refused (`unsupported-exception`).
* **`Bind` raised by what an input arc wants** (its value, coefficient or delay: `let val (x :: _) = f (n, k) in x end`), if it needs a variable `n` that has
  its value from a token or an equation and a variable `k` that has all values of its colour set, means to CPN Tools that the other values of `k` are not
  tried; here it stops the run, as any other exception. Without such a `k` there is no binding, in both; without such an `n` both stop.
* **An arc without an orientation**, and an element inside the text of an inscription, are refused: CPN Tools writes neither, and the net could be read in
  two ways.
* **Multi-sets of many millions of tokens** (``1073741823`e``) are lists in the engine, which gives no answer for them; here they are numbers.
* **Library**: of the 345 structures that the engine has in scope some 100 are there; of the others (its compiler, its inner parts, the state-space library, ...)
  each function is refused by its name (`unsupported-function`). So is `IOUtil`, which changes where the standard streams go. Of `SMLofNJ`, `BinIO`, `Socket` and `Unix` `check` warns, and a
  run stops where one is applied; so it does at `SMLofNJ.Cont.callcc`. Of the functors of SML/NJ those of maps, sets, hash tables and queues with
  priorities are there; `isSubset` of `HashSetFn` raises `Subscript` in the engine, and works here.
* **`RealOrderStats`** leaves its array as it is; the engine's sorts a part of it, by random numbers, so that `UnivariateStats.averageDeviation` may have another last digit after `median`.
* **`Real.split` and `Real.realMod`** of reals below some 1.1E~16 give them; in the engine what is behind the point of these is 0.0.
* **Connections** (`openConnection`, `receive`, ...) are opened by `simulate --sockets` only, in code segments only. Sending over one that the other side has closed raises
  `OS.SysErr`; the engine ends. Waiting has an end here.
* **Time zones**: dates are those of UTC.
"""

# ruff: noqa: E501 - a text
"""Where pn2code does not follow the engine of CPN Tools, and why: the part of the report that is written by hand."""

TEXT = """\
Of inscriptions and expressions also, each kept on purpose:

* **A constant inside a list, a nested tuple or a union in an input inscription** (`four :: x :: nil`): the engine binds the name
  anew and then ends with `Subtract`; here it is compared, as at the top of a tuple.
* **A real constant in an input inscription**: the engine cannot compile it; here it is compared. In `fun`, `case`, `fn`, `val` it is refused, as in SML.
* **`x as pattern` on an arc** is a syntax error in the engine; here it is understood, with a warning.
* **A priority below zero** is accepted by the engine's check, but its simulator cannot start; here it is taken, with a warning.
* **`intinf with 1..3`** is refused by the engine, which takes the bounds for `int`; here they are taken, with a warning.
* **An `ml` declaration that is empty, or only a comment**, is refused by the engine; here it is warned of.
* **A negative zero** is printed as `0.0`, by the engine as `~0.0`: both are one token, and one state.
* **`Math.pow`, `exp`, `sinh`, `cosh`, `tanh`** are exact to some ten digits in SML/NJ (`Math.pow (3.0, ~1.0)` is 0.333333333353), and not numbers where
  they leave the range of the processor (`Math.tanh 1E10`, `Math.sin 1E300`); here they are those of C. So are `Real.rem` of what is very different in size,
  `Real.toManExp` and `fromManExp` of zero and of what is not finite, and `Real.toLargeInt` of zero.
* **`null`** tests a list; in the engine it is the time 0, which hides the test.
* **`Vector.update`** notices an index beyond the end; `IntInf.div` and its like raise `Div` for 0 by 0; `IntInf.pow (1, ~1)` is 1, in the engine 0.
* **What nothing decides** in a type after the value restriction (`val f = rev o rev`) is `unit`; in SML/NJ it is a type of its own.
* **`ListMergeSort.sort`** keeps the order of equal elements; the engine's may exchange them.
* **`CS.col` of a union at positions below zero** may give the last constant constructor in the engine; here it raises `CPN'Error`.
* **`Real.nextAfter`** works; SML/NJ raises `Fail`. `String.fromCString` reads up to what it cannot read; SML/NJ gives `NONE`.
* **Time zones**: dates are those of UTC.
"""

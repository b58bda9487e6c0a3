# ruff: noqa: E501 - a text
"""Where pn2code does not follow the engine of CPN Tools, and why: the part of the report that is written by hand."""

TEXT = """\
Of inscriptions and expressions also, each kept on purpose:

* **A constant inside a list, a nested tuple or a union in an input inscription** (`four :: x :: nil`): the engine binds the name
  anew and then ends with `Subtract`; here it is compared, as at the top of a tuple.
* **A real constant in a pattern**: the engine cannot compile it; here it is compared.
* **`x as pattern` on an arc** is a syntax error in the engine; here it is understood, with a warning.
* **A priority below zero** is accepted by the engine's check, but its simulator cannot start; here it is taken, with a warning.
* **`intinf with 1..3`** is refused by the engine, which takes the bounds for `int`; here they are taken, with a warning.
* **An `ml` declaration that is empty, or only a comment**, is refused by the engine; here it is warned of.
* **A negative zero** is printed as `0.0`, by the engine as `~0.0`.
* **`ListMergeSort.sort`** keeps the order of equal elements; the engine's may exchange them.
* **`CS.col` of a union at positions below zero** may give the last constant constructor in the engine; here it raises `CPN'Error`.
* **`Real.nextAfter`** works; SML/NJ raises `Fail`. `String.fromCString` reads up to what it cannot read; SML/NJ gives `NONE`.
* **Time zones**: dates are those of UTC.
"""

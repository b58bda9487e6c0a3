"""pn2code: from Coloured Petri nets of robot cells to C supervisors and robot programs.

One pipeline, each stage a function from one immutable value to the next:

    read -> link -> check -> flatten -> partition -> lower -> emit

`pn2code.pipeline` drives it; `docs/architecture.md` follows one small net through all of it.
"""

__version__ = "0.1.0"

"""pn2code as a library: nets are loaded, played, verified and turned into programs from Python (docs/library.md).

    import pn2code

    net = pn2code.load("philosophers.cpn", values={"n": "5"})
    marking = net.initial_marking()
    for binding in marking.enabled():
        print(binding, "->", marking.fire(binding))
    net.simulate(steps=100, seed=7).final
    net.verify("deadlock free").verdict               # "no"

All of it is what the command does, by the same code. Nothing is printed; what is wrong is raised as `NetError`.
"""

from pn2code.api.drawing import Drawing
from pn2code.api.errors import NetError
from pn2code.api.marking import Binding, Marking, Token
from pn2code.api.net import Net, check, load
from pn2code.api.programs import OutputFolderError, Programs, generate
from pn2code.api.simulation import Simulation
from pn2code.api.verification import PropertyAnswer, Verification

__all__ = [
    "Binding",
    "Drawing",
    "Marking",
    "Net",
    "NetError",
    "OutputFolderError",
    "Programs",
    "PropertyAnswer",
    "Simulation",
    "Token",
    "Verification",
    "check",
    "generate",
    "load",
]

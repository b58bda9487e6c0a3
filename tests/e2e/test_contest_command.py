"""`pn2code contest` as the contest calls it: its words, its limits, its errors."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.cli import invoke
from helpers.pnml_nets import arc, net, place, transition


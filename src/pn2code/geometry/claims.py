"""What is asked of pairs, in words."""

from __future__ import annotations


def kept_apart(*, devices: bool) -> str:
    """What is asked of pairs; `devices`: whether something of devices moves, too."""
    if devices:
        return "no two arms or devices collide, nor one of them and a part, in any interleaving that the net permits"
    return "no two arms collide, nor an arm and a part, in any interleaving that the net permits"

"""Monitors for nets in the short text form: `with_monitors(text, Spec(...), ...)` gives the bytes of a `.cpn` file.

The nodes of a monitor are named `Page.Name`, or `Path/To/Instance.Name` where a page has several instances.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lxml import etree
from typer.testing import CliRunner

from helpers.netbuilder import DOCTYPE, cpn
from pn2code.cli.main import app

SAME = ("steps", "why", "breakpoint", "places", "monitors", "error", "output", "time")
"""What a simulation says that does not depend on the engine."""


@dataclass(frozen=True)
class Spec:
    """A monitor as the file has it."""

    name: str
    kind: str
    nodes: Sequence[str] = ()
    functions: Mapping[str, str] = field(default_factory=dict)
    options: Mapping[str, str] = field(default_factory=dict)
    disabled: bool = False


def with_monitors(text: str, *specs: Spec) -> bytes:
    """The file of the net, with its monitors."""
    root = etree.fromstring(cpn(text))
    net = root.find("cpnet")
    assert net is not None
    instances = _instances(net)
    block = net.find("monitorblock")
    assert block is not None
    for number, spec in enumerate(specs):
        monitor = etree.SubElement(
            block,
            "monitor",
            id=f"MON{number}",
            name=spec.name,
            typedescription=spec.kind,
            disabled="true" if spec.disabled else "false",
        )
        for node in spec.nodes:
            path, _, name = node.rpartition(".")
            page = instances[path][1]
            element = next(
                e
                for tag in ("place", "trans")
                for e in page.findall(tag)
                if e.findtext("text") == name
            )
            etree.SubElement(
                monitor, "node", idref=element.get("id", ""), pageinstanceidref=instances[path][0]
            )
        for name, code in spec.functions.items():
            declaration = etree.SubElement(monitor, "declaration", name=name)
            etree.SubElement(declaration, "ml").text = code
        for name, value in spec.options.items():
            etree.SubElement(monitor, "option", name=name, value=value)
    return bytes(etree.tostring(root, encoding="iso-8859-1", xml_declaration=True, doctype=DOCTYPE))


def simulated(
    net: Path, text: str, specs: Sequence[Spec], steps: int, *options: object
) -> dict[str, Any]:
    """What a simulation of the net with its monitors says; the file is written to `net`."""
    net.write_bytes(with_monitors(text, *specs))
    command = ["simulate", net, "--json", "--steps", steps, *options]
    done = CliRunner().invoke(app, [str(word) for word in command])
    said: dict[str, Any] = json.loads(done.stdout)
    return said


def _instances(net: etree._Element) -> dict[str, tuple[str, etree._Element]]:
    """Page instances by path; those below prime pages are added to the file, as CPN Tools writes them."""
    pages = {p.get("id", ""): p for p in net.findall("page")}
    found: dict[str, tuple[str, etree._Element]] = {}

    def walk(instance: etree._Element, page: etree._Element, path: str) -> None:
        found[path] = (instance.get("id", ""), page)
        for trans in page.findall("trans"):
            subst = trans.find("subst")
            if subst is not None:
                name = trans.findtext("text") or ""
                identity = f"{instance.get('id')}x{trans.get('id')}"
                below = etree.SubElement(
                    instance, "instance", id=identity, trans=trans.get("id", "")
                )
                walk(below, pages[subst.get("subpage", "")], f"{path}/{name}")

    block = net.find("instances")
    assert block is not None
    for top in block.findall("instance"):
        page = pages[top.get("page", "")]
        attributes = page.find("pageattr")
        assert attributes is not None
        walk(top, page, attributes.get("name", ""))
    return found

"""Options that several verbs have are the same in each."""

from __future__ import annotations

import pytest
import typer

from pn2code.cli import main
from pn2code.cli.options import OUTPUT_FLAGS


def flags(verb: str) -> dict[str, list[str]]:
    """Each option's spellings, by the name of its parameter."""
    command = main._Verbs().get_command(typer.Context(typer.main.get_command(main.app)), verb)
    return {p.name: p.opts for p in command.params}


@pytest.mark.parametrize("verb", ["generate", "run", "draw", "convert"])
def test_the_place_of_the_results_is_named_alike(verb: str) -> None:
    assert list(OUTPUT_FLAGS) in flags(verb).values()
    assert {"-o", "--out", "--output"} == set(OUTPUT_FLAGS)


@pytest.mark.parametrize("verb", ["generate", "conform", "run"])
def test_what_messages_about_checks_advise_is_there(verb: str) -> None:
    """These verbs check the supervisor, and their messages name this option."""
    assert ["--unchecked"] in flags(verb).values()

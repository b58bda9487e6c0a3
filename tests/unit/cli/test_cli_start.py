"""Verbs are loaded one at a time; `explain` knows the codes of all."""

from __future__ import annotations

import ast
import importlib
import inspect
import os
import pty
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from pn2code.cli import main
from pn2code.cli.explain import REGISTERING


def loaded_by(*arguments: str) -> set[str]:
    """The modules in memory after a command."""
    program = (
        "import sys\nfrom pn2code.cli.main import app\n"
        "try: app(sys.argv[1:])\n"
        "except SystemExit: pass\n"
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments], capture_output=True, text=True, check=True
    )
    return set(done.stderr.split())


def test_check_of_a_net_loads_no_generator_and_no_simulator(root: Path, tmp_path: Path) -> None:
    net = tmp_path / "cell.cpn"  # without a cell.toml beside it, whose geometry would need NumPy
    net.write_bytes((root / "examples" / "riveting" / "cell.cpn").read_bytes())
    loaded_by("check", str(net))  # the tables of the parser are kept from now on
    modules = loaded_by("check", str(net))
    assert "pn2code.net.flatten" in modules
    heavy = {"numpy", "scipy", "pybullet", "jinja2", "rich", "pydantic", "lxml", "lark"}
    assert not heavy & modules
    assert not [m for m in modules if m.startswith(("pn2code.lowering", "pn2code.emission"))]


def test_check_of_a_cell_loads_nothing_that_only_moving_arms_need(root: Path) -> None:
    modules = loaded_by("check", str(root / "examples" / "riveting"))
    assert "numpy" in modules
    assert not {"ruckig", "numpy.ma", "scipy", "jinja2"} & modules


@pytest.mark.parametrize("option", ["--version", "--help"])
def test_version_and_the_list_of_verbs_load_no_verb(option: str) -> None:
    modules = loaded_by(option)
    assert not [m for m in modules if m.startswith(("pn2code.ml", "pn2code.net"))]
    assert not {f"pn2code.cli.{verb}" for verb in main.VERBS} & modules


@pytest.mark.parametrize("words", [["--help"], ["explain", "--help"]])
def test_help_loads_neither_markdown_nor_what_prints_tracebacks(words: list[str]) -> None:
    modules = loaded_by(*words)
    assert "typer.rich_utils" in modules and "rich.panel" in modules
    assert not {"rich.markdown", "markdown_it", "rich.traceback", "rich.syntax"} & modules


def test_what_help_does_not_load_is_the_real_thing_when_it_is_wanted() -> None:
    program = (
        "from pn2code.cli import light_help\n"
        "light_help.load()\n"
        "from typer.rich_utils import Markdown, Traceback\n"
        "from rich import markdown, traceback\n"
        "made = Markdown('*so*', style='bold')\n"
        "assert type(made) is markdown.Markdown and isinstance(made, Markdown)\n"
        "try: 1 / 0\n"
        "except ZeroDivisionError as e: found = Traceback.from_exception(type(e), e, e.__traceback__)\n"
        "assert type(found) is traceback.Traceback\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("verb", main.VERBS)
def test_the_list_says_what_the_help_of_the_verb_begins_with(verb: str) -> None:
    module = importlib.import_module(f"pn2code.cli.{verb}")
    first = inspect.cleandoc(getattr(module, verb).__doc__).split("\n\n")[0]
    assert " ".join(first.split()) == main.VERBS[verb]


@pytest.mark.parametrize("verb", main.VERBS)
def test_every_verb_has_help(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main.app([verb, "-h"])
    assert left.value.code == 0
    assert verb in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "wanted"),
    [("pn2code ver", {"verify"}), ("pn2code verify --max", {"--max-states", "--max-seconds"})],
)
def test_shells_complete_verbs_and_options(words: str, wanted: set[str]) -> None:
    asked = {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    done = subprocess.run(
        [sys.executable, "-c", "from pn2code.cli.main import app; app(prog_name='pn2code')"],
        env={**os.environ, **asked, "_PN2CODE_COMPLETE": "complete_bash"},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert set(done.stdout.split()) == wanted


@pytest.mark.parametrize(("variable", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False)])
def test_colours_on_a_terminal(variable: dict[str, str], coloured: bool, tmp_path: Path) -> None:
    ours, theirs = pty.openpty()
    environment = {k: v for k, v in os.environ.items() if k != "NO_COLOR"} | variable
    with os.fdopen(ours, "rb", buffering=0) as terminal:
        subprocess.run(
            [sys.executable, "-m", "pn2code", "check", str(tmp_path / "no.cpn")],
            stderr=theirs, stdout=subprocess.DEVNULL, env=environment, check=False,
        )  # fmt: skip
        os.close(theirs)
        said = terminal.read(4096)
    assert b"there is no file" in said
    # The line of progress, if it has come to one, is erased in any case.
    assert bool(re.search(rb"\x1b\[[0-9;]*m", said)) == coloured


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
def test_with_closed_streams(closed: str) -> None:
    """What would be written there is lost, and nothing else changes."""
    command = f'"$0" -m pn2code explain file-missing {closed}'
    done = subprocess.run(
        ["sh", "-c", command, sys.executable], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert (done.stdout == "") == (">&- " in f"{closed} ".replace("2>&-", ""))


@pytest.mark.parametrize(
    "words",
    ["--version", "--help", "explain", "check examples/philosophers", "marking examples/riveting"],
)
def test_a_reader_that_has_gone(words: str, root: Path) -> None:
    """This is neither success, since not all was said, nor a wrong model."""
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "pn2code", *words.split()],
        cwd=root, stdout=writing, stderr=subprocess.PIPE, text=True, check=False,
    )  # fmt: skip
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(("code", "left"), [(0, 141), (1, 1), (3, 3)])
def test_a_verdict_is_kept_when_its_last_words_are_not_read(code: int, left: int) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    program = f"from pn2code.cli.main import _leave; print('no'); _leave({code})"
    buffered = {k: v for k, v in os.environ.items() if k != "PYTHONUNBUFFERED"}
    done = subprocess.run(
        [sys.executable, "-c", program], stdout=writing, env=buffered, check=False
    )
    os.close(writing)
    assert done.returncode == left


def test_a_misspelt_verb_gets_a_suggestion(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main.app(["generat"])
    assert left.value.code == 2
    assert "generate" in capsys.readouterr().err


def test_explain_knows_all_modules_that_declare_codes(root: Path) -> None:
    base = root / "src"
    found = set()
    for path in base.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for node in ast.walk(ast.parse(text if "register(" in text else "")):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == "register"
            ):
                found.add(".".join(path.relative_to(base).with_suffix("").parts))
    assert found == set(REGISTERING)


def test_interrupted_while_it_is_loaded() -> None:
    program = (
        "import os, signal, sys\n"
        "class Interrupting:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'pn2code.cli': os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Interrupting())\n"
        "sys.argv = ['pn2code', '--version']\n"
        "from pn2code.start import main\n"
        "main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


def test_daemon_threads_are_not_ended_by_the_interpreter() -> None:
    """In a library of C++ they would abort the process when they ask for the interpreter's lock."""
    program = (
        "import atexit, threading, time\n"
        "from pn2code.cli.main import _leave\n"
        "class Last:\n"
        "    def __del__(self):\n"
        "        print('finalised')\n"
        "last = Last()\n"
        "threading.Thread(target=time.sleep, args=(60,), daemon=True).start()\n"
        "atexit.register(print, 'registered')\n"
        "_leave(3)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (3, "registered\n", "")

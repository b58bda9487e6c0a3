"""Modules become one script; what cannot be bundled is refused when the page is written."""

from __future__ import annotations

import pytest

from pn2code.base import resources
from pn2code.replay.bundle import BadModule, bundle, modules


def test_each_module_stands_once_after_those_that_it_imports() -> None:
    text = bundle(
        {
            "main.js": 'import { f } from "./f.js";\nimport { g, h } from "./g.js";\nf(g, h);\n',
            "f.js": 'import { g } from "./g.js";\nexport function f() { return g; }\n',
            "g.js": "export const g = 1;\nexport class h {}\n",
            "other.js": "export const unused = 1;\n",
        },
        "main.js",
    )
    names = [f'modules["{n}"] = ' for n in ("g.js", "f.js", "main.js")]
    assert [text.count(n) for n in names] == [1, 1, 1]
    assert sorted(names, key=text.index) == names
    assert "unused" not in text
    assert "export" not in text and "import {" not in text


@pytest.mark.parametrize(
    ("sources", "why"),
    [
        ({"main.js": 'import { f } from "./f.js";\n'}, "imports f.js, which is not there"),
        ({"main.js": 'import { f } from "./f.js";\n', "f.js": "const f = 1;\n"}, "which f.js does not export"),
        ({"main.js": 'import { f } from "./main.js";\nexport const f = 1;\n'}, "modules need themselves"),
        ({"main.js": 'import * as f from "./f.js";\n'}, "main.js:1: this form of `import`"),
        ({"main.js": "\nexport default 1;\n"}, "main.js:2: this form of `export`"),
    ],
)  # fmt: skip
def test_what_cannot_be_bundled_is_refused(sources: dict[str, str], why: str) -> None:
    with pytest.raises(BadModule) as refused:
        bundle(sources, "main.js")
    assert why in str(refused.value)


def test_all_modules_of_the_pages_are_used() -> None:
    sources = modules(resources.templates_folder() / "web")
    text = "".join(bundle(sources, main) for main in ("main.js", "play.js", "live.js"))
    assert [name for name in sources if f'modules["{name}"] = ' not in text] == []
    assert "</script" not in text.lower() and "<!--" not in text
    assert ".innerHTML" not in text and "insertAdjacentHTML" not in text and "eval(" not in text

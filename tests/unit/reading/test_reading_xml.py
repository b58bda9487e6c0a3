"""XML is read without trust: hostile and damaged files give one clear diagnostic each."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from helpers.netbuilder import cpn
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.reading import xml
from pn2code.reading.cpn import read, read_data

NET = """
    net Cell
      colset INT = int;
      var n: INT;
      place Buffer : INT = 1`1
      trans Pick
        in Buffer : n
"""


def only(data: bytes) -> tuple[str, str, str]:
    """Code, message and location of the one diagnostic that refuses the data."""
    d = Diagnostics()
    assert read_data(data, "cell.cpn", d) is None
    assert len(d) == 1
    item = d.items[0]
    return item.code, item.message, item.origin.location()


def refuse(path: Path) -> tuple[str, str]:
    d = Diagnostics()
    assert read(path, d) is None
    assert len(d) == 1
    return d.items[0].code, d.items[0].message


def test_missing_file(tmp_path: Path) -> None:
    code, message = refuse(tmp_path / "no.cpn")
    assert code == "file-missing"
    assert "no.cpn" in message


def test_directory(tmp_path: Path) -> None:
    assert refuse(tmp_path) == ("file-unreadable", f"`{tmp_path}` is a directory")


def test_device_is_not_read() -> None:
    # /dev/zero never ends
    assert refuse(Path("/dev/zero"))[0] == "file-unreadable"


def test_path_with_null_character() -> None:
    assert refuse(Path("a\0b.cpn"))[0] == "file-unreadable"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "cell.cpn"
    path.write_bytes(cpn(NET))
    path.chmod(0)
    code, message = refuse(path)
    assert code == "file-unreadable"
    assert "permission denied" in message


def test_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "cell.cpn"
    path.write_bytes(cpn(NET))
    monkeypatch.setattr(xml, "MAX_BYTES", 1000)
    code, message = refuse(path)
    assert code == "file-too-large"
    assert f"{path.stat().st_size:,}" in message


def test_empty() -> None:
    assert only(b"  \n")[:2] == ("xml-truncated", "the file is empty")


def test_not_xml() -> None:
    code, message, where = only(b"This is no net.\n")
    assert code == "xml-syntax"
    assert message.startswith("not well-formed XML: ")
    assert where == "cell.cpn:1:1"


def test_mismatched_tag() -> None:
    code, message, where = only(b"<workspaceElements>\n<cpnet></page>\n</workspaceElements>")
    assert (code, where) == ("xml-syntax", "cell.cpn:2:10")
    assert "element `cpnet` is not closed before the end of another one" in message


def test_every_truncation_is_a_diagnostic() -> None:
    data = cpn(NET)
    end = data.rindex(b"</workspaceElements>") + len(b"</workspaceElements>")
    codes = set()
    for length in range(end):
        code, _, _ = only(data[:length])
        codes.add(code)
    assert codes == {"xml-truncated", "xml-syntax"}


def test_truncation_names_the_open_element() -> None:
    data = cpn(NET)
    cut = data.index(b"<trans ") + len(b"<trans id=")
    code, message, _ = only(data[:cut])
    assert code == "xml-truncated"
    assert message == "the file ends too early, inside element `page`"


BOMB = b"""<?xml version="1.0"?>
<!DOCTYPE workspaceElements [
  <!ENTITY a "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa">
  <!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">
]>
<workspaceElements><cpnet><page id="P"><pageattr name="&b;"/></page></cpnet></workspaceElements>
"""


def test_entity_bomb() -> None:
    code, message, where = only(BOMB)
    assert code == "xml-entity"
    assert message == "the file declares an XML entity, `a`"
    assert where.startswith("cell.cpn:3:")


def test_external_entity_is_not_fetched(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("token")
    data = (
        f'<!DOCTYPE w [<!ENTITY x SYSTEM "{secret.as_uri()}">]><workspaceElements>&x;'
        "</workspaceElements>"
    )
    code, message, _ = only(data.encode())
    assert code == "xml-entity"
    assert "token" not in message


def test_parameter_entity() -> None:
    data = b'<!DOCTYPE w [<!ENTITY % p "x"> %p;]><workspaceElements/>'
    assert only(data)[0] == "xml-entity"


def test_undeclared_entity() -> None:
    doctype = b'<!DOCTYPE w PUBLIC "-//CPN//DTD CPNXML 1.0//EN" "http://127.0.0.1:1/cpn.dtd">'
    for start in (b"", doctype):
        code, _, where = only(start + b"\n<workspaceElements>\n&nbsp;</workspaceElements>")
        assert code == "xml-entity"
        assert where == "cell.cpn:3:1"


def test_too_deep() -> None:
    data = b"<workspaceElements>" + b"<a>" * 300_000 + b"</a>" * 300_000 + b"</workspaceElements>"
    code, message, _ = only(data)
    assert code == "xml-limit"
    assert "200 levels" in message


def test_too_many_elements(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml, "MAX_ELEMENTS", 1000)
    code, message, _ = only(b"<workspaceElements>" + b"<a/>" * 1000 + b"</workspaceElements>")
    assert (code, message) == ("xml-limit", "there are more than 1,000 elements")


def test_unknown_encoding() -> None:
    code, message, _ = only(b'<?xml version="1.0" encoding="klingon"?><workspaceElements/>')
    assert code == "xml-syntax"
    assert "encoding" in message


@pytest.mark.parametrize(
    "noise", [b"\x00", b"\xff\xfe", b"<", b"]]>", b"&#0;", b"&#xFFFFFFFF;", b"\x1b"]
)
@pytest.mark.parametrize("part", [b"Buffer", b"<place ", b"PtoT", b"?>", b"1`1"])
def test_noise_anywhere_gives_diagnostics_only(noise: bytes, part: bytes) -> None:
    data = cpn(NET)
    at = data.index(part)
    d = Diagnostics()
    read_data(data[:at] + noise + data[at:], "cell.cpn", d)  # must not raise
    assert all(item.origin.file == "cell.cpn" for item in d)


def test_positions_of_characters() -> None:
    lines = [
        '<?xml version="1.0" encoding="iso-8859-1"?>',
        "<a><!-- a comment -->",
        "  <text>  x &lt; \xe9&#38;y",
        "    z<![CDATA[ <w>]]></text>",
        "</a>",
    ]
    for newline in ("\n", "\r\n"):
        d = Diagnostics()
        root = xml.parse(newline.join(lines).encode("iso-8859-1"), "f", d)
        assert root is not None
        source = root.children[0].source(Origin("f"))
        assert source.text == "x < \xe9&y\n    z <w>"
        where = {c: source.position(i) for i, c in enumerate(source.text) if not c.isspace()}
        assert where == {
            "x": (3, 11),
            "<": (4, 16),  # the second one, in the CDATA section
            "\xe9": (3, 18),
            "&": (3, 19),
            "y": (3, 24),
            "z": (4, 5),
            "w": (4, 17),
            ">": (4, 18),
        }
        assert source.position(source.text.index("<")) == (3, 13)
        assert (source.origin.line, source.origin.column) == (3, 11)


def test_utf16_and_bom() -> None:
    text = cpn(NET).decode("iso-8859-1").replace("iso-8859-1", "utf-16")
    d = Diagnostics()
    assert read_data(text.encode("utf-16"), "f", d) is not None
    text = text.replace("utf-16", "utf-8")
    assert read_data(text.encode("utf-8-sig"), "f", d) is not None
    assert not list(d)


def test_long_texts_and_attributes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml, "MAX_TEXT", 20)
    for inside in (b"<a>%s</a>" % (b"x\n" * 20), b"<a b='%s'/>" % (b"x" * 30)):
        code, message, _ = only(b"<workspaceElements>" + inside + b"</workspaceElements>")
        assert code == "xml-limit"
        assert message.endswith("more than 20 characters")


def test_white_space_between_elements_may_be_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml, "MAX_TEXT", 20)
    data = b"<workspaceElements>" + b"<cpnet>" + b"\n   " * 50 + b"</cpnet></workspaceElements>"
    document = read_data(data, "cell.cpn", Diagnostics())
    assert document is not None


def test_a_pnml_file_may_have_more_elements(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml, "MAX_ELEMENTS", 1000)
    monkeypatch.setattr(xml, "MAX_PNML_ELEMENTS", 2000)
    d = Diagnostics()
    assert xml.parse(b"<pnml>" + b"<a/>" * 1500 + b"</pnml>", "net.pnml", d) is not None
    assert xml.parse(b"<pnml>" + b"<a/>" * 2500 + b"</pnml>", "net.pnml", d) is None
    assert [e.message for e in d.errors] == ["there are more than 2,000 elements"]

"""The page of `pn2code play` in a browser: what is clicked occurs, and the page shows what the token game says."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from helpers.browser import Page, launched, opened
from helpers.legible import complaints
from helpers.monitors import Spec, with_monitors
from helpers.played import Served, marking, of, served
from helpers.processes import pn2code
from helpers.shown import PAIR
from pn2code.play import saving
from pn2code.semantics.game.report import time_text

HOSTILE = "<img src=x onerror=alert(1)>"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def server(root: Path) -> Iterator[Served]:
    with served(root / "examples/philosophers/philosophers.cpn") as found:
        yield found


def visit(browser: Page, server: Served) -> None:
    browser.page.goto(server.url)
    browser.page.wait_for_selector("body[data-ready=true]")


@pytest.fixture
def browser(server: Served, chromium: Any) -> Iterator[Page]:
    with opened(chromium) as found:
        visit(found, server)
        yield found
        assert found.errors == [] and found.dialogues == []


def position(browser: Page) -> int:
    return int(browser.ask("() => play.page.position.state.position"))


def at(browser: Page, number: int) -> None:
    """Waits until so many entries have happened."""
    browser.wait(f"play.page.position.state.position === {number}")


def transition(browser: Page, name: str) -> Any:
    return browser.page.get_by_role("button", name=f"transition {name}")


class TestPlaying:
    def test_a_click_lets_a_transition_occur(self, browser: Page) -> None:
        assert browser.page.locator(".sheet .enabled").count() == 1
        transition(browser, "Take left, enabled").click()
        at(browser, 1)
        assert dict(browser.ask("() => play.marking()"))["Table.Waits"].startswith("1`ph(")
        browser.page.get_by_role("button", name="Undo").click()
        at(browser, 0)
        browser.page.get_by_role("button", name="Redo").click()
        at(browser, 1)
        # What is not enabled does not occur, and the page says so.
        transition(browser, "Put down, not enabled").click()
        browser.page.get_by_text("`Put down` is not enabled").wait_for()
        assert position(browser) == 1

    def test_wide_names_and_long_markings_do_not_lie_in_the_way(
        self, chromium: Any, tmp_path: Path
    ) -> None:
        tokens = "++".join(f"1`{i}" for i in range(25))
        place = f"page Top\n  place A : INT = {tokens}\n"
        text = f'{place}  trans "A name that is much wider than its box"\n    both A : 0\n'
        net = tmp_path / "wide.cpnt"
        net.write_text(f"standard\n{text}", encoding="utf-8")
        with served(net) as wide, opened(chromium) as browser:
            visit(browser, wide)
            browser.page.locator(".sheet .enabled").click()
            at(browser, 1)
            lines = "() => document.querySelectorAll('#net .tokens tspan').length"
            shown = [browser.ask(lines)]
            for clicked in ("tspan", "circle", "circle"):
                browser.page.locator(f"#net .tokens .choice:has({clicked})").click()
                shown.append(browser.ask(lines))
            browser.page.get_by_role("button", name="place A").click()
            for _ in range(3):
                browser.page.keyboard.press("m")
                shown.append(browser.ask(lines))
            assert shown == [8, 20, 0, 8, 20, 0, 8]

    def test_a_binding_is_chosen(self, browser: Page) -> None:
        transition(browser, "Take left").click(button="right")
        rows = browser.page.get_by_role("list", name="Enabled bindings").get_by_role("button")
        rows.nth(2).wait_for()
        assert rows.all_inner_texts() == ["p = ph(1)", "p = ph(2)", "p = ph(3)"]
        part = browser.page.get_by_label("A part of the binding")
        part.fill("p = ph(2)")
        part.press("Enter")
        browser.page.get_by_text("1 binding", exact=True).wait_for()
        rows.first.click()
        at(browser, 1)
        assert browser.ask("() => play.page.position.bound(1)") == [["p", "ph(2)"]]
        part.fill("q = 1")
        part.press("Enter")
        browser.page.get_by_text("`q` is not declared").first.wait_for()

    def test_keys_do_everything(self, browser: Page) -> None:
        keys = browser.page.keyboard
        keys.press("Space")
        at(browser, 1)
        keys.press("Space")
        at(browser, 2)
        keys.press("ArrowLeft")
        at(browser, 1)
        keys.press("Home")
        at(browser, 0)
        keys.press("End")
        at(browser, 2)
        keys.press("ArrowLeft")
        at(browser, 1)
        browser.page.locator(".sheet .enabled").first.focus()
        keys.press("Enter")
        at(browser, 2)
        browser.page.locator(".sheet [aria-label^='transition']").first.focus()
        keys.press("Shift+Enter")
        browser.page.get_by_label("A part of the binding").wait_for()
        browser.page.locator("#net h2").click()
        keys.press("r")
        for name in ("Run", "Keys"):
            dialogue = browser.page.get_by_role("dialog", name=name)
            dialogue.wait_for()
            keys.press("Escape")
            dialogue.wait_for(state="detached")
            keys.press("?")
        browser.page.get_by_role("button", name="Close", exact=True).click()
        keys.press("d")
        assert browser.ask("() => document.documentElement.dataset.theme") == "dark"

    def test_markings_are_those_of_the_token_game(
        self, browser: Page, server: Served, root: Path, tmp_path: Path
    ) -> None:
        """Fifty steps at random, some of them taken back: the saved run, repeated, gives what the page shows."""
        keys = browser.page.keyboard
        for k in range(25):
            keys.press("Space" if k % 6 != 5 else "ArrowLeft")
            browser.wait("play.page.link.waiting.size === 0")
        with browser.page.expect_download() as saved:
            browser.page.get_by_role("tab", name="Game").click()
            browser.page.get_by_role("button", name="Save the run").click()
        file = tmp_path / "saved.trace.jsonl"
        saved.value.save_as(file)
        net = root / "examples/philosophers/philosophers.cpn"
        assert pn2code("replay", file, net).returncode == 0
        game = of(net, tmp_path)
        saving.load(game, file)
        last = position(browser)
        assert game.history.position == last
        for k in range(last, -1, -1):
            browser.ask("k => play.page.bar.go(k)", k)
            at(browser, k)
            game.go(k)
            assert dict(browser.ask("() => play.marking()")) == marking(game)
            enabled = [t.index for t in game.game.enabled_transitions(game.game.marking)]
            assert browser.ask("() => play.page.position.enabled") == enabled

    def test_a_marking_is_changed(self, browser: Page) -> None:
        browser.page.get_by_role("button", name="place Waits").click()
        field = browser.page.get_by_label("New marking of Waits")
        field.fill("1`ph(1) ++ 1`7")
        browser.page.get_by_role("button", name="Change").click()
        browser.page.locator(".chosen .wrong").wait_for()
        assert browser.page.locator(".chosen .wrong mark").count() == 1
        field.fill("2`ph(1)")
        browser.page.get_by_role("button", name="Change").click()
        at(browser, 1)
        assert dict(browser.ask("() => play.marking()"))["Table.Waits"] == "2`ph(1)"

    def test_a_marking_can_be_typed_as_it_stands_to_be_changed(self, browser: Page) -> None:
        """`{x=~1.5}` as it is shown is no CPN ML: `=~` is one operator."""
        field = browser.ask("""() => {
            const { marking, position } = play.page, held = position.markings[0];
            position.markings[0] = '1`{x=~1.5,s="a=~b\\nc"}';
            marking.choose(0);
            position.markings[0] = held;
            return marking.change.input.value;
        }""")
        assert field == '1`{x= ~1.5,s="a=~b\\nc"}'

    def test_expressions_are_evaluated(self, browser: Page) -> None:
        browser.page.get_by_role("tab", name="Evaluate").click()
        field = browser.page.get_by_label("Expression in CPN ML")
        field.fill("length (Mark.Table'Forks 1)")
        field.press("Enter")
        found = browser.page.get_by_text("3 : int", exact=True)
        found.wait_for()
        assert found.count() == 1

    def test_the_space_around_leads_to_a_marking(self, browser: Page) -> None:
        browser.page.locator("#net h2").click()
        browser.page.keyboard.press("s")
        browser.page.locator(".space .state").nth(3).wait_for()
        browser.page.locator(".space .state").nth(4).click()
        browser.wait("play.page.position.state.position > 0")
        browser.page.get_by_role("button", name="To a dead marking").click()
        browser.page.locator("#verdict .chip.bad").wait_for()
        assert browser.page.locator("#verdict").inner_text() == "dead"

    @pytest.mark.cc
    def test_a_counterexample_is_opened(self, browser: Page) -> None:
        browser.page.get_by_role("tab", name="Ask").click()
        browser.page.get_by_role("button", name="Ask", exact=True).click()
        browser.page.get_by_role("button", name="Show the run").click()
        at(browser, 3)
        assert browser.page.locator("#verdict").inner_text() == "dead"

    @pytest.mark.cc
    def test_a_run_of_many_steps_leaves_the_page_alive(self, browser: Page) -> None:
        browser.page.get_by_role("button", name="Many steps at once").click()
        browser.page.get_by_label("Steps at most").fill("1000000")
        browser.page.get_by_role("button", name="Run", exact=True).click()
        browser.page.get_by_text("by the compiled simulator").wait_for()
        assert browser.page.locator("#verdict").inner_text() == "dead"
        assert "Nothing is enabled any more" in browser.page.locator("#said").inner_text()
        browser.page.get_by_role("button", name="Undo").click()
        at(browser, 0)

    def test_tabs_of_the_browser_are_independent(
        self, browser: Page, server: Served, chromium: Any
    ) -> None:
        with opened(chromium) as other:
            visit(other, server)
            browser.page.keyboard.press("Space")
            at(browser, 1)
            assert position(other) == 0
            other.page.reload()
            other.page.wait_for_selector("body[data-ready=true]")
            assert position(other) == 0
        browser.page.reload()
        browser.page.wait_for_selector("body[data-ready=true]")
        at(browser, 1)

    def test_all_has_names_and_stands_out_by_day_and_night(self, browser: Page) -> None:
        tabs = browser.page.get_by_role("tab")
        for _ in range(2):
            browser.ask("() => play.page.frame.dark()")
            for name in tabs.all_inner_texts():
                browser.page.get_by_role("tab", name=name, exact=True).click()
                assert complaints(browser) == [], name

    def test_dots_start_after_the_picture_of_their_step(self, browser: Page) -> None:
        seen = browser.ask("""async () => {
            const { net, link } = play.page, { flights } = net, found = [];
            let pictures = 0, times = [];
            (function count() { pictures++; requestAnimationFrame(count); })();
            const note = () => found.push([flights.waiting.length, flights.ways.size, pictures]);
            const [hear, depart] = [link.hear.bind(link), flights.depart.bind(flights)];
            link.hear = said => { hear(said); if (said.state) note(); };
            await new Promise(departed => {
                flights.depart = () => {
                    depart();
                    note();
                    times = [...flights.ways].map(way => way.effect.getTiming());
                    departed();
                };
                document.querySelector(".sheet .enabled").dispatchEvent(new MouseEvent("click", { bubbles: true }));
            });
            return { found, delays: times.map(t => t.delay), lasts: times.map(t => t.duration) };
        }""")
        [first, last] = seen["found"]
        assert first[:2] == [1, 0] and last[0] == 0 and last[1] >= 2
        assert last[2] - first[2] == 2, "there is a picture without them before"
        assert set(seen["delays"]) == {0} and len(set(seen["lasts"])) == 1

    def test_keys_come_to_what_scrolls(self, browser: Page) -> None:
        """Not all browsers make what scrolls a stop of Tab: declarations are one, after what finds in them."""
        browser.page.get_by_role("tab", name="Net", exact=True).click()
        panel = browser.page.get_by_role("tabpanel", name="Net")
        browser.page.get_by_role("tab", name="Game", exact=True).focus()
        browser.page.keyboard.press("Tab")
        assert panel.evaluate("(e) => e === document.activeElement && e.tabIndex === 0")
        browser.page.get_by_role("tab", name="Steps", exact=True).click()
        assert browser.page.get_by_role("tabpanel").evaluate("(e) => e.tabIndex") == -1

    def test_keys_stay_with_bindings_and_go_back(self, browser: Page) -> None:
        """What is opened by keys gets them, they stay while bindings come and go, and Escape takes them back."""
        keys = browser.page.keyboard
        focus = "() => document.activeElement.closest('ul, section, g, .panel')?.getAttribute('aria-label')"
        browser.page.locator(".sheet .enabled").first.focus()
        where = browser.ask(focus)
        keys.press("Shift+Enter")
        browser.wait("document.activeElement.closest('.bindings')")
        keys.press("Enter")
        at(browser, 1)
        browser.wait("document.activeElement.closest('.chosen')")
        keys.press("Escape")
        assert browser.page.locator(".chosen").first.is_hidden()
        assert browser.ask(focus) == where
        keys.press("2")
        keys.press("Space")
        at(browser, 2)
        keys.press("Tab")
        assert browser.ask(focus) == "Marking"
        row = browser.page.get_by_role("list", name="Marking").get_by_role("button").first
        row.focus()
        keys.press("Enter")
        assert browser.ask("() => document.activeElement.tagName") == "TEXTAREA"
        keys.press("Escape")
        assert browser.ask(focus) == "Marking"

    def test_what_changes_many_times_a_second_is_not_told_each_time(self, browser: Page) -> None:
        where = browser.page.locator("#transport [aria-live]").first
        assert where.get_attribute("aria-live") == "polite"
        browser.page.keyboard.press("p")
        assert where.get_attribute("aria-live") == "off"
        browser.page.keyboard.press("p")
        assert where.get_attribute("aria-live") == "polite"

    def test_how_far_a_run_is_has_a_rate_and_an_estimate(self, browser: Page) -> None:
        said = browser.ask("""() => {
            const { bar } = play.page, own = performance.now, said = [];
            let t = 0;
            performance.now = () => t;
            for (const [total, ...moments] of [[1000, [100, 90], [2000, 500], [4000, 1000]], [0, [2000, 5000]]]) {
                t = 0;
                bar.begin(total);
                for (const [now, steps] of moments) {
                    t = now;
                    bar.progress({ progress: steps });
                    said.push(bar.busy.textContent);
                }
            }
            performance.now = own;
            bar.setBusy(false);
            bar.busy.textContent = "";
            return said;
        }""")
        assert said == [
            "90 …",
            "500, 250 a second, about 2 s left",
            "1,000 …, reading what has occurred",
            "5,000, 2,500 a second",
        ]

    def test_a_run_that_cannot_begin_is_over(self, browser: Page) -> None:
        """Not *running …* for ever."""
        browser.page.keyboard.press("r")
        browser.page.get_by_role("textbox", name="Until this is true, in CPN ML").fill(
            "nothing > 2"
        )
        browser.page.keyboard.press("Enter")
        browser.wait("document.getElementById('said').textContent.includes('not declared')")
        assert browser.page.locator("#transport [role=status]").text_content() == ""

    def test_nothing_else_is_asked_for(self, browser: Page, server: Served) -> None:
        browser.page.keyboard.press("Space")
        at(browser, 1)
        assert all(url.startswith((server.url, "data:")) for url in browser.asked)


def test_a_timed_net_on_a_phone_in_the_dark(root: Path, chromium: Any, tmp_path: Path) -> None:
    net = root / "examples/timed"
    how = {
        "viewport": {"width": 390, "height": 844},
        "reduced_motion": "reduce",
        "color_scheme": "dark",
    }
    with served(net) as server, opened(chromium, **how) as browser:
        visit(browser, server)
        assert browser.ask("() => document.documentElement.dataset.theme") == "dark"
        game = of(net, tmp_path)
        for k in range(1, 13):
            browser.page.get_by_role("button", name="A step at random").click()
            at(browser, k)
            game.step()
            assert dict(browser.ask("() => play.marking()")) == marking(game)
            shown = browser.ask("() => play.page.position.state.time")
            assert shown == time_text(game.game.marking.time)
        assert game.game.marking.time > 0
        assert browser.ask("() => document.documentElement.scrollWidth") <= 390
        assert browser.page.locator(".flight").count() == 0
        browser.page.get_by_role("button", name="More").click()
        assert browser.page.get_by_role("list", name="Enabled transitions").is_visible()
        browser.ask("""() => void play.page.enabled.list(
            play.page.net.net.transitions.findIndex((t) => t.sensors?.some((s) => s.variable === "v")))""")
        sensor = browser.page.get_by_role("group", name="Sensor gauge", exact=True)
        assert "what the gauge finds of the bond" in sensor.inner_text()
        sensor.get_by_role("button", name="good").click()
        assert browser.page.get_by_label("A part of the binding").input_value() == "v = good"
        assert browser.errors == []


def test_monitors_are_plotted(chromium: Any, tmp_path: Path) -> None:
    net = tmp_path / "net.cpn"
    net.write_bytes(with_monitors(PAIR, Spec("Size of A", "Marking size", ["Top.A"])))
    with served(net) as server, opened(chromium) as browser:
        visit(browser, server)
        for k in range(1, 6):
            browser.page.keyboard.press("Space")
            at(browser, k)
        last = browser.page.get_by_role("tab", name="Game")
        before = last.bounding_box()
        browser.page.get_by_role("tab", name="Monitors").click()
        assert last.bounding_box() == before  # a tab that is chosen does not push the others
        assert "Size of A" in browser.page.locator(".strip").inner_text()
        count = browser.ask("() => play.page.plots.points[0].length")
        browser.page.keyboard.press("Home")
        at(browser, 0)
        assert browser.ask("() => play.page.plots.points[0].length") < count
        assert browser.errors == []


def test_a_net_with_errors_shows_them_in_place(chromium: Any, tmp_path: Path) -> None:
    netbuilder.write(PAIR.replace("[n < 40]", "[n < forty]"), tmp_path / "net.cpn")
    with served(tmp_path / "net.cpn") as server, opened(chromium) as browser:
        visit(browser, server)
        assert browser.page.locator("#verdict").inner_text() == "has errors"
        assert browser.page.locator(".problems mark").inner_text() == "forty"
        browser.page.locator(".problems button.link").first.click()
        assert browser.ask("() => play.page.net.choice.selectedOptions[0].text") == "Sub"
        assert browser.page.locator(".sheet .selected").count() == 1
        assert browser.page.get_by_role("tab").all_inner_texts() == ["Problems", "Net"]
        assert browser.errors == []


def test_a_hostile_net_does_nothing(chromium: Any, tmp_path: Path) -> None:
    text = PAIR.replace("page Sub", f'page Sub\n    place "{HOSTILE}" : STRING = 1`"{HOSTILE}"')
    netbuilder.write(text, tmp_path / "net.cpn")
    with served(tmp_path / "net.cpn") as server, opened(chromium) as browser:
        visit(browser, server)
        for name in ("Marking", "Steps", "Space", "Net"):
            browser.page.get_by_role("tab", name=name, exact=True).click()
        browser.page.locator("#net h2").click()
        browser.page.keyboard.press("Space")
        at(browser, 1)
        browser.page.get_by_role("tab", name="Marking").click()
        assert "onerror" in browser.page.locator("#panel-Marking").inner_text()
        browser.page.get_by_role("tab", name="Evaluate").click()
        field = browser.page.get_by_label("Expression in CPN ML")
        field.fill(f'"{HOSTILE}"')
        field.press("Control+Enter")
        browser.page.locator(".answers pre").wait_for()
        assert browser.page.locator("img, iframe, object").count() == 0
        assert browser.errors == [] and browser.dialogues == []


def test_a_lost_server_is_told(chromium: Any, tmp_path: Path) -> None:
    netbuilder.write(PAIR, tmp_path / "net.cpn")
    with served(tmp_path / "net.cpn") as server, opened(chromium) as browser:
        visit(browser, server)
        assert server.end() == 0
        browser.page.get_by_text("The connection to pn2code is lost").wait_for()


RAISES = """
net Raises
  standard
  colset L = list INT;
  var n : INT;
  var l : L;
  page Top
    place A : INT = 1`1 ++ 1`2
    place B : L = 1`[]
    place C : INT
    trans Good
      in A : n
      out C : n
    trans Bad guard [hd l > 0]
      in B : l
      out C : 0
"""


def test_a_transition_that_raises_an_exception_says_so_and_the_others_go_on(
    chromium: Any, tmp_path: Path
) -> None:
    net = netbuilder.write(RAISES, tmp_path / "raises.cpn")
    with served(net) as server, opened(chromium) as browser:
        visit(browser, server)
        assert browser.page.locator(".sheet .enabled").count() == 1
        node = browser.page.locator(".sheet .raises")
        assert node.count() == 1
        assert "raises an exception: " in str(node.get_attribute("aria-label"))
        assert "raised the exception `Empty`" in node.locator("title").first.text_content()
        browser.page.get_by_role("tab", name="Enabled").click()
        row = browser.page.get_by_role("list", name="Transitions that raise an exception")
        assert row.inner_text().startswith("Bad")
        assert "`Top.Bad` raised the exception `Empty`" in row.inner_text()
        transition(browser, "Good, enabled").click()
        at(browser, 1)
        assert browser.page.locator("#verdict").inner_text() == "error"
        assert complaints(browser) == []
        node.click()
        browser.page.locator("#said").get_by_text("raised the exception `Empty`").wait_for()
        assert position(browser) == 1
        assert browser.errors == []

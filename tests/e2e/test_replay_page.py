"""The replay page in a browser: it shows what token game and kinematics say, and everything is connected."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.browser import Page, launched, opened
from helpers.fingers import PHONE
from helpers.legible import complaints
from helpers.shown import PAIR, described, with_arm
from pn2code.diagnostics import Diagnostics
from pn2code.net.source import read
from pn2code.replay import run as runs
from pn2code.replay.arrays import packed, packed_bytes, packed_reals
from pn2code.replay.motion import Motion
from pn2code.replay.page import page
from pn2code.robot.transforms import Array
from pn2code.run.cell import run_cell
from pn2code.run.engine import Engine
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game
from pn2code.trace.replay import replay_lines

MOMENTS = 50
TOLERANCE_M = 1e-4


@dataclass
class Between:
    """Notes where the arms are between the samples, as the motions themselves say it."""

    chance: random.Random = field(default_factory=lambda: random.Random(7))
    last: float = 0.0
    seen: list[tuple[float, str, Array]] = field(default_factory=list)

    def begun(self, engine: Engine) -> None: ...

    def advanced(self, engine: Engine) -> None: ...

    def ended(self, engine: Engine) -> None: ...

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        now = self.chance.uniform(max(self.last, engine.now), t)
        for robot in engine.robots:
            if robot.arm is not None and robot.motion is not None:
                self.seen.append((now, robot.name, np.array(robot.joints(now))))
        self.last = t


@dataclass(frozen=True)
class Shown:
    """A run of the riveting cell, its page, and what it must show."""

    result: RunResult
    file: Path
    between: Between


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The browser of this file."""
    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def shown(
    root: Path, tmp_path_factory: pytest.TempPathFactory, quick_build: None, chromium: Any
) -> Shown:
    out = tmp_path_factory.mktemp("riveting")
    motion, between, d = Motion(), Between(), Diagnostics()
    options = RunOptions(out=out, backend="fake", checked=False)
    result = run_cell(root / "examples/riveting", options, d, [motion, between])
    assert result is not None, [e.message for e in d.errors]
    document = read(root / "examples/riveting/cell.cpn", Diagnostics())
    assert document is not None
    file = out / "replay.html"
    file.write_text(page(runs.describe(result, motion, document)), encoding="utf-8")
    return Shown(result, file, between)


@pytest.fixture(scope="module")
def browser(shown: Shown, chromium: Any) -> Iterator[Page]:
    with opened(chromium) as found:
        found.open(shown.file)
        found.settled()
        yield found


@pytest.mark.cc
class TestRivetingCell:
    """One page of the riveting cell, looked at from all sides."""

    def test_it_is_one_small_file(self, shown: Shown) -> None:
        assert shown.file.stat().st_size < 5_000_000

    def test_markings_are_those_of_the_token_game(self, browser: Page, shown: Shown) -> None:
        net = shown.result.prepared.generated.partition.net
        markings: list[dict[str, str]] = []

        def watch(game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
            rows = {
                (row["id"], row["instance"]): str(row["marking"])
                for row in places(net, game.marking)
            }
            markings.append({p.name: rows[p.id, p.instance_number] for p in net.places})

        record = shown.result.record
        lines = [json.dumps(line) for line in (record.header, *record.events)]
        storage = shown.result.prepared.config.storage
        assert replay_lines(lines, net, storage, watch=watch).ok
        times = [float(e["t"]) for e in record.events if "transition" in e]
        chance = random.Random(3)
        for _ in range(MOMENTS):
            t = chance.uniform(0.0, record.time)
            browser.ask("t => replay.seek(t)", t)
            step = sum(x <= t for x in times)
            assert dict(browser.ask("() => replay.marking()")) == markings[step]

    def test_arms_are_where_the_kinematics_says(self, browser: Page, shown: Shown) -> None:
        cell = shown.result.prepared.robot_cell
        names = [r.name for r in cell.robots]
        chosen = random.Random(5).sample(shown.between.seen, MOMENTS)
        for t, name, q in chosen:
            robot = cell.robot(name)
            wanted = robot.T_world_base @ robot.kinematics.forward(q)
            found = browser.ask("([r, t]) => replay.tcp(r, t)", [names.index(name), t])
            frame = np.array(found).reshape(4, 4)
            assert np.linalg.norm(frame[:3, 3] - wanted[:3, 3]) < TOLERANCE_M
            assert np.abs(frame[:3, :3] - wanted[:3, :3]).max() < 1e-4

    def test_a_bar_leads_to_the_transition_and_its_line(self, browser: Page, shown: Shown) -> None:
        record = shown.result.record
        action = next(a for a in record.actions if a.kind == "tool")
        party = 1 + [r.name for r in shown.result.prepared.config.programs].index(action.robot)
        middle = (action.start + action.end) / 2
        at = browser.ask(
            "([t, p]) => { const l = replay.page.timeline; const b = l.canvas.getBoundingClientRect();"
            " return [b.x + l.x(t), b.y + l.lanes[p].y + 0.5 * l.lanes[p].height]; }",
            [middle, party],
        )
        browser.ask("() => replay.seek(0)")
        browser.page.mouse.click(*at)
        assert browser.ask("() => replay.page.clock.t") == pytest.approx(action.start)
        selected = browser.ask(
            "() => replay.page.course.net.transitions[replay.page.transition].name"
        )
        assert selected == action.transition
        assert browser.page.locator("#net .selected").count() >= 1
        browser.page.get_by_role("tab", name="Code").click()
        browser.page.get_by_role("combobox", name="Program").select_option(
            label=f"{action.robot}.tdl"
        )
        top = browser.ask("() => document.querySelector('.mark.moves').style.top")
        assert round(float(top.removesuffix("px")) / 17) + 1 == action.line

    def test_lines_of_what_is_chosen_are_seen(self, browser: Page, shown: Shown) -> None:
        """Of a bar whose command another step has begun; and of a transition that never occurs."""
        record = shown.result.record
        action = next(a for a in record.actions if a.kind == "tool")
        browser.page.get_by_role("tab", name="Code").click()
        follow = browser.page.locator("#panel-code").get_by_role("button", name="Follow")
        if follow.get_attribute("aria-pressed") == "false":
            follow.click()
        seen = """() => {
          const { code, run } = replay.page, view = code.view.getBoundingClientRect();
          const top = (m) => m.getBoundingClientRect().top;
          const inside = (m) => top(m) >= view.top - 1 && top(m) < view.bottom;
          return [run.programs.files[code.shown].name, [...document.querySelectorAll('.mark.chosen')].some(inside)];
        }"""
        select = """([name, jump]) => {
          const { page } = replay, i = page.course.net.transitions.findIndex((t) => t.name === name);
          page.selectTransition(i, jump);
        }"""
        browser.ask("t => replay.seek(t)", (action.start + action.end) / 2)
        browser.ask(select, [action.transition, False])
        assert browser.ask(seen) == [f"{action.robot}.tdl", True]
        occurred = {e["transition"] for e in record.events if "transition" in e}
        programs = shown.result.prepared.generated.files
        never = next(
            b.element
            for f in programs
            for b in f.blocks
            if f.path == "net.c" and b.kind == "transition" and b.element not in occurred
        )
        browser.ask(select, [never, True])
        assert browser.ask(seen) == ["net.c", True]
        browser.ask("() => replay.seek(0)")
        assert browser.page.locator(".mark.chosen").count() == 0

    def test_a_watched_place_shows_its_values(self, browser: Page) -> None:
        """Numbers are a curve, and values are written where they have room; the number of tokens alone said nothing."""
        browser.page.get_by_role("tab", name="Watch").click()
        written = browser.ask("""() => {
          const { page } = replay, { prototype } = CanvasRenderingContext2D, own = prototype.fillText, said = [];
          const i = page.course.net.places.findIndex((p) => p.name === "Cell.Robot1.Commanded");
          prototype.fillText = function (text, ...how) { said.push(text); return own.call(this, text, ...how); };
          page.watch.add(i);
          prototype.fillText = own;
          const { history } = page.watch.places.get(i);
          const { texts, tokens } = page.course;
          const values = history.map(({ count, only }) => (count ? texts[tokens.text[only]] : ""));
          page.watch.remove(i);
          return [said, values];
        }""")
        assert set(written[0]) & {"2", "5"} and set(written[1]) >= {"", "1", "2", "5"}

    def test_a_line_of_code_leads_to_its_transition(self, browser: Page, shown: Shown) -> None:
        block = next(
            b
            for f in shown.result.prepared.generated.files
            if f.path == "net.c"
            for b in f.blocks
            if b.kind == "transition"
        )
        found = browser.ask("line => replay.page.code.transitionAt(0, line)", block.first)
        assert (
            browser.ask("i => replay.page.course.net.transitions[i].name", found) == block.element
        )

    def test_a_message_leads_to_its_place(self, browser: Page, shown: Shown) -> None:
        browser.page.get_by_role("tab", name="Messages").click()
        browser.ask("() => replay.seek(0)")
        browser.page.locator(".panel.messages li").first.click()
        place = browser.ask("() => replay.page.course.net.places[replay.page.place].short")
        assert place == shown.result.record.traffic[0][1].channel

    def test_messages_of_one_moment_are_told_apart(self, browser: Page) -> None:
        """At 33.42 s there are five: each step by message leads to the step that writes or takes it."""
        found = browser.ask("""() => {
            const { page } = replay, { clock, course, messages } = page, rows = [];
            page.update = () => messages.update();  // the arms need not be drawn at each of them
            replay.step(0);
            for (let before = -1; messages.list.current > before || before < 0; page.toMessage(1)) {
              before = messages.list.current;
              rows.push([before, clock.k, clock.t]);
            }
            const back = [];
            for (; messages.list.current > 0; page.toMessage(-1)) back.push(messages.list.current);
            const moves = messages.messages.map(({ place }, i) => {
              const k = messages.steps[i], { offset, token } = course.changes;
              return [...token.slice(offset[k - 1], offset[k])].some((x) => course.tokens.place[x] === place);
            });
            delete page.update;
            messages.list.rows.onRow(7);
            return { rows, back, moves, times: messages.times, one: [clock.k, messages.steps[7]] };
        }""")
        times, rows = found["times"], [row for row in found["rows"] if row[0] >= 0]
        assert len(set(times)) < len(rows) > 150 and all(found["moves"])
        assert [t for _, _, t in rows] == [times[i] for i, _, _ in rows]
        assert [k for _, k, _ in rows] == sorted({k for _, k, _ in rows})
        assert found["back"] == [i for i, _, _ in rows][::-1][: len(found["back"])]
        assert len(found["back"]) >= len(rows) - 1
        assert found["one"][0] == found["one"][1]

    def test_an_activity_leads_to_the_transition_with_which_it_begins(self, browser: Page) -> None:
        where = """() => { const l = replay.page.timeline; l.whole(); replay.seek(0);
            const b = l.canvas.getBoundingClientRect(); const [{ y, height }] = l.lanes;
            return [b.x + l.x(50), b.y + y + 0.5 * height]; }"""
        browser.page.mouse.click(*browser.ask(where))
        browser.settled()
        name = "() => replay.page.course.net.transitions[replay.page.transition].name"
        assert browser.ask(name).startswith("Cell.Supervisor.Install.")
        assert browser.page.locator("#net .selected").count() == 1

    def test_keys_go_to_a_line_of_code_and_its_transition(
        self, browser: Page, shown: Shown
    ) -> None:
        blocks = {f.path: f.blocks for f in shown.result.prepared.generated.files}["robot1.tdl"]
        longest = max(
            (b for b in blocks if b.element == "Cell.Robot1.Drill"), key=lambda b: b.last - b.first
        )
        browser.page.get_by_role("tab", name="Code").click()
        seen = browser.ask("""() => {
            const { page } = replay, { code, net } = page;
            replay.step(0);
            code.setFollowing(true);
            page.selectTransition(net.net.transitions.findIndex((t) => t.name === "Cell.Robot1.Drill"), true);
            return [code.files[code.shown].name, code.view.scrollTop / 17, code.view.clientHeight / 17];
        }""")
        assert seen[0] == "robot1.tdl" and seen[1] < longest.first < seen[1] + seen[2]
        text = browser.page.locator("pre.code")
        browser.ask("(line) => (replay.page.code.line = line)", longest.first - 1)
        text.press("ArrowDown")
        assert f"line {longest.first}: " in str(text.get_attribute("aria-label"))
        assert browser.page.locator(".mark.line").count() == 1
        browser.ask("() => replay.page.selectPlace(0)")
        text.press("Enter")
        name = "() => replay.page.course.net.transitions[replay.page.transition].name"
        assert browser.ask(name) == "Cell.Robot1.Drill"

    def test_a_place_leads_to_its_message(self, browser: Page, shown: Shown) -> None:
        found = browser.ask("""() => {
            const { page } = replay, { messages } = page;
            page.tab("Messages");
            replay.seek(50);
            const sent = messages.messages.filter((m) => m.t <= 50);
            const other = sent.findLastIndex((m) => m.place !== sent.at(-1).place);
            page.selectPlace(sent[other].place);
            return [messages.list.current, other, page.clock.t];
        }""")
        assert found[0] == found[1] and found[2] == 50

    def test_the_way_of_an_arm_leads_to_its_moment_and_the_arm_to_what_it_does(
        self, browser: Page, shown: Shown
    ) -> None:
        action = next(a for a in shown.result.record.actions if a.kind == "linear")
        number = [r.name for r in shown.result.prepared.robot_cell.robots].index(action.robot)
        where = """([robot, t, kind]) => {
            replay.seek(t);
            const { cell } = replay.page, { camera } = cell;
            camera.updateMatrixWorld();
            const f = replay.tcp(robot, t);
            const points = [[f[3], f[7], f[11]]];
            if (kind === "arm") {
                const { links } = cell.cell.robots[robot];
                const box = new THREE.Box3().setFromObject(links.find((l) => l.name.endsWith("link_1")));
                points[0] = box.getCenter(new THREE.Vector3()).toArray();
            }
            const p = new THREE.Vector3().fromArray(points[0]).project(camera);
            const b = cell.renderer.domElement.getBoundingClientRect();
            return [b.left + (p.x + 1) * b.width / 2, b.top + (1 - p.y) * b.height / 2];
        }"""
        middle = (action.start + action.end) / 2
        at = browser.ask(where, [number, middle, "way"])
        browser.ask("() => (replay.page.cell.showPaths(true), replay.seek(0))")
        browser.page.mouse.click(*at)
        chosen = browser.ask("""() => {
            const { clock, transition, course, cell } = replay.page;
            return [clock.t, course.net.transitions[transition].name, cell.isGoing];
        }""")
        tcp = "([robot, t]) => { const f = replay.tcp(robot, t); return [f[3], f[7], f[11]]; }"
        away = np.subtract(
            browser.ask(tcp, [number, chosen[0]]), browser.ask(tcp, [number, middle])
        )
        assert np.linalg.norm(away) < 0.2, "it is at a moment when the tool was there"
        browser.ask("() => replay.page.cell.showPaths(false)")
        at = browser.ask(where, [number, middle, "arm"])
        browser.page.mouse.click(*at)
        assert browser.ask("() => replay.page.clock.t") == pytest.approx(middle)
        selected = browser.ask(
            "() => replay.page.course.net.transitions[replay.page.transition].name"
        )
        assert selected == action.transition
        browser.ask("() => replay.page.cell.showPaths(true)")

    def test_keys_move_the_cursor(self, browser: Page, shown: Shown) -> None:
        browser.page.locator("body").click(position={"x": 200, "y": 12})
        keys = browser.page.keyboard
        keys.press("Home")
        before = browser.ask("() => replay.page.clock.k")
        keys.press("ArrowRight")
        assert browser.ask("() => replay.page.clock.k") == before + 1
        keys.press("ArrowLeft")
        assert browser.ask("() => replay.page.clock.k") == before
        keys.press("]")
        assert browser.ask("() => replay.page.clock.t") > 0
        keys.press("End")
        assert browser.ask("() => replay.page.clock.k") == browser.ask(
            "() => replay.page.course.steps"
        )
        keys.press("Home")
        keys.press("Space")
        browser.wait("replay.page.clock.t > 0.05")
        keys.press("Space")
        assert browser.ask("() => replay.page.clock.isPlaying") is False

    def test_rivets_appear_as_they_are_set(self, browser: Page, shown: Shown) -> None:
        ends = sorted(a.end for a in shown.result.record.actions if a.label == "insert")
        for t, count in ((ends[2] - 0.01, 2), (ends[2] + 0.01, 3), (0.0, 0)):
            browser.ask("t => replay.seek(t)", t)
            assert browser.ask("() => replay.page.cell.cell.marks.count") == count

    def test_search_finds_transitions_places_and_values(self, browser: Page) -> None:
        field = browser.page.get_by_role("combobox", name="Find a transition")
        field.fill("robot")
        # What Enter would take is told to who hears the page.
        for key, at in (("ArrowDown", 1), ("ArrowUp", 0)):
            field.press(key)
            chosen = browser.page.locator("#found [aria-selected=true]")
            assert chosen.get_attribute("id") == field.get_attribute("aria-activedescendant")
            assert chosen.get_attribute("id") == f"found-{at}"
        for word, kind in (
            ("moveLinear", "transition"),
            ("dadosrobo1", "place"),
            ("5802.2", "value"),
            # A message has other digits than the value of the net.
            (
                browser.ask(
                    "() => replay.page.messages.messages.find((m) => m.text.includes('.')).text"
                ),
                "message",
            ),
        ):
            field.fill(word)
            assert browser.page.locator(f"#found .kind.{kind}").count() >= 1
        field.press("Enter")
        assert browser.ask("() => replay.page.clock.k") > 0

    def test_an_address_names_a_moment(self, browser: Page, shown: Shown) -> None:
        browser.page.goto("about:blank")
        browser.open(shown.file, "#t=33.42")
        assert browser.ask("() => replay.page.clock.t") == 33.42

    def test_the_address_of_a_step_leads_to_this_step(self, browser: Page) -> None:
        """Times of steps have more digits than an address usually has: `#t=` must not name the moment before."""
        steps = browser.ask("() => replay.page.course.steps")
        early = browser.ask(
            """() => [...replay.page.course.time.keys()]
               .filter((i) => Number(replay.page.course.time[i].toFixed(3)) < replay.page.course.time[i] - 1e-6)
               .map((i) => i + 1)"""
        )
        assert len(early) > 3
        for k in (*early[:3], early[-1], steps):
            browser.ask("(k) => (history.replaceState(null, '', '#'), replay.step(k))", k)
            browser.wait("location.hash.length > 1")
            assert browser.ask("() => (replay.page.fromAddress(), replay.page.clock.k)") == k

    def test_without_a_gpu_the_arms_move_on_while_the_rest_waits(self, browser: Page) -> None:
        drawn = browser.ask("""() => {
            const { page } = replay;
            let [arms, rest] = [0, 0];
            const [cell, net] = [page.cell.update, page.net.update];
            page.cell.update = (...how) => (arms++, cell.apply(page.cell, how));
            page.net.update = (...how) => (rest++, net.apply(page.net, how));
            page.clock.isPlaying = true;
            page.drawnAt = performance.now() + 1e6;  // as if all had just been drawn
            for (let i = 0; i < 10; i++) page.clock.seek(10 + i / 100);
            page.clock.isPlaying = false;
            page.clock.seek(10.5);
            delete page.cell.update, delete page.net.update;
            return [page.cell.isSparing, page.cell.hasShadows, arms, rest, page.transport.time.value];
        }""")
        assert drawn == [True, False, 11, 1, "10.50"]

    def test_without_a_gpu_shapes_are_as_coarse_as_the_picture_while_they_move(
        self, browser: Page
    ) -> None:
        found = browser.ask("""() => {
            const { page } = replay, { cell } = page;
            const count = (isGoing) => {
                cell.isGoing = isGoing;
                cell.draw(0.75, true);
                return cell.renderer.info.render.triangles;
            };
            const [whole, coarse] = [count(false), count(true)];
            const size = cell.cell.size;
            let worst = 0, meshes = 0;
            cell.cell.scene.traverse((o) => {
                if (!o.fine) return;
                meshes++;
                const { geometry, whole } = o;
                geometry.computeBoundingBox();
                whole.computeBoundingBox();
                const [a, b] = [geometry.boundingBox, whole.boundingBox];
                for (const end of ["min", "max"]) {
                    for (const axis of "xyz") {
                        worst = Math.max(worst, Math.abs(a[end][axis] - b[end][axis]) * o.grows / size);
                    }
                }
                const { array } = geometry.index;
                for (let i = 0; i < array.length; i += 3) {
                    if (new Set(array.subarray(i, i + 3)).size < 3) worst = Infinity;
                }
            });
            const again = count(false);
            return [coarse / whole, worst, meshes > 50, again === whole];
        }""")
        share, worst, are_many, is_whole_again = found
        assert 0.1 < share < 0.7
        assert worst < 1.0, "no shape has lost more than a cell of the grid"
        assert are_many and is_whole_again

    def test_what_stays_in_the_time_is_not_drawn_anew(self, browser: Page) -> None:
        drawn = browser.ask("""() => {
            const { timeline } = replay.page;
            let times = 0; // that room is divided between lanes and curves, and these are drawn
            const own = timeline.divide;
            timeline.divide = () => (times++, own.apply(timeline));
            const seen = [];
            const draw = (work) => { times = 0; work(); timeline.draw(); seen.push(times); };
            draw(() => (timeline.drawn = ""));
            draw(() => replay.seek(20));
            draw(() => timeline.zoom(0.5, 20));
            draw(() => timeline.whole());
            draw(() => replay.page.frame.dark());
            draw(() => replay.page.frame.dark());
            delete timeline.divide;
            return seen;
        }""")
        assert drawn == [1, 0, 1, 1, 1, 1]

    def test_all_has_names_and_stands_out_by_day_and_night(self, browser: Page) -> None:
        browser.ask("() => replay.seek(33.42)")
        for _ in range(2):
            browser.ask("() => replay.page.frame.dark()")
            for name in ("Messages", "Steps", "Code", "Watch", "Run"):
                browser.page.get_by_role("tab", name=name).click()
                assert complaints(browser) == [], name

    def test_nothing_was_complained_of_or_asked_for(self, browser: Page, shown: Shown) -> None:
        assert browser.errors == []
        own = {
            shown.file.resolve().as_uri(),
            f"{shown.file.resolve().as_uri()}#t=33.42",
            "about:blank",
        }
        assert [
            url for url in browser.asked if url not in own and not url.startswith("data:")
        ] == []


def test_a_gap_is_shown_as_long_as_it_is_there(tmp_path: Path, chromium: Any) -> None:
    """It comes nearer within a step of the samples, stays however long nothing moves, and is gone when it is gone."""
    shown = with_arm(described(tmp_path, PAIR))
    notes = [(0.2, 0.1), (1.2, 0.02), (3.2, 1.0)]
    shown["cell"]["gaps"] = {
        "step": 0.5,
        "near": 0.12,
        "pairs": [["arm/tip", "wall"]],
        "t": packed_reals([t for t, _ in notes], double=True),
        "pair": packed([0, 0, 0]),
        "distance": packed_reals([d for _, d in notes]),
        "points": packed_reals([0.0, 0.0, 0.0, 0.1, 0.0, 0.0] * 3),
    }
    file = tmp_path / "replay.html"
    file.write_text(page(shown), encoding="utf-8")
    moments = {0.1: [], 0.2: [0.1], 0.7: [0.1], 0.95: [0.06], 1.2: [0.02], 3.1: [0.02], 3.2: []}
    with opened(chromium) as browser:
        browser.open(file)
        for t, distances in moments.items():
            found = browser.ask("(t) => replay.page.cell.gaps.at(t).map((g) => g.distance)", t)
            assert found == pytest.approx(distances, abs=1e-6), t


@pytest.mark.parametrize("size", [(1280, 720), (390, 844)])
def test_what_messages_say_is_seen_beside_many_programs(
    tmp_path: Path, chromium: Any, size: tuple[int, int]
) -> None:
    """Columns are as narrow as they must be; names are whole, and each leads to its column, where arrows begin."""
    shown = with_arm(described(tmp_path, PAIR))
    shown["happenings"]["parties"] += [
        {"name": f"robot number {k}", "kind": "robot"} for k in range(3, 8)
    ]
    for m in shown["happenings"]["messages"]:
        m["from"] = 6
    file = tmp_path / "replay.html"
    file.write_text(page(shown), encoding="utf-8")
    with opened(chromium, viewport={"width": size[0], "height": size[1]}) as browser:
        browser.open(file)
        if size[0] < size[1]:
            browser.page.get_by_role("button", name="More").click()
        browser.wait("document.querySelector('.panel.messages .said')")
        room, leads, begins, names = browser.ask("""() => {
            const box = (what) => document.querySelector(`.panel.messages ${what}`).getBoundingClientRect();
            const panel = box(".long"), said = box(".said");
            const last = document.querySelectorAll(".panel.messages .lead")[6].getBoundingClientRect();
            const line = box(".message .line");
            const names = [...document.querySelectorAll(".panel.messages .party")].map((name) => {
              const { left, right, top, bottom } = name.getBoundingClientRect();
              return { left, right, top, bottom, cut: name.scrollWidth - name.clientWidth };
            });
            return [panel.right - Math.max(said.left, panel.left), last.left, line.right, names];
        }""")
        assert room > 120
        assert abs(begins - leads) < 3
        assert len(names) == 7
        assert all(name["cut"] <= 0 and name["right"] <= size[0] for name in names), names
        for a, b in combinations(names, 2):
            is_beside = a["right"] <= b["left"] or b["right"] <= a["left"]
            assert is_beside or a["bottom"] <= b["top"] + 1 or b["bottom"] <= a["top"] + 1, (a, b)
        assert browser.errors == []


def test_an_arm_in_a_singularity_has_no_number(tmp_path: Path, chromium: Any) -> None:
    """How large the condition number is there is rounding: it is no number to be read."""
    shown = with_arm(described(tmp_path, PAIR))
    curve = {"kind": "condition", "of": "arm", "unit": "", "limit": 50.0}
    values = packed_reals([8645777688063115264.0, 8645777688063115264.0, 7.25])
    shown["happenings"]["curves"] = [
        {**curve, "t": packed_reals([0.0, 1.0, 2.0], double=True), "v": values}
    ]
    file = tmp_path / "replay.html"
    file.write_text(page(shown), encoding="utf-8")
    for options in ({}, PHONE):
        with opened(chromium, **options) as browser:
            browser.open(file)
            if options:
                browser.page.get_by_role("button", name="Cell", exact=True).click()
            arm = browser.page.locator("#cell .status .arm").first
            for t, says in ((0.5, "conditioning above 1,000,000"), (2.0, "conditioning 7.3")):
                browser.ask("t => replay.seek(t)", t)
                assert " ".join(arm.inner_text().split()).endswith(f"· {says}")
                assert arm.evaluate("(e) => e.scrollWidth <= e.clientWidth"), "it is cut off"
            assert browser.errors == []


def test_how_it_ended_leaves_room_to_search_on_a_phone(tmp_path: Path, chromium: Any) -> None:
    shown = with_arm(described(tmp_path, PAIR))
    final = ["Top.Robot has stopped after a fault"]
    shown["verdict"] = {"word": "finished", "reason": "", "final": final, "failed": final}
    with opened(chromium, **PHONE) as browser:
        browser.open(written(tmp_path, shown))
        chip, search = (
            browser.page.locator(f"#top {which}").bounding_box() for which in (".chip", "#search")
        )
        assert chip["height"] < 30 and search["width"] >= 60
        assert browser.ask("() => document.documentElement.scrollWidth") <= 390
        cut = "() => { const e = document.getElementById('verdict'); return e.scrollWidth - e.clientWidth; }"
        assert browser.ask(cut) <= 0 and chip["width"] < 375


@pytest.mark.parametrize("options", [{}, PHONE], ids=["desk", "phone"])
def test_by_what_a_run_has_failed_can_be_read(
    options: dict[str, Any], tmp_path: Path, chromium: Any
) -> None:
    """Also where it is not the place at which it ended: *failure: Finished* said nothing."""
    shown = with_arm(described(tmp_path, PAIR))
    failed = ["{ Mark.Supervisor'Result 1 = [scrap] }"]
    shown["verdict"] = {
        "word": "finished",
        "reason": "",
        "final": ["Top.Finished"],
        "failed": failed,
    }
    with opened(chromium, **options) as browser:
        browser.open(written(tmp_path, shown))
        chip = browser.page.locator("#verdict .chip.bad")
        condition = failed[0][2:-2]
        assert chip.inner_text() == f"failure: {condition}"
        assert chip.get_attribute("title") == f"failure: {condition}; finished, ended in Finished"
        assert browser.ask("() => document.documentElement.scrollWidth <= innerWidth")
        if options:
            browser.page.get_by_role("button", name="More", exact=True).click()
        browser.page.get_by_role("tab", name="Run", exact=True).click()
        row = browser.page.locator("#panel-run dt", has_text="failure").locator("+ dd")
        assert row.inner_text() == condition
        assert browser.errors == []


@pytest.mark.parametrize("options", [{}, PHONE], ids=["desk", "phone"])
def test_why_a_run_has_failed_stands_in_the_head(
    options: dict[str, Any], tmp_path: Path, chromium: Any
) -> None:
    """As in the terminal, and as far as there is room; the title and the search keep theirs."""
    shown = with_arm(described(tmp_path, PAIR))
    why = "`robot2/link_4` and `pillar` collide (17.6 mm deep at 1958, 280, 1688 mm)"
    shown["verdict"] = {"word": "failed", "reason": 3 * f"{why}; ", "final": []}
    with opened(chromium, **options) as browser:
        browser.open(written(tmp_path, shown))
        assert browser.page.locator("#verdict .chip.bad").inner_text() == "failed"
        assert browser.page.locator("#verdict .reason").inner_text().startswith(why)
        assert browser.page.locator("#search").bounding_box()["width"] >= 60
        cut = "(e) => e.scrollWidth - e.clientWidth"
        assert options or browser.page.locator("#title").evaluate(cut) <= 0
        assert browser.ask("() => document.documentElement.scrollWidth <= innerWidth")
        assert complaints(browser) == []


def test_what_a_key_goes_to_is_seen_and_stands_out(tmp_path: Path, chromium: Any) -> None:
    """Also where the window shows a part of the page, and of what occurs just then."""
    file = tmp_path / "replay.html"
    file.write_text(page(described(tmp_path, PAIR)), encoding="utf-8")
    with opened(chromium, viewport={"width": 390, "height": 844}) as browser:
        browser.open(file, "#step=1")
        browser.ask("""() => {
            const { net } = replay.page, [x, y, w, h] = net.window.view;
            net.window.set([x + 5 * w, y, w / 2, h / 2], false);
        }""")
        browser.page.get_by_role("button", name="Fit").focus()
        for _ in range(browser.page.locator(".sheet .active").count()):
            browser.page.keyboard.press("Tab")
            inside, width = browser.ask("""() => {
                const own = document.activeElement, pane = own.closest("svg").getBoundingClientRect();
                const box = own.getBoundingClientRect();
                const shape = own.querySelector(":scope > rect, :scope > ellipse");
                const { stroke, strokeWidth } = getComputedStyle(shape);
                return [
                    box.left < pane.right && box.right > pane.left && box.top < pane.bottom && box.bottom > pane.top,
                    stroke === "rgb(11, 95, 196)" ? parseFloat(strokeWidth) : 0,
                ];
            }""")
            assert inside and width >= 5


WITHOUT_WEBGL = """
    const own = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...how) {
        return kind.includes("webgl") ? null : own.call(this, kind, ...how);
    };
"""


@pytest.mark.cc
def test_without_webgl_the_rest_of_the_page_works(shown: Shown, chromium: Any) -> None:
    """Firefox without it: test_other_browsers."""
    with opened(chromium) as browser:
        browser.page.add_init_script(WITHOUT_WEBGL)
        browser.open(shown.file)
        said = browser.ask("() => document.querySelector('.missing').textContent")
        assert "this browser has no WebGL" in said
        keys = browser.page.keyboard
        keys.press("Home")
        before = browser.ask("() => replay.page.clock.k")
        keys.press("ArrowRight")
        assert browser.ask("() => replay.page.clock.k") == before + 1


def test_shapes_are_drawn_as_the_gltf_has_them(tmp_path: Path, chromium: Any) -> None:
    """In the colours of the cell, of which glTF has the light; points and frames to 0.01 mm."""
    with opened(chromium) as browser:
        browser.open(written(tmp_path, with_arm(described(tmp_path, PAIR))))
        found = browser.ask("""() => {
            const [{ links }] = replay.page.cell.cell.robots;
            return links.map((link) => link.children.map((o) => {
                const { color, opacity } = o.fine;
                o.geometry.computeBoundingBox();
                const { min, max } = o.geometry.boundingBox;
                return [...color.toArray(), opacity, ...min.toArray(), ...max.toArray()];
            }));
        }""")
        expected = [0.8, 0.4, 0.1, 1.0, -0.1, -0.1, -0.1, 0.1, 0.1, 0.1]
        assert found == [[pytest.approx(expected, abs=1e-5)]] * 2 + [[]]
        assert browser.errors == []


ELSEWHERE = json.dumps(
    {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "http://127.0.0.1:9/points"}],
    }
).encode()


@pytest.mark.parametrize("glb", [b"", b"glTF no more than that", b"{}", ELSEWHERE])
def test_shapes_that_cannot_be_read_leave_the_rest(
    glb: bytes, tmp_path: Path, chromium: Any
) -> None:
    run = with_arm(described(tmp_path, PAIR))
    run["cell"]["glb"] = packed_bytes(glb)
    with opened(chromium) as browser:
        browser.open(written(tmp_path, run))
        assert "its glTF cannot be read" in browser.page.locator(".missing").inner_text()
        browser.page.keyboard.press("ArrowRight")
        assert browser.ask("() => replay.page.clock.k") == 1
        assert len(browser.asked) == 1, "nothing but the page itself"


DRAWN_BY = """
    for (const kind of [WebGLRenderingContext, WebGL2RenderingContext]) {
        const own = kind.prototype.getParameter;
        kind.prototype.getParameter = function (name) {
            return name === 0x9246 ? "%s" : own.call(this, name);
        };
    }
"""


@pytest.mark.cc
@pytest.mark.parametrize(("rate", "is_sparing"), [(1000.0, True), (0.0, False)])
def test_a_browser_that_hides_who_draws_is_measured(
    shown: Shown, chromium: Any, rate: float, is_sparing: bool
) -> None:
    """WebKit says `Apple GPU` everywhere. Whether pictures take long is a matter of the clock, which is the test's."""
    clock = "const real = performance.now.bind(performance); performance.now = () => RATE * real();"
    with opened(chromium) as browser:
        browser.page.add_init_script(DRAWN_BY % "Apple GPU" + clock.replace("RATE", str(rate)))
        browser.open(shown.file)
        asked = "() => [replay.page.cell.isSparing, replay.page.cell.hasShadows]"
        assert browser.ask(asked) == [is_sparing, not is_sparing]
        assert browser.errors == []


@pytest.mark.cc
def test_pictures_that_take_seconds_are_too_slow_as_well(browser: Page) -> None:
    asked = browser.ask("""() => {
        const thrift = new (replay.page.cell.thrift.constructor)();
        const pictures = (...times) => times.map((t) => thrift.picture(t));
        const first = pictures(10, 5000, 10000, 15000, 20000);
        thrift.rest();  // the page was in the background
        return [first, pictures(90000, 90020, 90600, 90620, 91200, 91220)];
    }""")
    assert asked == [[False, False, False, True, False], [False] * 6]


@pytest.mark.cc
def test_the_cursor_keeps_the_time_where_pictures_are_slow(browser: Page) -> None:
    moved = browser.ask("""() => {
        const { clock } = replay.page;
        const before = requestAnimationFrame;
        window.requestAnimationFrame = () => 0;
        clock.seek(1), clock.play();
        for (const t of [1000, 1800, 2600]) clock.frame(t);
        clock.pause();
        window.requestAnimationFrame = before;
        return clock.t;
    }""")
    assert moved == pytest.approx(2.6)


@pytest.mark.cc
def test_with_a_gpu_there_are_shadows_and_all_of_the_shapes(shown: Shown, chromium: Any) -> None:
    with opened(chromium) as browser:
        browser.page.add_init_script(DRAWN_BY % "A GPU")
        browser.open(shown.file)
        browser.wait("replay.page.cell.hasShadows")
        seen = browser.ask("""() => {
            const { cell } = replay.page;
            cell.isGoing = true;
            cell.draw(cell.ratio, cell.isSparing);
            return [cell.isSparing, cell.cell.size, cell.renderer.getContext().getContextAttributes().antialias];
        }""")
        assert seen == [False, 0, True]
        assert browser.errors == []


HOSTILE = "<img src=x onerror=alert(1)>"
TURNED = {
    "viewport": {"width": 390, "height": 844},
    "reduced_motion": "reduce",
    "color_scheme": "dark",
}


def written(folder: Path, shown: dict[str, Any], other: dict[str, Any] | None = None) -> Path:
    file = folder / "page.html"
    file.write_text(page(shown, other), encoding="utf-8")
    return file


def test_a_trace_without_arms_on_a_phone_in_the_dark(tmp_path: Path, chromium: Any) -> None:
    file = written(tmp_path, described(tmp_path))
    with opened(chromium, **TURNED) as browser:
        browser.open(file, "#step=7")
        assert browser.ask("() => replay.page.clock.k") == 7
        assert browser.ask("() => document.documentElement.dataset.theme") == "dark"
        assert browser.ask("() => document.documentElement.scrollWidth") <= 390
        assert browser.ask("() => [...document.querySelectorAll('#net .tokens text')].length") > 0
        assert browser.ask("() => document.querySelectorAll('.flight').length") == 0
        # A value that no step binds is found where it is, now or later.
        found = browser.ask("""() => {
            const { search, course, clock } = replay.page;
            clock.step(course.steps);
            const marking = replay.marking();
            const all = marking.map(([, text]) => text).join("++");
            const last = String(Math.max(...[...all.matchAll(/`(\\d+)/g)].map((m) => m[1])));
            const look = () => search.search(last).filter((f) => f.kind === "value").map((f) => f.more);
            const now = look();
            clock.step(7);
            const later = look();
            search.search(last)[0].go();
            const { place } = replay.page;
            return { now, later, text: course.text(place), last, k: clock.k };
        }""")
        assert found["now"][0].startswith("now in ") and len(found["now"]) == 1
        assert len(found["later"]) == 1 and f"step {found['k']}: comes to " in found["later"][0]
        assert f"`{found['last']}" in found["text"]
        browser.page.get_by_role("button", name="More").click()
        assert browser.page.get_by_role("listbox", name="Steps").is_visible()
        assert browser.errors == []


def test_on_a_phone_what_occurs_can_be_read(shown: Shown, chromium: Any) -> None:
    text = """() => {
        const { net } = replay.page, t = net.course.occurred(replay.page.clock.k);
        const node = net.draw(net.net.instances[net.current].page).elements.get(t.id)[0];
        const [box, sheet] = [node.getBoundingClientRect(), net.sheet.getBoundingClientRect()];
        const isSeen = box.left >= sheet.left && box.right <= sheet.right && box.top >= sheet.top;
        return [net.net.style.size * net.sheet.getScreenCTM().a, isSeen && box.bottom <= sheet.bottom];
    }"""
    with opened(chromium, **TURNED) as browser:
        browser.open(shown.file, "#step=30")
        browser.settled()
        for step in (30, 31, 60, 90):
            browser.ask("k => replay.step(k)", step)
            size, is_seen = browser.ask(text)
            assert size > 8 and is_seen, step
        browser.page.get_by_role("button", name="Fit").click()
        browser.ask("""() => {
            const { course, clock, net } = replay.page;
            let k = clock.k + 1;
            while (course.occurred(k).instance !== net.current) k++;
            replay.step(k);
        }""")
        assert browser.ask(text)[0] < 5, "whoever wants the whole page keeps it"
        browser.page.get_by_role("button", name="Follow").click(click_count=2)
        assert browser.ask(text)[0] > 8
        browser.page.get_by_role("button", name="More").click()
        browser.wait(
            "document.querySelector('.panel.messages .said')?.getBoundingClientRect().width > 100"
        )
        assert browser.errors == []


def test_a_hostile_net_does_nothing(tmp_path: Path, chromium: Any) -> None:
    text = PAIR.replace("page Sub", f'page Sub\n    place "{HOSTILE}" : STRING = 1`"{HOSTILE}"')
    shown = described(tmp_path, text)
    shown["title"] = f"</script><script>alert(2)</script>{HOSTILE}"
    shown["facts"].append([HOSTILE, "javascript:alert(3)"])
    shown["net"]["pages"][0]["name"] = HOSTILE
    file = written(tmp_path, shown)
    with opened(chromium) as browser:
        browser.open(file, "#step=3")
        field = browser.page.get_by_role("combobox", name="Find a transition")
        field.fill("img")
        assert "onerror" in browser.page.locator("#found").inner_text()
        field.press("Escape")
        browser.page.get_by_role("tab", name="Run").click()
        browser.settled()
        assert browser.dialogues == []
        assert browser.page.locator("img, iframe, object").count() == 0
        assert browser.errors == []


def test_two_runs_beside_each_other(tmp_path: Path, chromium: Any) -> None:
    (tmp_path / "b").mkdir()
    other = described(
        tmp_path / "b", PAIR.replace("out Out : n + 1", "out Out : if n = 3 then 9 else n + 1")
    )
    file = written(tmp_path, described(tmp_path), other)
    with opened(chromium) as browser:
        browser.open(file)
        banner = browser.page.locator("#difference")
        button = banner.get_by_role("button", name="Net: step")
        step = int(button.inner_text().split("step ")[1])
        button.click()
        assert browser.ask("() => [replay.page.course.at, replay.page.beside.course.at]") == [
            step,
            step,
        ]
        assert browser.page.locator(".sheet").count() == 2
        assert browser.page.locator("#net .differs").count() > 0
        browser.ask("k => replay.step(k)", step - 1)
        assert browser.page.locator(".differs").count() == 0
        assert complaints(browser) == []
        # On a phone there is no choice that leads to nothing.
        assert browser.page.locator("#panes button").all_text_contents() == ["Net", "Time", "More"]
        assert browser.errors == []


def test_how_both_runs_have_ended_is_said(tmp_path: Path, chromium: Any) -> None:
    run = described(tmp_path, steps=6)
    first = {**run, "verdict": {"word": "finished", "reason": "", "final": []}}
    second = {**run, "verdict": {"word": "error", "reason": "Subscript", "final": []}}
    with opened(chromium, viewport={"width": 1400, "height": 950}) as browser:
        browser.open(written(tmp_path, first, second))
        said = browser.page.locator("#verdict")
        words = "A nothing is enabled any more B an inscription of the net raised an error"
        assert " ".join(said.inner_text().split()) == words
        kinds = "() => [...document.querySelectorAll('#verdict .chip')].map((c) => c.className)"
        assert browser.ask(kinds) == ["chip plain", "chip bad"]
        assert complaints(browser) == []
        browser.open(written(tmp_path, first))
        assert said.inner_text() == "nothing is enabled any more"
        assert browser.errors == []


def test_how_both_runs_have_ended_is_read_on_a_phone(tmp_path: Path, chromium: Any) -> None:
    run = described(tmp_path, steps=6)
    verdicts = (
        {
            "word": "finished",
            "reason": "",
            "final": ["Top.Supervisor.All parts are at their place"],
        },
        {"word": "error", "reason": "Subscript", "final": []},
    )
    first, second = ({**run, "verdict": v} for v in verdicts)
    with opened(chromium, **PHONE) as browser:
        browser.open(written(tmp_path, first, second))
        head = browser.page.locator("#verdict").bounding_box()
        for text in ("nothing is enabled any more", "raised an error"):
            chip = browser.page.locator("#verdict .chip", has_text=text).bounding_box()
            assert head["x"] <= chip["x"] and chip["x"] + chip["width"] <= head["x"] + head["width"]
            assert (
                head["y"] <= chip["y"] and chip["y"] + chip["height"] <= head["y"] + head["height"]
            )
        # Each mark stands beside its chip, and the page that is shown of each net can be read.
        boxes = browser.ask(
            """() => [...document.querySelectorAll('#verdict .which, #verdict .chip')].map((e) => {
                const box = e.getBoundingClientRect(); return [box.top, box.bottom, e.getClientRects().length]; })"""
        )
        for mark, chip in zip(boxes[::2], boxes[1::2], strict=True):
            assert chip[2] == 1 and chip[0] <= (mark[0] + mark[1]) / 2 <= chip[1]
        choosers = "() => [...document.querySelectorAll('#net select, #net-2 select')].map((s) => s.clientWidth)"
        assert min(browser.ask(choosers)) > 90
        assert browser.ask("() => document.documentElement.scrollWidth") <= 390
        assert complaints(browser) == []


def test_curves_are_seen_below_the_lanes_or_named_where_they_are_not(
    tmp_path: Path, chromium: Any
) -> None:
    """At 1280 x 720: of two arms all is seen; of many, what is below the fold is named, and a click shows it."""
    run = with_arm(described(tmp_path, PAIR))
    happenings = run["happenings"]
    happenings["parties"] += [{"name": "robot2", "kind": "robot"}]
    of = {
        "clearance": ["robots", "scene.robot1", "scene.robot2", "self.robot1", "self.robot2"],
        "condition": ["robot1", "robot2"],
    }
    happenings["curves"] = [
        {"kind": kind, "of": name, "limit": 0.02 if kind == "clearance" else 50.0}
        | {"t": packed_reals([0.0, 9.0], double=True), "v": packed_reals([1.0, 2.0])}
        for kind, names in of.items()
        for name in names
    ]
    seen = """() => {
      const { host, curves, below } = replay.page.timeline;
      const { y, height } = curves[curves.length - 1];
      return [host.scrollTop + host.clientHeight - y - height, below.hidden ? "" : below.textContent];
    }"""
    with opened(chromium) as browser:
        browser.open(written(tmp_path, run))
        browser.settled()
        room, below = browser.ask(seen)
        assert room >= 0 and not below
        happenings["parties"] += [{"name": f"robot {k}", "kind": "robot"} for k in range(3, 12)]
        browser.open(written(tmp_path, run))
        browser.settled()
        room, below = browser.ask(seen)
        assert room < 0 and below == "▾ clearance [mm], conditioning"
        assert complaints(browser) == []
        browser.page.locator(".below").click()
        browser.wait("replay.page.timeline.below.hidden")
        assert browser.ask(seen)[0] >= 0
        assert browser.errors == []


def test_tools_in_use_and_clamps_are_told(tmp_path: Path, chromium: Any) -> None:
    run = with_arm(described(tmp_path, steps=6), joints=lambda k: 0.0)
    unit = run["cell"]["robots"][0]["base"]
    in_world = {"frame": unit, "holder": ""}
    held = {"frame": unit, "holder": "arm"}
    coupled = [{"t": 0.0, **in_world}, {"t": 2.0, **held}, {"t": 5.0, **in_world}]
    run["cell"] |= {
        "kinds": {"cup": [], "part": []},
        "tools": {"cup": [*unit[:3], 0.25, *unit[4:]]},
        "parts": [
            {"name": "part.1", "kind": "part", "states": [{"t": 0.0, **held}]},
            {"name": "cup", "kind": "cup", "states": coupled},
        ],
    }
    run["cell"]["robots"][0]["changes"] = True
    jaws = [
        {"parent": 0, "child": k, "frame": unit, "axis": [1, 0, 0], "moves": k - 1, "slides": True}
        for k in (1, 2, 3)
    ]
    links = [{"name": name} for name in ("stand", "door", "vice_1", "vice_2")]
    press = {"name": "press", "device": True, "base": unit, "home": [0.9, 0.05, 0.06], "tcp": 0}
    press |= {"links": links, "joints": jaws, "clamps": {"vice": [1, 2]}, "lower": [], "upper": []}
    run["cell"]["robots"].append(press)
    with opened(chromium, viewport={"width": 1400, "height": 950}) as browser:
        browser.open(written(tmp_path, run))
        said = browser.page.locator("#cell .status .arm")
        for t, tool, reach in ((1.0, "no tool", 1000), (3.0, "cup", 1250), (5.5, "no tool", 1000)):
            browser.ask("t => replay.seek(t)", t)
            words = " ".join(said.nth(0).inner_text().split())
            assert words == f"arm rests · {tool} · TCP {reach:.1f} 0.0 0.0 mm"
        assert said.nth(1).inner_text().split("·")[1].split() == [
            "door",
            "900.0",
            "mm",
            "vice",
            "110.0",
            "mm",
        ]
        assert browser.errors == []


def test_two_cells_move_in_step_whatever_their_tempo(tmp_path: Path, chromium: Any) -> None:
    run = described(tmp_path, steps=12)
    other = with_arm(
        run, 2.0, lambda k: 0.1 * k + 0.2 * (k > 7), lambda k: "x" if k == 9 else f"{k}"
    )
    file = written(tmp_path, with_arm(run), other)
    at = "() => { const { clock, beside } = replay.page; return [clock.t, clock.k, beside.pacing.t, beside.pacing.k]; }"
    with opened(chromium, viewport={"width": 1400, "height": 950}) as browser:
        browser.open(file)
        assert browser.page.locator(".stage canvas").count() == 2
        browser.ask("() => replay.seek(4.5)")
        assert browser.ask(at) == [4.5, 4, 9.0, 4]
        arms = "() => [replay.page.cell, replay.page.beside.cell].map((c) => c.frames[0][2].slice(3, 4)[0])"
        assert len({round(x, 6) for x in browser.ask(arms)}) == 1
        banner = browser.page.locator("#difference")
        banner.get_by_role("button", name="Pose: arm").click()
        assert browser.ask(at) == [8.0, 8, 16.0, 8]
        assert "mm from A" in browser.page.locator("#cell-2 .apart").inner_text()
        margin = "(e) => getComputedStyle(e).marginLeft"
        assert browser.page.locator("#cell-2 .apart").evaluate(margin) == "8px"
        banner.get_by_role("button", name="Message: done").click()
        assert browser.ask(at)[0] == 9.0
        banner.get_by_role("button", name="Same time").click()
        assert browser.ask(at) == [9.0, 9, 9.0, 4]
        assert browser.ask("() => replay.page.clock.end") == 24.0
        browser.ask("() => replay.page.cell.view(2)")
        cameras = "() => [replay.page.cell, replay.page.beside.cell].map((c) => c.camera.position.toArray())"
        one, two = browser.ask(cameras)
        assert one == pytest.approx(two, abs=1e-9)
        browser.page.get_by_role("tab", name="Time of B").click()
        size = "document.querySelector('.time-of-b canvas').getBoundingClientRect()"
        browser.wait(f"{size}.width > 200 && {size}.height > 60")
        assert complaints(browser) == []
        assert browser.errors == []


def test_the_page_of_the_last_step_is_turned_to_though_no_step_follows(
    tmp_path: Path, chromium: Any
) -> None:
    """A page stays for a while, so that all can be read where much happens; then that of the last step is shown."""
    with opened(chromium) as browser:
        browser.open(written(tmp_path, described(tmp_path)))
        before, soon, later, wanted = browser.ask("""() => {
          const { net, course } = replay.page;
          const at = (k) => course.occurred(k).instance;
          const k = [...Array(29).keys()].find((i) => i > 0 && at(i) !== at(i + 1));
          const how = { isPlaying: true, speed: 1 };
          const seen = [];
          net.update(k, k, { ...how, isPlaying: false });
          net.shownAt = performance.now();
          seen.push(net.current === at(k));
          net.update(k + 1, k + 1, how);
          seen.push(net.current);
          net.shownAt = -1e6;
          net.update(k + 1, k + 1.5, how);
          return [...seen, net.current, at(k + 1)];
        }""")
        assert before and soon != wanted and later == wanted


def test_a_moment_of_a_very_long_run_is_near_a_key(tmp_path: Path, chromium: Any) -> None:
    """Many steps: seeking to and fro gives the same markings as going there step by step."""
    text = PAIR.replace("[n < 40]", "[n < 1200]")
    file = written(tmp_path, described(tmp_path, text, 1800))
    with opened(chromium) as browser:
        browser.open(file)
        script = """() => { const c = replay.page.course, r = [];
            const text = () => c.net.places.map((_, i) => c.text(i)).join();
            const there = new Map();
            for (let k = 0; k <= c.steps; k++) { c.seek(k); if (k % 97 === 0) there.set(k, text()); }
            for (const k of [...there.keys()].sort((a, b) => (a * 7919) % 6007 - (b * 7919) % 6007)) {
              c.seek(k); if (text() !== there.get(k)) r.push(k); }
            return [there.size, r]; }"""
        assert browser.ask(script) == [19, []]

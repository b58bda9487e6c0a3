"""Random supervisors: they ask devices, hear, try again, give up; with timers, queues, references, other pages."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

from tools.adversary.devices import Program
from tools.adversary.extras import more, relay
from tools.adversary.pages import PRIORITIES, Page, head

_PATH = "Top.Supervisor."


class Supervisor:
    """Its pages, the declarations that they need, its final places, and the places that are worth looking at."""

    def __init__(self, r: Random, devices: Sequence[Program], *, is_timed: bool) -> None:
        self.r = r
        self.is_timed = is_timed
        self.page = page = Page("Sup")
        self.pages = [page]
        self.declarations = ""
        self.looked_at: list[str] = []
        self.followed: list[tuple[str, str]] = []
        self.has_references = r.random() < 0.1
        if self.has_references:
            self.declarations = (
                "  val seen = ref 0;\n  val last = ref (nil : int list);\n"
                "  fun note i = (seen := (!seen + 1) mod 3; last := List.tabulate (i mod 3, fn j => j));\n"
            )
        # A page of its own for alarms shares its place by fusion, or is the same page.
        self.guards = page
        page.place("Alarm", fusion=self._other_page(r.random() < 0.3))
        for k, made in enumerate(devices, 1):
            self._exchange(k, made)
        self._ends(len(devices))
        self._extras()
        self.looked_at += more(r, page, len(devices), self._head, is_timed=is_timed, path=_PATH)
        self.pages += relay(r, page, len(devices))
        self.may_fail = r.random() < 0.5
        if self.may_fail:
            self.guards.transition("GiveUp", ["in Alarm : ()", "out Failed : ()"], self._head())
        fused = "Failed" if self.guards is not page else ""
        page.place("Failed", fusion=fused)
        if fused:
            self.guards.place("Failed", fusion=fused)
        self.looked_at += (
            ["Fusion.Alarm", "Fusion.Failed"] if fused else [_PATH + "Alarm", _PATH + "Failed"]
        )
        self.final = ["Finished"] + (["Failed"] if self.may_fail and r.random() < 0.7 else [])

    def _other_page(self, wanted: bool) -> str:
        """The fusion set of alarms; "": they stay on the page."""
        if not wanted:
            return ""
        self.guards = Page("Guards")
        self.guards.place("Alarm", fusion="Alarm")
        self.pages.append(self.guards)
        self.page.transitions.append("    subst Watch = Guards ()")
        return "Alarm"

    def _head(self, guard: str = "", delay: str = "") -> str:
        code = "note 2" if self.has_references and self.r.random() < 0.4 else ""
        return head(self.r.choice(PRIORITIES), guard, delay, code)

    # --- a device ------------------------------------------------------------------------------

    def _exchange(self, k: int, made: Program) -> None:
        """What is done with a device."""
        r, page = self.r, self.page
        told, answer = made.ports[0].sort, made.ports[1].sort
        for p in made.ports:
            page.port(f"{p.name}{k}", "out" if p.told else "in", p.colset)
        page.place(f"Idle{k}", initial="1" if k == 1 or r.random() < 0.6 else "")
        page.place(f"Armed{k}")
        page.place(f"Have{k}")
        page.place(f"Left{k}", "INT", f"1`{r.randint(0, 2)}")
        self.looked_at += [f"{_PATH}{n}{k}" for n in ("Idle", "Armed", "Have")]
        self.followed.append((f"{_PATH}Armed{k}", f"{_PATH}Have{k}"))
        sends = [f"out cmd{k} : {r.choice(told.values)}", f"out Armed{k} : ()"]
        if made.port("dat"):
            sends.append(f"out dat{k} : {r.randint(0, 5)}")
        is_hinted = r.random() < 0.6
        if made.port("hint") and is_hinted:
            sends.append(f"out hint{k} : {r.randint(0, 5)}")
        for n in range(r.choice([1, 1, 2])) if self.is_timed else ():
            if r.random() < 0.6:
                page.place(f"Dog{k}_{n}", "TU")
                sends.append(f"out Dog{k}_{n} : ()@+{r.randint(1, 3)}")
                self._watchdog(k, n)
        guard = "!seen < 2" if self.has_references and r.random() < 0.3 else ""
        page.transition(f"Ask{k}", [f"in Idle{k} : ()", *sends], self._head(guard))
        heard = [f"in Armed{k} : ()", f"in ans{k} : {answer.variable}"]
        if made.port("rep"):
            heard.append(f"in rep{k} : {r.choice(['e', 'e', 'e', '1'])}")
        tests = list(answer.tests)
        r.shuffle(tests)
        for w, test in enumerate(tests[: r.randint(1, 2)]):
            guard = test if r.random() < 0.5 else ""
            arcs = list(heard)
            if w > 0 and r.random() < 0.6:
                guard = f"{test}, n > 0" if guard else "n > 0"
                arcs += [f"in Left{k} : n", f"out Left{k} : n - 1", f"out Idle{k} : ()"]
            else:
                arcs.append(f"out Have{k} : ()")
            if r.random() < 0.2:
                arcs.append(f"both {r.choice([f'Left{k} : m', 'Tick : m'])}")
            page.transition(f"Got{k}_{w}", arcs, self._head(guard))
        if r.random() < 0.3:  # it may go on before it has heard
            page.place(f"Past{k}")
            page.transition(f"Advance{k}", [f"in Armed{k} : ()", f"out Past{k} : ()"], self._head())
            arcs = [f"in Past{k} : ()", *heard[1:]]
            arcs.append(f"out {r.choice([f'Have{k}', f'Idle{k}', f'Have{k}'])} : ()")
            page.transition(f"Late{k}", arcs, self._head())
            self.looked_at.append(f"{_PATH}Past{k}")
        if made.port("hint") and (
            not is_hinted or r.random() < 0.4
        ):  # a second thought while the device works
            page.place(f"Hinted{k}", initial="1")
            arcs = [f"in Hinted{k} : ()", f"both Armed{k} : ()", f"out hint{k} : 4"]
            page.transition(f"Hint{k}", arcs, self._head())

    def _watchdog(self, k: int, n: int) -> None:
        """A timer that may run out while the device works."""
        r = self.r
        arcs = [f"in Dog{k}_{n} : ()"]
        how = r.random()
        if how < 0.35:
            arcs += [f"in Armed{k} : ()", f"out Have{k} : ()"]
        elif how < 0.6:
            arcs += [f"both Armed{k} : ()", "out Alarm : ()"]
        elif how < 0.75:
            arcs += [f"in Armed{k} : ()", f"out Idle{k} : ()"]
        else:
            arcs.append("out Alarm : ()")
        self.page.transition(f"Bark{k}_{n}", arcs, self._head())

    # --- the whole -----------------------------------------------------------------------------

    def _ends(self, devices: int) -> None:
        """How it finishes, and what else it does."""
        r, page = self.r, self.page
        page.place("Tick", "INT", "1`0")
        page.place("Finished")
        needed = [f"in Have{k} : ()" for k in range(1, devices + 1)]
        page.transition("End", [*needed, "out Finished : ()"], self._head())
        self.is_long = False
        if r.random() < 0.5:
            k, other = r.randint(1, devices), r.randint(1, devices)
            self.is_long = r.random() < 0.08
            most = r.choice([40, 120, 300]) if self.is_long else r.randint(1, 2)
            arcs = [f"in Have{k} : ()", "in Tick : n", "out Tick : n + 1", f"out Idle{other} : ()"]
            page.transition("More", arcs, self._head(f"n < {most}"))
        if devices > 1 and r.random() < 0.5:
            a, b = r.sample(range(1, devices + 1), 2)
            page.place("Once", initial="1")
            arcs = ["in Once : ()", f"both Have{a} : ()", f"both Idle{b} : ()", "out Alarm : ()"]
            page.transition("Notice", arcs, self._head())
        if devices > 1 and r.random() < 0.4:  # whoever comes first wakes the next one
            a, b = r.sample(range(1, devices + 1), 2)
            page.place("Chance", initial="1")
            arcs = ["in Chance : ()", f"both Armed{a} : ()", f"out Idle{b} : ()"]
            page.transition("Wake", arcs, self._head())

    def _extras(self) -> None:
        """A queue, a union, a free choice, a clock that goes on ticking."""
        r, page = self.r, self.page
        if r.random() < 0.2:
            page.place("Queue", "LIST", "1`[1, 2]")
            page.transition("Pop", ["in Queue : n :: l", "out Queue : l"], self._head())
            arcs = ["both Have1 : ()", "in Queue : l", "out Queue : l ^^ [3]"]
            page.transition("Push", arcs, self._head("length l = 1"))
            self.looked_at.append(f"{_PATH}Queue")
        if r.random() < 0.2:
            page.place("Events", "EVENT", "1`none")
            what = r.choice(["told 1", "heard red", "felt 0.5"])
            arcs = ["in Events : ev", f"out Events : {what}", "both Armed1 : ()"]
            page.transition("Event", arcs, self._head("ev = none"))
        if r.random() < 0.2:
            page.place("Choice", initial="1")
            page.place("Chosen", "COL")
            arcs = ["in Choice : ()", "out Chosen : c", "both Idle1 : ()"]
            page.transition("Choose", arcs, self._head())
            arcs = ["in Chosen : green", r.choice(["out Alarm : ()", "out Idle1 : ()"])]
            page.transition("Chose", arcs, self._head())
            self.looked_at.append(f"{_PATH}Chosen")
        if self.is_timed and r.random() < 0.3:
            page.place("Clock", "TI", "1`0")
            arcs = ["in Clock : n", f"out Clock : n + 1@+{r.randint(1, 2)}"]
            if r.random() < 0.4:
                arcs.append("out Alarm : ()")
            page.transition("Strikes", arcs, self._head(f"n < {r.randint(1, 3)}"))
        if self.is_timed and r.random() < 0.2:
            page.place("Slow", "TU", "1`()")
            page.place("Rested", "TU")
            page.transition("Rest", ["in Slow : ()", "out Rested : ()"], self._head(delay="@+2"))
            page.transition("Rise", ["in Rested : ()", "out Idle1 : ()"], self._head())

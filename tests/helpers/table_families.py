"""Place/transition nets of the kinds that the Model Checking Contest has, small ones, written from the literature."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import combinations, product

from pn2code.contest.tables import Tables

Arcs = Mapping[str, int]
Move = tuple[str, Arcs | Iterable[str], Arcs | Iterable[str]]


def net(initial: Arcs, moves: Iterable[Move]) -> Tables:
    """A net of places with their tokens, and of transitions: what each takes and puts."""
    place = {name: i for i, name in enumerate(initial)}
    made = [(name, _tokens(pre, place), _tokens(post, place)) for name, pre, post in moves]
    return Tables(
        tuple(initial.values()),
        tuple(pre for _, pre, _ in made),
        tuple(post for _, _, post in made),
        {name: (i,) for name, i in place.items()},
        {name: (i,) for i, (name, _, _) in enumerate(made)},
    )


def _tokens(arcs: Arcs | Iterable[str], place: Mapping[str, int]) -> dict[int, int]:
    tokens = arcs if isinstance(arcs, Mapping) else dict.fromkeys(arcs, 1)
    return {place[p]: n for p, n in tokens.items()}


def kanban(n: int = 1) -> Tables:
    """Four stations, the second and third between the first and the last (Ciardo, Tilgner 1996)."""
    initial: dict[str, int] = {}
    moves: list[Move] = []
    for i in range(1, 5):
        initial |= {f"in{i}": 0, f"back{i}": 0, f"out{i}": 0, f"card{i}": n}
        moves += [
            (f"done{i}", [f"in{i}"], [f"out{i}"]),
            (f"bad{i}", [f"in{i}"], [f"back{i}"]),
            (f"again{i}", [f"back{i}"], [f"in{i}"]),
        ]
    moves += [
        ("begin", ["card1"], ["in1"]),
        ("split", ["out1", "card2", "card3"], ["card1", "in2", "in3"]),
        ("join", ["out2", "out3", "card4"], ["card2", "card3", "in4"]),
        ("end", ["out4"], ["card4"]),
    ]
    return net(initial, moves)


def swimming_pool(n: int = 1) -> Tables:
    """Guests need a cabin and a bag to undress, and a cabin again to dress: there is a deadlock."""
    initial = {"out": 4 * n, "cabins": 2 * n, "bags": 3 * n}
    initial |= dict.fromkeys(["entered", "key", "undressed", "bath", "dressing", "dressed"], 0)
    return net(
        initial,
        [
            ("enter", ["out"], ["entered"]),
            ("cabin", ["entered", "cabins"], ["key"]),
            ("bag", ["key", "bags"], ["undressed"]),
            ("swim", ["undressed"], ["bath", "cabins"]),
            ("return", ["bath", "cabins"], ["dressing"]),
            ("dress", ["dressing"], ["dressed", "bags"]),
            ("leave", ["dressed"], ["out", "cabins"]),
        ],
    )


def dekker(n: int = 3) -> Tables:
    """Each process raises its flag, and withdraws it where another one is up."""
    initial: dict[str, int] = {}
    moves: list[Move] = []
    for i in range(n):
        initial |= {f"idle{i}": 1, f"up{i}": 0, f"down{i}": 1, f"asks{i}": 0, f"in{i}": 0}
        others = [f"down{j}" for j in range(n) if j != i]
        moves += [
            (f"ask{i}", [f"idle{i}", f"down{i}"], [f"asks{i}", f"up{i}"]),
            (f"enter{i}", [f"asks{i}", *others], [f"in{i}", *others]),
            (f"leave{i}", [f"in{i}", f"up{i}"], [f"idle{i}", f"down{i}"]),
        ]
        for j in range(n):
            if j != i:
                moves.append(
                    (
                        f"yield{i}to{j}",
                        [f"asks{i}", f"up{i}", f"up{j}"],
                        [f"idle{i}", f"down{i}", f"up{j}"],
                    )
                )
    return net(initial, moves)


def philosophers(n: int = 3) -> Tables:
    """Each takes the two forks beside him one by one, in either order."""
    initial: dict[str, int] = {}
    moves: list[Move] = []
    for i in range(n):
        left, right = f"fork{i}", f"fork{(i + 1) % n}"
        initial |= {f"thinks{i}": 1, left: 1, f"left{i}": 0, f"right{i}": 0, f"eats{i}": 0}
        moves += [
            (f"take_left{i}", [f"thinks{i}", left], [f"left{i}"]),
            (f"take_right{i}", [f"thinks{i}", right], [f"right{i}"]),
            (f"then_right{i}", [f"left{i}", right], [f"eats{i}"]),
            (f"then_left{i}", [f"right{i}", left], [f"eats{i}"]),
            (f"end{i}", [f"eats{i}"], [f"thinks{i}", left, right]),
        ]
    return net(initial, moves)


def readers_and_writers(readers: int = 4, writers: int = 2) -> Tables:
    """A writer takes what each of the readers needs one of."""
    initial: dict[str, int] = {f"free{i}": 1 for i in range(readers)}
    moves: list[Move] = []
    for i in range(readers):
        initial |= {f"thinks{i}": 1, f"reads{i}": 0}
        moves += [
            (f"read{i}", [f"thinks{i}", f"free{i}"], [f"reads{i}"]),
            (f"read_no_more{i}", [f"reads{i}"], [f"thinks{i}", f"free{i}"]),
        ]
    free = [f"free{i}" for i in range(readers)]
    for i in range(writers):
        initial |= {f"waits{i}": 1, f"writes{i}": 0}
        moves += [
            (f"write{i}", [f"waits{i}", *free], [f"writes{i}"]),
            (f"write_no_more{i}", [f"writes{i}"], [f"waits{i}", *free]),
        ]
    return net(initial, moves)


def eratosthenes(n: int = 14) -> Tables:
    """A number strikes out its multiples, as long as it is there: what is dead then are the primes."""
    moves: list[Move] = [
        (f"by{k}strike{k * j}", [f"p{k}", f"p{k * j}"], [f"p{k}"])
        for k in range(2, n + 1)
        for j in range(2, n // k + 1)
    ]
    return net({f"p{k}": 1 for k in range(2, n + 1)}, moves)


def queens(n: int = 4) -> Tables:
    """Each queen takes her row, her column and two diagonals."""
    initial = {f"row{i}": 1 for i in range(n)} | {f"column{i}": 1 for i in range(n)}
    initial |= {f"up{i}": 1 for i in range(2 * n - 1)} | {f"down{i}": 1 for i in range(2 * n - 1)}
    initial |= {f"queen{i}_{j}": 0 for i in range(n) for j in range(n)}
    moves: list[Move] = [
        (
            f"put{i}_{j}",
            [f"row{i}", f"column{j}", f"up{i + j}", f"down{i - j + n - 1}"],
            [f"queen{i}_{j}"],
        )
        for i in range(n)
        for j in range(n)
    ]
    return net(initial, moves)


def cascade(n: int = 2) -> Tables:
    """A signal that three enzymes hand on, each reaction with its way back (the MAPK cascade of Huang, Ferrell)."""
    initial = {"signal": n, "rest": n, "a": n, "aa": 0, "b": n, "bb": 0, "bbb": 0, "pool": n}
    initial |= dict.fromkeys(["signal_a", "aa_b", "aa_bb", "pool_aa", "pool_bbb"], 0)
    moves: list[Move] = []
    for enzyme, before, bound, after in (
        ("signal", "a", "signal_a", "aa"),
        ("aa", "b", "aa_b", "bb"),
        ("aa", "bb", "aa_bb", "bbb"),
        ("pool", "aa", "pool_aa", "a"),
        ("pool", "bbb", "pool_bbb", "b"),
    ):
        moves += [
            (f"bind_{bound}", [enzyme, before], [bound]),
            (f"release_{bound}", [bound], [enzyme, before]),
            (f"make_{bound}", [bound], [enzyme, after]),
        ]
    return net(initial, moves)


def batches(n: int = 2) -> Tables:
    """Goods come, are packed by threes and sent by pairs of boxes, as long as there are any: weights, no cycle."""
    return net(
        {"stock": 9 * n, "packer": 1, "loose": 0, "boxes": 0, "sent": 0, "shelf": 4},
        [
            ("take", {"stock": 1, "shelf": 1}, {"loose": 1}),
            ("pack", {"loose": 3, "packer": 1}, {"boxes": 1, "packer": 1, "shelf": 2}),
            ("send", {"boxes": 2}, {"sent": 1, "shelf": 2}),
            ("lose", {"loose": 2}, {"shelf": 2}),
        ],
    )


def election(n: int = 3) -> Tables:
    """A leader needs the votes of two others, who vote once until it is no leader any more."""
    initial: dict[str, int] = {}
    moves: list[Move] = []
    for i in range(n):
        follows, stands, leads, free, gone = (
            f"{x}{i}" for x in ("follows", "stands", "leads", "free", "gone")
        )
        initial |= {follows: 1, stands: 0, leads: 0, free: 1, gone: 0}
        moves += [
            (f"stand{i}", [follows, free], [stands, gone]),
            (f"step_down{i}", [leads, gone], [follows, free]),
        ]
        others = [j for j in range(n) if j != i]
        for j in others:
            vote = f"vote{j}for{i}"
            initial[vote] = 0
            moves += [
                (
                    vote,
                    [stands, f"follows{j}", f"free{j}"],
                    [stands, f"follows{j}", f"gone{j}", vote],
                ),
                (f"give_back{j}by{i}", [follows, vote, f"gone{j}"], [follows, f"free{j}"]),
                (f"withdraw{i}for{j}", [stands, gone, f"leads{j}"], [follows, free, f"leads{j}"]),
            ]
        for j, k in combinations(others, 2):
            votes = [f"vote{j}for{i}", f"vote{k}for{i}"]
            moves.append((f"win{i}by{j}and{k}", [stands, *votes], [leads, *votes]))
    return net(initial, moves)  # fmt: skip


def crossing(n: int = 2) -> Tables:
    """A gate that closes when a train is near, and opens when none is: trains are counted."""
    initial = {"open": 1, "closed": 0, "closing": 0, "opening": 0, "near": 0, "room": n}
    moves: list[Move] = [
        ("close", ["open", "near"], ["closing", "near"]),
        ("is_closed", ["closing"], ["closed"]),
        ("open", {"closed": 1, "room": n}, {"opening": 1, "room": n}),
        ("is_open", ["opening"], ["open"]),
    ]
    for i in range(n):
        initial |= {f"far{i}": 1, f"comes{i}": 0, f"in{i}": 0, f"told{i}": 0}
        moves += [
            (f"come{i}", [f"far{i}"], [f"comes{i}", f"told{i}"]),
            (f"count{i}", [f"told{i}", "room"], ["near"]),
            (f"enter{i}", [f"comes{i}", "closed"], [f"in{i}", "closed"]),
            (f"leave{i}", [f"in{i}", "near"], [f"far{i}", "room"]),
        ]
    return net(initial, moves)


def balancing(n: int = 2) -> Tables:
    """Clients of two servers, of which the one with fewer requests gets the next."""
    initial: dict[str, int] = {}
    moves: list[Move] = []
    for s in "ab":
        initial |= {f"idle_{s}": 1} | {f"load_{s}{k}": int(k == 0) for k in range(n + 1)}
    for i in range(n):
        initial |= {f"thinks{i}": 1, f"waits{i}": 0, f"asks{i}": 0}
        initial |= {f"{x}{i}_{s}": 0 for x in ("queued", "served") for s in "ab"}
        moves.append((f"ask{i}", [f"thinks{i}"], [f"waits{i}", f"asks{i}"]))
        for a, b in product(range(n), repeat=2):
            before = [f"load_a{a}", f"load_b{b}"]
            s = "a" if a <= b else "b"
            after = [f"load_a{a + (s == 'a')}", f"load_b{b + (s == 'b')}"]
            moves.append((f"send{i}_{a}{b}", [f"asks{i}", *before], [f"queued{i}_{s}", *after]))
        for s in "ab":
            moves.append((f"serve{i}_{s}", [f"queued{i}_{s}", f"idle_{s}"], [f"served{i}_{s}"]))
            moves += [
                (f"end{i}_{s}{k}", [f"served{i}_{s}", f"waits{i}", f"load_{s}{k}"],
                 [f"idle_{s}", f"thinks{i}", f"load_{s}{k - 1}"])
                for k in range(1, n + 1)
            ]  # fmt: skip
    return net(initial, moves)


FAMILIES: Mapping[str, Callable[[], Tables]] = {
    "kanban": kanban,
    "swimming pool": swimming_pool,
    "dekker": dekker,
    "readers and writers": readers_and_writers,
    "eratosthenes": eratosthenes,
    "queens": queens,
    "cascade": lambda: cascade(1),
    "batches": batches,
    "election": election,
    "crossing": crossing,
    "balancing": balancing,
}

"""What an occurrence can change about what is enabled, and what decides about it besides the marking: for hosts."""

from __future__ import annotations

from pn2code.base.frozen import frozen


@frozen
class Effects:
    """Of a transition.

    Args:
        affected: the transitions that may be enabled in another way after an occurrence, in order.
        touched: the places whose tokens an occurrence may change, in order.
        read: the places whose tokens decide, with the time, which occurrences there are and what each takes and puts,
            in order; places in which it only puts tokens are not among them.
        looks: whether more than the binding, the marking and the stream of random numbers decides.
        looks_outside: the same without references: whether it may be another time what it is now, in the same state.
        assigns: whether an occurrence changes what is state besides the marking (`NetIR.roots`).
        search_assigns: whether looking for bindings or for times does.
        search_writes: whether looking for bindings changes what any reference holds, state or not.
        search_draws, fire_draws, thresholds_draw: whether they take from the stream of random numbers.
    """

    affected: tuple[int, ...] = ()
    touched: tuple[int, ...] = ()
    read: tuple[int, ...] = ()
    looks: bool = False
    looks_outside: bool = False
    assigns: bool = False
    search_assigns: bool = False
    search_writes: bool = False
    search_draws: bool = False
    fire_draws: bool = False
    thresholds_draw: bool = False

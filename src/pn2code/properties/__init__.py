"""Properties of a net: what is asked of its state space, and the answers."""

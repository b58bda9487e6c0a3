"""Many small searches of one state space, each another one, on the workers of a cluster (docs/verify.md, "Swarm")."""

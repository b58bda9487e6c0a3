"""Random nets and cells asked in all combinations of reductions, limits and options: no two may contradict."""

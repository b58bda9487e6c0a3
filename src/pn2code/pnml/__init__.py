"""PNML (ISO/IEC 15909-2): place/transition nets and symmetric nets, read into the same `Document` as `.cpn` files."""

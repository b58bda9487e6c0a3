"""Decision diagrams for place/transition nets: the order of their levels (the diagrams are in `cnative/src/symbolic`)."""

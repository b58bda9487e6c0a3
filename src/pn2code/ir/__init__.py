"""`NetIR`: a net as small imperative programs over C-like types; its nodes, its types, its dump, and passes over it."""

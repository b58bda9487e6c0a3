"""How long things take: each command from everywhere, and a whole cycle over everything that a net permits."""

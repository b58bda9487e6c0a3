"""Where bases of arms should stand: what may move, how good a placing is, the search for it, and its proof."""

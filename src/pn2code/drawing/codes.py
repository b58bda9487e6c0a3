"""Diagnostic codes of drawing."""

from pn2code.diagnostics.codes import register

DRAW_PAGE = register(
    "draw-page",
    "there is no such page to draw",
    "`--page` takes the name of a page as CPN Tools shows it, or its id in the file. `--instance` takes the number of "
    "an instance of that page, from 1; a page that is not a subpage has one instance.",
)
DRAW_OUTPUT = register(
    "draw-output",
    "the drawing cannot be written",
    "`-o` names what to write: a file that ends in `.svg` or `.png` (with `--page` one page, otherwise all pages, one "
    "below the other), in `.pdf` (a page for each page of the net) or in `.html` (all pages, linked), a folder (one "
    "SVG for each page), or `-` for an SVG on standard output. PNG and PDF need libraries that `pip install "
    "'pn2code[pictures]'` brings.",
)
DRAW_TRACE = register(
    "draw-trace",
    "the steps of a trace cannot be drawn",
    "`--trace` takes a file that `simulate --trace` or `verify` has written, of the same net with the same `--set`; "
    "`--step` a number of steps in it, 0 for the start. The steps are played by the reference token game.",
)
DRAW_ARRANGED = register(
    "draw-arranged",
    "a page was arranged automatically",
    "The file has no usable positions for the nodes of the page: they are missing, or many nodes are on top of each "
    "other, as in files written by converters. The page is drawn in layers instead. CPN Tools would show the nodes at "
    "the positions in the file.",
)

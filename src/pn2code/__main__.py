"""`python -m pn2code` is the command `pn2code`."""

from pn2code.start import main

main()

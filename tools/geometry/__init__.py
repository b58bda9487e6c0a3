"""What `pn2code check --geometry` says of the examples, and next to runs of random cells."""

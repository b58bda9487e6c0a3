"""Random cells: what `verify` proves of them must hold in what runs. `python -m tools.adversary --help`."""

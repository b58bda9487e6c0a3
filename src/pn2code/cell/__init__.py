"""The cell: `cell.toml`, the partition of the net among supervisor and robots, its channels."""

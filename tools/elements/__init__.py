"""Each element of a net changed or removed, one at a time: it must show. `./dev elements --help`."""

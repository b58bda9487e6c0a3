"""The order of the levels of decision diagrams; the diagrams themselves are in `cnative/src/symbolic`."""

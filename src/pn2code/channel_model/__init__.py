"""The channel model: the shared-file protocol between the owners of a cell, as a net."""

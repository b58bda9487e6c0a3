"""Nets as text (`.cpnt`): read into a `Document`, as a `.cpn` file is, and written from one."""

"""Monitors of CPN Tools: what watches a simulation, collects numbers, writes files, stops it."""

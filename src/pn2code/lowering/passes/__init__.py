"""Passes over `NetIR`: what is known of the programs of a net, which decides how they are printed as C."""

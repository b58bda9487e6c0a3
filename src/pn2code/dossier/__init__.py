"""Everything that is known of a cell in one folder, for the file that goes with a machine: `pn2code report`.

`steps` says which commands are carried out, and does it; `findings` reads what they have written, `traceability` which
lines of the programs each element of the net became; `page` makes `index.html` of it.
"""

"""What `verify` says of a net or a cell: exploration, properties, checks of the supervisor and of its files.

    opened = read(path, {}, d)
    asked = question(opened, ["deadlock free"], None, d, found=True)
    looked = look(opened, asked, limits, options, folder, d)
    said = conclude(looked, opened, asked, folder, d)

The command and the library (`pn2code.api`) both go this way, so they cannot answer differently.
"""

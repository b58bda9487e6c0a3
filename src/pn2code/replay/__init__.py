"""The replay page: a run described as data (`run.json`), and one HTML file that shows it (docs/replay.md).

    described = run.describe(result, motion)              # of a cell that has just run
    described = trace.describe(trace_file, document, net) # of any trace
    files.write(described, Path("run"))                   # run.json
    page.page(described)                                  # the HTML file

The description is the interface: whatever shows a run reads it and nothing else.
"""

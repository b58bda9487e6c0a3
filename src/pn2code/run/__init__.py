"""Running a cell: the compiled supervisor and the robots' interpreters, in lock-step or in real time."""

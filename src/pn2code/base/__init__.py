"""What every package may use and what uses none of them: files, folders, time limits, caches, JSON reals."""

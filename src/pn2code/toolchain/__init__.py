"""Finding and running the C compiler and make; mapping their errors back to net elements."""

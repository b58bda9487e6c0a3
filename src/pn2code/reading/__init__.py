"""Reading files into a `Document`. Knows XML, nothing of CPN ML."""

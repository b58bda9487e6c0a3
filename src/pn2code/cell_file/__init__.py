"""What a cell.toml may say: every section and key, once, for those who read it, check it, explain it and edit it."""

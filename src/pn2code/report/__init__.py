"""What a run leaves behind: rows, summary, pictures, charts."""

"""What the explorer's answers mean in terms of what was asked, and the runs that show why."""

"""Reports of a state space: text, a page of HTML, graphs and pictures, progress."""

"""Robot pages of a net as structured scripts (`RobotIR`), whatever language prints them."""

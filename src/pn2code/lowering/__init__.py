"""Lowering: partition -> NetIR (for C) and RobotIR (for robot scripts)."""

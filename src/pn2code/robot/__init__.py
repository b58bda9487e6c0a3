"""Robots: poses, commands, kinematics, motion, scene, monitoring, backends."""

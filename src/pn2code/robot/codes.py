"""Diagnostic codes of robot models, tools and the scene."""

from pn2code.diagnostics.codes import register

ROBOT_MODEL = register(
    "robot-model",
    "there is no such robot model",
    "`model` names a robot that comes with pn2code, or a URDF file by its path relative to the folder of cell.toml: "
    '`model = "arms/my_arm.urdf"`. The message lists the known names.',
)
ROBOT_TOOL = register(
    "robot-tool",
    "there is no such end effector",
    "`tool` names an end effector that comes with pn2code, or a URDF file by its path relative to the folder of "
    "cell.toml. Its root link is fixed to the flange and it has a link `tcp`, the tool centre point.",
)
ROBOT_URDF = register(
    "robot-urdf",
    "a URDF file cannot be used",
    "The file is missing, not XML, or its links and joints are not one tree with four, six or seven joints with limits "
    "from the base to the flange. The flange is the link named `flange` or `tool0`, or the end of the chain.",
)
UNSUPPORTED_KINEMATICS = register(
    "unsupported-robot-kinematics",
    "there is no closed-form inverse kinematics for this arm",
    "Supported are six-axis arms with parallel axes 2 and 3, an axis 1 that is the base's z axis, and a spherical "
    "wrist: nearly every large industrial robot; collaborative robots with parallel axes 2, 3 and 4; arms with seven "
    "axes, SCARA and gantries. The parameters are derived from the URDF's axes and then checked against its forward "
    "kinematics.",
)
ROBOT_KEY = register(
    "robot-key",
    "a key of `[robots]`, `[motion]` or `[scene]` is not known or is missing",
    "The keys of these sections are fixed, see docs/robots.md. A misspelt key is an error, not silently ignored.",
)
ROBOT_VALUE = register(
    "robot-value",
    "a value in `[robots]`, `[motion]` or `[scene]` has the wrong type or range",
    "Lengths are in metres, angles in degrees, speeds are above zero; the message says what was found.",
)
ROBOT_HOME = register(
    "robot-home",
    "an arm touches something at HOME",
    "Each run begins with all robots at HOME. An arm that touches another one, the scene or itself there would stop "
    "the run at once. Distances are measured with PyBullet; without it a note says that they are not checked.",
)
ROBOT_PART = register(
    "robot-part",
    "a part overlaps something at the start",
    "The poses of `at` in `[parts.KIND]` say where parts are when a run begins. Overlaps above 1 mm are measured "
    "with PyBullet, as at HOME.",
)
ROBOT_PAYLOAD = register(
    "robot-payload",
    "a robot carries more than its arm may",
    "The masses of tools (`inertial` in their URDF files) and of parts (`mass` in `[parts.KIND]`) are compared with "
    "what the URDF file of the arm says: `payload` in kg, and the moments about axes 4, 5 and 6.",
)
ROBOT_SPEED = register(
    "robot-speed",
    "a line or an arc has a speed that it never comes to",
    "From rest to rest, with the acceleration of `[motion]`, the longest way within the reach of the arm does not "
    "suffice for this speed; so it has no effect, and is mostly a wrong unit. Speeds are in m/s in cell.toml, and in "
    "mm/s in nets and scripts.",
)
ROBOT_REACH = register(
    "robot-reach",
    "a robot cannot reach a constant pose",
    "A script moves to a pose that is known before it runs, but no joint position within the limits of the arm puts "
    "the tool there, or a tool lies where the robot that changes it cannot come. Poses that come in messages are known "
    "only in a run.",
)

"""Texts of tasks with one mistake each: in the robot, in obstacles, in what only a later version reads."""

from right_tasks import TASK, inline, limits, task

# (content, key, line, words of the message): the only mistake in each.
WRONG_HARDWARE = {
    # the robot
    "preset": (task("malleable-2dof", "maleable-2dof"), "robot", 4, "did you mean 'malleable-2dof'"),
    "preset unlike any": (task("malleable-2dof", "ur5"), "robot", 4, "presets malleable-2dof"),
    "robot a number": (task("malleable-2dof", "7"), "robot", 4, "preset path mapping 7"),
    "robot an empty text": (task("malleable-2dof", "''"), "robot", 4, "preset"),
    "robot file missing": (task("malleable-2dof", "no/such.yaml"), "robot", 4, "such.yaml no such file"),
    "robot file a directory": (task("malleable-2dof", "./"), "robot", 4, "directory"),
    "robot file no name": (
        task("malleable-2dof", '"a\\0.yaml"'),
        "robot",
        4,
        "neither preset path 'a\\x00.yaml'",
    ),
    "robot file surrogate": (task("malleable-2dof", '"\\ud800.yaml"'), "robot", 4, "neither preset path"),
    "robot file name too long": (task("malleable-2dof", "a" * 5000 + ".yaml"), "robot", 4, "cannot be read"),
    "d12": (inline("58", "0"), "robot.d12", 4, "greater than 0"),
    "length crossed": (inline("[550, 700]", "[700, 550]"), "robot.link.length", 6, "low high [700, 550]"),
    "length of three": (inline("[550, 700]", "[1, 2, 3]"), "robot.link.length", 6, "2 numbers 3"),
    "length no number": (inline("[550, 700]", "long"), "robot.link.length", 6, "number [low, high] 'long'"),
    "length end": (inline("[550, 700]", "[0, 700]"), "robot.link.length[0]", 6, "greater than 0"),
    "bend radius": (inline("110", "-110"), "robot.link.min_bend_radius", 7, "greater than 0 -110"),
    "diameter": (inline("110", "110\n    diameter: 0"), "robot.link.diameter", 8, "greater than 0"),
    "triangle: d34 long": (inline("d34: 49", "d34: 1000"), "robot.rigid_link", 9, "d35 + d45 915 d34 = 1000"),
    "triangle: d45 long": (
        inline("d45: 460", "d45: [505, 600]"),
        "robot.rigid_link",
        9,
        "d45 exceeds d35 50 d34",
    ),
    "triangle: d35 long": (
        inline("d45: 460", "d45: [100, 200]"),
        "robot.rigid_link",
        9,
        "d35 exceeds d45 255",
    ),
    "joint limits crossed": (limits("[350, 10]"), "robot.joint_limits_deg.base", 12, "low high"),
    "joint limits too wide": (limits("[0, 361]"), "robot.joint_limits_deg.base", 12, "360 361"),
    "joint limits one number": (limits("90"), "robot.joint_limits_deg.base", 12, "list 90"),
    "joint limits far out": (limits("[0, 1e5]"), "robot.joint_limits_deg.base[1]", 12, "at most 720"),
    # obstacles
    "obstacles not a list": (task("[]", "{box: 1}"), "obstacles", 12, "a list mapping"),
    "obstacle of no kind": (
        task("[]", "[{name: a}]"),
        "obstacles[0]",
        12,
        "no solid sphere, box and capsule",
    ),
    "obstacle of two kinds": (
        task("[]", "[{sphere: {center: [0, 0, 1], radius: 1}, box: {center: [0, 0, 1], size: [1, 1, 1]}}]"),
        "obstacles[0]",
        12,
        "sphere and box",
    ),
    "obstacle misspelt": (task("[]", "[{spere: {}}]"), "obstacles[0].spere", 12, "did you mean 'sphere'"),
    "sphere of no radius": (
        task("[]", "[{sphere: {center: [0, 0, 1]}}]"),
        "obstacles[0].sphere.radius",
        12,
        "missing",
    ),
    "sphere inside out": (
        task("[]", "[{sphere: {center: [0, 0, 1], radius: -1}}]"),
        "obstacles[0].sphere.radius",
        12,
        "greater than 0",
    ),
    "box of two sizes": (
        task("[]", "[{box: {center: [0, 0, 1], size: [1, 1]}}]"),
        "obstacles[0].box.size",
        12,
        "3 numbers has 2",
    ),
    "capsule of one end": (
        task("[]", "[{capsule: {from: [0, 0, 1], radius: 1}}]"),
        "obstacles[0].capsule.to",
        12,
        "missing other end",
    ),
    "capsule misspelt": (
        task("[]", "[{capsule: {form: [0, 0, 1], to: [1, 1, 1], radius: 1}}]"),
        "obstacles[0].capsule.form",
        12,
        "did you mean 'from'",
    ),
    "obstacle named twice": (
        task(
            "[]",
            "[{name: a, box: {center: [0, 0, 1], size: [1, 1, 1]}}, "
            "{name: a, sphere: {center: [0, 0, 1], radius: 1}}]",
        ),
        "obstacles[1].name",
        12,
        "the name of obstacles[0]",
    ),
    # surfaces and paths
    "surface": (
        TASK + "surface: {sphere: {center: [0, 0, 0], radius: -1}}\n",
        "surface.sphere.radius",
        13,
        "must be greater than 0",
    ),
    "path of no file": (TASK + "path: {csv: a.csv}\n", "path.csv", 13, "a.csv: there is no such file"),
    "path of nothing": (TASK + "path: {}\n", "path", 13, "either waypoints or csv"),
    "path of a number": (TASK + "path: 3\n", "path", 13, "must be a mapping (key: value) or a list of them"),
    "path of one point": (
        TASK + "path: {waypoints: [[500, 0, 300]]}\n",
        "path.waypoints",
        13,
        "must be 2 at least, but there are 1",
    ),
    "path on the spot": (
        TASK + "path: [{waypoints: [[500, 0, 300], [500, 0, 300]]}]\n",
        "path[0].waypoints[1]",
        13,
        "is where waypoints[0] is",
    ),
    "path back and forth": (
        TASK + "path: {waypoints: [[500, 0, 300], [500, 9, 300]], closed: true}\n",
        "path.waypoints",
        13,
        "must be 3 at least, but there are 2",
    ),
}

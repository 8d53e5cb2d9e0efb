"""Texts of two right tasks, and of wrong ones with one mistake each: for the reader and for the command."""

TASK = """\
synth: 1                    # version of this format
name: two crates
length_unit: mm
robot: malleable-2dof       # preset | path, relative to this file | mapping
base: {position: [0, 100, 0], yaw_deg: 90}
floor: 5
topology: any               # any | general | puma | scara | spherical
targets:
  - {name: pick, position: [512.0, 140.5, 210.0], tolerance: 2.0, weight: 1}
  - {name: place, position: [-300, 420, 180]}
objective: least_squares    # | minimax
obstacles: []
"""

INLINE = """\
synth: 1
length_unit: mm
robot:
  d12: 58
  link:
    length: [550, 700]
    min_bend_radius: 110
  d34: 49
  rigid_link:
    d35: 455
    d45: 460
targets:
- position: [100, 200, 300]
"""


def task(old, new):
    assert old in TASK
    return TASK.replace(old, new, 1)


def tolerance(text):
    return task("tolerance: 2.0", f"tolerance: {text}")


def inline(old, new):
    assert old in INLINE
    return INLINE.replace(old, new, 1)


def limits(base):
    return inline("targets:", f"  joint_limits_deg: {{base: {base}}}\ntargets:")


# (content, key, line, words of the message): the only mistake in each.
WRONG = {
    # the file as a whole
    "empty": ("", "", 1, "empty"),
    "only a comment": ("# nothing\n", "", 1, "empty"),
    "null": ("---\n", "", 1, "empty"),
    "a list": ("- 1\n- 2\n", "", 1, "mapping list"),
    "a scalar": ("three", "", 1, "mapping 'three'"),
    "binary": (b"\x89PNG\x0d\x0a\x1a\x0a\x00\xff", "", 1, "UTF-8"),
    "zip": (b"synth: 1\nPK\x03\x04\x00", "", 2, "not a text file '\\x03'"),
    "latin-1": (task("two crates", "zwei Körbe").encode("latin-1"), "", 2, "UTF-8"),
    "too large": ("#" * 11_000_000, "", None, "larger"),
    "flow not closed": (task("[]", "["), "", 13, "YAML"),
    "tab": (task("  - {name: place", "\t- {name: place"), "", 10, "YAML"),
    "quote not closed": (task("pick", '"pick'), "", 13, "YAML quoted"),
    "two documents": (TASK + "---\n" + TASK, "", 14, "second"),
    "code point beyond Unicode": (task("pick", '"\\UFFFFFFFF"'), "", 9, "YAML"),
    "deep nesting": (task("[]", "[" * 100_000), "", 12, "nested 20"),
    "deep nesting in a key": (TASK + "? " * 50_000, "", 13, "nested 20"),
    # what of YAML is refused
    "python object": (task("two crates", "!!python/object:os.system x"), "name", 2, "tags python/object"),
    "custom tag on a list": (
        task("[512.0, 140.5, 210.0]", "!vec [a, b]"),
        "targets[0].position",
        9,
        "tags !vec",
    ),
    "standard tag": (tolerance("!!float 2"), "targets[0].tolerance", 9, "tags"),
    "alias": (
        task("two crates", "&a x").replace("name: place", "name: *a"),
        "targets[1].name",
        10,
        "aliases *a",
    ),
    "merge key": (TASK + "<<: {name: x}\n", "'<<'", 13, "merge"),
    "key twice": (TASK + "floor: 7\n", "floor", 13, "twice line 6"),
    "key twice in flow": (task("weight: 1", "name: a"), "targets[0].name", 9, "twice line 9"),
    "number as key": (TASK + "1: x\n", "", 13, "keys texts"),
    "null as key": (TASK + "~: x\n", "", 13, "keys texts"),
    "list as key": (TASK + "[1, [2, 3]]: {a: 1}\n", "", 13, "keys texts"),
    "mapping as key": (TASK + "? {a: 1}\n: 2\n", "", 13, "keys texts"),
    # keys
    "synth missing": (task("synth: 1 ", ""), "synth", 2, "missing version"),
    "unit missing": (task("length_unit: mm\n", ""), "length_unit", 1, "missing mm cm m"),
    "robot missing": (task("robot: malleable-2dof", ""), "robot", 1, "missing preset"),
    "targets missing": (TASK[: TASK.index("targets")], "targets", 1, "missing"),
    "position missing": (
        task("position: [-300, 420, 180]", "weight: 1"),
        "targets[1].position",
        10,
        "missing",
    ),
    "key of the robot missing": (inline("    d45: 460\n", ""), "robot.rigid_link.d45", 9, "missing"),
    "misspelt": (task("tolerance", "tolerence"), "targets[0].tolerence", 9, "did you mean 'tolerance'"),
    "misspelt and required": (
        task("length_unit", "lenght_unit"),
        "lenght_unit",
        3,
        "did you mean 'length_unit'",
    ),
    "misspelt deep": (
        inline("min_bend_rad", "min_bent_rad"),
        "robot.link.min_bent_radius",
        7,
        "'min_bend_radius'",
    ),
    "capital": (task("floor", "Floor"), "Floor", 6, "did you mean 'floor'"),
    "unknown": (TASK + "colour: red\n", "colour", 13, "known synth name"),
    "unknown like a tag of ours": (TASK + "<one>: 1\n", "'<one>'", 13, "known"),
    "unknown with a line break": (TASK + '"a\\nb": 1\n', "'a\\nb'", 13, "known"),
    # numbers
    "text": (tolerance("abc"), "targets[0].tolerance", 9, "number 'abc'"),
    "number in quotes": (tolerance("'1e-3'"), "targets[0].tolerance", 9, "number '1e-3'"),
    "sexagesimal": (task("floor: 5", "floor: 12:30:45"), "floor", 6, "number '12:30:45'"),
    "boolean": (tolerance("true"), "targets[0].tolerance", 9, "number true"),
    "no value": (
        task("floor: 5", "floor: 5\n").replace("yaw_deg: 90", "yaw_deg: "),
        "base.yaw_deg",
        5,
        "number empty",
    ),
    "nan": (tolerance(".nan"), "targets[0].tolerance", 9, "finite nan"),
    "infinite": (task("140.5", "-.inf"), "targets[0].position[1]", 9, "finite -inf"),
    "overflow": (task("140.5", "1e999"), "targets[0].position[1]", 9, "finite"),
    "huge": (task("140.5", "1e308"), "targets[0].position[1]", 9, "at most 1e+06"),
    "huge integer": (task("140.5", "-" + "9" * 5000), "targets[0].position[1]", 9, "finite"),
    "tolerance negative": (tolerance("-2"), "targets[0].tolerance", 9, "greater than 0, but is -2"),
    "tolerance zero": (tolerance("0"), "targets[0].tolerance", 9, "greater than 0, but is 0"),
    "tolerance tiny": (tolerance("1e-300"), "targets[0].tolerance", 9, "at least 1e-09"),
    "weight zero": (task("weight: 1", "weight: 0"), "targets[0].weight", 9, "greater than 0"),
    "version": (task("synth: 1", "synth: 2"), "synth", 1, "must be 1 version 2"),
    "version true": (task("synth: 1", "synth: true"), "synth", 1, "must be 1 true"),
    "version as a float": (task("synth: 1", "synth: 1.0"), "synth", 1, "must be 1 1.0"),
    # words
    "unit": (task("length_unit: mm", "length_unit: inch"), "length_unit", 3, "'mm', 'cm' or 'm' 'inch'"),
    "unit misspelt": (task("length_unit: mm", "length_unit: mmm"), "length_unit", 3, "did you mean 'mm'"),
    "topology": (task("topology: any", "topology: pumma"), "topology", 7, "did you mean 'puma'"),
    "topology a list": (task("topology: any", "topology: [any]"), "topology", 7, "'any' list"),
    "objective": (task("least_squares", "minmax"), "objective", 11, "did you mean 'minimax'"),
    "name a number": (task("name: pick", "name: 7"), "targets[0].name", 9, "text 7"),
    "name empty": (task("two crates", "' '"), "name", 2, "printable"),
    "name with a surrogate": (task("two crates", '"\\ud800"'), "name", 2, "characters"),
    "name twice": (task("name: place", "name: pick"), "targets[1].name", 10, "'pick' targets[0]"),
    "name of a nameless one": (
        task("name: pick", "name: target 2").replace("name: place, ", ""),
        "targets[1].name",
        10,
        "'target 2' targets[0]",
    ),
    # lists and mappings
    "two coordinates": (task("[-300, 420, 180]", "[-300, 420]"), "targets[1].position", 10, "3 numbers 2"),
    "four coordinates": (task("[-300, 420, 180]", "[1, 2, 3, 4]"), "targets[1].position", 10, "3 numbers 4"),
    "position a number": (task("[-300, 420, 180]", "5"), "targets[1].position", 10, "list 5"),
    "coordinate a list": (task("-300", "[1, 2]"), "targets[1].position[0]", 10, "number list"),
    "target a list": (
        task("{name: place, position: [-300, 420, 180]}", "[1, 2, 3]"),
        "targets[1]",
        10,
        "mapping list",
    ),
    "no targets": (TASK[: TASK.index("  - {name: pick")].rstrip() + " []\n", "targets", 8, "one target"),
    "targets null": (TASK[: TASK.index("  - {name: pick")], "targets", 8, "list empty"),
    "targets a mapping": (TASK[: TASK.index("  - {name: pick")] + "  a: 1\n", "targets", 8, "list mapping"),
    "base null": (task("base: {position: [0, 100, 0], yaw_deg: 90}", "base:"), "base", 5, "mapping empty"),
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
    # what a later version brings
    "surface": (
        TASK + "surface: {sphere: {center: [0, 0, 0], radius: 1}}\n",
        "surface.sphere",
        13,
        "not supported points",
    ),
    "path": (TASK + "path: {csv: a.csv}\n", "path", 13, "not supported targets"),
}

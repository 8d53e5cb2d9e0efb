"""Texts of two right tasks, and the same with something else in them."""

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

"""Texts of tasks, and what is wrong with them."""

import pytest

from synth.errors import InputError

ROBOT = """\
name: malleable-2dof
length_unit: mm
d12: 58
link: {length: [550, 700], min_bend_radius: 110, diameter: 50, max_total_bend_deg: 270}
tip_offset: 20
d34: 49
rigid_link: {d35: 455, d45: [455, 460]}
joint_limits_deg: {base: [10, 350], second: [53, 307]}
"""


def mistakes_in(read, *args, **kwargs):
    with pytest.raises(InputError) as caught:
        read(*args, **kwargs)
    assert caught.value.mistakes
    return caught.value.mistakes


def write(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path

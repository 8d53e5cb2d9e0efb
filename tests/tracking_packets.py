"""Packets as Motive and QTM send them, after the protocols that both publish."""

import struct

NAN = b"\xff\xff\xff\xff"  # what QTM sends of a coordinate that it has not
MEASURED, FILLED, HIDDEN, UNNAMED = 0x0A, 0x0C, 0x0F, 0x12  # flags of Motive's labelled markers
APPLICATION = b"Motive"
BODY = struct.pack("<i7ffh", 3, *range(7), 1e-4, 1)


def text(word):
    return word.encode() + b"\0"


def number(value):
    return struct.pack("<i", value)


def motive_packet(message, content):
    return struct.pack("<HH", message, len(content)) + content


def motive_server(version, group=None, port=1511):
    name = APPLICATION.ljust(256, b"\0") + bytes([3, 1, 0, 0, *version, 0, 0])
    address = bytes(map(int, (group or "127.0.0.1").split(".")))
    return name + struct.pack("<QHB", 10_000_000, port, bool(group)) + address


def _section(version, items):
    content = b"".join(items)
    return number(len(items)) + (number(len(content)) if version >= (4, 1) else b"") + content


def _body_description(version, name, identity, names):
    turned = struct.pack("<4f", 0, 0, 0, 1) if version >= (4, 2) else b""
    said = b"".join(map(text, names)) if version >= (4, 0) else b""
    places = bytes(12 * len(names)) + bytes(4 * len(names))
    head = text(name) + number(identity) + number(-1) + bytes(12) + turned
    return head + number(len(names)) + places + said


def motive_names(version, sets, bodies=(), *, plates=True):
    """Return what describes marker sets, bodies (name, ID, names), a skeleton, a force plate, a camera."""
    named = sets | {"all": [f"{owner}_{name}" for owner, names in sets.items() for name in names]}
    bone = _body_description(version, "Hip", 1, [])
    plate = (
        text("S1")
        + bytes(4 * (2 + 3 + 144 + 12))
        + number(1)
        + number(2)
        + number(2)
        + text("Fx")
        + text("Fy")
    )
    described = [
        *(
            (0, text(owner) + number(len(names)) + b"".join(map(text, names)))
            for owner, names in named.items()
        ),
        *((1, _body_description(version, *body)) for body in bodies),
        (2, text("Fred") + number(9) + number(2) + bone + bone),
        *([(3, number(1) + plate)] if plates else []),
        (5, text("Camera 1") + bytes(28)),
    ]
    sized = version >= (4, 1)
    items = [number(kind) + (number(len(each)) if sized else b"") + each for kind, each in described]
    return number(len(items)) + b"".join(items)


def motive_frame(version, sets, labelled):
    """Return a frame: positions of marker sets, and labelled markers (ID, position, flags)."""
    listed = [point for points in sets.values() for point in points]
    placed = [
        text(owner) + number(len(points)) + b"".join(struct.pack("<3f", *point) for point in points)
        for owner, points in (sets | {"all": listed}).items()
    ]
    skeleton = number(9) + number(2) + BODY + BODY
    markers = [struct.pack("<i3ffhf", identity, *p, 0.014, flags, 2e-4) for identity, p, flags in labelled]
    channels = number(2) + 2 * (number(1) + struct.pack("<f", 5.0))
    precise = bytes(8) if version >= (4, 1) else b""
    sections = [
        placed,
        [struct.pack("<3f", 1.0, 2.0, 3.0)],
        [BODY],
        [skeleton],
        *([[number(4) + number(1) + BODY + number(0)]] if version >= (4, 1) else []),
        markers,
        [number(1) + channels],
        [number(2) + channels],
    ]
    suffix = bytes(8) + struct.pack("<dQQQ", 1.0, 1, 2, 3) + precise + struct.pack("<hi", 0, 0)
    return number(17) + b"".join(_section(version, each) for each in sections) + suffix


def qtm_packet(kind, content=b""):
    return struct.pack("<II", 8 + len(content), kind) + content


def qtm_names(names):
    labels = "".join(f"<Label><Name>{name}</Name><RGBColor>255</RGBColor></Label>" for name in names)
    inside = f"<The_3D><AxisUpwards>+Z</AxisUpwards><Labels>{len(names)}</Labels>{labels}</The_3D>"
    return text(f"<QTM_Parameters_Ver_1.8>{inside}</QTM_Parameters_Ver_1.8>")


def qtm_frame(points):
    """Return a frame of points, mm, None where one is not seen, behind a component of another kind."""
    placed = b"".join(3 * NAN if point is None else struct.pack("<3f", *point) for point in points)
    markers = struct.pack("<IHH", len(points), 0, 0) + placed
    other = struct.pack("<iHH", 0, 0, 0)
    return struct.pack("<qII", 1, 2, 2) + qtm_packet(5, other) + qtm_packet(1, markers)

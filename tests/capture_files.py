"""Captures as tracking systems write them, of arms that stand somewhere."""

import io
import warnings
from itertools import chain

import numpy as np
import pytest
from standing import seen, standing

NAMES = "P1 P2 A1:300 P3 P4 P5 A2:-150 A2:150"
FRAMES = 20
HEADER = "Capture Frame Rate,120.000000,Total Exported Frames,9999,Rotation Type,Quaternion"


def recorded(seed=0, names=NAMES):
    """Return the arm wanted, the one that stands, names, and positions, shape (frames, markers, 3), m."""
    wanted, true = standing(seed)
    rng = np.random.default_rng(seed)
    exact = seen(true, names).positions
    return wanted, true, names.split(), exact + 2e-4 * rng.normal(size=(FRAMES, *exact.shape))


def _cells(point, unit, lost):
    return [lost] * 3 if np.isnan(point).any() else [f"{value * unit:.6f}" for value in point]


def _rows(positions, unit, lost=""):
    for number, points in enumerate(positions):
        yield [
            str(number + 1),
            f"{number / 120:.6f}",
            *(cell for p in points for cell in _cells(p, unit, lost)),
        ]


def motive_text(names, positions, unit=("Meters", 1.0), version="1.23", kind="Marker", prefix="Arm:"):
    """Return an export of Motive: a rigid body, then the markers."""
    first = {"1.21": ",", "1.23": ",Type", "1.25": ",Type"}[version]
    word = first != ","
    body = ["Rotation"] * 4 + ["Position"] * 3 + ["Mean Marker Error"]
    three = [f'"{prefix}{name}"' for name in names for _ in range(3)]
    said = f"Format Version,{version},Take Name,at rest,{HEADER}" + (
        f",Length Units,{unit[0]}" if unit[0] else ""
    )
    lines = [
        [said],
        [],
        [first, *["Rigid Body"] * 8, *[kind] * len(three)],
        [",Name" if word else ",", *["Arm"] * 8, *three],
        [",ID" if word else ",", *['"CF51"'] * 8, *['"8392"'] * len(three)],
        *([[",Parent", *[""] * 8, *["Arm"] * len(three)]] if version == "1.25" else []),
        [",", *body, *["Position"] * len(three)],
        ["Frame,Time (Seconds)", *"XYZWXYZ", "", *["X", "Y", "Z"] * len(names)],
    ]
    frames = ([*row[:2], *["0.5"] * 8, *row[2:]] for row in _rows(positions, unit[1]))
    return "\n".join(map(",".join, [*lines, *frames])) + "\n"


def motive_frames_text(names, positions, unit=1.0, hand="righthanded", lost=None):
    """Return an export of Motive in version 1.1: a line a frame; `lost` is what stands for lost positions."""
    lines = ['comment,"at rest"', hand, "info,version,1.1", "info,framecount,99999", "info,rigidbodycount,1",
             'rigidbody,"Arm",1,3,0.1,0.2,0.3']  # fmt: skip
    for number, points in enumerate(positions):
        there = [k for k, point in enumerate(points) if lost is not None or not np.isnan(point).any()]
        cells = [[*_cells(points[k], unit, lost), str(k), f'"Arm:{names[k]}"'] for k in there]
        body = ["1", *["0.5"] * 10, str(len(there))]
        lines.append(
            ",".join(["frame", str(number), f"{number / 120:.6f}", "1", *body, *chain.from_iterable(cells)])
        )
        lines.append(f"rigidbody,{number},0.0,Arm,1,0,3,0.1,0.2,0.3")
    return "\n".join(lines) + "\n"


def trc_text(names, positions, unit=("mm", 1000.0), frames=None, pad=0, end="\n", aside=False):
    """Return a TRC file; `pad` tabs stand at the ends of its header, `aside` puts the names side by side."""
    count = len(positions) if frames is None else frames
    keys = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame OrigNumFrames"
    values = ["100.00", "100.00", str(count), str(len(names)), unit[0], "100.00", "1", str(count)]
    lines = [
        ["PathFileType", "4", "(X/Y/Z)", "rest.trc"],
        keys.split(),
        values,
        ["Frame#", "Time", *(cell for name in names for cell in ([name] if aside else [name, "", ""]))],
        ["", "", *(f"{axis}{k}" for k in range(1, len(names) + 1) for axis in "XYZ")],
    ]
    padded = [line + [""] * pad for line in lines]
    return end.join("\t".join(line) for line in [*padded, [], *_rows(positions, unit[1])]) + end


def qtm_text(names, positions, lost="0.000", unit=1000.0, columns=2, header=True, end="\r\n", tab=""):
    """Return an export of QTM, with columns of frame and time or none, and their names or not."""
    lines = [
        ["NO_OF_FRAMES", "99999"],
        ["NO_OF_CAMERAS", "14"],
        ["NO_OF_MARKERS", str(len(names))],
        ["FREQUENCY", "200"],
        ["TIME_STAMP", "2022-06-03, 10:47:36.627", "94247.45402301"],
        ["DATA_INCLUDED", "3D"],
        ["MARKER_NAMES", *names],
        ["TRAJECTORY_TYPES", *["Measured"] * len(names)],
    ]
    words = ["Frame", "Time", *(f"{name} {axis}" for name in names for axis in "XYZ")]
    table = [*([words] if header else []), *_rows(positions, unit, lost)]
    return end.join("\t".join(line) + tab for line in [*lines, *(row[2 - columns :] for row in table)]) + end


def c3d_bytes(names, positions, unit=("mm", 1000.0)):
    """Return a C3D file in floating point, as the package c3d writes it."""
    c3d = pytest.importorskip("c3d")
    writer = c3d.Writer(point_rate=100.0, point_units=unit[0])
    writer.set_point_labels(names)
    for points in positions:
        lost = np.isnan(points).any(axis=1)
        values = np.column_stack(
            [unit[1] * np.nan_to_num(points), np.where(lost, -1.0, 0.0), np.zeros(len(lost))]
        )
        writer.add_frames([(values, np.empty((0, 1)))])
    stream = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that there is nothing analog
        writer.write(stream)
    return stream.getvalue()

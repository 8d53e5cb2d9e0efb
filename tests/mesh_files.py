"""STL, PLY and OBJ files as other programs write them, of one small body: a pyramid on a square."""

import struct

import numpy as np

CORNERS = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 1]], dtype=float)
SIDES = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
BASE = [0, 3, 2, 1]
TRIANGLES = [*SIDES, [0, 3, 2], [0, 2, 1]]
AREA = 4.0 + 4.0 * np.sqrt(2.0)


def stl_text(triangles=TRIANGLES, name="pyramid", end="\n"):
    facets = [
        ["facet normal 0 0 0", "outer loop", *(f"vertex {x:e} {y:e} {z:e}" for x, y, z in CORNERS[corners])]
        + ["endloop", "endfacet"]
        for corners in triangles
    ]
    lines = [f"solid {name}", *("  " + line for facet in facets for line in facet), f"endsolid {name}"]
    return (end.join(lines) + end).encode("latin-1")


def stl_bytes(triangles=TRIANGLES, header=b"solid though it is binary"):
    facets = [struct.pack("<12fH", 0, 0, 0, *CORNERS[corners].ravel(), 0) for corners in triangles]
    return header.ljust(80) + struct.pack("<I", len(facets)) + b"".join(facets)


def ply(coding, vertices=CORNERS, faces=TRIANGLES, extra=(), remark=""):
    """Return a PLY file; extra properties of vertices are (type, name, values)."""
    lines = ["ply", f"format {coding} 1.0", *([f"comment {remark}"] if remark else [])]
    lines += [f"element vertex {len(vertices)}", *(f"property double {axis}" for axis in "xyz")]
    lines += [f"property {kind} {name}" for kind, name, _ in extra]
    if faces is not None:
        lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
    header = "".join(line + "\n" for line in [*lines, "end_header"]).encode("latin-1")
    rows = [[*point, *(values[i] for _, _, values in extra)] for i, point in enumerate(vertices)]
    if coding == "ascii":
        table = [*rows, *([len(face), *face] for face in faces or [])]
        return header + "".join(" ".join(map(str, row)) + "\n" for row in table).encode()
    order = "<" if "little" in coding else ">"
    kinds = "ddd" + "".join({"float": "f", "uchar": "B"}[kind] for kind, _, _ in extra)
    body = [struct.pack(order + kinds, *row) for row in rows]
    body += [struct.pack(f"{order}B{len(face)}i", len(face), *face) for face in faces or []]
    return header + b"".join(body)


def obj(vertices=CORNERS, faces=TRIANGLES, told="{0}", before="", end="\n"):
    """Return an OBJ file; told has {0} for the number of a corner and {1} for that counted from behind."""
    lines = [f"v {x} {y} {z}" for x, y, z in vertices]
    lines += ["f " + " ".join(told.format(c + 1, c - len(vertices)) for c in face) for face in faces]
    return before + end.join(lines) + end

"""Meshes as files: OBJ of the tube; STL, PLY and GLB of the workspace surface with its reachable part."""

from __future__ import annotations

import json
import struct
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from synth.export.planners.pieces import Tube
    from synth.robot import SurfaceMesh

_REACHED, _BEYOND = (0.20, 0.55, 0.85), (0.75, 0.75, 0.75)  # colours of both parts of a workspace


def obj_bytes(tube: Tube, comments: Sequence[str]) -> bytes:
    """Return a tube as Wavefront OBJ."""
    lines = [f"# {comment}" for comment in comments]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in tube.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (tube.faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


def stl_bytes(mesh: SurfaceMesh, faces: NDArray[np.int64], title: str) -> bytes:
    """Return some faces of a surface as binary STL, in metres."""
    corners = mesh.vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    table = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    table["normal"] = normals / np.where(lengths > 0.0, lengths, 1.0)
    table["corners"] = corners
    # It must not begin with "solid", by which readers know the other kind of STL.
    header = title.encode("ascii", "replace")[:80].ljust(80)
    return header + struct.pack("<I", len(faces)) + table.tobytes()


def ply_bytes(mesh: SurfaceMesh, comments: Sequence[str]) -> bytes:
    """Return a surface as binary PLY; each face says by `reachable` and its colour where the arm gets to."""
    kind = [("count", "u1"), ("corners", "<i4", 3), ("reachable", "u1"), ("colour", "u1", 3)]
    table = np.zeros(len(mesh.faces), dtype=kind)
    table["count"], table["corners"], table["reachable"] = 3, mesh.faces, mesh.reachable
    table["colour"] = np.where(mesh.reachable[:, None], _bytes(_REACHED), _bytes(_BEYOND))
    header = [
        "ply",
        "format binary_little_endian 1.0",
        *(f"comment {comment.encode('ascii', 'replace').decode()}" for comment in comments),
        f"element vertex {len(mesh.vertices)}",
        *(f"property double {axis}" for axis in "xyz"),
        f"element face {len(mesh.faces)}",
        "property list uchar int vertex_indices",
        *(f"property uchar {name}" for name in ("reachable", "red", "green", "blue")),
        "end_header\n",
    ]
    return "\n".join(header).encode() + mesh.vertices.astype("<f8").tobytes() + table.tobytes()


def _bytes(colour: Sequence[float]) -> NDArray[np.uint8]:
    return np.round(255.0 * np.array(colour)).astype(np.uint8)


def glb_bytes(mesh: SurfaceMesh, comments: Sequence[str]) -> bytes:
    """Return a surface as binary glTF: the reachable part, and half transparent the rest."""
    points = mesh.vertices.astype("<f4")
    parts = [(mesh.faces[mesh.reachable], "reachable"), (mesh.faces[~mesh.reachable], "out of reach")]
    parts = [(faces, name) for faces, name in parts if len(faces)]
    data = [points.tobytes(), *(faces.astype("<u4").tobytes() for faces, _ in parts)]
    starts = np.cumsum([0, *map(len, data)]).tolist()
    targets = [34962, *(34963 for _ in parts)]  # arrays of vertices, and of indices
    views = [
        {"buffer": 0, "byteOffset": start, "byteLength": len(part), "target": target}
        for start, part, target in zip(starts, data, targets, strict=False)
    ]
    extremes = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    accessors: list[dict[str, object]] = [
        {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", **extremes}
    ]
    accessors += [
        {"bufferView": number, "componentType": 5125, "count": faces.size, "type": "SCALAR"}
        for number, (faces, _) in enumerate(parts, 1)
    ]
    content = {
        "asset": {"version": "2.0", "generator": "synth", "extras": {"comments": list(comments)}},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        # glTF has y up: a quarter turn about x brings z there.
        "nodes": [{"name": "workspace", "rotation": [-(0.5**0.5), 0.0, 0.0, 0.5**0.5], "children": [1]}]
        + [{"name": "surface", "mesh": 0}],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0}, "indices": number, "material": number - 1}
                    for number in range(1, len(parts) + 1)
                ]
            }
        ],
        "materials": [_material(name) for _, name in parts],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": starts[-1]}],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(data)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _material(name: str) -> dict[str, object]:
    reached = name == "reachable"
    colour = [*(_REACHED if reached else _BEYOND), 1.0 if reached else 0.35]
    shading = {"baseColorFactor": colour, "metallicFactor": 0.0}
    kind = "OPAQUE" if reached else "BLEND"
    return {"name": name, "doubleSided": True, "alphaMode": kind, "pbrMetallicRoughness": shading}

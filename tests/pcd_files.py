"""PCD files as other programs write them, from points in numpy."""

import struct

import numpy as np

HEADER = "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\n"


def pcd_file(columns, coding="ascii", before="", **header):
    """Return the content of a PCD file of columns, (name, numpy type, values of shape (n,) or (n, count))."""
    columns = [(name, np.dtype(kind), np.asarray(values).astype(kind)) for name, kind, values in columns]
    tables = [values.reshape(len(values), -1) for _, _, values in columns]
    said = {
        "FIELDS": " ".join(name for name, _, _ in columns),
        "SIZE": " ".join(str(kind.itemsize) for _, kind, _ in columns),
        "TYPE": " ".join({"f": "F", "i": "I", "u": "U"}[kind.kind] for _, kind, _ in columns),
        "COUNT": " ".join(str(table.shape[1]) for table in tables),
        "WIDTH": len(tables[0]),
        "HEIGHT": 1,
        "VIEWPOINT": "0 0 0 1 0 0 0",
        "POINTS": len(tables[0]),
    } | header
    lines = "".join(f"{key} {value}\n" for key, value in said.items() if value is not None)
    return (before + HEADER + lines + f"DATA {coding}\n").encode() + _CODED[coding](tables)


def _as_text(tables):
    rows = zip(*tables, strict=True)
    return "".join(" ".join(str(x) for part in row for x in part) + "\n" for row in rows).encode()


def _as_rows(tables):
    return b"".join(part.tobytes() for row in zip(*tables, strict=True) for part in row)


def _as_packed_columns(tables):
    columns = b"".join(table.tobytes() for table in tables)
    packed = packed_by_lzf(columns)
    return struct.pack("<II", len(packed), len(columns)) + packed


def packed_by_lzf(content):
    """Return bytes packed by LZF, with runs of both kinds and of all lengths that occur."""
    packed, at, waiting, seen = bytearray(), 0, bytearray(), {}
    while at < len(content):
        back = at - seen.get(content[at : at + 3], -9999)
        seen[content[at : at + 3]] = at
        length = 0
        most = min(264, len(content) - at) if back <= 8192 else 0
        while length < most and content[at + length] == content[at + length - back]:
            length += 1
        if length >= 3:
            _stand(packed, waiting)
            high = (back - 1) >> 8
            packed += bytes([((length - 2) << 5) | high] if length < 9 else [224 | high, length - 9])
            packed.append((back - 1) & 255)
            at += length
        else:
            waiting.append(content[at])
            at += 1
    _stand(packed, waiting)
    return bytes(packed)


def _stand(packed, waiting):
    for start in range(0, len(waiting), 32):
        run = waiting[start : start + 32]
        packed += bytes([len(run) - 1]) + run
    waiting.clear()


_CODED = {"ascii": _as_text, "binary": _as_rows, "binary_compressed": _as_packed_columns}

"""Damaged files of surfaces: each is read or refused with a reason, in little time and memory.

    python tests/benchmarks/fuzz_surfaces.py [--files 10000] [--seed 1] [--kinds stl ply ...]

Of each kind so many files are made from small ones that are right: bytes turned over, cut off, put in, left
out or told twice, numbers that lie, words in the place of others, other encodings, the end of another file.
Whatever is no `InputError` with a short reason, takes more than 5 s of the processor or 100 MB more than all
files before it, warns, or reads numbers that a surface cannot have, is told with the file, which is kept.
"""

from __future__ import annotations

import argparse
import faulthandler
import logging
import re
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from mesh_files import BASE, SIDES, obj, ply, stl_bytes, stl_text
from pcd_files import pcd_file

from synth.errors import InputError
from synth.surfaces import Scan, Surface, TriangleMesh, read_corners, read_points

SECONDS, MEGABYTES, LONGEST = (
    5.0,
    100.0,
    2_500,
)  # of one file; characters of its reason, which may be ten lines
LIES = (
    *("0", "-1", "1", "3", "255", "65536", "2147483648", "4000000000", "4294967295", "18446744073709551616"),
    *("1" + "0" * 40, "nan", "inf", "-inf", "1e999", "1e-400", "0x10", "1_0", "", "x", "٣", "1e5e5", "1 2"),
)
WORDS = re.compile(rb"[A-Za-z_]+|[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?")
RNG = np.random.default_rng(0)
POINTS = RNG.uniform(-1.0, 1.0, (40, 3))
XYZ = [(name, "f4", POINTS[:, axis]) for axis, name in enumerate("xyz")]
MORE = [("label", "u1", np.ones(40)), *XYZ, ("rgb", "f4", POINTS[:, 0]), ("histogram", "f4", POINTS[:, :2])]
COLOURS = [("uchar", name, np.arange(5)) for name in ("red", "green", "blue")]
TABLE = "\n".join(",".join(map(str, point)) for point in POINTS.tolist())
CODINGS = ("ascii", "binary", "binary_compressed")
PLY = [ply(f"binary_{end}_endian", extra=COLOURS) for end in ("little", "big")]
RIGHT = {
    "stl": [stl_text(), stl_text(SIDES, end="\r\n") + stl_text(SIDES[:2], "two"), stl_bytes()],
    "ply": [ply("ascii", faces=[*SIDES, BASE], extra=COLOURS, remark="by hand"), ply("ascii"), *PLY],
    "obj": [obj().encode(), obj(told="{0}/1/1", before="vt 0 0\n").encode(), obj(told="{1}").encode()],
    "pcd": [pcd_file(columns, coding) for columns in (XYZ, MORE) for coding in CODINGS],
    "points of ply": [ply("ascii", POINTS, None), ply("binary_little_endian", POINTS, None), ply("ascii")],
    "points of obj": [obj(POINTS, []).encode(), obj().encode()],
    "csv": [b"x,y,z\n" + TABLE.encode(), TABLE.encode()],
    "xyz": [b"# a scan\n" + TABLE.replace(",", " ").encode(), TABLE.replace(",", "\t").encode()],
}  # fmt: skip


class TooLongError(BaseException):
    """A file took more than its time; no `Exception`, so that nobody takes it for a damaged file."""


def flipped(rng, content):
    damaged = bytearray(content)
    for place in rng.integers(0, max(len(content), 1), rng.integers(1, 12)):
        damaged[place : place + 1] = rng.bytes(1)
    return bytes(damaged)


def moved(rng, content):
    """Put in, leave out, tell twice, or overwrite some bytes."""
    start, end = sorted(rng.integers(0, len(content) + 1, 2).tolist())
    end = min(end, start + int(rng.integers(1, 60)))
    part = [
        rng.bytes(int(rng.integers(1, 40))),
        b"",
        content[start:end] * int(rng.integers(2, 50)),
        b"\xff" * 4,
    ]
    kept = (start, end, start, min(start + 4, len(content)))
    way = int(rng.integers(4))
    return content[:start] + part[way] + content[kept[way] :]


def lied(rng, content):
    """Put a lie in the place of a word or a number, three times of four within the first 400 bytes."""
    words = list(WORDS.finditer(content, 0, 400 if rng.random() < 0.75 else len(content)))
    if not words:
        return content
    word = words[rng.integers(len(words))]
    other = words[rng.integers(len(words))].group()
    lie = LIES[rng.integers(len(LIES))].encode() if rng.random() < 0.8 else other
    return content[: word.start()] + lie + content[word.end() :]


def encoded(rng, content):
    text = content.decode("latin-1")
    ways = (
        lambda: text.encode("utf-16"),
        lambda: text.encode("utf-16-be"),
        lambda: b"\xef\xbb\xbf" + content,
        lambda: text.replace("\n", "\r").encode("latin-1"),
        lambda: text.replace(" ", "\u00a0").encode("utf-8"),
        lambda: text.upper().encode("utf-8"),
        lambda: text.replace("\n", "\n\n").encode("latin-1"),
        lambda: text.replace(".", ",").encode("latin-1"),
    )
    return ways[rng.integers(len(ways))]()


def joined(rng, content):
    """Put the end of a right file of any kind behind the beginning."""
    others = RIGHT[list(RIGHT)[rng.integers(len(RIGHT))]]
    other = others[rng.integers(len(others))]
    return content[: rng.integers(len(content) + 1)] + other[rng.integers(len(other)) :]


def cut(rng, content):
    return content[: rng.integers(len(content) + 1)]


WAYS = (flipped, moved, lied, lied, encoded, joined, cut)


def mutated(rng, kind):
    content = RIGHT[kind][rng.integers(len(RIGHT[kind]))]
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        content = WAYS[rng.integers(len(WAYS))](rng, content)
    return content


def outcome(kind, path):
    """Return what became of a file: "read", "refused", or what is wrong."""
    try:
        if kind in {"stl", "ply", "obj"}:
            shape = TriangleMesh(read_corners(path))
            numbers = shape.corners
        else:
            shape = Scan(read_points(path))
            numbers = shape.points
        told = Surface("surface", shape).samples.areas
    except InputError as error:
        reason = str(error)
        short = 0 < len(reason) < LONGEST and "Memory" not in reason
        return "refused" if short else f"refused with {reason[:300]!r}"
    good = np.isfinite(numbers).all() and np.abs(numbers).max() <= 1e6 and told.sum() > 0.0
    return "read" if good else "read numbers that a surface cannot have"


def watched(kind, path, printed):
    """Return what became of a file, with a look at time, memory and what is printed."""
    before, began = memory(), time.process_time()
    signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
    faulthandler.dump_traceback_later(60.0 * SECONDS, exit=True)  # what no signal can stop
    try:
        result = outcome(kind, path)
    except TooLongError:
        result = "took too long"
    except Exception as error:  # noqa: BLE001 - that is what is looked for
        result = f"broke down: {type(error).__name__}: {str(error)[:200]}"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        faulthandler.cancel_dump_traceback_later()
    if result in {"read", "refused"}:
        if time.process_time() - began > SECONDS:
            result = "took too long"
        if memory() - before > MEGABYTES:
            result = f"took {memory() - before:.0f} MB"
        if printed:
            result = f"printed {printed[0]!r}"
    printed.clear()
    return result


def memory() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


class _Noting(logging.Handler):
    def __init__(self, noted: list[str]) -> None:
        super().__init__(logging.WARNING)
        self._noted = noted

    def emit(self, record: logging.LogRecord) -> None:
        self._noted.append(record.getMessage()[:100])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--files", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="*", default=list(RIGHT), choices=list(RIGHT))
    given = parser.parse_args()
    printed: list[str] = []
    logging.getLogger().addHandler(_Noting(printed))
    logging.captureWarnings(capture=True)
    warnings.simplefilter("always")
    signal.signal(signal.SIGVTALRM, lambda *_: (_ for _ in ()).throw(TooLongError))
    directory = Path(tempfile.mkdtemp(prefix="fuzzed-"))
    faults = 0
    for kind in given.kinds:
        counts, slowest = Counter(), 0.0
        for number, content in enumerate(RIGHT[kind]):
            path = directory / f"right-{number}.{kind.split()[-1]}"
            path.write_bytes(content)
            assert watched(kind, path, printed) == "read", (kind, number)
        for number in range(given.files):
            path = directory / f"{kind.replace(' ', '-')}-{number}.{kind.split()[-1]}"
            path.write_bytes(mutated(np.random.default_rng([given.seed, number, len(kind)]), kind))
            began = time.process_time()
            result = watched(kind, path, printed)
            slowest = max(slowest, time.process_time() - began)
            counts[result if result in {"read", "refused"} else "wrong"] += 1
            if result in {"read", "refused"}:
                path.unlink()
            else:
                faults += 1
                print(f"  {path}: {result}", flush=True)
        told = ", ".join(f"{what} {count}" for what, count in sorted(counts.items()))
        print(f"{kind}: {told}; slowest {slowest:.2f} s; memory so far {memory():.0f} MB", flush=True)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()

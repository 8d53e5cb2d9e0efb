"""Damaged captures: how many are refused by the reader, by the examination, or believed, and whether rightly.

Each of many damaged files must be read or refused, within five seconds, and no arm that the examination
believes may stand elsewhere than the one that was recorded.

    python tests/benchmarks/fuzz_captures.py [FILES] [SEED]
"""

from __future__ import annotations

import random
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from capture_files import c3d_bytes, motive_frames_text, motive_text, qtm_text, recorded, trc_text
from mutations import mutated
from planted import ROBOT
from standing import HOLD, SIGMA

from synth.errors import InputError
from synth.measurement import examine
from synth.measurement.markers.marker_file import load_readings

_SLOW = 5.0  # s
_OFF = 5e-3  # m; a believed end that is farther from the recorded one was moved by the damage
_FRAMES = 6


def outcome(path: Path, content: bytes, wanted, true) -> str:
    """Return what became of a file: refused by the reader or by the examination, believed, or a fault."""
    path.write_bytes(content)
    try:
        readings = load_readings(path, ROBOT, HOLD)
        result = examine(readings, wanted, ROBOT, SIGMA, base_calibrated=False)
    except InputError:
        return "refused by the reader"
    except Exception as error:  # noqa: BLE001  any other error is the fault that is looked for
        return f"FAULT: {type(error).__name__}: {error}"
    if result.fit is None:
        return "refused by the examination"
    off = float(np.linalg.norm(result.fit.arm.end - true.end))
    return "believed" if off < _OFF else f"FAULT: believed, {1e3 * off:.1f} mm off"


def main(files: int, seed: int) -> int:
    """Damage files of each format and count what becomes of them."""
    wanted, true, names, positions = recorded(seed)
    positions = positions[:_FRAMES]
    formats = {
        "motive 1.1": motive_frames_text(names, positions).encode(),
        "motive 1.23": motive_text(names, positions).encode(),
        "motive 1.25": motive_text(names, positions, ("Millimeters", 1000.0), version="1.25").encode(),
        "trc": trc_text(names, positions).encode(),
        "qtm": qtm_text(names, positions).encode(),
        "c3d": c3d_bytes(names, positions),
    }
    chance = random.Random(seed)  # noqa: S311
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, whole in formats.items():
            counts: Counter[str] = Counter()
            slowest = 0.0
            for k in range(files // len(formats)):
                content = mutated(whole, chance)
                start = time.perf_counter()
                said = outcome(Path(folder) / "capture.txt", content, wanted, true)
                slowest = max(slowest, time.perf_counter() - start)
                counts[said.partition(":")[0]] += 1
                if said.startswith("FAULT"):
                    faults += 1
                    print(f"{name} {k}: {said}")
            print(f"{name}: {dict(counts)}, slowest {slowest:.2f} s", flush=True)
            faults += slowest > _SLOW
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*(int(word) for word in (*sys.argv[1:], *("10000", "0")[len(sys.argv) - 1 :]))))

"""Files of surfaces damaged at random: read, or refused with a reason."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent / "benchmarks"))

from fuzz_surfaces import RIGHT, mutated, outcome

pytest.importorskip("trimesh")


@pytest.mark.parametrize("kind", RIGHT)
def test_damaged_files_are_read_or_refused(tmp_path, kind, caplog):
    suffix = kind.split()[-1]
    for number, content in enumerate(RIGHT[kind]):
        path = tmp_path / f"right-{number}.{suffix}"
        path.write_bytes(content)
        assert outcome(kind, path) == "read"
    results = set()
    for number in range(100):
        path = tmp_path / f"{number}.{suffix}"
        path.write_bytes(mutated(np.random.default_rng([2, number]), kind))
        results.add(outcome(kind, path))
    assert results == {"read", "refused"}
    assert not caplog.records

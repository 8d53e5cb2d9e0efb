"""The worked example in MuJoCo: the exported model carries a crate along the trajectory, and is drawn."""

import importlib
import os
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.filterwarnings("ignore")  # of MuJoCo's own
ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def example():
    os.environ.setdefault("MUJOCO_GL", "egl")  # asked for as MuJoCo is imported
    pytest.importorskip("mujoco", exc_type=ImportError)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "docs"))
        return importlib.import_module("pick_and_place")


@pytest.fixture(scope="module")
def solution(example):
    return example.solution()


def test_p5_rests_as_near_to_each_target_as_the_solution_says_and_takes_the_crate_along(example, solution):
    seen = []
    misses = example.carried(solution, lambda _, data: seen.append([*data.body("crate").xpos, data.time]))
    for target in solution.targets:
        assert misses[target.name] <= target.miss + 1e-5
        assert misses[target.name] <= target.tolerance
    first, last = (np.array(seen)[index, :3] for index in (0, -1))
    below = np.linalg.norm([first - solution.targets[0].reached, last - solution.targets[-1].reached], axis=1)
    np.testing.assert_allclose(below, example.CRATE, atol=1e-5)


def test_a_model_whose_link_is_bent_otherwise_does_not_get_there(example, solution):
    assert len(solution.designs) > 1
    model, data = example.model_of(solution)
    other = solution.designs[1].verification.joints[0]
    data.qpos[:2] = other
    importlib.import_module("mujoco").mj_forward(model, data)
    assert np.linalg.norm(data.site("P5").xpos - solution.targets[0].position) > 0.02


def test_it_is_drawn_without_a_display(example, solution):
    mujoco = importlib.import_module("mujoco")
    try:
        figure = example.picture(solution)
    except (mujoco.FatalError, AttributeError, ImportError) as error:  # what a machine without EGL says
        pytest.skip(f"MuJoCo cannot draw here: {error}")
    frames = [axes.images[0].get_array().astype(float) for axes in figure.axes if axes.images]
    assert len(frames) == 3
    crates = [
        np.argwhere((f[..., 0] > 150) & (f[..., 2] < 90) & (f[..., 1] < 0.7 * f[..., 0])) for f in frames
    ]
    assert all(len(crate) > 100 for crate in crates)
    middles = [crate.mean(axis=0) for crate in crates]
    assert np.linalg.norm(middles[0] - middles[-1]) > 100  # pixels
    titles = [axes.get_title() for axes in figure.axes]
    for target, title in zip(solution.targets, (titles[0], titles[2]), strict=True):
        assert title == f"{target.name}: {1e3 * target.miss:.2f} mm off"
    assert figure.axes[-1].get_ylabel() == "joint angle, deg"

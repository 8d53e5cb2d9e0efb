"""A sweep on executors of other packages, with two local workers, where they are installed."""

import pytest
from planted import planted_task

from synth.sweep import solve_many

TASKS = [planted_task(seed, 2)[0] for seed in range(4)]
pytestmark = pytest.mark.filterwarnings("ignore")  # those of other libraries about themselves


@pytest.fixture(scope="module")
def alone():
    return solve_many(TASKS, alternatives=0)


def same_answers(outcomes, others):
    return all(
        one.solution.designs == other.solution.designs for one, other in zip(outcomes, others, strict=True)
    )


def test_dask(alone, tmp_path):
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(tmp_path)
    )
    with cluster, distributed.Client(cluster) as client:
        outcomes = solve_many(TASKS, executor=client.get_executor(), store=tmp_path / "s", alternatives=0)
    assert same_answers(outcomes, alone)
    assert all(outcome.stored for outcome in solve_many(TASKS, store=tmp_path / "s", alternatives=0))


def test_executorlib(alone):
    executorlib = pytest.importorskip("executorlib")
    with executorlib.SingleNodeExecutor(max_workers=2) as executor:
        outcomes = solve_many(TASKS, executor=executor, alternatives=0)
    assert same_answers(outcomes, alone)

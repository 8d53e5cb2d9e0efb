"""Three quick tasks to be swept, what `solve` says of each alone, and whether outcomes say the same."""

from planted import planted_task

from synth.synthesis import solve

TASKS = [planted_task(seed, 3)[0] for seed in (5, 6, 8)]
QUICK = {"alternatives": 0}


def solved_alone():
    return [solve(task, **QUICK) for task in TASKS]


def same_answers(outcomes, solutions):
    return all(
        one.solution.designs == other.designs and one.solution.status is other.status
        for one, other in zip(outcomes, solutions, strict=True)
    )

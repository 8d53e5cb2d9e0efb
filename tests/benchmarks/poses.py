"""How often a link is found for an end pose, how often for none, and whether the reach is what links reach.

    python tests/benchmarks/poses.py [planted impossible undecided reach] [--poses 2000] [--samples 1000000]

Counts are of poses; times are of this machine and only good for ratios.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from bent_links import RADIUS, RATIOS, random_ends, reach_of, two_piece_ends
from planted import ROBOT
from planted_poses import (
    hopeless_pose,
    keeps_the_limits,
    links,
    missed_by,
    planted_poses,
    stiff_link,
)
from scipy.spatial import cKDTree

from synth.robot import ANYWHERE, Interval, LinkReach, MalleableLink, links_to_poses, why_no_link

PER_LINK = 50
AT_ZERO = Interval.fixed(0.0)


def planted(count: int) -> None:
    """Poses of random links, the preset's and others, half of them at their limits."""
    rng = np.random.default_rng(1)
    for name, theta1 in (("joint 1 anywhere", ANYWHERE), ("joint 1 at zero", AT_ZERO)):
        found = passed = called_impossible = 0
        began = time.perf_counter()
        for link in links(count // PER_LINK, rng):
            positions, axes = planted_poses(link, PER_LINK, rng)
            shapes = links_to_poses(link, positions, axes, theta1=theta1)
            for shape, position, axis in zip(shapes, positions, axes, strict=True):
                if shape is not None:
                    found += 1
                    off, askew = missed_by(shape, position, axis)
                    passed += off <= 1e-8 and askew <= 1e-8 and keeps_the_limits(link, shape)
            if theta1 is ANYWHERE:
                reasons = [why_no_link(link, *pose) for pose in zip(positions, axes, strict=True)]
                called_impossible += sum(map(bool, reasons))
        spent = (time.perf_counter() - began) / count
        print(
            f"planted, {name}: {count} poses, {found} found, {passed} pass the check, "
            f"{called_impossible} called impossible; {1e3 * spent:.0f} ms each",
            flush=True,
        )


def impossible(count: int) -> None:
    """Poses proven impossible: does the search find any?"""
    rng = np.random.default_rng(2)
    proven = found = 0
    words: dict[str, int] = {}
    while proven < count:
        for link in (*links(2, rng), stiff_link(rng)):
            candidates = [hopeless_pose(link, rng) for _ in range(PER_LINK)]
            reasons = [why_no_link(link, *pose) for pose in candidates]
            poses = [pose for pose, reason in zip(candidates, reasons, strict=True) if reason]
            poses = poses[: count - proven]
            if not poses:
                continue
            shapes = links_to_poses(link, *(np.array(part) for part in zip(*poses, strict=True)))
            proven, found = proven + len(poses), found + sum(shape is not None for shape in shapes)
            for reason in filter(None, reasons):
                kind = next(k for k in ("whatever", "deg is", "mm long", "axis 2") if k in reason)
                words[kind] = words.get(kind, 0) + 1
    print(f"impossible: {proven} poses proven, {found} found; by sentence {words}", flush=True)


def undecided(count: int) -> None:
    """Positions uniform in the reach of the position, axis 2 in any direction."""
    rng = np.random.default_rng(3)
    hardware: list[tuple[str, list[MalleableLink], Interval, int]] = [
        ("preset", [ROBOT.link], ANYWHERE, count),
        ("other hardware", links(2 * count // PER_LINK, rng)[1::2], ANYWHERE, count),
        ("preset, joint 1 at zero", [ROBOT.link], AT_ZERO, count // 5),
    ]
    for name, some, theta1, poses in hardware:
        found = proven = both = total = 0
        for link in some:
            share = poses // len(some)
            positions, axes = LinkReach(link).sample(share, seed=4), rng.normal(size=(share, 3))
            shapes = links_to_poses(link, positions, axes, theta1=theta1)
            for shape, position, axis in zip(shapes, positions, axes, strict=True):
                reason = why_no_link(link, position, axis)
                found, proven = found + (shape is not None), proven + bool(reason)
                both, total = both + (shape is not None and bool(reason)), total + 1
        print(
            f"random, {name}: {total} poses, {found} found, {proven} proven impossible, {both} both, "
            f"{total - found - proven + both} undecided",
            flush=True,
        )


def reach(count: int) -> None:
    """Ends of random and of extremal links against the closed form."""
    batch = 50_000
    for ratio in RATIOS:
        closed, length = reach_of(ratio), ratio * RADIUS
        boundary = np.concatenate(closed.boundary(181))
        outside, nearest = 0.0, np.full(len(boundary), np.inf)
        for seed in range(count // batch):
            ends = random_ends(ratio, batch, seed)
            beyond = ends[~closed.contains(ends)]
            outside = max(outside, *(-closed.margin(beyond)), 0.0)
            flat = np.column_stack([np.hypot(ends[:, 0], ends[:, 1]), ends[:, 2]])
            nearest = np.minimum(nearest, cKDTree(flat).query(boundary)[0])
        by_chance = nearest.max()
        nearest = np.minimum(nearest, cKDTree(two_piece_ends(ratio)).query(boundary)[0])
        print(
            f"reach, L/r = {ratio}: {count} links, the farthest {outside:.1e} m outside; every point of the "
            f"boundary is approached within {100 * nearest.max() / length:.2f} % of L "
            f"(by random links alone {100 * by_chance / length:.1f} %)",
            flush=True,
        )


def main() -> None:
    """Run the parts asked for."""
    parts = {"planted": planted, "impossible": impossible, "undecided": undecided, "reach": reach}
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", choices=[*parts, []], default=[])
    parser.add_argument("--poses", type=int, default=2000)
    parser.add_argument("--samples", type=int, default=1_000_000)
    arguments = parser.parse_args()
    for part in arguments.parts or parts:
        parts[part](arguments.samples if part == "reach" else arguments.poses)


if __name__ == "__main__":
    main()

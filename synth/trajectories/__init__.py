"""Joint angles over time: the ways between targets, within limits of speed and acceleration."""

from synth.trajectories.trajectory import Trajectory, has_trajectory, trajectory

__all__ = ["Trajectory", "has_trajectory", "trajectory"]

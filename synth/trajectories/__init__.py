"""Joint angles over time: the ways between targets, within limits of speed and acceleration."""

from synth.trajectories.trajectory import ACCELERATION, SPEED, Trajectory, has_trajectory, trajectory

__all__ = ["ACCELERATION", "SPEED", "Trajectory", "has_trajectory", "trajectory"]

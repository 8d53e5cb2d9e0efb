"""How a path is followed: the joint angles along it, and how far P5 strays from it at most."""

from __future__ import annotations

import numpy as np

from synth.arrays import FloatArray, frozen, frozen_value
from synth.rounding import rounded_down, rounded_up


@frozen_value
class Followed:
    """How a shape follows a path.

    Attributes:
        name: The path's name.
        tolerance: Largest distance of P5 from where it should be that counts as followed, m.
        joints: Angles (theta1, theta2) along the path, shape (k, 2), rad, within the joint limits, straight
            in between and clear of everything; none where it is not followed.
        points: Where P5 should be at each of these, in the task frame, shape (k, 3), m.
        lengths: How long the path is up to there, shape (k,), m.
        largest: Nowhere along the path is P5 farther from where it should be than this, m; infinite where it
            is not followed.
        seen: How far it is at least somewhere, m.
        breaks: Between which two points of the path it is not followed, shape (2, 3), m, in the task frame;
            empty where it is.
        jump: The joint angles there, between which the joints would have to jump, shape (2, 2), rad; empty
            where the path is followed, or one of the two points is not reached.
        speed: Speed of P5 that was asked for, m/s; None if none was.
    """

    name: str
    tolerance: float
    joints: FloatArray
    points: FloatArray
    lengths: FloatArray
    largest: float
    seen: float
    breaks: FloatArray
    jump: FloatArray
    speed: float | None = None

    @property
    def met(self) -> bool:
        """Whether the whole of the path is followed within the tolerance."""
        return self.largest <= self.tolerance

    @property
    def times(self) -> FloatArray | None:
        """When each of the joint angles is passed at the speed asked for, shape (k,), s; None without one."""
        return None if self.speed is None else frozen(self.lengths / self.speed)

    @property
    def joint_speeds(self) -> FloatArray | None:
        """Largest speed of each joint at the speed asked for, shape (2,), rad/s; None without one."""
        if self.times is None or not len(self.joints):
            return None
        return frozen(np.abs(np.diff(self.joints, axis=0) / np.diff(self.times)[:, None]).max(axis=0))

    @property
    def sentence(self) -> str:
        """How the path is followed, or where it is not, for the user."""
        if not self.met:
            start, end = (", ".join(f"{1e3 * x:z.0f}" for x in point) for point in self.breaks)
            told = f"{self.name}: it is not followed in one go: between ({start}) and ({end}) mm"
            if not len(self.jump):
                return f"{told} it is not reached all along"
            before, after = (", ".join(f"{angle:z.1f}" for angle in np.degrees(each)) for each in self.jump)
            return (
                f"{told} the joints would have to jump from ({before}) to ({after}) deg; no other motion was "
                f"found that strays by no more than {rounded_down(self.tolerance)} mm"
            )
        most = rounded_up(self.largest, digits=3)
        turns = np.degrees(np.ptp(self.joints, axis=0))
        told = (
            f"{self.name}: {1e3 * self.lengths[-1]:.0f} mm followed in one go; P5 strays by {most} mm at "
            f"most; joint 1 turns through {turns[0]:.1f} deg, joint 2 through {turns[1]:.1f} deg"
        )
        if self.speed is None or self.joint_speeds is None:
            return told
        rates = " and ".join(f"{each:.1f}" for each in np.degrees(self.joint_speeds))
        return f"{told}; at {1e3 * self.speed:.10g} mm/s they turn at up to {rates} deg/s"

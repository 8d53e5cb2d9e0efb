"""The check of what stands there now, again and again, as `synth check` does it of a file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from synth.errors import InputError, SynthError, in_a_line
from synth.export import check_to_json, refusal_to_json
from synth.guide import check_arm, check_text, hold_posture
from synth.measurement import StandingArm, at_rest, examine, sigma_of

if TYPE_CHECKING:
    from synth.live.feed import Feed
    from synth.measurement import Hand, Readings
    from synth.synthesis import Solution

_SOURCE = "the stream"
_PAUSE = 0.1  # s, between checks: the frames come first


@dataclass(frozen=True)
class CheckSettings:
    """What `synth check` is told, too.

    Attributes:
        corrections: How many corrections the operator is still willing to make.
        marker_error: Mean 3D error of a marker, m.
        base_calibrated: Whether axis 1 is the z axis of the frame.
        confidence: Chance that all targets are within tolerance from which on the link is locked.
        stiff: Whether the link is stiff already.
        hand: The hand that bends it; None for one as published.
    """

    corrections: int
    marker_error: float
    base_calibrated: bool
    confidence: float
    stiff: bool
    hand: Hand | None = None


class Checker:
    """Checks what a feed has seen, and publishes what is to be done.

    Args:
        solution: What is to be bent to, with a shape.
        settings: How.
    """

    def __init__(self, solution: Solution, settings: CheckSettings) -> None:
        self._solution, self._settings = solution, settings
        self.joint1 = hold_posture(solution.task, solution.robot).joint1
        self._wanted = StandingArm.of(solution.robot, self.joint1)

    def run(self, feed: Feed) -> None:
        """Check as often as there is something new, until the feed is closed."""
        seen = 0
        while not feed.closed:
            frames = feed.recent() if feed.seen != seen else []
            seen = feed.seen
            if frames:
                feed.publish("check", self.told_of(frames))
            feed.wait(_PAUSE)

    def told_of(self, frames: list[Readings]) -> dict[str, Any]:
        """Return what is told of frames: `synth.check/1` with all of its words, or why there is none."""
        try:
            readings = at_rest(frames, _SOURCE)
            moving = {name for each in frames for name in each.names} - set(readings.names)
        except InputError:
            moving = {name for each in frames for name in each.names}
        if moving:
            return _not_yet(f"{', '.join(sorted(moving))}: moving; hold still, and it is told what to do")
        try:
            return self._check(readings)
        except SynthError as error:
            return _not_yet(in_a_line(error))

    def _check(self, readings: Readings) -> dict[str, Any]:
        task, settings = self._solution.task, self._settings
        examination = examine(
            readings,
            self._wanted,
            task.robot,
            sigma_of(settings.marker_error),
            base_calibrated=settings.base_calibrated,
        )
        if examination.fit is None:
            return refusal_to_json(examination) | {"words": []}
        check = check_arm(
            task,
            self._solution.designs,
            examination.fit,
            corrections=settings.corrections,
            confidence=settings.confidence,
            stiff=settings.stiff,
            hand=settings.hand,
        )
        words = check_text(check, None, examination.rejected).split("\n")[2:]  # below the headline
        return check_to_json(check, examination, None) | {"words": words}


def _not_yet(message: str) -> dict[str, Any]:
    """Return that there is nothing to check."""
    return {
        "status": "moving",
        "message": message,
        "lock": False,
        "targets": [],
        "correction": None,
        "words": [],
    }

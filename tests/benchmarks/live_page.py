"""The live page in a real browser: `python tests/benchmarks/live_page.py [DIR]`, from the project's root.

A simulated arm stands wrong, is corrected and stands right; its markers come as datagrams, 60 frames a
second. The stream is dropped and the server started anew. Told are the delay from a datagram to the picture
that shows it, and how many pictures a second there are; pictures of the page are left in DIR.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from browser import browser

from synth import load_task, solve, write_files
from synth.guide import hold_posture
from synth.measurement import Readings, StandingArm, marker_named, marker_positions

if TYPE_CHECKING:
    from collections.abc import Iterator

    from synth.synthesis import Solution

ROOT = Path(__file__).parents[2]
NAMES = ["P1", "P2", "P3", "P4", "P5", "A2:-150", "A2:150", "A1:300"]
OFF = np.array([8e-3, -6e-3, 9e-3, 0.06, 0.03, -0.05])  # where the link's end stands first, m and rad
RATE = 60.0  # frames a second
PORT, UDP = 8711, 8712


class Arm:
    """A simulated arm that sends where its markers are.

    Attributes:
        share: How much of `OFF` is left.
        sending: Whether it sends.
    """

    def __init__(self, solution: Solution) -> None:
        robot = solution.task.robot
        self._wanted = StandingArm.of(solution.robot, hold_posture(solution.task, solution.robot).joint1)
        markers = tuple(marker_named(name, robot) for name in NAMES)
        joints = np.tile([self._wanted.joint1, np.pi], (len(NAMES), 1))
        self._blank = Readings(markers, np.zeros((len(NAMES), 3)), joints)
        self._tip_offset = robot.tip_offset
        self.share, self.sending, self.ended = 1.0, True, False

    def run(self) -> None:
        """Send frames until the end."""
        rng = np.random.default_rng(0)
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        due, frame = time.monotonic(), 0
        while not self.ended:
            frame, due = frame + 1, due + 1.0 / RATE
            if self.sending:
                exact = marker_positions(self._wanted.moved(self.share * OFF), self._blank, self._tip_offset)
                seen = 1e3 * (exact + 1.5e-4 * rng.normal(size=exact.shape))
                rows = [
                    {"marker": name, "x_mm": x, "y_mm": y, "z_mm": z, "frame": frame}
                    for name, (x, y, z) in zip(NAMES, seen.tolist(), strict=True)
                ]
                sender.sendto("\n".join(map(json.dumps, rows)).encode(), ("127.0.0.1", UDP))
            time.sleep(max(0.0, due - time.monotonic()))


@contextmanager
def served(solution_file: Path) -> Iterator[str]:
    """Run the command, and end it as a user does."""
    command = [sys.executable, "-m", "synth", "guide", str(solution_file), "--live"]
    running = subprocess.Popen(
        [*command, "--port", str(PORT), "--udp", str(UDP)], stdout=subprocess.PIPE, text=True, env=os.environ
    )
    assert running.stdout is not None
    try:
        yield running.stdout.readline().strip()
    finally:
        running.send_signal(signal.SIGINT)
        assert running.wait(10) == 0
        running.stdout.close()


# In the page: how many frames come, how old the newest is when a picture is made, and how many pictures there
# are. The last depends on what draws: a processor in place of a graphics card makes few.
PROBE = """new Promise((done) => {
  const ages = [], source = new EventSource('/events'), start = performance.now();
  let at = 0, pictures = 0, frames = 0;
  source.addEventListener('frame', (event) => { at = JSON.parse(event.data).at; frames += 1; });
  const step = (now) => {
    pictures += 1;
    if (at) ages.push(Date.now() - 1000 * at);
    at = 0;
    if (now - start < 4000) return requestAnimationFrame(step);
    source.close();
    ages.sort((a, b) => a - b);
    done({ pictures_a_second: pictures / 4, frames_a_second: frames / 4,
           delay_ms: ages[ages.length >> 1], delay_95_ms: ages[Math.floor(0.95 * ages.length)] });
  };
  requestAnimationFrame(step);
})"""
TITLE = "document.querySelector('.verdict strong').textContent"


def play(into: Path) -> dict[str, Any]:
    """Play it all, leave pictures in a folder, and return what was measured."""
    solution = solve(load_task(ROOT / "problems" / "two-crates" / "task.yaml"))
    file = write_files(solution, into)[0]
    arm = Arm(solution)
    threading.Thread(target=arm.run, daemon=True).start()
    record: dict[str, Any] = {}
    with browser() as tab:
        with served(file) as address:
            tab.show(address, 1360, 800)
            tab.wait_for(f"{TITLE} === 'Correct'")
            tab.evaluate("[...document.querySelectorAll('#views button')].at(-1).click()")
            time.sleep(1.0)
            (into / "live-correct.jpg").write_bytes(tab.picture("jpeg"))
            record["words"] = tab.evaluate("document.querySelector('.words').textContent")
            record |= tab.evaluate(PROBE)
            for share in np.linspace(1.0, 0.0, 60).tolist():
                arm.share = share
                time.sleep(1.0 / RATE)
            tab.wait_for(f"{TITLE} === 'Lock'")
            time.sleep(0.5)
            (into / "live-lock.jpg").write_bytes(tab.picture("jpeg"))
            arm.sending = False
            tab.wait_for(f"{TITLE} === 'Nothing seen'")
            arm.sending = True
            tab.wait_for(f"{TITLE} === 'Lock'")
        tab.wait_for(f"{TITLE} === 'Nothing seen'")
        tab.wait_for("document.querySelector('#live').innerText.includes('trying again')")
        arm.share = 1.0
        before = time.monotonic()
        with served(file):
            record["started_anew_s"] = time.monotonic() - before
            tab.wait_for(f"{TITLE} === 'Correct'")
            record["back_s"] = time.monotonic() - before
            tab.show(address, 390, 844, dark=True, pixels=2.0)
            tab.wait_for(f"{TITLE} === 'Correct'")
            time.sleep(1.0)
            (into / "live-narrow-dark.jpg").write_bytes(tab.picture("jpeg"))
        unexpected = [told for told in tab.complaints if "ERR_" not in told]  # of the server that was ended
        assert not unexpected, unexpected
        assert all(url.startswith(f"http://127.0.0.1:{PORT}/") for url in tab.requests), tab.requests
    arm.ended = True
    return record


def main() -> None:
    """Play it and print what was seen."""
    into = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp(prefix="live-"))
    print(json.dumps(play(into), indent=1))


if __name__ == "__main__":
    main()

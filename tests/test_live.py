"""The live guide: what is seen comes to the page as it was sent, and what is told is what the check says."""

import json
import signal
import socket
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from capture_files import motive_text, recorded
from command import invoked
from planted import ROBOT, planted_task
from sheets import SOLUTION, make_solution
from solutions import write_markers, write_solution
from standing import BARS, SIGMA, seen

from synth.errors import SynthError
from synth.export import check_to_json
from synth.guide import check_arm
from synth.live.checker import Checker, CheckSettings
from synth.live.feed import Feed
from synth.live.server import page_server
from synth.live.sources import feed_lines, feed_recording, feed_udp
from synth.measurement import (
    Readings,
    StandingArm,
    examine,
    load_readings,
    recorded_frames,
)
from synth.synthesis import solve

SETTINGS = CheckSettings(3, 0.455e-3, base_calibrated=True, confidence=0.95, stiff=False)
OFF = np.array([0.006, -0.005, 0.004, 0.03, 0.02, -0.04])


@pytest.fixture(scope="module")
def solution():
    task, _ = planted_task(5, 3)
    return solve(replace(task, targets=tuple(replace(each, tolerance=5e-3) for each in task.targets)))


def wanted(solution):
    return StandingArm.of(solution.robot, Checker(solution, SETTINGS).joint1)


def lines(frame):
    return [
        json.dumps({"marker": name, "x_m": x, "y_m": y, "z_m": z})
        for name, (x, y, z) in zip(frame.names, frame.positions.tolist(), strict=True)
    ]


@contextmanager
def serving(feed, page=b"the page"):
    server = page_server(page, feed, 0)
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        feed.close()
        server.shutdown()
        server.server_close()


def events(stream, kind):
    """Yield the contents of the events of a kind as they come."""
    name = ""
    for line in stream:
        field, _, value = line.decode().strip().partition(": ")
        name = value if field == "event" else name
        if field == "data" and name == kind:
            yield json.loads(value)


def test_what_was_seen_comes_over_a_socket_and_again_after_the_stream_was_dropped(solution):
    feed, frame = Feed(), seen(wanted(solution), BARS)
    with serving(feed) as address:
        feed.saw(frame)
        with urllib.request.urlopen(f"{address}/events", timeout=20) as stream:
            told = events(stream, "frame")
            first = next(told)
            assert first["count"] == 1
            assert list(first["markers"]) == list(frame.names)
            np.testing.assert_allclose(list(first["markers"].values()), frame.positions, atol=1e-6)
            assert first["joints"] == pytest.approx(frame.joints[0])
            feed.saw(Readings(frame.markers, frame.positions + 0.01, frame.joints))
            second = next(told)
            np.testing.assert_allclose(second["markers"]["P3"], frame.positions[2] + 0.01, atol=1e-6)
        for _ in range(50):  # while nobody listens
            feed.saw(frame)
        with urllib.request.urlopen(f"{address}/events", timeout=20) as stream:
            assert next(events(stream, "frame"))["count"] == 52  # the newest at once, nothing older


def test_only_the_page_and_its_events_are_there_and_only_for_this_machine():
    with serving(Feed()) as address:
        with urllib.request.urlopen(address, timeout=20) as page:
            assert page.read() == b"the page"
            assert page.headers["Cache-Control"] == "no-store"
        for path, host, code in (("/solution.json", None, 404), ("/", "example.org:80", 403)):
            request = urllib.request.Request(address + path, headers={"Host": host} if host else {})
            with pytest.raises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(request, timeout=20)
            assert refused.value.code == code
            refused.value.close()
        port = int(address.rpartition(":")[2])
        with pytest.raises(SynthError, match=f"cannot serve on port {port}"):
            page_server(b"", Feed(), port)


def test_a_marker_that_is_seen_no_more_is_told_no_more(solution):
    now = [0.0]
    feed, frame = Feed(lambda: now[0]), seen(wanted(solution), BARS)
    feed.saw(frame)
    now[0] = 0.4
    feed.saw(frame.without("P5"))
    assert set(json.loads(feed.after(0, 0.0)[1][0][1])["markers"]) == set(frame.names)
    now[0] = 0.6
    feed.saw(frame.without("P5"))
    assert "P5" not in json.loads(feed.after(0, 0.0)[1][0][1])["markers"]
    assert len(feed.recent()) == 2


def test_what_is_told_is_what_the_check_says(solution):
    checker, arm = Checker(solution, SETTINGS), wanted(solution)
    rng = np.random.default_rng(0)
    assert checker.told_of([seen(arm, BARS, rng) for _ in range(5)])["lock"]
    frame = seen(arm.moved(OFF), BARS, rng)
    told = checker.told_of([frame])
    examination = examine(frame, arm, ROBOT, SIGMA, base_calibrated=True)
    expected = check_to_json(check_arm(solution.task, solution.designs, examination.fit), examination, None)
    assert told["status"] == "correct"
    assert {key: told[key] for key in expected} == expected
    assert any("move the link's end" in word for word in told["words"])


def test_of_what_moves_or_cannot_be_nothing_is_said(solution):
    checker, arm = Checker(solution, SETTINGS), wanted(solution)
    still, moved = seen(arm, BARS), seen(arm.moved(10.0 * OFF), BARS)
    told = checker.told_of([still, moved])
    assert (told["status"], told["lock"], told["correction"]) == ("moving", False, None)
    assert "P3" in told["message"]
    assert "P1" not in told["message"]
    inches = Readings(still.markers, still.positions / 0.0254, still.joints)
    told = checker.told_of([inches])
    assert (told["status"], told["lock"]) == ("unusable", False)


def test_a_checker_publishes_what_is_new_until_the_feed_is_closed(solution):
    feed, checker = Feed(), Checker(solution, SETTINGS)
    feed.saw(seen(wanted(solution), BARS))
    working = threading.Thread(target=checker.run, args=(feed,))
    working.start()
    number, told = feed.after(1, 60.0)
    assert [kind for kind, _ in told] == ["check"]
    assert json.loads(told[0][1])["status"] == "lock"
    feed.close()
    working.join(60.0)
    assert not working.is_alive()
    assert feed.after(number, 60.0) == (number, [])


def test_lines_and_datagrams_are_read_and_wrong_ones_are_told_of(solution):
    arm = wanted(solution)
    frame, feed = seen(arm, BARS), Feed()
    feed_lines(feed, [*lines(frame), "", "no json"], ROBOT, arm.joint1)
    assert feed.seen == len(frame.names)
    told = dict(feed.after(0, 0.0)[1])
    assert json.loads(told["source"]) == {"message": "the stream has ended"}
    np.testing.assert_allclose(json.loads(told["frame"])["markers"]["P4"], frame.positions[3], atol=1e-6)

    feed = Feed()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(0.05)
        working = threading.Thread(target=feed_udp, args=(feed, receiver, ROBOT, arm.joint1))
        working.start()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for data in ("\n".join(lines(frame)).encode(), b"\xff{", b'{"marker": "P9", "x_m": 0}'):
                sender.sendto(data, receiver.getsockname())
        number, kinds = 0, []
        while len(kinds) < 2:
            number, told = feed.after(number, 60.0)
            kinds += [kind for kind, _ in told if kind not in kinds]
        feed.close()
        working.join(60.0)
    assert sorted(kinds) == ["frame", "source"]
    assert feed.seen == 1
    np.testing.assert_allclose(feed.recent()[0].positions, frame.positions, atol=1e-12)


def test_a_recording_is_shown_frame_by_frame(tmp_path):
    _, true, names, positions = recorded()
    y_up = np.stack([positions[..., 0], positions[..., 2], -positions[..., 1]], axis=-1)
    y_up[3, 4] = np.nan  # a gap
    file = tmp_path / "take.csv"
    file.write_text(motive_text(names, y_up))
    frames = recorded_frames(file, ROBOT, true.joint1)
    assert len(frames) == len(positions)
    np.testing.assert_allclose(frames[0].positions, positions[0], atol=1e-6)
    assert names[4] not in frames[3].names
    mean = np.mean([each.positions for each in frames if len(each.names) == len(names)], axis=0)
    np.testing.assert_allclose(mean, load_readings(file, ROBOT, true.joint1).positions, atol=2e-4)
    feed = Feed()
    feed_recording(feed, frames, 1000.0)
    assert feed.seen == len(frames)
    write_markers(file, seen(true, BARS))
    (only,) = recorded_frames(file, ROBOT, true.joint1)
    np.testing.assert_allclose(only.positions, seen(true, BARS).positions, atol=1e-9)


def test_the_command_serves_a_stream_from_stdin_until_it_is_stopped(solution, tmp_path):
    file = write_solution(tmp_path / "solution.json", solution.task, solution.designs)
    frame = seen(wanted(solution), BARS)
    with subprocess.Popen(
        [sys.executable, "-m", "synth", "guide", str(file), "--live", "--base-calibrated"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as running:  # fmt: skip
        address = running.stdout.readline().strip()
        running.stdin.write("\n".join(lines(frame)) + "\n")
        running.stdin.flush()
        with urllib.request.urlopen(address, timeout=60) as page:
            assert b'"live":true' in page.read()
        with urllib.request.urlopen(f"{address}events", timeout=60) as stream:
            assert next(told for told in events(stream, "check") if told["status"] == "lock")["lock"]
        running.send_signal(signal.SIGINT)
        _, talk = running.communicate(timeout=60)
    assert running.returncode == 0
    assert talk == "\nstopping\n"


def test_there_is_nothing_live_about_a_task_that_is_missed(tmp_path):
    missed = make_solution(offset=0.05)
    file = write_solution(tmp_path / "solution.json", missed.task, missed.designs)
    answer = invoked("guide", file, "--live")
    assert answer.exit_code == 2
    assert "there is nothing to bend the link to" in answer.output
    file = write_solution(tmp_path / "solution.json", SOLUTION.task, SOLUTION.designs)
    assert invoked("guide", file, "--udp", "9000").exit_code == 2
    assert invoked("guide", file, "--live", "--udp", "9000", "--replay", file).exit_code == 2
    assert "no such file" in invoked("guide", file, "--live", "--replay", tmp_path / "none.csv").output

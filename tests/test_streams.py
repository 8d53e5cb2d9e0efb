"""Motive and QTM over a network: what they send comes to the page, and what cannot be used is refused."""

import json
import threading
import time
import urllib.request
from contextlib import ExitStack, contextmanager
from dataclasses import replace

import numpy as np
import pytest
from command import invoked
from planted import ROBOT, planted_task
from sheets import SOLUTION
from solutions import write_solution
from standing import BARS, HOLD, seen, standing
from tracking_servers import GROUP, HOST, Motive, Qtm, running

from synth.errors import SynthError
from synth.live import MotiveStream, QtmStream, served_live
from synth.live.feed import Feed
from synth.live.sources import feed_stream
from synth.live.streams.stream import address_of
from synth.synthesis import solve

FRAME = seen(standing(3)[1], BARS)
PATIENCE = 20.0  # s, after which what is waited for does not come any more
NAMES, POINTS = list(FRAME.names), FRAME.positions
Y_UP = np.stack([POINTS[:, 0], POINTS[:, 2], -POINTS[:, 1]], axis=1)


@contextmanager
def fed(stream):
    """Yield a feed, and what is told on it of a kind, one after another."""
    feed = Feed()
    working = threading.Thread(target=feed_stream, args=(feed, stream, ROBOT, HOLD))
    working.start()

    def told(kind):
        number, deadline = 0, time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            number, events = feed.after(number, PATIENCE)
            yield from (json.loads(data) for each, data in events if each == kind)

    try:
        yield told
    finally:
        feed.close()
        working.join(20.0)
        assert not working.is_alive()


def message(told, words):
    return next(each["message"] for each in told("source") if words in each["message"])


def whole(told):
    """Return the first frame with all markers."""
    return next(each for each in told("frame") if len(each["markers"]) == len(NAMES))


def motive(version=(4, 1), names=NAMES, points=POINTS, **how):
    return Motive(version, list(names), points, **how)


def stream_of(server, port, patience=0.5):
    kind = QtmStream if isinstance(server, Qtm) else MotiveStream
    return kind(f"{HOST}:{port}", patience)


SERVERS = {
    "NatNet 3.1": motive((3, 1)),
    "NatNet 4.1": motive((4, 1)),
    "NatNet 4.1 by multicast": motive((4, 1), group=GROUP),
    "NatNet 4.2, in millimetres": motive((4, 2), points=1e3 * POINTS, millimetres=1.0),
    "NatNet that knows no unit": motive((3, 0), millimetres=None),
    "QTM": Qtm(NAMES, POINTS),
    "QTM with a set": Qtm([f"arm:{name}" for name in NAMES], POINTS),
}


@pytest.mark.parametrize("server", SERVERS.values(), ids=SERVERS)
def test_markers_come_by_their_names_in_metres(server):
    with running(server) as port, fed(stream_of(server, port)) as told:
        frame = whole(told)
        assert frame["up"] == "z"
        for name, point in zip(NAMES, POINTS, strict=True):
            np.testing.assert_allclose(frame["markers"][name], point, atol=2e-6)
        assert frame["joints"] == pytest.approx([HOLD, np.pi])


@pytest.mark.parametrize("server", [motive(points=Y_UP), Qtm(NAMES, Y_UP)], ids=["Motive", "QTM"])
def test_a_stream_with_y_up_is_turned(server):
    with running(server) as port, fed(stream_of(server, port)) as told:
        frame = whole(told)
        assert frame["up"] == "y"
        np.testing.assert_allclose(frame["markers"]["P5"], POINTS[NAMES.index("P5")], atol=2e-6)


@pytest.mark.parametrize("server", [motive(), motive((3, 1), group=GROUP), Qtm(NAMES, POINTS)])
def test_a_stream_that_was_dropped_goes_on_where_it_was(server):
    with ExitStack() as opened:
        with running(server) as port:
            stream = stream_of(server, port)
            told = opened.enter_context(fed(stream))
            count = whole(told)["count"]
        assert message(told, "trying again").startswith(f"{stream.name}: ")
        moved = replace(FRAME, positions=POINTS + 0.01)
        server.points = moved.positions
        with running(server, port):
            x = moved.positions[2, 0]
            frame = next(each for each in told("frame") if abs(each["markers"]["P3"][0] - x) < 1e-5)
            assert frame["count"] > count
            assert message(told, f"from {stream.name}")


def test_a_marker_that_is_not_seen_is_not_told():
    lost = POINTS.copy()
    lost[3] = np.nan
    server = Qtm(NAMES, lost)
    with running(server) as port, fed(stream_of(server, port)) as told:
        assert set(next(told("frame"))["markers"]) == set(NAMES) - {NAMES[3]}


@pytest.mark.parametrize("server", [motive(), Qtm(NAMES, POINTS)], ids=["Motive", "QTM"])
def test_a_name_that_is_given_later_is_known_then(server):
    names, server.names = server.names, [*server.names[:-1], "new marker"]
    with running(server) as port, fed(stream_of(server, port)) as told:
        assert set(next(told("frame"))["markers"]) == set(names[:-1])
        server.names = names
        assert names[-1] in whole(told)["markers"]


OTHERS = ["head", "hand", "toe", "heel", "hip", "knee", "nose"]
TWICE = ["arm:P1", "tool:P1", *OTHERS[2:]]
REFUSED = {
    "NatNet 2": (motive((2, 10)), "speaks NatNet 2.10, and only 3 and 4 are understood"),
    "NatNet 5": (motive((5, 0)), "speaks NatNet 5.0, and only 3 and 4 are understood"),
    "names in Motive": (motive(names=OTHERS), "has no marker of this arm, only 'arm:head'"),
    "names in QTM": (Qtm(OTHERS, POINTS), "has no marker of this arm, only 'head'"),
    "no names": (Qtm([], POINTS[:0]), "has no markers"),
    "a name twice": (Qtm(TWICE, POINTS), "P1 is there as 'arm:P1' and as 'tool:P1': which is it?"),
    "QTM's version": (Qtm(NAMES, POINTS, refusal="Version NOT supported"), "it says 'Version NOT supported'"),
    "QTM in a unit": (Qtm(NAMES, 1e3 * POINTS), "is farther than 100 m: which unit is it in?"),
    "Motive in a unit": (motive(points=1e3 * POINTS), "is farther than 100 m: which unit is it in?"),
}


@pytest.mark.parametrize(("server", "reason"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_used_is_refused_with_the_reason(server, reason):
    with running(server) as port:
        stream = stream_of(server, port, patience=20.0)
        with fed(stream) as told:
            said = message(told, reason)
    assert said.startswith(f"{stream.name}: ")
    assert said.endswith("; trying again")


def test_nobody_there_is_said():
    with running(motive()) as port:
        pass
    with fed(MotiveStream(f"{HOST}:{port}", 0.2)) as told:
        assert message(told, "no answer: does it stream")
    with fed(QtmStream(f"{HOST}:{port}", 0.2)) as told:
        assert message(told, "Connection refused")


def test_a_server_of_something_else_is_no_qtm():
    class Page(Qtm):
        def answer(self, _command):
            return b"HTTP/1.1 400 Bad Request\r\n\r\n"

    server = Page(NAMES, POINTS)
    with running(server) as port, fed(stream_of(server, port)) as told:
        assert message(told, "this is not QTM's real-time protocol")


def test_frames_without_names_are_said_to_be_missing():
    class Mute(Motive):
        def frame(self):
            return b""

    server = Mute((4, 1), NAMES, POINTS)
    with running(server) as port, fed(stream_of(server, port)) as told:
        assert message(told, "Motive 3.1 sends no frame: is it live")
    server = motive(points=np.zeros((0, 3)))
    with running(server) as port, fed(stream_of(server, port)) as told:
        assert message(told, "no marker with a name is seen")


@pytest.mark.parametrize("kind", [MotiveStream, QtmStream])
def test_the_page_is_served_from_a_tracking_system(kind):
    task, _ = planted_task(5, 3)
    solution = solve(replace(task, targets=tuple(replace(each, tolerance=5e-3) for each in task.targets)))
    server = motive() if kind is MotiveStream else Qtm(NAMES, POINTS)
    how = {"corrections_left": 3, "marker_error": 0.455e-3, "base_calibrated": True, "confidence": 0.95}
    with (
        running(server) as port,
        served_live(solution, kind(f"{HOST}:{port}"), 0, **how, stiff=False, hand=None) as address,
        urllib.request.urlopen(f"{address}events", timeout=20) as stream,
    ):
        lines = (line.decode() for line in stream)
        told = next(json.loads(line[6:]) for line in lines if '"markers"' in line and "P5" in line)
    np.testing.assert_allclose(told["markers"]["P5"], POINTS[NAMES.index("P5")], atol=2e-6)


def test_addresses_are_read_or_refused(tmp_path):
    assert address_of("cameras", 1510) == ("cameras", 1510)
    assert address_of(" 10.0.0.7:99 ", 1510) == ("10.0.0.7", 99)
    for wrong in ("", ":99", "10.0.0.7:", "10.0.0.7:x", "10.0.0.7:70000", "::1", "a..b", 70 * "a"):
        with pytest.raises(SynthError, match="is no address"):
            address_of(wrong, 1510)
    file = write_solution(tmp_path / "solution.json", SOLUTION.task, SOLUTION.designs)
    for option in ("--natnet", "--qtm"):
        assert invoked("guide", file, option, "cameras").exit_code == 2
        assert invoked("guide", file, "--live", option, "cameras", "--udp", "9000").exit_code == 2
        answer = invoked("guide", file, "--live", option, "cameras:x")
        assert answer.exit_code == 2
        assert "'cameras:x' is no address" in answer.output

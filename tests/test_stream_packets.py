"""Packets of Motive and QTM, byte by byte; other packages, where they are installed, read them alike."""

import asyncio

import numpy as np
import pytest
from tracking_packets import (
    FILLED,
    HIDDEN,
    MEASURED,
    UNNAMED,
    motive_frame,
    motive_names,
    motive_packet,
    motive_server,
    qtm_frame,
)
from tracking_servers import HOST, Qtm, running

from synth.errors import SynthError
from synth.live.streams import natnet_packets as natnet
from synth.live.streams.qtm import _seen

VERSIONS = [(3, 0), (3, 1), (4, 0), (4, 1), (4, 2), (4, 3)]
SETS = {"arm": ["P1", "P2", "arm:P3", "arm_P4", "A2:-150"]}
FULL = ("arm:P1", "arm:P2", "arm:P3", "arm:P4", "arm:A2:-150")
BODIES = [("tool", 12, ["P5", "E:-60"]), ("arm", 4, [""] * 5)]
PLACES = [tuple(point) for point in np.float32(np.random.default_rng(0).normal(size=(7, 3))).tolist()]
FLAGS = [MEASURED, FILLED, HIDDEN, MEASURED, MEASURED]
LABELLED = [
    *((0x7001 + k, place, flags) for k, (place, flags) in enumerate(zip(PLACES, FLAGS, strict=False))),
    (12 << 16 | 1, PLACES[5], MEASURED),
    (12 << 16 | 2, PLACES[6], HIDDEN),
    (12 << 16 | 3, (9.0, 9.0, 9.0), MEASURED),
    (0x9999, (8.0, 8.0, 8.0), UNNAMED),
]


def read(version, sets, labelled=LABELLED):
    names = natnet.names_in(motive_names(version, SETS, BODIES), version)
    return names, natnet.points_in(motive_frame(version, sets, labelled), version, names)


@pytest.mark.parametrize("version", VERSIONS)
def test_what_was_measured_has_its_name_and_what_was_filled_in_is_not_there(version):
    names, points = read(version, {"arm": PLACES[:5]})
    own = {"tool:P5": PLACES[5]} if version >= (4, 0) else {}  # in 3 a body does not say its markers' names
    assert points == {name: PLACES[k] for k, name in enumerate(FULL) if FLAGS[k] == MEASURED} | own
    assert names.all == FULL + (("tool:P5", "tool:E:-60") if version >= (4, 0) else ())


@pytest.mark.parametrize("version", VERSIONS)
def test_a_rigid_body_is_known_by_its_number_where_no_set_is_sent(version):
    labelled = [(4 << 16 | k, PLACES[k], MEASURED) for k in range(1, 6)]
    assert read(version, {}, labelled)[1] == {name: PLACES[k] for k, name in enumerate(FULL, 1)}


@pytest.mark.parametrize("version", VERSIONS)
def test_what_is_cut_short_or_damaged_is_refused(version):
    described = motive_names(version, SETS, BODIES)
    names = natnet.names_in(described, version)
    frame = motive_frame(version, {"arm": PLACES[:5]}, LABELLED)
    whole = natnet.points_in(frame, version, names)
    rng = np.random.default_rng(1)
    refused = 0
    for cut in range(len(frame)):
        damaged = bytearray(frame)
        damaged[cut] = rng.integers(256)
        for content in (frame[:cut], bytes(damaged)):
            try:
                found = natnet.points_in(content, version, names)
            except SynthError:
                refused += 1
            else:
                assert content is not frame[:cut] or found == whole  # only what stands behind is lost
    for cut in range(len(described)):
        damaged = bytearray(described)
        damaged[cut] = rng.integers(256)
        try:
            natnet.names_in(bytes(damaged), version)
        except SynthError:
            refused += 1
    assert refused > len(frame) // 2
    with pytest.raises(SynthError, match="is shorter than it says"):
        natnet.server_in(bytes(100))


def test_labelled_markers_of_another_length_are_refused():
    frame = motive_frame((4, 1), {"arm": PLACES[:5]}, LABELLED)
    start = frame.index((len(LABELLED) * 26).to_bytes(4, "little"))
    longer = frame[:start] + (len(LABELLED) * 30).to_bytes(4, "little") + frame[start + 4 :]
    with pytest.raises(SynthError, match="labelled markers of 30 bytes are not known"):
        natnet.points_in(longer, (4, 1), natnet.Names({}, {}))


def test_a_server_says_its_version_and_where_its_frames_come():
    said = motive_server((4, 1), "239.255.42.99", 1511)
    assert natnet.server_in(said) == ("Motive 3.1", (4, 1), ("239.255.42.99", 1511))
    assert natnet.server_in(motive_server((4, 1))).group is None
    assert natnet.server_in(said[:264]).group is None  # as before it was said
    assert natnet.opened(motive_packet(1, said)) == (1, said)
    assert natnet.opened(b"\1") == (-1, b"")


def test_a_frame_of_qtm_that_is_cut_short_is_refused():
    names = ("P1", "P2")
    frame = qtm_frame([(100.0, 200.0, -300.0), None])
    points = _seen(frame, names).points
    np.testing.assert_allclose(points["P1"], (0.1, 0.2, -0.3))
    assert np.isnan(points["P2"]).all()
    assert _seen(frame, ("P1",)) is None
    for cut in range(len(frame)):
        with pytest.raises(SynthError):
            _seen(frame[:cut], names)


@pytest.mark.parametrize("version", VERSIONS)
def test_the_package_for_motive_reads_the_same(version):
    package = pytest.importorskip("natnet")
    spoken = package.Version(*version)
    frame = motive_frame(version, {"arm": PLACES[:5]}, LABELLED)
    told = package.DataFrame.read_from_buffer(package.packet_buffer.PacketBuffer(frame), spoken)
    assert {each.model_name: each.marker_pos_list for each in told.marker_sets}["arm"] == tuple(PLACES[:5])
    assert [(each.id_num, each.pos, each.param) for each in told.labeled_markers] == LABELLED
    assert [each.occluded for each in told.labeled_markers][:5] == [flags == HIDDEN for flags in FLAGS]
    described = motive_names(version, SETS, BODIES, plates=False)  # of which it reads 9 of 12 corners
    told = package.DataDescriptions.read_from_buffer(package.packet_buffer.PacketBuffer(described), spoken)
    assert {each.name: each.marker_names for each in told.marker_sets}["arm"] == tuple(SETS["arm"])
    assert [(each.name, each.id_num, len(each.markers)) for each in told.rigid_bodies] == [
        (name, number, len(names)) for name, number, names in BODIES
    ]


def test_the_package_for_qtm_reads_the_same():
    package = pytest.importorskip("qtm_rt")
    names, points = ["P1", "P2"], [[0.1, 0.2, -0.3], [0.4, 0.5, 0.6]]

    async def first(port):
        connection = await package.connect(HOST, port=port, version="1.8", loop=asyncio.get_running_loop())
        described = await connection.get_parameters(["3d"])
        packets = asyncio.Queue()
        await connection.stream_frames(components=["3d"], on_packet=packets.put_nowait)
        packet = await asyncio.wait_for(packets.get(), 20.0)
        connection.disconnect()
        return described, packet.get_3d_markers()[1]

    with running(Qtm(names, points)) as port:
        described, markers = asyncio.run(first(port))
    assert b"<Name>P2</Name>" in described
    np.testing.assert_allclose(markers, 1e3 * np.array(points), rtol=1e-6)

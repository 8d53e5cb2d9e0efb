"""The files for planners and simulators, read by those that read them: as many as are installed."""

import numpy as np
import pytest
from robot_files import Urdf, arms, solution_with

ARMS = arms()
BODIES = ("base_link", "malleable_link", "rigid_link")
pytestmark = pytest.mark.filterwarnings("ignore")  # those of other libraries about themselves


@pytest.fixture(scope="module", params=ARMS)
def exported(request, tmp_path_factory):
    arm = ARMS[request.param]
    folder = tmp_path_factory.mktemp("readers")
    solution_with(arm, floor=-1.0).export(folder)
    joints = np.random.default_rng(0).uniform(*arm.joint_bounds, (1000, 2))
    pieces = sum(len(Urdf(folder / "robot.urdf").pieces(body)) for body in BODIES)
    return arm, folder, joints, arm.forward_kinematics(*joints.T), pieces


def test_pinocchio(exported):
    pin = pytest.importorskip("pinocchio")
    arm, folder, joints, points, pieces = exported
    urdf = str(folder / "robot.urdf")
    model = pin.buildModelFromUrdf(urdf)
    data, tool = model.createData(), model.getFrameId("tool0")
    for each, point in zip(joints, points, strict=True):
        pin.framesForwardKinematics(model, data, each)
        np.testing.assert_allclose(data.oMf[tool].translation, point, atol=1e-9)
    shapes = pin.buildGeomFromUrdf(model, urdf, pin.GeometryType.COLLISION, package_dirs=[str(folder)])
    assert len(shapes.geometryObjects) == pieces
    seen = pin.buildGeomFromUrdf(model, urdf, pin.GeometryType.VISUAL, package_dirs=[str(folder)])
    assert len(seen.geometryObjects) == 3
    np.testing.assert_array_equal([model.lowerPositionLimit, model.upperPositionLimit], arm.joint_bounds)
    for each in joints[:20]:
        jacobian = pin.computeFrameJacobian(model, data, each, tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
        np.testing.assert_allclose(jacobian[:3], arm.jacobian(each), atol=1e-9)


@pytest.mark.parametrize("file", ["robot.urdf", "robot.xml"])
def test_mujoco(exported, file):
    mujoco = pytest.importorskip("mujoco")
    arm, folder, joints, points, pieces = exported
    model = mujoco.MjModel.from_xml_path(str(folder / file))
    data, tool = mujoco.MjData(model), model.body("tool0").id
    for each, point in zip(joints, points, strict=True):
        data.qpos[:] = each
        mujoco.mj_kinematics(model, data)
        np.testing.assert_allclose(data.xpos[tool], point, atol=1e-9)
    np.testing.assert_allclose(model.jnt_range.T, arm.joint_bounds, atol=1e-12)
    collide = int((model.geom_contype > 0).sum())
    if file == "robot.urdf":
        assert collide == pieces
    else:  # a capsule for each cylinder with its spheres, a column, a floor
        tube = len(Urdf(folder / "robot.urdf").pieces("malleable_link")) // 2
        assert collide == tube + 1 + 1 + 1
        np.testing.assert_allclose(data.site("P5").xpos, points[-1], atol=1e-9)
        for key in range(model.nkey):
            mujoco.mj_resetDataKeyframe(model, data, key)
            mujoco.mj_forward(model, data)
            target = data.site(f"target_{model.key(key).name}").xpos
            np.testing.assert_allclose(data.site("P5").xpos, target, atol=1e-9)


def test_drake(exported):
    parsing = pytest.importorskip("pydrake.multibody.parsing")
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph  # noqa: PLC0415
    from pydrake.systems.framework import DiagramBuilder  # noqa: PLC0415

    arm, folder, joints, points, pieces = exported
    plant, _ = AddMultibodyPlantSceneGraph(DiagramBuilder(), 0.0)
    parsing.Parser(plant).AddModels(str(folder / "robot.urdf"))
    plant.Finalize()
    context, tool = plant.CreateDefaultContext(), plant.GetFrameByName("tool0")
    for each, point in zip(joints, points, strict=True):
        plant.SetPositions(context, each)
        np.testing.assert_allclose(tool.CalcPoseInWorld(context).translation(), point, atol=1e-9)
    assert plant.num_collision_geometries() == pieces
    limits = [plant.GetPositionLowerLimits(), plant.GetPositionUpperLimits()]
    np.testing.assert_array_equal(limits, arm.joint_bounds)


def test_yourdfpy(exported):
    yourdfpy = pytest.importorskip("yourdfpy")
    _, folder, joints, points, pieces = exported
    robot = yourdfpy.URDF.load(
        str(folder / "robot.urdf"),
        build_collision_scene_graph=True,
        load_collision_meshes=True,
    )
    for each, point in zip(joints, points, strict=True):
        robot.update_cfg(each)
        np.testing.assert_allclose(robot.get_transform("tool0", "world")[:3, 3], point, atol=1e-9)
    assert sum(len(link.collisions) for link in robot.robot.links) == pieces
    assert set(robot.collision_scene.geometry) == {f"{body}_piece_1" for body in BODIES}  # one for each body
    assert robot.validate()


def test_roboticstoolbox(exported):
    toolbox = pytest.importorskip("roboticstoolbox")
    _, folder, joints, points, pieces = exported
    robot = toolbox.Robot.URDF(str(folder / "robot.urdf"))
    reached = [robot.fkine(each, end="tool0").t for each in joints]
    np.testing.assert_allclose(reached, points, atol=1e-9)
    assert sum(len(link.collision.data) for link in robot.links) == pieces


def test_meshes_are_closed(exported):
    trimesh = pytest.importorskip("trimesh")
    arm, folder, *_ = exported
    tube = trimesh.load(folder / "malleable_link.obj")
    assert tube.is_watertight
    assert tube.is_winding_consistent
    assert tube.volume > 0.0
    low, high = trimesh.load(folder / "workspace.ply").bounds
    np.testing.assert_allclose(trimesh.load(folder / "workspace.stl").bounds, [low, high], atol=1e-6)
    # In glTF y is up.
    upright = [[low[0], low[2], -high[1]], [high[0], high[2], -low[1]]]
    np.testing.assert_allclose(trimesh.load(folder / "workspace.glb").bounds, upright, atol=1e-6)
    assert len(trimesh.load(folder / "workspace_reachable.stl").faces) > 0
    assert (low < arm.base.position + 2.0).all()

"""One value of each frozen dataclass of the package, as small runs of all of it make them."""

from __future__ import annotations

import dataclasses
import importlib
import math
import pkgutil
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from capture_files import recorded, trc_text
from exact_targets import random_values, targets_of
from planted import ROBOT, planted_task
from planted_approaches import planted_approach
from planted_bases import planted_base
from planted_obstacles import planted_with_obstacles
from planted_paths import planted_path
from planted_surfaces import as_mesh, as_points, as_torus
from sampled_shapes import noisy_task
from standing import BARS, HOLD, SIGMA, seen, standing

import synth
from synth.errors import Mistake
from synth.export import write_files
from synth.geometry import Box, Capsule, Sphere, planes_through, spheres_through
from synth.geometry.circle import CircleAboutAxis
from synth.guide import make_guide
from synth.guide.loop.checking import check_arm
from synth.guide.loop.settings import best_settings
from synth.guide.loop.swept_targets import swept_targets
from synth.live.checker import CheckSettings
from synth.live.serving import Recording
from synth.measurement import (
    MARKER_ERROR,
    Deed,
    StandingArm,
    calibrate,
    examine,
    hand_error,
    inspect,
    learned_hand,
    matched,
)
from synth.measurement.captures.formats import capture_in
from synth.measurement.distances.measured import Precision
from synth.measurement.distances.reading import parse_measurements
from synth.robot import Arm, BaseChoices, LinkShape, Workspace, link_to_pose, why_no_link
from synth.robot.arm_in_shape import ArmInShape
from synth.surfaces import Rectangle
from synth.sweep import solve_many
from synth.synthesis import Release, solve, verify
from synth.synthesis.bound import prove
from synth.synthesis.check.between import between_samples
from synth.synthesis.relaxed_limits import limits_of
from synth.synthesis.solution import Outcome
from synth.watch import Watch

# These hold symbolic expressions, and figures: of neither can anybody say whether it is equal to another.
WITHOUT_A_VALUE = {"Derivation", "_Piece", "Page", "_Paper", "RobotDrawing"}


def frozen_dataclasses():
    """Return those of all modules, private ones among them."""
    names = [module.name for module in pkgutil.walk_packages(synth.__path__, "synth.")]
    modules = [importlib.import_module(name) for name in names if not name.endswith("__main__")]
    found = {
        value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, type) and dataclasses.is_dataclass(value) and value.__module__ == module.__name__
    }
    return {cls for cls in found if cls.__dataclass_params__.frozen and cls.__name__ not in WITHOUT_A_VALUE}


@contextmanager
def recording(classes):
    """Yield a dictionary that gets the first value of each class that is made."""
    made, makers = {}, {cls: cls.__init__ for cls in classes}

    def watched(cls, maker):
        def make(self, *arguments, **options):
            maker(self, *arguments, **options)
            made.setdefault(cls, self)

        return make

    for cls, maker in makers.items():
        cls.__init__ = watched(cls, maker)
    try:
        yield made
    finally:
        for cls, maker in makers.items():
            cls.__init__ = maker


def recorded_values(folder):
    """Return a value of each frozen dataclass, by its class; files are written into a folder."""
    with recording(frozen_dataclasses()) as made:
        _solved(folder)
        _proven()
        _stood_somewhere_else()
        _bent_by_a_hand()
        _measured()
        _exact()
        _small()
        _free_bases()
        _surfaces()
        _paths()
        _rigid_links()
        _captures()
    return made


def _solved(folder):
    task, _, _ = planted_with_obstacles("window", 2)
    solution = solve(task)
    (make_guide(task, solution.best), solution.targets)
    write_files(solution, folder)
    ArmInShape(*(getattr(solution.robot, field.name) for field in dataclasses.fields(ArmInShape)))
    Outcome(*(getattr(solution, field.name) for field in dataclasses.fields(Outcome)))
    solution.export(folder)
    told = []
    solve_many([task], store=folder / "sweep.sqlite", progress=told.append, alternatives=0)
    limit = next(iter(limits_of(task)))
    Release(limit.name, 0.1, 0.1, limit.sentence(0.1), solution.best, limit.relaxed(0.1))


def _proven():
    ends, task = [], noisy_task(5)

    def improve(end):
        ends.append(end.links(ROBOT.link, 4, 8, np.random.default_rng(0)))
        return 0.01

    watch = Watch(stop=lambda: bool(ends))  # until there was an end to be tried
    prove(task, 0.01, np.zeros(len(task.targets)), tightest=1e-3, watch=watch, improve=improve)


def _stood_somewhere_else():
    task, arm = planted_task(5, 3)
    solution = solve(task, alternatives=0)
    wanted = StandingArm.of(solution.robot, HOLD)
    true = wanted.moved(np.array([0.006, -0.005, 0.004, 0.03, 0.02, -0.04]))
    fit = examine(seen(true, BARS), wanted, ROBOT, SIGMA, base_calibrated=True).fit
    check_arm(task, solution.designs, fit)
    best_settings(task, ROBOT, fit, solution.best.verification.joints)
    joints = np.random.default_rng(0).uniform([0.5, 1.5], [6.0, 5.0], (60, 2))
    swept_targets(calibrate(true.forward(joints), joints, wanted, SIGMA), task)
    verify(task, Arm(ROBOT, LinkShape([[0.0, 0.0]], [5.0]), arm.d35, arm.d45))


def _bent_by_a_hand():
    wanted, true = standing(0)
    readings = seen(true, BARS)
    matched(readings.positions, readings.markers, wanted, ROBOT.tip_offset, SIGMA, base_calibrated=True)
    fit = examine(readings, wanted, ROBOT, SIGMA, base_calibrated=True).fit
    learned_hand([hand_error(fit, Deed.PLACED, wanted.end, wanted.axis, np.zeros(6))])
    CheckSettings(3, MARKER_ERROR, base_calibrated=True, confidence=0.95, stiff=False)
    Recording(Path("take.csv"), 1.0)


def _measured():
    distances = "{d13: 500, d14: 544, d15: 562, d23: 451, d24: 494, d25: 520}"
    text = f"synth: 1\nlength_unit: mm\nrobot: malleable-2dof\nrounding: 1\ndistances: {distances}\n"
    inspect(parse_measurements(text.replace("544", "5440"))[0], samples=20)
    Precision.from_sigma(1e-3)


def _exact():
    rng = np.random.default_rng(0)
    values = random_values(rng, 1)
    synth.geometry.arms_through_five(targets_of(values, 5, rng))
    values[:, 1] = 0.0
    planes_through(targets_of(values, 5, rng)[0])
    values[:, [0, 1]] = 0.0, 0.7
    spheres_through(targets_of(values, 5, rng)[0])


def _free_bases():
    task, base = planted_base(0, count=3)
    make_guide((solution := solve(task)).task, solution.best)
    solve(replace(task, places=BaseChoices(["here"], [base])), alternatives=0)
    planted_approach(0)


def _surfaces():
    for task in (as_points(0, 40)[0], as_mesh(0, 4)[0], as_torus(0)):
        solve(task, alternatives=0, time_limit=3.0)
    task, arm = as_mesh(0, 4)
    between_samples(task, arm, task.surfaces[0], Watch(1.0))
    Rectangle([1.0, 0.5])


def _rigid_links():
    several = "{one_of: [{d35: 300, d45: 310}, {d35: 400, d45: 410}]}"
    link = "{length: [550, 700], min_bend_radius: 110}"
    robot = f"{{d12: 58, d34: 49, link: {link}, rigid_link: {several}, joint_limits_deg: {{}}}}"
    start = "synth: 1\nlength_unit: mm\ntargets: [{position: [500, 0, 300]}]\n"
    synth.parse_task(f"{start}robot: {robot}\n")


def _captures():
    _, _, names, positions = recorded()
    capture_in(trc_text(names, positions), "walk.trc")


def _paths():
    task, arm = planted_path(2)
    verify(task, arm)


def _small():
    _, arm = planted_task(5, 3)
    Workspace.within_limits(arm).mesh(math.radians(30.0))
    rotation, position = arm.shape.end_frame()
    link_to_pose(ROBOT.link, position, rotation[:, 0], current=arm.shape)
    why_no_link(ROBOT.link, position, rotation[:, 0])
    CircleAboutAxis.from_points(arm.circle.axis_points(0.1, 0.2).repeat(2, axis=0)[1:])
    arm.circle.distance([[0.3, 0.2, 0.1]])
    (Sphere([0, 0, 1], 1), Capsule([[0, 0, 0], [1, 1, 1]], 1), Box([0, 0, 0], [1, 1, 1]), Mistake("wrong"))

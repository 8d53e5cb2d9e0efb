"""A robot in one shape for planners and simulators: kinematics in CasADi and C, descriptions, meshes."""

from synth.export.planners.files import KINDS, kinds_of, planner_files
from synth.export.planners.symbolic import casadi_kinematics, kinematics_c_code

__all__ = ["KINDS", "casadi_kinematics", "kinds_of", "kinematics_c_code", "planner_files"]

"""Solutions as files: for programs (JSON) and spreadsheets (CSV), to hold (PDF), to look around in (HTML)."""

from synth.export.calibration_json import calibration_to_json
from synth.export.check_json import check_to_json, refusal_to_json
from synth.export.files import (
    SOLUTION_FILES,
    live_page,
    write_files,
    write_page,
    write_planner_files,
    write_what_can_be,
)
from synth.export.hand_json import hand_to_json
from synth.export.inspection import (
    file_names,
    inspection_text,
    inspections_markdown,
    inspections_to_json,
    write_inspections,
)
from synth.export.json_data import json_bytes, json_text, plain
from synth.export.markers import markers_csv
from synth.export.page import page_content
from synth.export.planners import casadi_kinematics, kinematics_c_code
from synth.export.sheet import draw_robot, draw_sheet
from synth.export.solution_json import solution_to_json
from synth.export.task_json import task_to_json
from synth.export.writing import prepare_directory, write_all

__all__ = [
    "SOLUTION_FILES",
    "calibration_to_json",
    "casadi_kinematics",
    "check_to_json",
    "draw_robot",
    "draw_sheet",
    "file_names",
    "hand_to_json",
    "inspection_text",
    "inspections_markdown",
    "inspections_to_json",
    "json_bytes",
    "json_text",
    "kinematics_c_code",
    "live_page",
    "markers_csv",
    "page_content",
    "plain",
    "prepare_directory",
    "refusal_to_json",
    "solution_to_json",
    "task_to_json",
    "write_all",
    "write_files",
    "write_inspections",
    "write_page",
    "write_planner_files",
    "write_what_can_be",
]

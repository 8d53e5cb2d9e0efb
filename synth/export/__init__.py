"""Solutions as files: for programs (JSON), for spreadsheets (CSV), and to be held in a hand (PDF)."""

from synth.export.files import (
    SOLUTION_FILES,
    json_text,
    prepare_directory,
    write_files,
    write_what_can_be,
)
from synth.export.markers import markers_csv
from synth.export.sheet import draw_sheet
from synth.export.solution_json import solution_to_json

__all__ = [
    "SOLUTION_FILES",
    "draw_sheet",
    "json_text",
    "markers_csv",
    "prepare_directory",
    "solution_to_json",
    "write_files",
    "write_what_can_be",
]

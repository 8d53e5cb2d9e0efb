"""Solutions as files: for programs (JSON), for spreadsheets (CSV), and to be held in a hand (PDF)."""

from synth.export.files import write_files
from synth.export.markers import markers_csv
from synth.export.sheet import sheet
from synth.export.solution_json import solution_to_json

__all__ = ["markers_csv", "sheet", "solution_to_json", "write_files"]

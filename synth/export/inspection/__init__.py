"""What an inspection of measured configurations writes."""

from synth.export.inspection.files import file_names, write_inspections
from synth.export.inspection.json import inspections_to_json
from synth.export.inspection.text import inspection_text, inspections_markdown

__all__ = [
    "file_names",
    "inspection_text",
    "inspections_markdown",
    "inspections_to_json",
    "write_inspections",
]

"""What files of measurements may hold, as JSON Schema."""

from __future__ import annotations

from typing import Any

from synth.measurement.distances import MeasuredFile
from synth.measurement.markers import row_schema
from synth.task import json_schema


def measured_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of measurements.

    A list is one of rows, as `synth check` and `synth calibrate` read them: lines of JSON, or of CSV with
    these columns. A mapping is a file of distances or markers in YAML, as `synth inspect` reads it.
    """
    file = MeasuredFile.model_json_schema()
    definitions = file.pop("$defs")
    definitions |= {"Row": row_schema(), "MeasuredFile": file}
    rows = {"type": "array", "items": {"$ref": "#/$defs/Row"}, "minItems": 1}
    either = [rows, {"$ref": "#/$defs/MeasuredFile"}]
    return json_schema({"title": "Measured", "anyOf": either, "$defs": definitions})

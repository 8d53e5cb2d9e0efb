"""`synth schema`: JSON Schema of each kind of file."""

import json

import pytest
from command import invoked


@pytest.mark.parametrize("kind", ["task", "robot", "solution", "measured"])
def test_schemas_are_printed(kind):
    result = invoked("schema", kind)
    assert result.exit_code == 0
    schema = json.loads(result.stdout)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    jsonschema = pytest.importorskip("jsonschema")
    jsonschema.Draft202012Validator.check_schema(schema)


def test_the_schema_of_measurements_knows_rows_and_files():
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(invoked("schema", "measured").stdout)
    valid = jsonschema.Draft202012Validator(schema).is_valid
    row = {"marker": "P3", "x_mm": -432.1, "y_mm": 20.4, "z_mm": 310.0, "joint1_deg": 180}
    assert valid([row])
    assert not valid([row | {"x_m": 1.0, "y_m": 1.0, "z_m": 1.0}])
    assert not valid([row | {"w_mm": 1.0}])
    markers = {name: [0.0, 0.0, 1.0] for name in ("P1", "P2", "P3", "P4")}
    file = {"synth": 1, "length_unit": "mm", "robot": "malleable-2dof", "markers": markers}
    assert valid(file)
    assert not valid(file | {"unit": "mm"})

"""Files at random: what is read is a task, what is not is told; never a traceback."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from right_tasks import INLINE, TASK
from task_texts import ROBOT, write

from synth.errors import InputError
from synth.task import (
    load_robot,
    load_task,
    parse_task,
    task_schema,
)


class TestSchema:
    def test_is_plain_json_schema(self):
        schema = task_schema()
        assert json.loads(json.dumps(schema, allow_nan=False)) == schema
        text = json.dumps(schema)
        for bogus in ('"gt"', '"ge"', '"lt"', '"le"', ": null", "<one>"):
            assert bogus not in text

    def test_has_the_fields_of_the_format(self):
        schema = task_schema()
        fields = (
            "synth name length_unit robot base floor topology objective "
            "targets surface path obstacles current"
        )
        assert set(schema["properties"]) == set(fields.split())
        assert set(schema["required"]) == {"synth", "length_unit", "robot"}
        assert schema["anyOf"] == [{"required": [key]} for key in ("targets", "surface", "path")]
        assert schema["additionalProperties"] is False


def reads_or_refuses(read, *args):
    try:
        read(*args)
    except InputError as error:
        str(error).encode()  # what it says can be printed


PIECES = [
    *":,[]{}#&*!|>'\"%@`?-~.<\\\n\t \r\0\x07\x85\u2028\ufeff",
    "<<",
    "---",
    "...",
    "!!",
    "null",
    "1e999",
    "- ",
    ": ",
]


@st.composite
def mutations(draw):
    content = draw(st.sampled_from([TASK, INLINE, ROBOT]))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(content)))
        end = min(len(content), start + draw(st.integers(0, 12)))
        inserted = draw(st.sampled_from(PIECES) | st.text(max_size=4) | st.just(content[start : end + 40]))
        content = content[:start] + inserted + content[end:]
    return content.encode(errors="surrogatepass")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz") / "fuzz.yaml"


class TestFuzz:
    @given(content=st.binary(max_size=200))
    @settings(max_examples=200, derandomize=True)
    def test_any_bytes(self, path, content):
        reads_or_refuses(load_task, write(path, content))

    @given(content=mutations())
    @settings(max_examples=400, derandomize=True)
    def test_any_mutation(self, path, content):
        reads_or_refuses(load_task, write(path, content))
        reads_or_refuses(load_robot, path)

    @given(
        value=st.recursive(
            st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
            lambda inner: st.lists(inner) | st.dictionaries(st.text() | st.integers(), inner),
            max_leaves=6,
        ),
        key=st.sampled_from(
            [
                "synth",
                "name",
                "length_unit",
                "robot",
                "base",
                "floor",
                "topology",
                "objective",
                "targets",
                "obstacles",
            ]
        ),
    )
    @settings(max_examples=300, derandomize=True)
    def test_any_value(self, value, key):
        mapping = {
            "synth": 1,
            "length_unit": "m",
            "robot": "malleable-2dof",
            "targets": [{"position": [1, 1, 1]}],
        }
        reads_or_refuses(parse_task, mapping | {key: value})

"""Text of files: YAML and JSON with the line of every entry, whatever they describe."""

from synth.files.document import Document, KeyPath, Refused, key_text
from synth.files.yaml_text import read_file, read_text

__all__ = ["Document", "KeyPath", "Refused", "key_text", "read_file", "read_text"]

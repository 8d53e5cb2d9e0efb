"""A solution from its file, `solution.json`: its models, and the way back to the value."""

from synth.solution_file.reading import load_solution, load_solved, solution_from_json
from synth.solution_file.schema import solution_schema

__all__ = ["load_solution", "load_solved", "solution_from_json", "solution_schema"]

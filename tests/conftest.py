"""One profile for hypothesis: the same examples in every run, so that a failure is a change of code."""

from hypothesis import settings

settings.register_profile("deterministic", derandomize=True, deadline=None, max_examples=100)
settings.load_profile("deterministic")

"""The nonlinear program that polishes a shape; CasADi is known here and nowhere else.

From the bottom up: `structure`, what the tasks of one program have in common; `blocks`, unknowns and
constraints with their bounds; `arm`, the robot in expressions; `ipopt`, the solver; `packing`, a shape as
the values of the unknowns; `program`, which puts them together and says what is solved.
"""

from synth.synthesis.nlp.planes import Separation, separations
from synth.synthesis.nlp.program import SynthesisNlp, shared_nlp
from synth.synthesis.nlp.structure import Structure

__all__ = ["Separation", "Structure", "SynthesisNlp", "separations", "shared_nlp"]

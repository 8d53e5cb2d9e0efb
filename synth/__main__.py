"""`python -m synth` and the `synth` command."""

from synth.cli import main

if __name__ == "__main__":
    main()

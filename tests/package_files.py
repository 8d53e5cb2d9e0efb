"""The files of the package, as paths from its folder."""

from pathlib import Path

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent / "synth"
FILES = sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py"))
MODULES = [file for file in FILES if not file.endswith("__init__.py")]
FOLDERS = sorted({str(Path(file).parent) for file in FILES} - {"."})

"""A set of files, written whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from synth.errors import SynthError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence


def write_all(
    files: Mapping[str, bytes], directory: str | os.PathLike[str], *, without: Iterable[str] = ()
) -> list[Path]:
    """Write files into a directory, all or none; a reader never meets half of one.

    Args:
        files: Contents by name.
        directory: Where to; it is made if it is not there.
        without: Names of files that must not be there any more.

    Returns:
        The paths of the files, in the order given.

    Raises:
        SynthError: They cannot be written. What stood there before stands there still.
    """
    directory = Path(directory)
    gone = [directory / name for name in without]
    # All are written beside their places, then moved there; the process id keeps two runs apart.
    beside = {directory / name: directory / f".{name}.{os.getpid()}.part" for name in files}
    try:
        directory.mkdir(parents=True, exist_ok=True)
        _see_that_files_can_be(beside)
        for path, temporary in beside.items():
            temporary.write_bytes(files[path.name])
        with _restored_if_it_fails([*beside, *gone]):
            for path, temporary in beside.items():
                temporary.replace(path)
            for path in gone:
                path.unlink(missing_ok=True)
    except OSError as error:
        raise _cannot_write(directory, error) from error
    finally:
        for temporary in beside.values():
            with contextlib.suppress(OSError):
                temporary.unlink()
    return list(beside)


@contextlib.contextmanager
def _restored_if_it_fails(paths: Sequence[Path]) -> Iterator[None]:
    """Put files back as they were, or away if they were not there, if a block fails."""
    before = {path: path.read_bytes() if path.exists() else None for path in paths}
    try:
        yield
    except BaseException:
        for path, content in before.items():
            with contextlib.suppress(OSError):
                if content is None:
                    path.unlink(missing_ok=True)
                else:
                    path.write_bytes(content)
        raise


def prepare_directory(directory: str | os.PathLike[str], names: Iterable[str] = ()) -> None:
    """Make a directory and see that files can be written there, before a search spends its time.

    Args:
        directory: The directory; it may be there.
        names: Names of the files that are to be written.

    Raises:
        SynthError: Files cannot be written there.
    """
    directory = Path(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
        _see_that_files_can_be(directory / name for name in names)
    except OSError as error:
        raise _cannot_write(directory, error) from error


def _see_that_files_can_be(paths: Iterable[Path]) -> None:
    """Raise an error if something that is no file stands in the place of one."""
    for path in paths:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, f"{path.name} is a directory, and a file is to be there")


def _cannot_write(directory: Path, error: OSError) -> SynthError:
    return SynthError(f"cannot write to {directory}: {error.strerror or error}")

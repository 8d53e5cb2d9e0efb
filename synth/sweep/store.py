"""Solutions kept in a file of SQLite, so that a sweep that was killed goes on where it was.

Rows are only ever added. One process writes, whatever solves; each solution is on the disk before the next
one is waited for.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, Self

from synth.errors import SynthError
from synth.export import plain, task_to_json
from synth.sweep.outcome import TaskOutcome
from synth.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from types import TracebackType

    from synth.task import Task

_TABLE = """CREATE TABLE IF NOT EXISTS solutions (
    key TEXT PRIMARY KEY, name TEXT NOT NULL, seed INTEGER NOT NULL, version TEXT NOT NULL,
    options TEXT NOT NULL, seconds REAL NOT NULL, solution TEXT NOT NULL)"""
_ADD = "INSERT OR IGNORE INTO solutions VALUES (?, ?, ?, ?, ?, ?, ?)"
_FIND = "SELECT name, solution, seconds FROM solutions WHERE key = ?"


def key_of(task: Task, seed: int, options: Mapping[str, object]) -> str:
    """Return what a solution is kept under: a hash of the task, the seed, how it is asked, and the version.

    Args:
        task: The task.
        seed: Seed of the search.
        options: What else of `solve` changes the answer.
    """
    asked = {"task": task_to_json(task), "seed": seed, "options": dict(options), "version": __version__}
    text = json.dumps(plain(asked), sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


class Store:
    """The solutions so far.

    Args:
        path: The file; it is made if it is not there.

    Raises:
        SynthError: It cannot be opened, or is no such file.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._path = path
        try:
            with ExitStack() as closed_if_it_fails:
                self._connection = closed_if_it_fails.enter_context(closing(sqlite3.connect(path)))
                with self._connection:
                    self._connection.execute(_TABLE)
                closed_if_it_fails.pop_all()
        except sqlite3.Error as error:
            raise self._cannot(error) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connection.close()

    def find(self, key: str) -> TaskOutcome | None:
        """Return what is kept under a key, or None."""
        try:
            row = self._connection.execute(_FIND, (key,)).fetchone()
        except sqlite3.Error as error:
            raise self._cannot(error) from error
        return None if row is None else TaskOutcome(row[0], row[1], "", row[2], stored=True)

    def add(self, key: str, outcome: TaskOutcome, seed: int, options: Mapping[str, object]) -> None:
        """Keep a solution; once this returns, it outlives the process."""
        told = json.dumps(plain(options), sort_keys=True)
        row = (key, outcome.name, seed, __version__, told, outcome.seconds, outcome.text)
        try:
            with self._connection:
                self._connection.execute(_ADD, row)
        except sqlite3.Error as error:
            raise self._cannot(error) from error

    def _cannot(self, error: sqlite3.Error) -> SynthError:
        return SynthError(f"cannot keep solutions in {self._path}: {error}")

# SPDX-License-Identifier: BSD-3-Clause
"""What the package raises."""
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .solution import Solution


class Error(Exception):
    """Of the library. `code` is the kacanov_code of the C interface, 0 where the failure is not of a call of it."""

    code: int = 0


class InputError(Error, ValueError):
    """Bad input: says which key, element, argument or file, and what was expected there."""


class StateError(Error, RuntimeError):
    """A call is missing that has to come first, or another thread is at work on the object."""


class InternalError(Error, RuntimeError):
    """A library beneath has failed, or the library has a defect."""


class RankError(Error, RuntimeError):
    """Another rank of a solve of several has raised something, so that this one cannot go on. `rank`: which one."""

    def __init__(self, message: str, rank: int) -> None:
        super().__init__(message)
        self.rank = rank


class Interrupted(KeyboardInterrupt):
    """Ctrl-C has ended a solve, on this rank or on another one. `solution` is the state after its last whole outer step; None where there is none yet."""

    def __init__(self, solution: Solution | None) -> None:
        super().__init__("interrupted" + ("" if solution is None else ": " + solution.message))
        self.solution = solution

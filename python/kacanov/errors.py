# SPDX-License-Identifier: BSD-3-Clause
"""Exceptions of the package."""
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .solution import Solution


class Error(Exception):
    """Base of the exceptions. `code` is the kacanov_code of the C interface, 0 if no call of it has failed."""

    code: int = 0


class InputError(Error, ValueError):
    """Bad input: the message names the key, element, argument or file, and the expected value."""


class StateError(Error, RuntimeError):
    """A required earlier call is missing, or another thread is using the object."""


class InternalError(Error, RuntimeError):
    """A library underneath has failed, or the library has a defect."""


class RankError(Error, RuntimeError):
    """Another rank of a joint solve has raised an exception, so this one cannot continue. `rank`: that rank."""

    def __init__(self, message: str, rank: int) -> None:
        super().__init__(message)
        self.rank = rank


class Interrupted(KeyboardInterrupt):
    """Ctrl-C has ended a solve, on any rank. `solution`: state after the last complete outer step, or None."""

    def __init__(self, solution: Solution | None) -> None:
        super().__init__("interrupted" + ("" if solution is None else ": " + solution.message))
        self.solution = solution

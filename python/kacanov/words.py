# SPDX-License-Identifier: BSD-3-Clause
"""Laws, obstacles and selections: small objects that convert to entries of the case file."""
from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InputError

Array = npt.NDArray[Any]
# (x, element, point) → (g, slope, energy), see OwnLaw
Evaluate = Callable[[Array, Array, Array], tuple[Array, Array | None, Array | None]]


def plain(value: Any, path: str = "") -> Any:
    """Converts a value to JSON types: arrays to lists, numpy numbers to numbers, words to their entries.

    Raises InputError with the path of a value that JSON cannot represent.
    """
    if isinstance(value, Word):
        return plain(value.json(), path)
    if isinstance(value, Mapping):
        return {str(key): plain(entry, f"{path}.{key}" if path else str(key)) for key, entry in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist(), path)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, list | tuple):
        return [plain(entry, f"{path}[{i}]") for i, entry in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(f"{path}: expected a finite number, got {value}")
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise InputError(f"{path}: expected what a case file can say, got {type(value).__name__}")


class Word:
    """An object that converts to an entry of the case file."""

    def json(self) -> Any:
        raise NotImplementedError


def _given(word: Any) -> dict[str, Any]:
    """Returns the fields that are not None."""
    return {f.name: getattr(word, f.name) for f in fields(word) if getattr(word, f.name) is not None}


class Law(Word):
    """`law` of a material: the behaviour beyond yield. `yield_stress` can replace `x0`."""

    type: str

    def json(self) -> dict[str, Any]:
        return {"type": self.type, **_given(self)}


@dataclass(frozen=True)
class Linear(Law):
    type = "linear"


@dataclass(frozen=True)
class Logarithmic(Law):
    type = "logarithmic"
    x0: float | None = None
    yield_stress: float | None = None
    argument: str | None = None


@dataclass(frozen=True)
class LinearHardening(Law):
    type = "linear_hardening"
    x0: float | None = None
    gamma: float | None = None
    yield_stress: float | None = None
    argument: str | None = None


@dataclass(frozen=True)
class Power(Law):
    type = "power"
    x0: float | None = None
    n: float | None = None
    yield_stress: float | None = None
    argument: str | None = None


@dataclass(frozen=True)
class Saturating(Law):
    type = "saturating"
    x0: float | None = None
    q: float | None = None
    yield_stress: float | None = None
    argument: str | None = None


@dataclass(frozen=True)
class Table(Law):
    type = "table"
    points: Sequence[Sequence[float]] = ()
    argument: str | None = None


@dataclass(frozen=True)
class RambergOsgood(Law):
    type = "ramberg_osgood"
    sigma0: float | None = None
    alpha: float | None = None
    n: float | None = None


@dataclass(frozen=True)
class OwnLaw:
    """A user-defined law, for operators only: the case file has no entry for it.

    evaluate(x, element, point) gets a few thousand points at once, as arrays of equal length: x = |dev eps| (float64),
    and for each the element and its quadrature point (int32, from 0). It returns (g, slope, energy): the secant shear
    modulus g > 0, dg/dx, and the integral of g(s) s ds from 0 to x. slope may be None if no tangent is needed, energy
    if no energy is needed.
    yield_strain: the x above which `stress` reports plastic; 0: never.
    """

    evaluate: Evaluate
    yield_strain: float = 0.0


@dataclass(frozen=True)
class Material(Word):
    """An elastic material that can yield: by a `law`, a tensile test (`plastic`), or bilinear (`tangent_modulus`)."""

    young: float
    poisson: float
    law: Law | OwnLaw | Evaluate | Mapping[str, Any] | None = None  # the second and third for operators only
    plastic: Sequence[Sequence[float]] | None = None
    yield_stress: float | None = None
    tangent_modulus: float | None = None
    bbar: bool | None = None

    def json(self) -> dict[str, Any]:
        return _given(self)


@dataclass(frozen=True)
class Box(Word):
    """Selects the facets or elements that lie in the closed box."""

    lower: Sequence[float]
    upper: Sequence[float]

    def json(self) -> dict[str, Any]:
        return {"box": [self.lower, self.upper]}


class Obstacle(Word):
    """`obstacle` of a contact entry."""

    key: str

    def json(self) -> dict[str, Any]:
        return {self.key: _given(self)}


@dataclass(frozen=True)
class Plane(Obstacle):
    key = "plane"
    point: Sequence[float]
    normal: Sequence[float]


@dataclass(frozen=True)
class Sphere(Obstacle):
    key = "sphere"
    centre: Sequence[float]
    radius: float
    direction: Sequence[float] | None = None
    inside: bool | None = None


@dataclass(frozen=True)
class Cylinder(Obstacle):
    key = "cylinder"
    point: Sequence[float]
    axis: Sequence[float]
    radius: float
    direction: Sequence[float] | None = None
    inside: bool | None = None


@dataclass(frozen=True)
class Cone(Obstacle):
    key = "cone"
    apex: Sequence[float]
    axis: Sequence[float]
    half_angle: float
    direction: Sequence[float] | None = None


@dataclass(frozen=True)
class Torus(Obstacle):
    key = "torus"
    centre: Sequence[float]
    axis: Sequence[float]
    radius: float
    tube: float


@dataclass(frozen=True)
class Block(Obstacle):
    """The obstacle `box` of the case file."""

    key = "box"
    lower: Sequence[float]
    upper: Sequence[float]
    frame: Sequence[Sequence[float]] | None = None


@dataclass(frozen=True)
class Surface(Obstacle):
    key = "surface"
    file: str | os.PathLike[str]
    group: str | None = None


@dataclass(frozen=True)
class HeightMap(Obstacle):
    key = "height_map"
    file: str | os.PathLike[str]
    lower: Sequence[float]
    upper: Sequence[float]
    scale: float | None = None
    offset: float | None = None
    body: str | None = None


@dataclass(frozen=True)
class Gap(Obstacle):
    """A constant gap along the body's outward normal."""

    gap: float

    def json(self) -> dict[str, Any]:
        return {"gap": self.gap}

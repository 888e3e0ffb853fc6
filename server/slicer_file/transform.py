"""Rigid transforms in ITK's text format (`.tfm`), as 3D Slicer, SimpleITK, ANTs and Plus write it.

A file maps points of the fixed frame to the moving frame, in LPS mm: the direction in which ITK resamples an
image. A registration of this program maps in the opposite direction, so that both functions invert. In
Slicer, data of the moving frame under the loaded transform are displayed in the fixed frame.
"""

import re
from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Anchor, Array, Rigid, Vertebra, rotation_from_vector

SUFFIX = ".tfm"
# Not supported: a library for HDF5 would be needed for these files alone.
HDF5_SUFFIXES, HDF5_SIGNATURE = (".h5", ".hdf5"), b"\x89HDF\r\n\x1a\n"
HEADER = "#Insight Transform File V1.0"
MAX_BYTES = 2**16
MAX_TRANSLATION_MM = 100_000.0
REMEDY = (
    "Save one linear transform without scale as text (.tfm), not a composite, a deformation or HDF5 (.h5)."
)
LINE = re.compile(r"^(Transform|Parameters|FixedParameters)\s*:(.*)$")
# With and without the names of number type and dimensions: "AffineTransform_double_3_3".
NAME = re.compile(r"^([A-Za-z0-9]+?)(?:_(?:double|float)_3_3)?$")

Rotation: TypeAlias = Callable[[Array, Array], Array]


def is_itk_name(name: str) -> bool:
    """Return whether a file of this name contains a transform of ITK: text, or HDF5, which is rejected."""
    return name.lower().endswith((SUFFIX, *HDF5_SUFFIXES))


def itk_text(fixed_from_moving: Rigid[Vertebra, Anchor]) -> str:
    """Return the content of a file with this registration, which ITK states as moving from fixed."""
    moving_from_fixed = fixed_from_moving.inverse
    numbers = [*moving_from_fixed.rotation.ravel(), *moving_from_fixed.translation_mm]
    return (
        f"{HEADER}\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
        f"Parameters: {' '.join(repr(float(number)) for number in numbers)}\n"
        "FixedParameters: 0 0 0\n"
    )


def fixed_from_moving_in_itk(content: bytes, *, name: str) -> Rigid[Vertebra, Anchor]:
    """Parse a file with one rigid transform, and return the registration that it states.

    Args:
        content: Bytes of the file.
        name: Name of the file, for messages.

    Raises:
        InvalidInput: TRANSFORM_UNREADABLE, the file contains no transform, several, or one of another class;
            TRANSFORM_INVALID, its numbers are not a rigid transform.
    """
    fields = _fields(content, name)
    match = NAME.match(fields["Transform"].strip())
    kind = match[1] if match else fields["Transform"].strip()
    if kind not in CLASSES:
        known = ", ".join(CLASSES)
        raise _unreadable(name, f"it contains a {kind[:40]}, supported are {known} in three dimensions")
    count, rotation_of = CLASSES[kind]
    parameters = _numbers(fields["Parameters"], "Parameters", name)
    fixed = _numbers(fields["FixedParameters"], "FixedParameters", name)
    if len(parameters) != count or len(fixed) not in {3, 4}:
        raise _invalid(
            name,
            f"its {kind} has {len(parameters)} parameters and {len(fixed)} fixed parameters, expected "
            f"{count} and 3",
        )
    rotation = rotation_of(parameters[:-3], fixed[3:])
    # The rotation is about a centre; the translation is added afterwards.
    centre = fixed[:3]
    translation = parameters[-3:] + centre - rotation @ centre
    if not np.abs(translation).max() <= MAX_TRANSLATION_MM:
        raise _invalid(name, f"its translation exceeds {MAX_TRANSLATION_MM:g} mm")
    try:
        moving_from_fixed: Rigid[Anchor, Vertebra] = Rigid(rotation=rotation, translation_mm=translation)
    except InvalidInput as error:
        raise _invalid(name, error.message) from error
    return moving_from_fixed.inverse


def _fields(content: bytes, name: str) -> Mapping[str, str]:
    if content.startswith(HDF5_SIGNATURE):
        raise _unreadable(name, "it is an HDF5 file (.h5)")
    try:
        text = content.decode("utf-8-sig") if len(content) <= MAX_BYTES else ""
    except UnicodeDecodeError:
        text = ""
    lines = text.splitlines()
    if not lines or lines[0].strip() != HEADER:
        raise _unreadable(name, f"its first line is not '{HEADER}'")
    if not text.endswith(("\n", "\r")):
        # A truncated last number would still be a number.
        raise _unreadable(name, "its last line has no line end, as in a truncated file")
    found = [(match[1], match[2]) for line in lines if (match := LINE.match(line))]
    names = [key for key, _ in found]
    if names.count("Transform") != 1:
        raise _unreadable(name, f"it contains {names.count('Transform')} transforms, expected 1")
    if sorted(names) != ["FixedParameters", "Parameters", "Transform"]:
        raise _unreadable(name, "it does not contain each of Transform, Parameters and FixedParameters once")
    return dict(found)


def _numbers(text: str, which: str, name: str) -> Array:
    try:
        numbers = np.array([float(word) for word in text.split()], dtype=np.float64)
    except ValueError:
        numbers = np.array([np.nan])
    if not np.isfinite(numbers).all():
        raise _invalid(name, f"its {which} are not finite numbers")
    return numbers


def _of_matrix(parameters: Array, _fixed: Array) -> Array:
    return parameters.reshape(3, 3)


def _of_angles(parameters: Array, fixed: Array) -> Array:
    """Return the rotation of Euler angles Z X Y, or Z Y X if the fourth fixed parameter is set."""
    x, y, z = (rotation_from_vector(angle * axis) for angle, axis in zip(parameters, np.eye(3), strict=True))
    return z @ y @ x if fixed.size and fixed[0] != 0.0 else z @ x @ y


def _of_versor(parameters: Array, _fixed: Array) -> Array:
    """Return the rotation of the vector part of a unit quaternion with a non-negative scalar part."""
    sine = float(np.linalg.norm(parameters))
    # A length above 1 gives a matrix of NaN, which `Rigid` rejects.
    angle = 2.0 * np.arcsin(sine) if sine <= 1.0 else np.nan
    return rotation_from_vector(parameters / sine * angle) if sine > 0.0 else np.eye(3)


CLASSES: Mapping[str, tuple[int, Rotation]] = {
    "AffineTransform": (12, _of_matrix),
    "MatrixOffsetTransformBase": (12, _of_matrix),
    "Euler3DTransform": (6, _of_angles),
    "VersorRigid3DTransform": (6, _of_versor),
}


def _unreadable(name: str, why: str) -> InvalidInput:
    return InvalidInput(
        "TRANSFORM_UNREADABLE",
        f"{name} is not a readable transform: {why}",
        REMEDY,
        {"file": name, "transform_problem": why},
    )


def _invalid(name: str, why: str) -> InvalidInput:
    return InvalidInput(
        "TRANSFORM_INVALID", f"{name} cannot be used: {why}", REMEDY, {"file": name, "transform_problem": why}
    )

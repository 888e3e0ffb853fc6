"""Structures and request numbers of V4L2, from linux/videodev2.h and the kernel's documentation."""

import ctypes
from typing import ClassVar, TypeAlias

from tracker.camera import CameraControl

U32 = ctypes.c_uint32
S32 = ctypes.c_int32
Field: TypeAlias = tuple[str, type]

VIDEO_CAPTURE = 1  # buffer type of cameras
CAN_CAPTURE = 0x0000_0001
HAS_DEVICE_CAPS = 0x8000_0000
DISCRETE = 1  # sizes or intervals are listed individually, not as a range
FLAG_DISABLED = 0x0001
FLAG_INACTIVE = 0x0010

EXPOSURE_MANUAL = 1  # menu value of automatic exposure; cameras use 0 or 3 for on

_USER, _CAMERA = 0x0098_0900, 0x009A_0900
CONTROL_IDS: dict[CameraControl, int] = {
    CameraControl.FOCUS: _CAMERA + 10,
    CameraControl.AUTOFOCUS: _CAMERA + 12,
    CameraControl.ZOOM: _CAMERA + 13,
    CameraControl.PAN: _CAMERA + 8,
    CameraControl.TILT: _CAMERA + 9,
    CameraControl.AUTO_EXPOSURE: _CAMERA + 1,
    CameraControl.EXPOSURE: _CAMERA + 2,
    CameraControl.GAIN: _USER + 19,
    CameraControl.AUTO_WHITE_BALANCE: _USER + 12,
    CameraControl.WHITE_BALANCE: _USER + 26,
}


class Capability(ctypes.Structure):
    """Capabilities of a device: struct v4l2_capability."""

    _fields_: ClassVar[list[Field]] = [
        ("driver", ctypes.c_char * 16),
        ("card", ctypes.c_char * 32),
        ("bus_info", ctypes.c_char * 32),
        ("version", U32),
        ("capabilities", U32),
        ("device_caps", U32),
        ("reserved", U32 * 3),
    ]


class FormatDescription(ctypes.Structure):
    """One pixel format: struct v4l2_fmtdesc."""

    _fields_: ClassVar[list[Field]] = [
        ("index", U32),
        ("type", U32),
        ("flags", U32),
        ("description", ctypes.c_char * 32),
        ("pixelformat", U32),
        ("mbus_code", U32),
        ("reserved", U32 * 3),
    ]


class FrameSize(ctypes.Structure):
    """One size, or a range of sizes: struct v4l2_frmsizeenum.

    `values` is width, height, or minimum and maximum width, its step, and likewise for the height.
    """

    _fields_: ClassVar[list[Field]] = [
        ("index", U32),
        ("pixel_format", U32),
        ("type", U32),
        ("values", U32 * 6),
        ("reserved", U32 * 2),
    ]


class FrameInterval(ctypes.Structure):
    """One frame interval, or a range: struct v4l2_frmivalenum.

    `values` is numerator, denominator in seconds; for a range those of the shortest, the longest and the
    step.
    """

    _fields_: ClassVar[list[Field]] = [
        ("index", U32),
        ("pixel_format", U32),
        ("width", U32),
        ("height", U32),
        ("type", U32),
        ("values", U32 * 6),
        ("reserved", U32 * 2),
    ]


class Format(ctypes.Structure):
    """The present format: struct v4l2_format, whose union is aligned to eight bytes."""

    _fields_: ClassVar[list[Field]] = [
        ("type", U32),
        ("padding", U32 * (ctypes.alignment(ctypes.c_void_p) // 4 - 1)),
        ("width", U32),
        ("height", U32),
        ("pixelformat", U32),
        ("rest", ctypes.c_uint8 * 188),
    ]


class StreamParameters(ctypes.Structure):
    """The present frame interval: struct v4l2_streamparm."""

    _fields_: ClassVar[list[Field]] = [
        ("type", U32),
        ("capability", U32),
        ("capturemode", U32),
        ("numerator", U32),
        ("denominator", U32),
        ("rest", ctypes.c_uint8 * 184),
    ]


class QueryControl(ctypes.Structure):
    """Description of a control: struct v4l2_queryctrl."""

    _fields_: ClassVar[list[Field]] = [
        ("id", U32),
        ("type", U32),
        ("name", ctypes.c_uint8 * 32),
        ("minimum", S32),
        ("maximum", S32),
        ("step", S32),
        ("default_value", S32),
        ("flags", U32),
        ("reserved", U32 * 2),
    ]


class Control(ctypes.Structure):
    """A control's value: struct v4l2_control."""

    _fields_: ClassVar[list[Field]] = [("id", U32), ("value", S32)]


def _request(reads: bool, writes: bool, number: int, record: type[ctypes.Structure]) -> int:
    """Return the number of an ioctl as in asm-generic/ioctl.h: direction, size, letter V, number."""
    direction = (2 if reads else 0) | (1 if writes else 0)
    return direction << 30 | ctypes.sizeof(record) << 16 | ord("V") << 8 | number


QUERYCAP = _request(True, False, 0, Capability)
ENUM_FMT = _request(True, True, 2, FormatDescription)
G_FMT = _request(True, True, 4, Format)
G_PARM = _request(True, True, 21, StreamParameters)
G_CTRL = _request(True, True, 27, Control)
S_CTRL = _request(True, True, 28, Control)
QUERYCTRL = _request(True, True, 36, QueryControl)
ENUM_FRAMESIZES = _request(True, True, 74, FrameSize)
ENUM_FRAMEINTERVALS = _request(True, True, 75, FrameInterval)


def fourcc_text(code: int) -> str:
    """Return the four characters of a pixel format, without trailing blanks: "MJPG"."""
    return code.to_bytes(4, "little").decode("latin-1").rstrip(" \0")


def fourcc_code(text: str) -> int:
    """Return the code of a pixel format's characters."""
    return int.from_bytes(text.ljust(4).encode("latin-1")[:4], "little")

"""Buffer for the voxels of a CT: in memory, or a memory-mapped file that is written atomically."""

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from server.disk import reject_without_space, reserve_space, sync_path
from tracker.errors import InvalidInput

MAX_VOXELS = 2**30
# Value of padding voxels: air.
PADDING_HU = -1024
MIN_HU, MAX_HU = -32768, 32767


@dataclass(slots=True, kw_only=True)
class Voxels:
    """An array (slices, rows, columns) int16 that is being filled; read-only once it is complete."""

    hu: npt.NDArray[np.int16]


def check_voxels(shape: tuple[int, int, int]) -> None:
    """Reject a volume that is too large, before memory is allocated.

    Raises:
        InvalidInput: CT_TOO_LARGE.
    """
    voxels = shape[0] * shape[1] * shape[2]
    if voxels > MAX_VOXELS:
        raise InvalidInput(
            "CT_TOO_LARGE",
            f"the CT has {shape[2]} x {shape[1]} x {shape[0]} voxels, {voxels / 1e6:.0f} million, the "
            f"maximum is {MAX_VOXELS / 1e6:.0f} million",
            "Export only the part around the vertebrae, or a series with fewer pixels.",
            {
                "voxels": voxels,
                "max_voxels": MAX_VOXELS,
                "columns": int(shape[2]),
                "rows": int(shape[1]),
                "slices": int(shape[0]),
                "million": voxels / 1e6,
                "max_million": MAX_VOXELS / 1e6,
            },
        )


@contextmanager
def voxels_to_fill(shape: tuple[int, int, int], into: Path | None) -> Iterator[Voxels]:
    """Context manager for an array to fill; after the block it is complete, and mapped from `into` if given.

    Args:
        shape: slices, rows, columns.
        into: A `.npy` file that gets its name when every voxel is on the disk.

    Raises:
        InvalidInput: CT_TOO_LARGE.
        DiskFull: STORE_FULL.
    """
    check_voxels(shape)
    if into is None:
        voxels = Voxels(hu=np.empty(shape, dtype=np.int16))
        yield voxels
        voxels.hu.setflags(write=False)
        return
    partial = into.with_name(f".{into.name}.{uuid.uuid4().hex}.partial")
    reject_without_space(into.parent, shape[0] * shape[1] * shape[2] * np.dtype(np.int16).itemsize)
    try:
        mapped = np.lib.format.open_memmap(partial, mode="w+", dtype=np.int16, shape=shape)
        reserve_space(partial)
        voxels = Voxels(hu=mapped)
        yield voxels
        mapped.flush()
        sync_path(partial)
        partial.replace(into)
        sync_path(into.parent)
        voxels.hu = np.load(into, mmap_mode="r")
    finally:
        partial.unlink(missing_ok=True)

"""Small synthetic videos: image n is grey with level 10 n."""

from pathlib import Path

import cv2
import numpy as np

RATE_HZ = 25.0


def grey_image(level: int, size_wh_px: tuple[int, int] = (64, 48)) -> np.ndarray:
    return np.full((size_wh_px[1], size_wh_px[0], 3), level, dtype=np.uint8)


def write_video(
    path: Path, *, images: int = 8, size_wh_px: tuple[int, int] = (64, 48), codec: str = "MJPG"
) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*codec), RATE_HZ, size_wh_px)
    for number in range(images):
        writer.write(grey_image(10 * number, size_wh_px))
    writer.release()
    return path


def cut_video(path: Path, *, images: int = 20, content_ratio: float = 0.6) -> Path:
    whole = write_video(path, images=images)
    content = whole.read_bytes()
    path.write_bytes(content[: int(len(content) * content_ratio)])
    return path


def write_images(folder: Path, levels: dict[str, int]) -> Path:
    folder.mkdir(exist_ok=True)
    for name, level in levels.items():
        cv2.imwrite(str(folder / name), grey_image(level))
    return folder

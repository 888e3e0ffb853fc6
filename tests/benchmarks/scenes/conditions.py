"""Image degradations, single and mixed, in steps."""

from dataclasses import dataclass

from tests.benchmarks.scenes.rigs import Rig


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """Parameters of the image formation.

    Attributes:
        name: of the condition.
        blur_px: standard deviation of the lens's Gaussian blur; 0.6 is in focus.
        motion_px: how far the marker moves while the shutter is open.
        read_noise_grey: standard deviation, grey levels.
        full_well_electrons: of a pixel at grey 255; decides the shot noise.
        illumination_ratio: of the light, 1 lets white paper be about 215.
        gradient_ratio: change of the light from the middle of the image to its corner.
        shadow_ratio: how much light the edge of a shadow across the marker takes away.
        glare_ratio: height of a bright blob on the marker, 1 is full scale.
        occlusion_ratio: share of the black square that a finger covers.
        jpeg_quality: 0 for none.
        gamma: of the camera's answer to light; 1 is straight.
        has_bent_lens: whether the lens bends straight lines.
        tilt_deg: least and most, of the marker from the line of sight.
    """

    name: str = "base"
    blur_px: float = 0.6
    motion_px: float = 0.0
    read_noise_grey: float = 1.2
    full_well_electrons: float = 12_000.0
    illumination_ratio: float = 1.0
    gradient_ratio: float = 0.2
    shadow_ratio: float = 0.0
    glare_ratio: float = 0.0
    occlusion_ratio: float = 0.0
    jpeg_quality: int = 0
    gamma: float = 1.0
    has_bent_lens: bool = False
    tilt_deg: tuple[float, float] = (0.0, 60.0)


BASE = Condition()


def conditions_of(rig: Rig) -> dict[str, Condition]:
    """Return all conditions by name, in ascending difficulty; blur and motion scale with the marker."""
    small = rig.is_small
    steps = [
        BASE,
        *(Condition(name=f"tilt{low}-{low + 15}", tilt_deg=(low, low + 15)) for low in (0, 15, 30, 45)),
        *(Condition(name=f"noise{grey}", read_noise_grey=grey) for grey in (4, 8, 16)),
        *(Condition(name=f"defocus{px:g}", blur_px=px) for px in ((1, 1.5, 2) if small else (1.5, 3, 5))),
        *(Condition(name=f"motion{px}", motion_px=px) for px in ((2, 4, 8) if small else (4, 10, 20))),
        *(Condition(name=f"dark{ratio:g}", illumination_ratio=ratio) for ratio in (0.4, 0.15, 0.06)),
        *(Condition(name=f"shadow{ratio:g}", shadow_ratio=ratio) for ratio in (0.5, 0.8)),
        *(Condition(name=f"glare{ratio:g}", glare_ratio=ratio) for ratio in (0.4, 0.8, 1.6)),
        *(
            Condition(name=f"cover{percent:02d}", occlusion_ratio=percent / 100)
            for percent in (5, 10, 20, 30)
        ),
        *(Condition(name=f"jpeg{quality}", jpeg_quality=quality) for quality in (70, 40, 20)),
        Condition(name="gamma2.2", gamma=2.2),
        Condition(name="lens", has_bent_lens=True),
        Condition(
            name="hard1",
            blur_px=1.0 if small else 1.5,
            motion_px=2.0 if small else 5.0,
            read_noise_grey=4.0,
            illumination_ratio=0.5,
            shadow_ratio=0.4,
            glare_ratio=0.3,
            jpeg_quality=70,
        ),
        Condition(
            name="hard2",
            blur_px=1.2 if small else 2.0,
            motion_px=3.0 if small else 8.0,
            read_noise_grey=6.0,
            illumination_ratio=0.4,
            shadow_ratio=0.6,
            glare_ratio=0.5,
            occlusion_ratio=0.1,
            jpeg_quality=50,
        ),
    ]
    return {one.name: one for one in steps}

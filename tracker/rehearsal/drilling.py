"""Hand motions for good drilling and for a breach towards the canal."""

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.rehearsal.motion import WANDERING, Hand, Phase, Script
from tracker.rehearsal.settings import Skill

# time s | depth mm of the tip; the tip stays on the channel's axis, in the picture, from end to end.
GOOD_DEPTHS = (
    (0.0, -34.0), (3.0, -26.0), (6.0, -6.0), (8.0, -0.6), (11.5, -0.2), (15.0, 9.0), (20.0, 20.0),
    (25.0, 28.0), (29.0, 28.5), (32.0, 12.0), (34.0, -2.0), (37.0, -24.0),
)  # fmt: skip
GOOD_PHASES = (
    (0.0, Phase.APPROACH),
    (7.0, Phase.ALIGN),
    (11.5, Phase.DRILL),
    (29.5, Phase.WITHDRAW),
    (34.5, Phase.RETURN),
)
# time s | depth mm | mm towards the canal: leaves the axis at 16 s, is deepest in the wall at 23 s.
BREACH = (
    (0.0, -34.0, 0.0), (3.0, -26.0, 0.0), (6.0, -6.0, 0.0), (8.0, -0.6, 0.0), (11.5, -0.2, 0.0),
    (14.0, 8.0, 0.0), (16.0, 13.0, 0.2), (20.0, 20.0, 3.2), (23.0, 24.0, 6.2), (25.0, 24.5, 6.4),
    (28.0, 12.0, 2.5), (30.0, -2.0, 0.0), (34.0, -26.0, 0.0), (37.0, -30.0, 0.0),
)  # fmt: skip
BREACH_PHASES = (
    (0.0, Phase.APPROACH),
    (7.0, Phase.ALIGN),
    (11.5, Phase.DRILL),
    (16.0, Phase.DRIFT),
    (25.5, Phase.WITHDRAW),
    (31.0, Phase.RETURN),
)
STEADY_SWAY, STEADY_SHAKE = 0.6, 0.7


def drilling_hand(skill: Skill, *, seed: int, rest: Rigid[Vertebra, Tool]) -> Hand:
    """Return the operation's hand for a skill."""
    match skill:
        case Skill.GOOD:
            return Hand(seed, _steady(_along_the_axis(), GOOD_PHASES))
        case Skill.BREACHING:
            return Hand(seed, _steady(_to_the_canal(rest), BREACH_PHASES))
        case Skill.WANDERING:
            return Hand(seed, WANDERING)


def _steady(keyframes: Array, phases: tuple[tuple[float, Phase], ...]) -> Script:
    return Script(
        keyframes=keyframes,
        phases=phases,
        sway_ratio=STEADY_SWAY,
        shake_ratio=STEADY_SHAKE,
        variety_ratio=0.0,
    )


def _along_the_axis() -> Array:
    times_s, depths_mm = np.array(GOOD_DEPTHS).T
    out = np.zeros((len(times_s), 7))
    out[:, 0], out[:, 3] = times_s, depths_mm
    return out


def _to_the_canal(rest: Rigid[Vertebra, Tool]) -> Array:
    """Return keyframes in which the tip leaves the axis medially, with the shaft through the entry point."""
    times_s, depths_mm, aside_mm = np.array(BREACH).T
    entry = rest.translation_mm
    medial = rest.rotation.T @ np.array([-np.sign(entry[0]), 0.0, 0.0])
    medial = medial[:2] / np.linalg.norm(medial[:2])
    lean_deg = np.degrees(np.arctan2(aside_mm, np.maximum(depths_mm, 1.0)))
    out = np.zeros((len(times_s), 7))
    out[:, 0], out[:, 3] = times_s, depths_mm
    out[:, 1:3] = aside_mm[:, None] * medial
    # Turned about z x medial, so that +z leans to the midline.
    out[:, 4:6] = lean_deg[:, None] * np.array([-medial[1], medial[0]])
    return out

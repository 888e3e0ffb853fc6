"""The coordinate frames.

| frame     | origin                         | axes                                           | unit |
|-----------|--------------------------------|------------------------------------------------|------|
| Camera    | projection centre              | x right, y down, z forward (OpenCV)            | mm   |
| Marker    | centre of the black square     | x right, y up on the printed face, z out of it | mm   |
| Tool      | tip of the burr                | +z the drilling direction                      | mm   |
| Vertebra  | the CT's patient coordinates   | LPS                                            | mm   |
| Reference | marker fixed to the patient    | as Marker                                      | mm   |
| Anchor    | what a registration is fixed   | of Camera or of Reference                      | mm   |
|           | to: camera, or reference       |                                                |      |
| Pattern   | first point of a camera's      | x right, y down on the printed face, z into it | mm   |
|           | calibration board              |                                                |      |

Pixels (u, v) count from the centre of the top-left pixel, which is (0, 0). The classes below are never
instantiated: they are the type arguments of `Rigid[To, From]`, so that a swapped product fails in the type
checker.
"""


class Camera:
    """The camera's frame."""


class Marker:
    """The frame of one printed marker."""


class Tool:
    """The frame of the tool, with its origin at the tip."""


class Vertebra:
    """The frame of the plan: CT patient coordinates, LPS."""


class Reference:
    """The frame of the marker fixed to the patient."""


class Anchor:
    """The frame of a registration: the camera's, or the reference's if there is one."""


class Pattern:
    """The frame of a calibration board."""

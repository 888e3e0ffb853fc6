"""The step in which plan and patient are registered by points: the tip on landmarks of the plan."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from server.config import RegistrationConfig
from server.live import LiveHub
from server.procedure.held import Held
from server.procedure.registered import Value
from server.procedure.registration.gates import capture_settings
from server.procedure.registration.ground import Ground, GroundFinder
from server.procedure.registration.repository import RegistrationRepository
from server.procedure.registration.session import PointsSession, PointsStatus, residuals_mm
from server.store import Document
from tracker.errors import RegistrationError
from tracker.registration.needles import TouchedPoint
from tracker.registration.points import PointGate, PointRegistration

# How well a landmark is marked on the CT and found on bone, along each axis.
LANDMARK_SD_MM = 0.7
# From the entry point to the end of a channel.
ALONG = (0.0, 0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetError:
    """The error to expect at one point of a channel.

    Attributes:
        side: of the patient.
        depth_mm: from the entry point along the channel; 0 is the entry point itself.
        expected_mm: 3-D RMS by Fitzpatrick's formula, from the residuals alone.
        stated_mm: 3-D RMS as stated and as gated, wider for few points and for what a tip's depth errs.
    """

    side: str
    depth_mm: float
    expected_mm: float
    stated_mm: float


class PointsStep:
    """Registers by points; one session at a time. Safe to use from any thread.

    Args:
        hub: the live images.
        grounds: what a registration is made on.
        shelf: where it is kept.
        gate: what it must reach.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        grounds: GroundFinder,
        repository: RegistrationRepository,
        gate: RegistrationConfig,
    ) -> None:
        self._hub = hub
        self._grounds = grounds
        self._repository = repository
        self.gate = gate
        self._captures = capture_settings(gate)
        self._held: Held[PointsSession] = Held(
            "landmarks are",
            remedy="Begin with the points, and say with which tool.",
        )

    def begin(self, *, tool: str, vertebra: str | None = None) -> PointsSession:
        """Begin to touch a vertebra's landmarks with this tool; what was touched before is thrown away.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or what it waits for.
            PlanError: VERTEBRA_UNKNOWN.
            InvalidInput: TOOL_UNKNOWN.
            RegistrationError: LANDMARKS_TOO_FEW.
        """
        ground = self._grounds.find(vertebra=vertebra, tool=tool)
        there, needed = len(ground.vertebra.landmarks), self.gate.min_points
        if there < needed:
            raise RegistrationError(
                "LANDMARKS_TOO_FEW",
                f"the plan has {there} landmarks on {ground.vertebra.name}, needed {needed}",
                "Mark landmarks on the CT, in the plan; one more serves as the check.",
                {"landmarks": there, "needed": needed},
            )
        return self._held.begin(lambda: PointsSession(self._hub, ground, self._captures))

    @property
    def session(self) -> PointsSession:
        """What was touched so far.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        return self._held.get()

    @property
    def running(self) -> bool:
        """Whether landmarks are being touched."""
        return self._held.is_there

    def end(self) -> None:
        """Look no more, and throw away what was touched."""
        self._held.end()

    def failures(self, status: PointsStatus) -> tuple[RegistrationError, ...]:
        """What keeps these points from being used; nothing where they pass their gate."""
        if len(status.used) < self.gate.min_points:
            return (
                RegistrationError(
                    "POINTS_TOO_FEW",
                    f"{len(status.used)} landmarks are touched and used, needed {self.gate.min_points}",
                    "Touch another landmark, or use one that was left out.",
                    {"points": len(status.used), "needed": self.gate.min_points},
                ),
            )
        if status.fit is None:
            problem = status.problem
            if problem is None:
                raise RuntimeError("neither a fit nor a trouble")
            return (RegistrationError(problem.code, problem.message, problem.remedy, problem.context),)
        gate = PointGate(max_fre_mm=self.gate.max_fre_mm, max_tre_mm=self.gate.max_tre_mm)
        return (
            *status.fit.failures(gate, list(status.ground.entries_mm)),
            *strays(status.fit, max_mm=self.gate.max_left_out_mm),
        )

    def conclude(self, *, made_by: str) -> Document:
        """Keep the registration in the open case, if it passes its gate; the session ends.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING, or what it waits for.
            OutOfDateError: REGISTRATION_GROUND_CHANGED.
            RegistrationError: what the points lack, or the gate that is not passed.
        """
        session = self.session
        self._grounds.reject_changed(session.ground)
        status = session.status
        failures = self.failures(status)
        if failures or status.fit is None:
            raise failures[0]
        document = self._repository.put(
            session.ground,
            status.fit.registration(session.ground.anchored_to),
            numbers=self.numbers(status, status.fit),
            made_from=made_from(status),
            made_by=made_by,
            from_s=status.from_s,
        )
        self.end()
        return document

    def numbers(self, status: PointsStatus, fit: PointRegistration) -> dict[str, Value]:
        """The numbers of the gate."""
        entries = [error for error in target_errors(status.ground, fit) if error.depth_mm == 0.0]
        return {
            "points": int(fit.used.sum()),
            "fre_rms_mm": fit.fre_rms_mm,
            "max_fre_mm": self.gate.max_fre_mm,
            "left_out_mm": max(fit.left_out_mm.values(), default=None),
            "max_left_out_mm": self.gate.max_left_out_mm,
            "tre_at_entry_mm": max((error.stated_mm for error in entries), default=None),
            "max_tre_mm": self.gate.max_tre_mm,
        }


def touched_points(step: PointsStep) -> tuple[TouchedPoint, ...]:
    """What was touched so far before the camera, as it tells the depth of needles.

    Raises:
        SetupOrderError: COLLECTION_MISSING.
        RegistrationError: TOUCHED_BESIDE_REFERENCE, the points are not in the camera's frame.
    """
    status = step.session.status
    if status.ground.reference:
        raise RegistrationError(
            "TOUCHED_BESIDE_REFERENCE",
            f"the landmarks were touched beside the marker '{status.ground.reference}'",
            "Register by these points alone, or by the needles alone.",
            {"reference": status.ground.reference},
        )
    return tuple(
        TouchedPoint(
            name=one.name,
            point_lps_mm=one.point_lps_mm,
            point_in_camera_mm=one.touched.tip_in_anchor_mm,
            covariance_mm2=one.touched.covariance_mm2 + LANDMARK_SD_MM**2 * np.eye(3),
        )
        for one in status.used
        if one.touched is not None
    )


def strays(fit: PointRegistration, *, max_mm: float) -> tuple[RegistrationError, ...]:
    """The landmark that lies farthest from where all others have it, if that is too far.

    One mistaken landmark among five draws the fit to itself, and the RMS of all hides it.
    """
    worst = max(fit.left_out_mm, key=lambda index: fit.left_out_mm[index], default=None)
    if worst is None or fit.left_out_mm[worst] <= max_mm:
        return ()
    name, far_mm = fit.pairs.labels[worst], fit.left_out_mm[worst]
    return (
        RegistrationError(
            "POINT_STRAYS",
            f"'{name}' lies {far_mm:.2f} mm from where all other landmarks have it, allowed {max_mm:.2f} mm",
            "Touch that landmark again, or leave it out.",
            {"landmark": name, "left_out_mm": far_mm, "allowed_mm": max_mm},
        ),
    )


def target_errors(ground: Ground, fit: PointRegistration) -> tuple[TargetError, ...]:
    """The error to expect along every channel of the vertebra."""
    found = []
    for planned in ground.vertebra.channels:
        entry, target = planned.channel.entry_in_vertebra_mm, planned.channel.target_in_vertebra_mm
        length_mm = float(np.linalg.norm(target - entry))
        for share in ALONG:
            point = entry + share * (target - entry)
            found.append(
                TargetError(
                    side=str(planned.side),
                    depth_mm=share * length_mm,
                    expected_mm=fit.tre_expected_mm(point),
                    stated_mm=fit.tre_stated_mm(point),
                )
            )
    return tuple(found)


def made_from(status: PointsStatus) -> dict[str, object]:
    """What the document says of the points."""
    off = residuals_mm(status)
    fit = status.fit
    points: list[Mapping[str, object]] = [
        {
            "landmark": one.name,
            "point_lps_mm": one.point_lps_mm.tolist(),
            "tip_in_anchor_mm": one.touched.tip_in_anchor_mm.tolist(),
            "tip_covariance_mm2": one.touched.covariance_mm2.tolist(),
            "spread_mm": one.touched.spread_mm.tolist(),
            "images": one.touched.images,
            "used": one.used,
            "residual_mm": off.get(one.name),
        }
        for one in status.landmarks
        if one.touched is not None
    ]
    return {
        "tool": status.ground.tool,
        "points": points,
        "targets": []
        if fit is None
        else [
            {
                "side": error.side,
                "depth_mm": error.depth_mm,
                "expected_mm": error.expected_mm,
                "stated_mm": error.stated_mm,
            }
            for error in target_errors(status.ground, fit)
        ],
        "remarks": [] if fit is None else [remark.message for remark in fit.remarks],
    }

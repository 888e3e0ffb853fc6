"""The tool calibration step: pivot calibration of the tip, spin calibration of the axis, tip check."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import Field

from server.config import Point, ToolConfig
from server.live import LiveHub
from server.procedure.camera import MAIN_CAMERA
from server.procedure.collecting_step import CollectingStep
from server.procedure.documents import parse_document
from server.procedure.markers import MarkerStep
from server.procedure.open_case import require_open_case
from server.procedure.tool_collection import ToolCollection
from server.store import CaseStore, Document, DocumentKind, Validity
from server.tool_file import ToolFile, pivot_part, spin_part
from tracker.errors import CalibrationError, InvalidInput
from tracker.pose import ToolModel
from tracker.pose.tool import PivotCalibration, SpinCalibration, TipCheck, ToolGate
from tracker.pose.tool.collector import Purpose


class ToolRecord(ToolFile):
    """A tool as stored in a case: the content of a tool file, and its shape from the drawing."""

    side_mm: Annotated[float, Field(gt=0.0, le=1000.0)] | None  # pyrefly: ignore[bad-override]  # wider than in a file
    """Null for a rigid body of an external tracker, which has no square."""
    axis_in_marker: Point | None = None
    """Axis from the drawing; that of a spin calibration takes precedence."""
    radius_mm: Annotated[float, Field(gt=0.0, le=50.0)]
    length_mm: Annotated[float, Field(gt=0.0, le=1000.0)]

    def model(self, name: str) -> ToolModel | None:
        """Return the tool model for tracking; None while its axis is unknown."""
        axis = self.axis_in_marker if self.spin is None else self.spin.axis_in_marker
        if axis is None:
            return None
        return ToolModel.from_tip_and_axis(
            name=name,
            marker=self.marker,
            tip_in_marker_mm=self.pivot.tip_in_marker_mm,
            axis_in_marker=axis,
            radius_mm=self.radius_mm,
            length_mm=self.length_mm,
            tip_covariance_mm2=self.pivot.covariance_mm2,
            axis_sd_deg=0.0 if self.spin is None else self.spin.axis_sd_deg,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownTool:
    """A tool from the settings or the open case.

    Attributes:
        name: name of the tool.
        configured: its entry in the settings; None if there is none.
        document: its document in the open case, valid or not; None if there is none.
        check: document of the newest tip check.
    """

    name: str
    configured: ToolConfig | None
    document: Document | None
    check: Document | None


def tool_from_document(document: Document) -> ToolRecord:
    """Parse the tool in a case document.

    Raises:
        InvalidInput: TOOL_DOCUMENT_INVALID.
    """
    return parse_document(
        ToolRecord, document, code="TOOL_DOCUMENT_INVALID", remedy="Calibrate the tool again."
    )


class ToolStep(CollectingStep[ToolCollection]):
    """Calibrates and checks tools from live poses; one collection at a time. Thread-safe.

    Args:
        hub: the live images.
        store: where the results are stored.
        gate: acceptance limits.
        markers: the tracked markers.
        tools: the configured tools, with radius, length and axis.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        gate: ToolGate,
        markers: MarkerStep,
        tools: Mapping[str, ToolConfig],
    ) -> None:
        super().__init__(
            "collection of tool poses is",
            remedy="Start a collection for a tool and a purpose.",
        )
        self._hub = hub
        self._store = store
        self._gate = gate
        self._markers = markers
        self._tools = tools

    def begin(self, tool: str, *, marker: str | None, purpose: Purpose) -> ToolCollection:
        """Start to collect poses of this tool; a previous collection is discarded.

        Raises:
            InvalidInput: MARKER_UNKNOWN, TOOL_MARKER_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
            CalibrationError: TOOL_TIP_MISSING, a tip check or spin before the pivot.
        """
        record = self._record(tool)
        known = {one.name: one.document for one in self._markers.known()}
        marker = (
            marker or (record.marker if record else None) or self._marker_in_settings(tool, sorted(known))
        )
        if marker not in known:
            markers = ", ".join(sorted(known)) or "none"
            raise InvalidInput(
                "MARKER_UNKNOWN",
                f"the marker '{marker}' is not tracked",
                f"Tracked markers: {markers}. Upload it on the camera's page.",
                {"marker": marker, "markers": markers},
            )
        if purpose is not Purpose.PIVOT and record is None:
            raise CalibrationError(
                "TOOL_TIP_MISSING",
                f"the tip of '{tool}' is not calibrated in this case",
                "Calibrate the tip by pivoting first.",
                {"tool": tool},
            )
        document = known[marker]
        tip = None if record is None or purpose is Purpose.PIVOT else np.array(record.pivot.tip_in_marker_mm)
        return self._start(
            lambda: ToolCollection(
                self._hub,
                tool=tool,
                marker=marker,
                marker_document_id="" if document is None else document.id,
                purpose=purpose,
                tip_in_marker_mm=tip,
                gate=self._gate,
            )
        )

    def all(self) -> "tuple[KnownTool, ...]":
        """Return the tools of the settings and of the open case, ordered by name."""
        case = self._store.get_open_case()
        record = () if case is None else self._store.all(case.id, DocumentKind.TOOL)
        document_from_name = {document.name: document for document in record}
        checks = () if case is None else self._store.all(case.id, DocumentKind.CHECK)
        check_from_name = {document.name: document for document in checks}
        return tuple(
            KnownTool(
                name=name,
                configured=self._tools.get(name),
                document=document_from_name.get(name),
                check=check_from_name.get(tip_check_name(name)),
            )
            for name in sorted({*self._tools, *document_from_name})
        )

    def validity(self, document: Document) -> Validity:
        """Return whether a tool's calibration is valid."""
        return self._store.validity(document)

    def conclude(
        self,
        *,
        made_by: str,
        radius_mm: float | None = None,
        length_mm: float | None = None,
        axis_in_marker: Sequence[float] | None = None,
    ) -> Document:
        """Store the result in the open case if it is accepted, and end the collection.

        By default radius, length and axis are those stored before, or those of the settings.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING.
            CalibrationError: The poses are insufficient, or a limit is exceeded.
            InvalidInput: TOOL_SHAPE_UNKNOWN.
        """
        collection = self.collection
        outcome = collection.status.progress.outcome
        if isinstance(outcome, CalibrationError):
            raise outcome
        failures = outcome.failures(self._gate)
        if failures:
            raise failures[0]
        document = self._keep(collection, outcome, made_by, (radius_mm, length_mm, axis_in_marker))
        self.end()
        return document

    def _keep(
        self,
        collection: ToolCollection,
        outcome: PivotCalibration | SpinCalibration | TipCheck,
        made_by: str,
        shape: tuple[float | None, float | None, Sequence[float] | None],
    ) -> Document:
        case = require_open_case(self._store)
        tool = collection.tool
        before = self._store.latest(case.id, DocumentKind.TOOL, tool)
        if isinstance(outcome, TipCheck):
            return self._store.put(
                case.id,
                DocumentKind.CHECK,
                tip_check_name(tool),
                {"tool": tool, **check_values(outcome)},
                made_by=made_by,
                depends_on=[] if before is None else [before.id],
            )
        record = self._record(tool)
        if isinstance(outcome, SpinCalibration):
            if record is None:
                raise CalibrationError(
                    "TOOL_TIP_MISSING",
                    f"the tip of '{tool}' is no longer available",
                    "Calibrate the tip by pivoting first.",
                    {"tool": tool},
                )
            whole = record.model_copy(update={"spin": spin_part(outcome)})
        else:
            whole = self._pivoted(collection, outcome, record, shape)
        camera = self._store.latest(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        return self._store.put(
            case.id,
            DocumentKind.TOOL,
            tool,
            whole.model_dump(mode="json"),
            made_by=made_by,
            # The version of the marker at the first pose: a later change of the marker invalidates the tool.
            depends_on=[
                *([] if camera is None else [camera.id]),
                *([collection.marker_document_id] if collection.marker_document_id else []),
            ],
        )

    def _pivoted(
        self,
        collection: ToolCollection,
        outcome: PivotCalibration,
        record: ToolRecord | None,
        shape: tuple[float | None, float | None, Sequence[float] | None],
    ) -> ToolRecord:
        drawn = record or self._tools.get(collection.tool)
        radius_mm, length_mm, axis = shape
        radius_mm = radius_mm if radius_mm is not None or drawn is None else drawn.radius_mm
        length_mm = length_mm if length_mm is not None or drawn is None else drawn.length_mm
        axis = axis if axis is not None or drawn is None else drawn.axis_in_marker
        if radius_mm is None or length_mm is None:
            raise InvalidInput(
                "TOOL_SHAPE_UNKNOWN",
                f"radius and length of '{collection.tool}' are not known",
                "Give radius_mm and length_mm of the drill or awl, measured or from its drawing.",
                {"tool": collection.tool},
            )
        same_marker = record is not None and record.marker == collection.marker
        return ToolRecord(
            marker=collection.marker,
            side_mm=self._markers.one(collection.marker).side_mm,
            pivot=pivot_part(outcome),
            # A new pivot calibration does not change the axis, as long as the marker is the same.
            spin=record.spin if record is not None and same_marker else None,
            axis_in_marker=None if axis is None else [float(v) for v in axis],
            radius_mm=radius_mm,
            length_mm=length_mm,
        )

    def _record(self, tool: str) -> ToolRecord | None:
        """Return the valid record of a tool in the open case, or None."""
        case = require_open_case(self._store)
        document = self._store.find_current(case.id, DocumentKind.TOOL, tool)
        return None if document is None else tool_from_document(document)

    def _marker_in_settings(self, tool: str, known: Sequence[str]) -> str:
        if tool in self._tools:
            return self._tools[tool].marker
        if len(known) == 1:
            return known[0]
        markers = ", ".join(known) or "none"
        raise InvalidInput(
            "TOOL_MARKER_UNKNOWN",
            f"the marker of the tool '{tool}' is not specified",
            f"Give its name. Available markers: {markers}.",
            {"tool": tool, "markers": markers},
        )


def tip_check_name(tool: str) -> str:
    """Return the document name of a tool's tip check."""
    return f"tip of {tool}"


def check_values(check: TipCheck) -> dict[str, object]:
    """Return the result of a tip check as JSON-serialisable values."""
    return {
        "rms_3d_mm": check.rms_3d_mm,
        "max_mm": check.max_mm,
        "rms_by_axis_mm": check.rms_by_axis_mm.tolist(),
        "poses": check.poses,
        "tilt_range_deg": check.motion_range.tilt_range_deg,
        "tilt_range_across_deg": check.motion_range.tilt_range_across_deg,
    }

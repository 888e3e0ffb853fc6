"""The step in which a tool is calibrated: its tip by pivoting, its axis by spinning, the tip checked."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import Field

from server.config import Point, ToolConfig
from server.live import LiveHub
from server.procedure.camera import MAIN_CAMERA
from server.procedure.held import Held
from server.procedure.markers import MarkerStep
from server.procedure.opened import opened_case
from server.procedure.read import read_document
from server.procedure.tool_collection import ToolCollection
from server.store import CaseStore, Current, Document, DocumentKind, Standing
from server.tool_file import ToolFile, pivot_part, spin_part
from tracker.errors import CalibrationError, InvalidInput
from tracker.pose import ToolModel
from tracker.pose.tool import PivotCalibration, SpinCalibration, TipCheck, ToolGate
from tracker.pose.tool.collector import Purpose


class KeptTool(ToolFile):
    """A tool as a case keeps it: what a tool file says, and its shape from the drawing."""

    axis_in_marker: Point | None = None
    """From the drawing; where it was spun, the spin's axis counts."""
    radius_mm: Annotated[float, Field(gt=0.0, le=50.0)]
    length_mm: Annotated[float, Field(gt=0.0, le=1000.0)]

    def model(self, name: str) -> ToolModel | None:
        """The tool for tracking; None while nobody knows which way it points."""
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
    """A tool that somebody has described or calibrated.

    Attributes:
        name: of the tool.
        settled: as the settings have it; None where they do not.
        document: as the open case keeps it, whether or not it holds; None where it does not.
        check: the newest check of its tip there.
    """

    name: str
    settled: ToolConfig | None
    document: Document | None
    check: Document | None


def kept_tool(document: Document) -> KeptTool:
    """The tool in a document of a case.

    Raises:
        InvalidInput: TOOL_DOCUMENT_INVALID.
    """
    return read_document(KeptTool, document, code="TOOL_DOCUMENT_INVALID", remedy="Calibrate the tool again.")


class ToolStep:
    """Calibrates and checks tools from live poses; one collection at a time. Safe to use from any thread.

    Args:
        hub: the live images.
        store: where the results are kept.
        gate: what they must reach.
        markers: that are looked for.
        tools: as the settings have them, for radius, length and axis.
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
        self._hub = hub
        self._store = store
        self._gate = gate
        self._markers = markers
        self._tools = tools
        self._held: Held[ToolCollection] = Held(
            "poses of a tool are",
            remedy="Start collecting, and say which tool and what for.",
        )

    def begin(self, tool: str, *, marker: str | None, purpose: Purpose) -> ToolCollection:
        """Gather poses of this tool; a collection that was there is thrown away.

        Raises:
            InvalidInput: MARKER_UNKNOWN, TOOL_MARKER_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
            CalibrationError: TOOL_TIP_MISSING, a tip check or spin before the pivot.
        """
        kept = self._kept(tool)
        known = {one.model.name: one.document for one in self._markers.known()}
        marker = marker or (kept.marker if kept else None) or self._marker_in_settings(tool, sorted(known))
        if marker not in known:
            raise InvalidInput(
                "MARKER_UNKNOWN",
                f"the marker '{marker}' is not looked for",
                f"Known are: {', '.join(sorted(known)) or 'none'}; send its picture on the camera's page.",
                {"marker": marker},
            )
        if purpose is not Purpose.PIVOT and kept is None:
            raise CalibrationError(
                "TOOL_TIP_MISSING",
                f"the tip of '{tool}' is not known in this case",
                "Calibrate the tip by pivoting first.",
                {"tool": tool},
            )
        document = known[marker]
        tip = None if kept is None or purpose is Purpose.PIVOT else np.array(kept.pivot.tip_in_marker_mm)
        return self._held.begin(
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
        """The tools that the settings describe and that the open case keeps, by name."""
        case = self._store.opened()
        kept = () if case is None else self._store.all(case.id, DocumentKind.TOOL)
        document_from_name = {document.name: document for document in kept}
        checks = () if case is None else self._store.all(case.id, DocumentKind.CHECK)
        check_from_name = {document.name: document for document in checks}
        return tuple(
            KnownTool(
                name=name,
                settled=self._tools.get(name),
                document=document_from_name.get(name),
                check=check_from_name.get(tip_check_name(name)),
            )
            for name in sorted({*self._tools, *document_from_name})
        )

    def standing(self, document: Document) -> Standing:
        """Whether a tool's calibration holds."""
        return self._store.standing(document)

    @property
    def collection(self) -> ToolCollection:
        """The poses so far.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        return self._held.get()

    @property
    def is_collecting(self) -> bool:
        """Whether poses are held."""
        return self._held.is_there

    def end(self) -> None:
        """Gather no more, and throw away what was gathered."""
        self._held.end()

    def conclude(
        self,
        *,
        made_by: str,
        radius_mm: float | None = None,
        length_mm: float | None = None,
        axis_in_marker: Sequence[float] | None = None,
    ) -> Document:
        """Keep what the poses give in the open case, if it passes its gate; the gathering ends.

        Radius, length and axis stay as they were, or come from the settings, where they are not given.

        Raises:
            SetupOrderError: NO_CASE_OPEN, COLLECTION_MISSING.
            CalibrationError: what the poses lack, or the gate that is not passed.
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
        case = opened_case(self._store)
        tool = collection.tool
        before = self._store.latest(case.id, DocumentKind.TOOL, tool)
        if isinstance(outcome, TipCheck):
            return self._store.put(
                case.id,
                DocumentKind.CHECK,
                tip_check_name(tool),
                {"tool": tool, **check_values(outcome)},
                made_by=made_by,
                stands_on=[] if before is None else [before.id],
            )
        kept = self._kept(tool)
        if isinstance(outcome, SpinCalibration):
            if kept is None:
                raise CalibrationError(
                    "TOOL_TIP_MISSING", f"the tip of '{tool}' is gone", "Calibrate the tip by pivoting first."
                )
            whole = kept.model_copy(update={"spin": spin_part(outcome)})
        else:
            whole = self._pivoted(collection, outcome, kept, shape)
        camera = self._store.latest(case.id, DocumentKind.CAMERA, MAIN_CAMERA)
        return self._store.put(
            case.id,
            DocumentKind.TOOL,
            tool,
            whole.model_dump(mode="json"),
            made_by=made_by,
            # The marker as it was at the first pose: behind one that was changed since it does not hold.
            stands_on=[
                *([] if camera is None else [camera.id]),
                *([collection.marker_document_id] if collection.marker_document_id else []),
            ],
        )

    def _pivoted(
        self,
        collection: ToolCollection,
        outcome: PivotCalibration,
        kept: KeptTool | None,
        shape: tuple[float | None, float | None, Sequence[float] | None],
    ) -> KeptTool:
        drawn = kept or self._tools.get(collection.tool)
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
        same_marker = kept is not None and kept.marker == collection.marker
        return KeptTool(
            marker=collection.marker,
            side_mm=self._markers.one(collection.marker).model.side_mm,
            pivot=pivot_part(outcome),
            # The axis does not move when the tip is found anew, as long as the marker is the same.
            spin=kept.spin if kept is not None and same_marker else None,
            axis_in_marker=None if axis is None else [float(v) for v in axis],
            radius_mm=radius_mm,
            length_mm=length_mm,
        )

    def _kept(self, tool: str) -> KeptTool | None:
        """What the open case knows of a tool now."""
        case = opened_case(self._store)
        document = self._store.latest(case.id, DocumentKind.TOOL, tool)
        if document is None or not isinstance(self._store.standing(document), Current):
            return None
        return kept_tool(document)

    def _marker_in_settings(self, tool: str, known: Sequence[str]) -> str:
        if tool in self._tools:
            return self._tools[tool].marker
        if len(known) == 1:
            return known[0]
        raise InvalidInput(
            "TOOL_MARKER_UNKNOWN",
            f"nobody said which marker the tool '{tool}' carries",
            f"Name it; known are: {', '.join(known) or 'none'}.",
            {"tool": tool},
        )


def tip_check_name(tool: str) -> str:
    """The name of the document that keeps the check of a tool's tip."""
    return f"tip of {tool}"


def check_values(check: TipCheck) -> dict[str, object]:
    """What a check of the tip found, as values that JSON can say."""
    return {
        "rms_3d_mm": check.rms_3d_mm,
        "max_mm": check.max_mm,
        "rms_by_axis_mm": check.rms_by_axis_mm.tolist(),
        "poses": check.poses,
        "tilt_range_deg": check.turning.tilt_range_deg,
        "tilt_range_across_deg": check.turning.tilt_range_across_deg,
    }

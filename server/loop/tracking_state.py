"""The state of `Tracking` between two images, with which a recording that starts inside a stream is exact.

Data that follow from the setup (templates, models, workspaces of kernels: 40 MB) are rebuilt. Data that
depend on earlier images are captured attribute by attribute: predicted poses, motion monitors, searches in
progress, smoothing. `STATE` and `DERIVED` name every attribute of the classes that contain both; objects of
other classes are captured completely. A capture takes about 2 ms, once per recording and after each change of
the case, which rebuilds the tracker anyway.
"""

import copyreg
import pickle
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, TypeAlias

import structlog

from server.loop.tracking import Tracking
from server.setup import Preparation
from tracker.navigation import LagEstimator, MotionMonitor, ToolSmoothing
from tracker.navigation.lag import TipSpeedEstimator
from tracker.navigation.monitoring import PoseJumpDetector, ReferenceMonitor, SceneMonitor
from tracker.pipeline import Tracker
from tracker.pipeline.focal_length import FocalLengthMonitor
from tracker.pipeline.idle_search import IdleSearch
from tracker.pipeline.image import RepeatedPatch
from tracker.pipeline.second_prints import SecondPrints
from tracker.plan import Channel
from tracker.pose import PoseSmoother

STATE: dict[type, frozenset[str]] = {
    Tracking: frozenset(
        {"_tracker", "_steadying", "_watching", "_lagging", "_watched_registration", "_changes"}
    ),
    Tracker: frozenset(
        {"_priors", "_patches", "_idle_search", "_second_prints", "focal_length", "_stepped_at_s"}
    ),
    IdleSearch: frozenset({"_image_number", "_costly_rounds", "_rejections"}),
    FocalLengthMonitor: frozenset({"views", "_measured_at_s"}),
    SecondPrints: frozenset({"_image_number", "_twice", "_rejections", "_seen"}),
    ToolSmoothing: frozenset({"_tools"}),
}
DERIVED: dict[type, frozenset[str]] = {
    Tracking: frozenset(
        {"_base_preparation", "_preparation", "_setup", "_camera_problem", "_guide", "_device"}
    ),
    Tracker: frozenset(
        {
            "readout_s",
            "_readout",
            "camera",
            "models",
            "settings",
            "stage_ms",
            "_templates",
            "_textures",
            "_stages",
            "_fitter",
        }
    ),
    IdleSearch: frozenset({"_fitter", "_templates_of"}),
    FocalLengthMonitor: frozenset({"camera", "models"}),
    SecondPrints: frozenset({"_fitter", "_templates_of"}),
    ToolSmoothing: frozenset({"_settings"}),
}
# Classes whose objects are restored without their constructors.
CAPTURED_ENTIRELY: tuple[type, ...] = (
    LagEstimator,
    MotionMonitor,
    PoseJumpDetector,
    PoseSmoother,
    ReferenceMonitor,
    RepeatedPatch,
    SceneMonitor,
    TipSpeedEstimator,
)
RESTORABLE: dict[str, type] = {kind.__name__: kind for kind in (*STATE, *CAPTURED_ENTIRELY)}

Value: TypeAlias = Any

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class ObjectState:
    """Attributes of one object.

    Attributes:
        name: Name of its class, a key of `RESTORABLE`.
        attributes: Values by name.
    """

    name: str
    attributes: dict[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackingState:
    """State of tracking before an image.

    Attributes:
        preparation: The setup in use, with the documents of the case; without the theatre of a rehearsal.
        size_wh_px: Image size for which it is prepared; None if the next image prepares it.
        device: Camera for which it is prepared; empty if unknown.
        tracking: Data that depend on earlier images.
    """

    preparation: Preparation
    size_wh_px: tuple[int, int] | None
    tracking: ObjectState
    device: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class StateRequest:
    """Request for the state before the next image, and before the first one after each change of the case.

    Attributes:
        is_recording: False ends it.
    """

    is_recording: bool


class StateError(ValueError):
    """A state of another version of the program cannot be restored."""


def tracking_state_bytes(tracking: Tracking) -> bytes:
    """Return the present state for another process of this machine; empty if it could not be captured."""
    try:
        return pickle.dumps(capture_state(tracking), protocol=5)
    except Exception:
        # This affects only the recording.
        log.exception("the tracking state could not be captured")
        return b""


def capture_state(tracking: Tracking) -> TrackingState:
    """Return the state; it shares arrays with tracking, which never modifies them in place."""
    preparation, setup = tracking.preparation, tracking.setup
    channel = preparation.channel
    if preparation.theatre is not None:
        # The theatre is a renderer with its scene; tracking needs only its bone.
        bone = preparation.drill_reference_for(channel) if isinstance(channel, Channel) else None
        preparation = replace(preparation, theatre=None, drill_reference=bone)
    return TrackingState(
        preparation=preparation,
        size_wh_px=None if setup is None else setup.camera.size_wh_px,
        tracking=_captured(tracking),
        device=tracking.device,
    )


def restore_state(state: TrackingState, *, at_s: float) -> Tracking:
    """Return tracking in this state, ready for the image captured at `at_s`.

    Raises:
        StateError: The state is of another version.
    """
    tracking = Tracking(state.preparation)
    if state.size_wh_px is not None:
        tracking.prepare(state.size_wh_px, at_s, device=state.device)
    _overlay(tracking, state.tracking)
    return tracking


def _captured(value: Value) -> Value:
    kind = type(value)
    if kind in STATE:
        own_names = sorted(STATE[kind])
        return ObjectState(
            name=kind.__name__, attributes={one: _captured(getattr(value, one)) for one in own_names}
        )
    if kind in CAPTURED_ENTIRELY:
        return ObjectState(
            name=kind.__name__, attributes={one: _captured(own) for one, own in vars(value).items()}
        )
    if isinstance(value, dict):
        return {key: _captured(own) for key, own in value.items()}
    if kind in (list, tuple):
        return kind(_captured(own) for own in value)
    return value


def _overlay(target: Value, state: ObjectState) -> None:
    """Set the captured attributes of an object; derived attributes keep the values of the constructor."""
    kind = type(target)
    if kind.__name__ != state.name:
        raise StateError(f"the state of {state.name} was recorded, but this version has {kind.__name__}")
    if kind in STATE and STATE[kind] != set(state.attributes):
        other = sorted(STATE[kind] ^ set(state.attributes))
        raise StateError(f"the state of {state.name} differs in {', '.join(other)}")
    for name, value in state.attributes.items():
        own = getattr(target, name, None)
        if isinstance(value, ObjectState) and type(own) in STATE:
            _overlay(own, value)
        elif isinstance(own, dict) and isinstance(value, dict):
            # Updated in place, because some mappings create missing entries.
            own.clear()
            own.update({key: _restored(one) for key, one in value.items()})
        else:
            setattr(target, name, _restored(value))


def _restored(value: Value) -> Value:
    if isinstance(value, ObjectState):
        kind = RESTORABLE.get(value.name)
        if kind is None or kind in STATE:
            raise StateError(f"this version has no {value.name}")
        made: Value = object.__new__(kind)
        for name, own in value.attributes.items():
            setattr(made, name, _restored(own))
        return made
    if isinstance(value, dict):
        return {key: _restored(own) for key, own in value.items()}
    if type(value) in (list, tuple):
        return type(value)(_restored(own) for own in value)
    return value


def unpickled_state(content: bytes) -> TrackingState | None:
    """Return the state sent by the tracking process of this server; None without one."""
    if not content:
        return None
    state: TrackingState = pickle.loads(content)  # noqa: S301  own child
    return state


def _proxy_of(values: dict[str, float]) -> MappingProxyType[str, float]:
    return MappingProxyType(values)


# `LastSeen` contains one, which pickle does not support.
copyreg.pickle(MappingProxyType, lambda proxy: (_proxy_of, (dict(proxy),)))

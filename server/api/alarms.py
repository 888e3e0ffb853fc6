"""Alarms: state, acknowledgement, audio pause, hold requests, sounds and log."""

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request, Response
from pydantic import Field, StringConstraints

from server.alarms import AlarmService
from server.alarms.sound import BURSTS, burst_wav
from server.api.errors import rejections
from server.api.requester import DoneBy
from server.security import actor_name, person_of
from server.stream.alarm_messages import AlarmsMessage, alarms_message
from server.stream.message import Message
from server.supervision import HoldRequests
from tracker.navigation.alarms import AlarmSnapshot, Priority

WAV = "audio/wav"
# Period of the screens' sound reports; `alarms.screen_lost_after_s` is three times as long.
ARMED_EVERY_S = 2.0
ScreenName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{8,64}$")]


class SoundMessage(Message):
    """One alarm sound."""

    priority: Priority
    path: str
    """One burst, as a WAV file."""
    repeat_every_s: float
    """Period between the starts of two bursts."""


class ByRequest(Message):
    """The person who acts."""

    by: DoneBy


class AcknowledgeRequest(Message):
    """Alarms to acknowledge, and by whom."""

    by: DoneBy
    numbers: Annotated[list[int], Field(min_length=1, max_length=100)]
    """Numbers of the displayed alarms; alarms raised since are not acknowledged."""


class PauseRequest(Message):
    """Duration of an audio pause."""

    by: DoneBy
    seconds: float
    """Maximum 120."""


class ScreenRequest(Message):
    """Sound state of a screen."""

    screen: ScreenName
    """Random name that the screen chooses when it loads the page."""
    state: Literal["armed", "silent", "closed"]
    """silent: sound not enabled yet, or it failed. closed: no alarm for its absence."""
    guiding_sound: bool = False
    """Whether the guiding sound is on; each change is in the alarm log."""


class LogMessage(Message):
    """The alarm log of the open case, or of the time without an open case."""

    lines: list[dict[str, object]]
    """Oldest first."""


def sound_messages() -> list[SoundMessage]:
    """Return the addresses of the alarm sounds."""
    return [
        SoundMessage(
            priority=priority,
            path=f"/api/alarms/sound/{priority.value}.wav",
            repeat_every_s=burst.repeat_every_s,
        )
        for priority, burst in BURSTS.items()
    ]


def alarms_router(service: AlarmService, holds: HoldRequests) -> APIRouter:
    """Return the router of `/api/alarms`."""
    router = APIRouter(prefix="/api/alarms", tags=["alarms"])
    _add_seeing(router, service)
    _add_answering(router, service)
    _add_holding(router, service, holds)
    return router


def _message(picture: AlarmSnapshot) -> AlarmsMessage:
    return alarms_message(picture, now_s=picture.at_s)


def _logged(service: AlarmService, picture: AlarmSnapshot) -> AlarmsMessage:
    """Flush the log, so that an action is on the disk before it is confirmed."""
    service.log.flush()
    return _message(picture)


def _add_seeing(router: APIRouter, service: AlarmService) -> None:
    @router.get("")
    def alarms() -> AlarmsMessage:
        """Return the active alarms, highest priority first. Each live message contains the same data."""
        return _message(service.picture)

    @router.get("/log", responses=rejections(422, 503))
    def log(last: Annotated[int, Query(ge=1, le=10_000)] = 200) -> LogMessage:
        """Return the last lines of the alarm log: changes of alarms, and guiding sounds turned on and off."""
        return LogMessage(lines=[dict(line) for line in service.log.newest(last)])

    @router.get(
        "/sound/{priority}.wav",
        response_class=Response,
        responses={200: {"content": {WAV: {}}}, **rejections(422)},
    )
    async def sound(priority: Priority) -> Response:
        """Return one burst of the sound of a priority; its period is in `GET /api/dashboard`."""
        return Response(burst_wav(priority), media_type=WAV)


def _add_answering(router: APIRouter, service: AlarmService) -> None:
    @router.post("/acknowledgement", responses=rejections(422, 503, 507))
    def acknowledge(requested: AcknowledgeRequest, request: Request) -> AlarmsMessage:
        """Acknowledge alarms: their sound stops, and alarms whose condition has ended are removed."""
        return _logged(
            service, service.acknowledge(requested.numbers, by=actor_name(request.scope, requested.by))
        )

    @router.post("/pause", responses=rejections(422, 503, 507))
    def pause(requested: PauseRequest, request: Request) -> AlarmsMessage:
        """Pause the sound for at most two minutes; a new or higher alarm ends the pause."""
        return _logged(service, service.pause(requested.seconds, by=actor_name(request.scope, requested.by)))

    @router.post("/resumption", responses=rejections(422, 503, 507))
    def resume(requested: ByRequest, request: Request) -> AlarmsMessage:
        """End the audio pause."""
        return _logged(service, service.resume(by=actor_name(request.scope, requested.by)))

    @router.post("/screens", responses=rejections(422))
    def screen(requested: ScreenRequest, request: Request) -> AlarmsMessage:
        """Report the sound state of a screen; expected every two seconds."""
        if requested.state == "closed":
            service.close_screen(requested.screen)
            return _message(service.picture)
        guiding_by = (
            actor_name(request.scope, f"screen {requested.screen[:4]}") if requested.guiding_sound else ""
        )
        armed = requested.state == "armed"
        return _message(service.report_screen(requested.screen, armed=armed, guiding_by=guiding_by))


def _add_holding(router: APIRouter, service: AlarmService, holds: HoldRequests) -> None:
    @router.post("/hold", responses=rejections(422, 503, 507))
    def hold(request: Request, requested: ByRequest) -> AlarmsMessage:
        """Request a hold from theatre. This raises an alarm and changes nothing else."""
        return _logged(service, holds.request(person_of(request.scope), name=requested.by or ""))

    @router.post("/release", responses=rejections(409, 422, 503, 507))
    def release(request: Request, requested: ByRequest) -> AlarmsMessage:
        """Withdraw a hold request: your own, or as operator all of them."""
        return _logged(service, holds.release(person_of(request.scope), name=requested.by or ""))

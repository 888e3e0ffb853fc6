"""Alarms: seen, acknowledged, paused, asked for; their sounds, and their log."""

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Request, Response
from pydantic import Field, StringConstraints

from server.alarms import AlarmDesk
from server.alarms.sound import BURSTS, burst_wav
from server.api.doing import DoneBy
from server.api.errors import rejections
from server.security import acting, person_of
from server.stream.alarm_messages import AlarmsMessage, alarms_message
from server.stream.message import Message
from server.supervision import Holds
from tracker.navigation.alarms import AlarmPicture, Priority

WAV = "audio/wav"
# Screens say this often whether their sound is armed; `alarms.screen_lost_after_s` is three times as long.
ARMED_EVERY_S = 2.0
ScreenName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{8,64}$")]


class SoundMessage(Message):
    """One alarm sound."""

    priority: Priority
    path: str
    """One burst, as a WAV file."""
    repeat_every_s: float
    """From the beginning of one burst to the beginning of the next."""


class ByRequest(Message):
    """Who does it."""

    by: DoneBy


class AcknowledgeRequest(Message):
    """Which alarms somebody has seen, and who."""

    by: DoneBy
    numbers: Annotated[list[int], Field(min_length=1, max_length=100)]
    """Of the alarms that were in sight; one that was raised since is not meant."""


class PauseRequest(Message):
    """For how long there shall be no sound."""

    by: DoneBy
    seconds: float
    """At most 120."""


class ScreenRequest(Message):
    """A screen says whether it would be heard."""

    screen: ScreenName
    """Made up by the screen, for as long as it shows the page."""
    state: Literal["armed", "silent", "closed"]
    """silent: nobody has touched it yet, or its sound failed. closed: it is not missed."""


class LogMessage(Message):
    """The alarm log of the open case, or of the time while none is open."""

    lines: list[dict[str, object]]
    """The oldest first."""


def sound_messages() -> list[SoundMessage]:
    """Where the sounds are, for the page."""
    return [
        SoundMessage(
            priority=priority,
            path=f"/api/alarms/sound/{priority.value}.wav",
            repeat_every_s=burst.repeat_every_s,
        )
        for priority, burst in BURSTS.items()
    ]


def alarms_router(desk: AlarmDesk, holds: Holds) -> APIRouter:
    """Everything under `/api/alarms`."""
    router = APIRouter(prefix="/api/alarms", tags=["alarms"])
    _add_seeing(router, desk)
    _add_answering(router, desk)
    _add_holding(router, desk, holds)
    return router


def _message(picture: AlarmPicture) -> AlarmsMessage:
    return alarms_message(picture, now_s=picture.at_s)


def _logged(desk: AlarmDesk, picture: AlarmPicture) -> AlarmsMessage:
    """What a person did is on the disk before they hear that it was done."""
    desk.log.flush()
    return _message(picture)


def _add_seeing(router: APIRouter, desk: AlarmDesk) -> None:
    @router.get("")
    def alarms() -> AlarmsMessage:
        """All alarms that are in sight, the highest first. The same comes with every live message."""
        return _message(desk.picture)

    @router.get("/log", responses=rejections(422, 503))
    def log(last: Annotated[int, Query(ge=1, le=10_000)] = 200) -> LogMessage:
        """The last lines of the alarm log: what was raised, cleared, acknowledged, paused, when, by whom."""
        return LogMessage(lines=[dict(line) for line in desk.log.newest(last)])

    @router.get(
        "/sound/{priority}.wav",
        response_class=Response,
        responses={200: {"content": {WAV: {}}}, **rejections(422)},
    )
    async def sound(priority: Priority) -> Response:
        """One burst of the sound of a priority; how often it comes again is in `GET /api/dashboard`."""
        return Response(burst_wav(priority), media_type=WAV)


def _add_answering(router: APIRouter, desk: AlarmDesk) -> None:
    @router.post("/acknowledgement", responses=rejections(422, 503, 507))
    def acknowledge(asked: AcknowledgeRequest, request: Request) -> AlarmsMessage:
        """Say that these alarms were seen: their sound stops, and one that was over goes out of sight."""
        return _logged(desk, desk.acknowledge(asked.numbers, by=acting(request.scope, asked.by)))

    @router.post("/pause", responses=rejections(422, 503, 507))
    def pause(asked: PauseRequest, request: Request) -> AlarmsMessage:
        """No sound for at most two minutes; it comes back by itself, at once with a new or higher alarm."""
        return _logged(desk, desk.pause(asked.seconds, by=acting(request.scope, asked.by)))

    @router.post("/resumption", responses=rejections(422, 503, 507))
    def resume(asked: ByRequest, request: Request) -> AlarmsMessage:
        """End the pause now."""
        return _logged(desk, desk.resume(by=acting(request.scope, asked.by)))

    @router.post("/screens", responses=rejections(422))
    def screen(asked: ScreenRequest) -> AlarmsMessage:
        """A screen says whether its sound is armed, every two seconds."""
        if asked.state == "closed":
            desk.screen_left(asked.screen)
            return _message(desk.picture)
        return _message(desk.screen_said(asked.screen, armed=asked.state == "armed"))


def _add_holding(router: APIRouter, desk: AlarmDesk, holds: Holds) -> None:
    @router.post("/hold", responses=rejections(422, 503, 507))
    def hold(request: Request, asked: ByRequest) -> AlarmsMessage:
        """Ask those in theatre to hold. It raises an alarm, and stops or changes nothing."""
        return _logged(desk, holds.ask(person_of(request.scope), name=asked.by or ""))

    @router.post("/release", responses=rejections(409, 422, 503, 507))
    def release(request: Request, asked: ByRequest) -> AlarmsMessage:
        """Ask no more: who asked for themselves, the operator for everybody."""
        return _logged(desk, holds.release(person_of(request.scope), name=asked.by or ""))

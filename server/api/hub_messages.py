"""Messages of the hub: the list of theatres."""

from server.hub.theatres import TheatrePresence
from server.stream.message import Message
from server.stream.messages import ProblemMessage


class HubAlarmMessage(Message):
    """An alarm of a theatre."""

    priority: str
    state: str
    title: str


class HubTheatreMessage(Message):
    """One theatre, with nothing but its age where it is not live."""

    name: str
    presence: TheatrePresence
    age_ms: float | None
    """Age of its newest message at the sending of this one, at most; null while it is not measured."""
    image_age_ms: float | None
    """Age of its newest image at most; null without one."""
    headline: str
    """Without figures; empty unless live."""
    tone: str
    alarms: list[HubAlarmMessage]
    """The highest priority first."""


class HubTheatresMessage(Message):
    """The theatres that this account may see."""

    theatres: list[HubTheatreMessage]
    sees: list[str]
    """Names of theatres that this account sees by the settings, `*` standing for any characters."""
    stale_after_ms: float
    """Age from which a theatre's state and picture are not shown."""
    problem: ProblemMessage | None
    """Why nothing is received from the NATS server now."""

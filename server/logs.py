"""Logging: human lines on a terminal, JSON lines elsewhere, always to standard error."""

import logging
import sys
from dataclasses import dataclass
from typing import Any

import structlog

# Loggers whose lines per request or per frame would hide other messages.
QUIET_LOGGERS = ("alembic", "uvicorn.access", "websockets", "asyncio", "numba", "multipart", "PIL")


@dataclass(frozen=True, slots=True, kw_only=True)
class LogSettings:
    """Log settings, also passed to the tracking process.

    Attributes:
        as_json: JSON lines instead of text lines.
        debug: Also log details of each image.
    """

    as_json: bool
    debug: bool = False

    @classmethod
    def for_terminal(cls, *, as_json: bool | None = None, debug: bool = False) -> "LogSettings":
        """Return settings with text lines if standard error is a terminal, unless `as_json` is given."""
        return cls(as_json=not sys.stderr.isatty() if as_json is None else as_json, debug=debug)


def configure_logging(settings: LogSettings, *, process: str = "server") -> None:
    """Configure structlog and the logging of the standard library for this process."""
    level = logging.DEBUG if settings.debug else logging.INFO
    shared: list[Any] = [
        structlog.contextvars.merge_contextvars,
        structlog.stdlib.add_log_level,
        structlog.processors.TimeStamper(fmt="iso" if settings.as_json else "%H:%M:%S", utc=settings.as_json),
    ]
    structlog.configure(
        processors=[*shared, structlog.stdlib.ProcessorFormatter.wrap_for_formatter],
        wrapper_class=structlog.make_filtering_bound_logger(level),
        logger_factory=structlog.stdlib.LoggerFactory(),
        cache_logger_on_first_use=False,
    )
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_formatter(settings, shared))
    root = logging.getLogger()
    root.handlers[:] = [handler]
    root.setLevel(level)
    for name in QUIET_LOGGERS:
        logging.getLogger(name).setLevel(logging.WARNING)
    # Its lines repeat those of this server.
    logging.getLogger("uvicorn.error").setLevel(logging.WARNING)
    structlog.contextvars.bind_contextvars(process=process)


def _formatter(settings: LogSettings, shared: list[Any]) -> logging.Formatter:
    last: list[Any] = [structlog.stdlib.ProcessorFormatter.remove_processors_meta]
    if settings.as_json:
        last += [structlog.processors.format_exc_info, structlog.processors.JSONRenderer()]
    else:
        traceback = structlog.dev.plain_traceback
        last += [
            structlog.dev.ConsoleRenderer(
                colors=sys.stderr.isatty(), exception_formatter=traceback, pad_event_to=0, pad_level=False
            )
        ]
    return structlog.stdlib.ProcessorFormatter(processors=last, foreign_pre_chain=shared)

"""Messages of warnings about completed work, in the language of the request."""

from server.stream.messages import Message
from server.texts import requested_language, worded
from tracker.errors import Remark
from tracker.plan.document import plain


class RemarkMessage(Message):
    """A warning about completed work."""

    code: str
    message: str
    remedy: str
    """Empty if there is nothing to do."""


def remark_message(remark: Remark) -> RemarkMessage:
    """Return the message of a remark."""
    return _message(plain(remark))


def stored_remark_messages(stored: object) -> list[RemarkMessage]:
    """Return the messages of the remarks in a document; of an older one, which has sentences, these."""
    return [_message(one) for one in stored] if isinstance(stored, list) else []


def _message(stored: object) -> RemarkMessage:
    localized = worded(stored, requested_language())
    if not isinstance(localized, dict):
        return RemarkMessage(code="", message=str(localized), remedy="")
    return RemarkMessage(
        code=str(localized["code"]), message=str(localized["message"]), remedy=str(localized["remedy"])
    )

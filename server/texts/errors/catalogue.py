"""Templates of messages by code, and of remedies, in all languages."""

from collections.abc import Mapping

from server.texts.language import Text

MESSAGES: Mapping[str, tuple[Text, ...]] = {}
REMEDIES: tuple[Text, ...] = ()

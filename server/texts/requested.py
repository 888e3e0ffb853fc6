"""The language that a request states."""

from contextvars import ContextVar

from server.texts.language import LANGUAGES, Language

# Set for each request by `server.api.language`; a thread that answers a request has a copy of its context.
_REQUESTED: ContextVar[Language] = ContextVar("requested_language", default="en")


def requested_language() -> Language:
    """Return the language of the request that is being answered; English outside of requests."""
    return _REQUESTED.get()


def set_requested_language(accept_language: str) -> None:
    """Set it from the value of an `Accept-Language` header, for the rest of the context."""
    _REQUESTED.set(accepted_language(accept_language))


def accepted_language(accept_language: str) -> Language:
    """Return the language with the highest weight in an `Accept-Language` header.

    A region is ignored: de-AT is German. English if the header names no language of the catalogue.
    """
    best: Language = "en"
    best_weight = 0.0
    for part in accept_language[:500].split(","):
        tag, _, parameter = part.strip().lower().partition(";")
        primary = tag.strip().partition("-")[0]
        weight = _weight(parameter)
        for language in LANGUAGES:
            if primary == language and weight > best_weight:
                best, best_weight = language, weight
    return best


def _weight(parameter: str) -> float:
    """Return the weight in `q=0.8`; 1 without one, and 0 if it is not a number of the permitted range."""
    if not parameter.strip():
        return 1.0
    name, _, digits = parameter.partition("=")
    try:
        weight = float(digits)
    except ValueError:
        return 0.0
    return weight if name.strip() == "q" and 0.0 <= weight <= 1.0 else 0.0

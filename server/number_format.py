"""Number formats shared by video, page, messages and reports."""

import math
from decimal import ROUND_HALF_UP, Decimal

NOT_KNOWN = "--"


def finite(value: float | None) -> float | None:
    """Return the number, or None where it is infinite or NaN, which JSON lacks."""
    return None if value is None or not math.isfinite(value) else value


def format_number(value: float, *, decimals: int = 1) -> str:
    """Format a number with fixed decimals; "--" if it is not finite, and no negative zero.

    Rounds half away from zero on the exact binary value, like `Number.prototype.toFixed` in the browser, so
    that page and video overlay show the same text.
    """
    if not math.isfinite(value):
        return NOT_KNOWN
    rounded = Decimal(value).quantize(Decimal(1).scaleb(-decimals), rounding=ROUND_HALF_UP)
    return f"{abs(rounded) if rounded.is_zero() else rounded:f}"

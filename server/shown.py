"""How a number is shown to a person: rounded in one place, so that video, page and report say the same."""

import math
from decimal import ROUND_HALF_UP, Decimal

NOT_KNOWN = "--"


def shown_number(value: float, *, decimals: int = 1) -> str:
    """A number with fixed decimals; "--" for one that is not finite, and never a negative zero.

    Half goes away from zero, on the exact binary value, as `Number.prototype.toFixed` does it in the browser:
    the page that formats the message's number with one decimal shows what is burned into the video.
    """
    if not math.isfinite(value):
        return NOT_KNOWN
    rounded = Decimal(value).quantize(Decimal(1).scaleb(-decimals), rounding=ROUND_HALF_UP)
    return f"{abs(rounded) if rounded.is_zero() else rounded:f}"

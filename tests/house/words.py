"""Words of the project's former dialect, which a name must not contain."""

import io
import re
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

# Each word, and what a computer-vision or web engineer calls it. Words that are standard terms in another
# sense (a line of text, a light in the 3-D scene, a page that turns) are not listed: only a reader knows.
STANDARD_TERMS = {
    "alike": "correlation, score",
    "asked": "request",
    "bell": "Gaussian PSF",
    "brought": "defaults",
    "certainty": "uncertainty",
    "chance": "probability",
    "desk": "service",
    "explains": "model fits",
    "explanation": "photometric verification",
    "follower": "listener",
    "glance": "template match",
    "glaring": "additive",
    "guesses": "failed logins",
    "held": "active session",
    "kept": "stored",
    "least": "min",
    "likeness": "correlation",
    "lobby": "hub",
    "most": "max",
    "noted": "recorded",
    "peek": "coarse match",
    "refusal": "rejection",
    "refuse": "reject, validate",
    "refused": "rejected",
    "rival": "pose ambiguity",
    "rivals": "pose ambiguity",
    "sayings": "messages",
    "shaded": "multiplicative",
    "shelf": "repository",
    "smear": "motion blur",
    "smeared": "motion-blurred",
    "standing": "validity",
    "sureness": "observability",
    "surprise": "Mahalanobis distance",
    "told": "sent, reported",
    "trouble": "problem, error",
}
# Names of other libraries, and terms in which the word is standard.
STANDARD_NAMES = re.compile(
    r"least_squares|least_trimmed_squares|most_common|left_most|held_out|leastSquares"
    r"|(?<![a-z])at_(most|least)|(?-i:\bat(Most|Least)|At(Most|Least))",
    re.IGNORECASE,
)
WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
TYPESCRIPT_NOISE = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:[^\"\\\n]|\\.)*\"|`[^`]*`", re.DOTALL)
TYPESCRIPT_NAME = re.compile(r"[A-Za-z_$][\w$]*")


def remaining_words(paths: list[Path]) -> Counter[str]:
    """Count the listed words in the names that Python and TypeScript files define or use."""
    found: Counter[str] = Counter()
    for path in paths:
        names = _python_names(path) if path.suffix == ".py" else _typescript_names(path)
        for name in names:
            # The name of a test is a sentence.
            if name.startswith("test_") or STANDARD_NAMES.search(name):
                continue
            found.update(word for word in map(str.lower, WORD.findall(name)) if word in STANDARD_TERMS)
    return found


def _python_names(path: Path) -> Iterator[str]:
    text = path.read_text(encoding="utf-8")
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME:
            yield token.string


def _typescript_names(path: Path) -> Iterator[str]:
    yield from TYPESCRIPT_NAME.findall(TYPESCRIPT_NOISE.sub(" ", path.read_text(encoding="utf-8")))

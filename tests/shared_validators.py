"""Applications of one test run share their validators.

FastAPI builds a pydantic validator for each parameter and answer of each address, some 800 an application,
of which 170 differ. Building them takes half of the time of creating an application, and hundreds of tests
create one.

"""

from typing import Any, get_args

from fastapi._compat import v2
from pydantic import TypeAdapter

_adapters: dict[tuple[object, ...], TypeAdapter[Any]] = {}


def share_validators() -> None:
    """Let FastAPI build each validator once a process. May be called again."""
    names = vars(v2)
    if names["TypeAdapter"] is not _shared_adapter:
        # FastAPI's private name: if it is gone, this must not stay without effect.
        assert names["TypeAdapter"] is TypeAdapter
        names["TypeAdapter"] = _shared_adapter


def _shared_adapter(annotated: Any, *, config: Any = None) -> TypeAdapter[Any]:  # noqa: ANN401  any type
    annotation, *metadata = get_args(annotated)
    try:
        # Metadata have no hash; what they are and contain is in their representation.
        key = (annotation, repr(metadata), repr(config))
        found = _adapters.get(key)
    except TypeError:  # an annotation without a hash
        return TypeAdapter(annotated, config=config)
    if found is None:
        found = _adapters[key] = TypeAdapter(annotated, config=config)
    return found

"""Fields are described by the strings below them, as pydantic does it."""

from typing import Annotated, ClassVar

from pydantic import BaseModel, ConfigDict, Field

from server.field_descriptions import FieldDescriptions


class Below(FieldDescriptions, BaseModel):
    """Two lines and an own text."""

    plain: int = 0
    """Of two
    lines."""
    own: Annotated[int, Field(description="own")] = 0
    """Of the source."""
    silent: int = 0
    shared: ClassVar[int] = 0
    """Of no field."""

    class Inner(FieldDescriptions, BaseModel):
        """A class inside."""

        deep: int = 0
        """Inside."""

    inner: Inner = Inner()
    """Of a reference."""


class Same(BaseModel):
    """Two lines and an own text."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    plain: int = 0
    """Of two
    lines."""
    own: Annotated[int, Field(description="own")] = 0
    """Of the source."""
    silent: int = 0
    shared: ClassVar[int] = 0
    """Of no field."""
    inner: Below.Inner = Below.Inner()
    """Of a reference."""


class Heir(Below):
    """One field is declared again, the last one is described."""

    plain: int = 1
    last: int = 0
    """Of the heir."""


def _described(model: type[BaseModel]) -> dict[str, str | None]:
    return {name: field.get("description") for name, field in model.model_json_schema()["properties"].items()}


def test_a_schema_is_that_of_pydantic() -> None:
    expected = Same.model_json_schema()
    assert Below.model_json_schema() == {**expected, "title": "Below"}
    assert _described(Below) == {
        "plain": "Of two\nlines.",
        "own": "own",
        "silent": None,
        "inner": "Of a reference.",
    }


def test_a_class_inside_is_described() -> None:
    assert _described(Below.Inner) == {"deep": "Inside."}


def test_an_heir_has_the_fields_of_its_base_and_its_own() -> None:
    assert _described(Heir) == {
        "plain": None,
        "own": "own",
        "silent": None,
        "inner": "Of a reference.",
        "last": "Of the heir.",
    }

"""Descriptions of the fields of a model from the strings below them.

pydantic's own `use_attribute_docstrings` reads the source of each class as soon as the class is made, which
takes an eighth of the time of a start. Here it is read when a JSON schema is written.
"""

import ast
import inspect
import sys
from functools import cache
from itertools import zip_longest

from pydantic import GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema


class FieldDescriptions:
    """Base of models whose JSON schema describes each field by the string literal below it in the source.

    No such model may be defined in a function.
    """

    @classmethod
    def __get_pydantic_json_schema__(
        cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Return the JSON schema with the descriptions; an explicit description of a field is kept."""
        schema = handler(core_schema)
        properties = handler.resolve_ref_schema(schema).get("properties", {})
        for name, text in _descriptions(cls).items():
            if name in properties:
                properties[name].setdefault("description", text)
        return schema


def _descriptions(model: type) -> dict[str, str]:
    """Return the description of each described field, by name."""
    found: dict[str, str] = {}
    for base in reversed(model.__mro__):
        body = _class_body(base) if issubclass(base, FieldDescriptions) else []
        for statement, below in zip_longest(body, body[1:]):
            if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
                # A field that a subclass declares again is another field.
                found.pop(statement.target.id, None)
                match below:
                    case ast.Expr(value=ast.Constant(value=str(text))):
                        found[statement.target.id] = inspect.cleandoc(text)
                    case _:  # a field without a description
                        pass
    return found


def _class_body(model: type) -> list[ast.stmt]:
    body = _module_body(model.__module__)
    for name in model.__qualname__.split("."):
        body = next(one.body for one in body if isinstance(one, ast.ClassDef) and one.name == name)
    return body


@cache
def _module_body(name: str) -> list[ast.stmt]:
    return ast.parse(inspect.getsource(sys.modules[name])).body

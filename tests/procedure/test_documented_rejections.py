"""The rejections documented in OpenAPI are those that are answered, at every address."""

from tests.procedure.conftest import Server


def test_every_rejection_is_documented_in_the_shape_that_it_has(server: Server) -> None:
    document = server.ask("GET", "/api/openapi.json", 200)
    rejections = {
        (method, path, status): answer.get("content", {}).get("application/json", {}).get("schema")
        for path, methods in document["paths"].items()
        for method, operation in methods.items()
        for status, answer in operation["responses"].items()
        # An unhealthy server answers with its own state.
        if status >= "400" and path != "/health"
    }
    assert {status for _, _, status in rejections} >= {"404", "409", "413", "421", "422", "503", "507"}
    ours = {"$ref": "#/components/schemas/ProblemMessage"}
    assert {where: schema for where, schema in rejections.items() if schema != ours} == {}
    assert "ValidationError" not in str(document)
    # Rejected by the framework itself.
    reported = server.ask("GET", "/api/cases/none/archive", 422, params={"with_identity": "perhaps"})
    assert set(reported) == set(document["components"]["schemas"]["ProblemMessage"]["required"])

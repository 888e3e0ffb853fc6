"""A procedure that waits for a confirmation after a restart."""

from playwright.sync_api import Route


def answer_unconfirmed(route: Route) -> None:
    """Answer the state of the procedure as after a restart."""
    reply = route.fetch().json()
    reply["confirmation"] = {
        "because": "server_started",
        "registration_id": "r1",
        "vertebra": "L3",
        "registered_at": "2026-05-01T10:00:00Z",
        "registered_by": "ito",
        "reference": None,
    }
    route.fulfill(json=reply)

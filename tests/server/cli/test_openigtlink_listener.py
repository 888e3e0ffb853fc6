"""The OpenIGTLink socket at the start: bound before anything else; its errors name its settings."""

import socket

import pytest

from server.cli.run import _link_listener
from server.config import Config
from server.errors import ConfigError


def test_it_is_off_by_default() -> None:
    assert _link_listener(Config()) is None


def test_it_listens_on_loopback() -> None:
    listener = _link_listener(Config.model_validate({"openigtlink": {"port": 0}}))
    assert listener is not None
    with listener:
        assert listener.getsockname()[0] == "127.0.0.1"
        with socket.create_connection(listener.getsockname()):
            pass


@pytest.mark.parametrize(
    ("host", "code", "setting"),
    [
        ("127.0.0.1", "PORT_NOT_AVAILABLE", "openigtlink.port"),
        ("192.0.2.1", "HOST_NOT_AVAILABLE", "openigtlink.host"),
    ],
)
def test_what_cannot_be_listened_on_is_reported_with_its_setting(host: str, code: str, setting: str) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(ConfigError) as reported:
            _link_listener(Config.model_validate({"openigtlink": {"port": port, "host": host}}))
    assert reported.value.code == code
    assert setting in reported.value.remedy

"""Settings of the hub: off by default, encrypted beyond this computer, and named where one is missing."""

import json
from pathlib import Path

import pytest

from server.alarms import StoredAlarmLog
from server.alarms.entries import guiding_entry
from server.config import Config
from server.config_file import load_config
from server.errors import ConfigError
from server.hub.connection import HubAddress, HubError
from server.hub.outbox import Outbox
from server.hub.subjects import Hospital, Leaf
from server.hub.theatre import HubPublication
from server.live import LiveHub
from server.logs import LogSettings
from server.security import AuditLog
from server.security.tls import reject_unsafe
from server.store import CaseStore, Home


def config_with(folder: Path, text: str) -> Config:
    file = folder / "config.yaml"
    file.write_text(f"hub: {{{text}}}")
    return load_config(file, environment={})


def test_the_address_has_the_files_beside_the_settings(tmp_path: Path) -> None:
    (tmp_path / "user").write_text("OR-1:a:b\n")
    config = config_with(
        tmp_path,
        "url: tls://nats.example:4222, hospital: clinic, theatre: OR-1, credentials: user, "
        "tls: {ca: ca.pem, certificate: own.pem, key: own.key}",
    )
    reject_unsafe(config)
    assert HubAddress.of(config.hub) == HubAddress(
        url="tls://nats.example:4222",
        hospital=Hospital("clinic"),
        user=("OR-1", "a:b"),
        ca=tmp_path / "ca.pem",
        certificate=(tmp_path / "own.pem", tmp_path / "own.key"),
    )


def test_figures_do_not_cross_a_network_in_plain_text_unless_that_is_stated(tmp_path: Path) -> None:
    reject_unsafe(config_with(tmp_path, "url: nats://127.0.0.1:4222"))
    with pytest.raises(ConfigError) as rejected:
        reject_unsafe(config_with(tmp_path, "url: nats://nats.example:4222"))
    assert rejected.value.code == "HUB_UNENCRYPTED"
    stated = "unencrypted: anybody on this network reads the theatres"
    reject_unsafe(config_with(tmp_path, f"url: nats://nats.example:4222, {stated}"))


def test_supervisors_act_through_the_hub_only_with_encryption_and_sign_in(tmp_path: Path) -> None:
    reject_unsafe(config_with(tmp_path, "url: nats://127.0.0.1:4222, requests: true"))
    reject_unsafe(config_with(tmp_path, "url: tls://nats.example:4222, requests: true"))
    stated = "unencrypted: anybody on this network reads the theatres"
    with pytest.raises(ConfigError, match="read the supervisors' sessions"):
        reject_unsafe(config_with(tmp_path, f"url: nats://nats.example:4222, {stated}, requests: true"))
    without = {"hub": {"url": "tls://nats.example:4222", "requests": True}, "security": {"sign_in": "off"}}
    with pytest.raises(ConfigError, match="anybody at the hub could act"):
        reject_unsafe(Config.model_validate(without))


@pytest.mark.parametrize("content", [None, "", "name", ":password", "one:two\nthree:four"])
def test_a_file_without_user_and_password_is_named(tmp_path: Path, content: str | None) -> None:
    if content is not None:
        (tmp_path / "user").write_text(content)
    config = config_with(tmp_path, "url: nats://127.0.0.1:4222, credentials: user")
    with pytest.raises(HubError, match="user:password") as rejected:
        HubAddress.of(config.hub)
    assert rejected.value.code == "HUB_CREDENTIALS_UNUSABLE"


def test_a_theatre_publishes_only_with_an_address_and_a_name(tmp_path: Path) -> None:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        alarms, audit = StoredAlarmLog(store), AuditLog(tmp_path / "audit")

        def publication(text: str) -> HubPublication | None:
            return HubPublication.of(
                config_with(tmp_path, text),
                LiveHub(),
                home=home.folder,
                alarms=alarms,
                audit=audit,
                log_settings=LogSettings(as_json=True),
            )

        try:
            assert publication("theatre: OR-1") is None
            assert not (home.folder / "hub-outbox.sqlite").exists()
            with pytest.raises(HubError) as rejected:
                publication("url: nats://127.0.0.1:4222")
            assert rejected.value.code == "HUB_THEATRE_MISSING"
        finally:
            alarms.stop()


def test_what_the_alarm_log_stores_is_in_the_outbox_before_it_is_confirmed(tmp_path: Path) -> None:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        alarms, audit = StoredAlarmLog(store), AuditLog(tmp_path / "audit")
        made = HubPublication.of(
            config_with(tmp_path, "url: nats://127.0.0.1:4222, theatre: OR-1"),
            LiveHub(),
            home=home.folder,
            alarms=alarms,
            audit=audit,
            log_settings=LogSettings(as_json=True),
        )
        assert made is not None
        try:
            alarms.append([guiding_entry(screen="s", by="B", is_on=True, at="now", at_s=1.0)])
            alarms.flush()
            reading = Outbox(home.folder)
            (entry,) = reading.after(Leaf.ALARM, 0, count=9)
            reading.close()
            assert json.loads(entry.content)["change"] == "guiding_on"
        finally:
            alarms.stop()
            made.stop()

"""Access control of the server: people, audit log, TLS certificate, and the start-up message about them."""

from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

from server.config import Config
from server.security import AuditLog, PeopleService
from server.security.audit import Entry, mark_lost_changes
from server.security.people import Token
from server.security.person import SERVER
from server.security.tls import Tls, select_tls
from server.store import CaseStore, translate_errors

# A folder of its own, so that a restored database does not bring back sessions that were ended.
SECURITY_FOLDER = "security"


@dataclass(frozen=True, slots=True, kw_only=True)
class AccessControl:
    """Sign-in, audit log and TLS of one server.

    Attributes:
        people: Invitations and sessions, with the audit log.
        tls: Certificate of the server; None without TLS.
        operator: Token of the printed sign-in link; None if none is printed.
    """

    people: PeopleService
    tls: Tls | None
    operator: Token | None

    @classmethod
    def of(cls, config: Config, home: Path, *, new_operator_link: bool) -> "AccessControl":
        """Open sign-in and audit log in the home folder, and record the start in the audit log.

        Raises:
            ConfigError: the certificate is not usable.
            StoreError: sign-in data or audit log cannot be written.
        """
        folder = home / SECURITY_FOLDER
        with translate_errors(folder):
            tls = select_tls(config, folder)
        audit = AuditLog(folder)
        people = PeopleService(
            folder,
            audit=audit,
            required=config.security.sign_in == "required",
            session_lasts=timedelta(hours=config.security.session_h),
        )
        operator = people.operator_token(wanted=new_operator_link)
        audit.append(Entry(who=SERVER, what="start", changes=tuple(_printed(operator))))
        return cls(people=people, tls=tls, operator=operator)

    def follow(self, store: CaseStore) -> None:
        """Write the changes of a store to the audit log; mark those that the log has and the store has lost.

        Raises:
            StoreError: the audit log cannot be written.
        """
        store.set_change_listener(self.people.audit.record_change)
        mark_lost_changes(store, self.people.audit)

    def startup_lines(self, host: str) -> list[str]:
        """Return the lines to print when the server is ready at this host."""
        address = f"{'http' if self.tls is None else 'https'}://{host}/"
        lines = [f"Open {address}"]
        if self.operator is not None:
            lines.append(f"Sign in as operator (once): {address}enter#{self.operator.text}")
        elif not self.people.required:
            lines.append("Sign-in is off: everyone who can reach this address has full access")
        if self.tls is not None:
            lines.append(f"SHA-256 of the certificate: {self.tls.fingerprint}")
        if self.tls is not None and self.tls.is_self_signed:
            lines.append(
                "The certificate is self-signed: accept it in the browser if it shows the same SHA-256"
            )
        return lines


def _printed(operator: Token | None) -> list[dict[str, object]]:
    if operator is None:
        return []
    return [{"what": "invitation", "id": operator.id, "name": "Operator", "from": None, "to": "operator"}]

"""The door of the server: people, audit log, certificate, and what is printed about them at the start."""

from dataclasses import dataclass
from datetime import timedelta

from server.config import Config
from server.security import AuditLog, PeopleDesk
from server.security.audit import Entry
from server.security.people import Token
from server.security.person import SERVER
from server.security.tls import Tls, chosen_tls
from server.store import CaseStore, told

# A room of its own in the home: a database from a backup brings back no session that was ended.
ROOM = "security"


@dataclass(frozen=True, slots=True, kw_only=True)
class Door:
    """What stands between the network and the application.

    Attributes:
        people: who is invited and signed in, with the audit log.
        tls: the certificate to serve with; None where no TLS is spoken.
        operator: the token of the link that is printed; None where none is.
    """

    people: PeopleDesk
    tls: Tls | None
    operator: Token | None

    @classmethod
    def of(cls, config: Config, store: CaseStore, *, new_operator_link: bool) -> "Door":
        """Set it up in the home of the cases, and have the log say so.

        Raises:
            ConfigError: the certificate cannot be used.
            StoreError: people or audit log cannot be kept.
        """
        folder = store.home.folder / ROOM
        with told(folder):
            tls = chosen_tls(config, folder)
        audit = AuditLog(folder)
        people = PeopleDesk(
            folder,
            audit=audit,
            required=config.security.sign_in == "required",
            session_lasts=timedelta(hours=config.security.session_h),
        )
        operator = people.operator_token(wanted=new_operator_link)
        store.tell_changes(audit.changed)
        audit.append(Entry(who=SERVER, what="start", changes=tuple(_printed(operator))))
        return cls(people=people, tls=tls, operator=operator)

    def words(self, host: str) -> list[str]:
        """The lines that are printed when the server answers at this host."""
        address = f"{'http' if self.tls is None else 'https'}://{host}/"
        lines = [f"Open {address}"]
        if self.operator is not None:
            lines.append(f"Sign in as operator (once): {address}enter#{self.operator.text}")
        elif not self.people.required:
            lines.append("Nobody has to sign in: whoever reaches this address may do everything")
        if self.tls is not None:
            lines.append(f"SHA-256 of its certificate: {self.tls.fingerprint}")
        if self.tls is not None and self.tls.self_made:
            lines.append("The certificate is self-made: browsers ask; go on if they show the same SHA-256")
        return lines


def _printed(operator: Token | None) -> list[dict[str, object]]:
    if operator is None:
        return []
    return [{"what": "invitation", "id": operator.id, "name": "Operator", "from": None, "to": "operator"}]

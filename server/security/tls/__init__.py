"""TLS: whether it is used, and the certificate."""

from server.security.tls.selection import Tls, reject_unsafe, select_dicom_tls, select_tls

__all__ = ["Tls", "reject_unsafe", "select_dicom_tls", "select_tls"]

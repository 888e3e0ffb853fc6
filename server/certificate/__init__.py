"""Accuracy certificates: plate file, content, signature, validity, and pages to print."""

from server.certificate.content import (
    Certificate,
    CertifiedAudit,
    ExaminedSystem,
    Issue,
    calibration_sha256,
    certificate_of,
    certified_camera,
    certified_faults,
    certified_figures,
    certified_tool,
    round_up,
    tracked_tool_of,
)
from server.certificate.examination import Examination, assess, examine
from server.certificate.installed import InstalledCertificates
from server.certificate.plate_file import (
    PlateFile,
    plate_file_from,
    plate_file_in,
    printed_plate,
    printed_sheet,
    text_of_plate_file,
)
from server.certificate.sheets import certificate_pdf, certificate_sheets, fault_rows, figure_rows
from server.certificate.signature import SigningKey, existing_signer
from server.certificate.validity import (
    CameraInUse,
    SystemInUse,
    ToolInUse,
    VerifiedCertificate,
    invalidities,
    verified,
)

__all__ = [
    "CameraInUse",
    "Certificate",
    "CertifiedAudit",
    "Examination",
    "ExaminedSystem",
    "InstalledCertificates",
    "Issue",
    "PlateFile",
    "SigningKey",
    "SystemInUse",
    "ToolInUse",
    "VerifiedCertificate",
    "assess",
    "calibration_sha256",
    "certificate_of",
    "certificate_pdf",
    "certificate_sheets",
    "certified_camera",
    "certified_faults",
    "certified_figures",
    "certified_tool",
    "examine",
    "existing_signer",
    "fault_rows",
    "figure_rows",
    "invalidities",
    "plate_file_from",
    "plate_file_in",
    "printed_plate",
    "printed_sheet",
    "round_up",
    "text_of_plate_file",
    "tracked_tool_of",
    "verified",
]

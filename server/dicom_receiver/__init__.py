"""The process that receives CTs from scanners and archives, started and watched by the web process."""

from server.dicom_receiver.service import DicomReceiver, ReceiverStatus, delete_received

__all__ = ["DicomReceiver", "ReceiverStatus", "delete_received"]

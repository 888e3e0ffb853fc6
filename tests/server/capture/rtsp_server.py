"""A simulated RTSP network camera: JPEG in RTP (RFC 2435), interleaved in the connection (RFC 2326).

It sends at once what a test provides: images with any RTP time, and sender reports with any NTP time.

"""

import socketserver
import struct
import threading
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from tests.server.capture.small_videos import grey_image

RTP_HZ = 90_000
MAX_PAYLOAD_BYTES = 1400
NTP_EPOCH_S = 2_208_988_800  # from 1900, where NTP begins, to 1970
SSRC = 0x5EED
SDP = (
    "v=0\r\no=- 1 1 IN IP4 127.0.0.1\r\ns=test\r\nc=IN IP4 0.0.0.0\r\nt=0 0\r\na=control:*\r\n"
    "m=video 0 RTP/AVP 26\r\na=control:track1\r\n"
)
SOUND = "m=audio 0 RTP/AVP 0\r\na=control:track2\r\n"
DQT, SOS = 0xDB, 0xDA


@dataclass(frozen=True, slots=True, kw_only=True)
class RtpImage:
    """One image: grey level, size (multiples of 8), and sender's time.

    Attributes:
        time_s: of the RTP timestamp.
        wall_s: wall-clock time of a sender report before it; None sends no report.

    """

    grey: int
    time_s: float
    size_wh_px: tuple[int, int] = (320, 240)
    wall_s: float | None = None


class RtspServer(socketserver.ThreadingTCPServer):
    """Answers on 127.0.0.1 until it is ended.

    Attributes:
        images: sent to each client after PLAY.
        hangs_up: close the connection afterwards; otherwise it stays open and silent.
        period_s: interval of the images; 0 sends them at once.
        has_sound: offers sound beside the video.
        methods: requested so far, in order.

    """

    daemon_threads = True
    allow_reuse_address = True

    def __init__(
        self,
        images: Sequence[RtpImage],
        *,
        hangs_up: bool = False,
        period_s: float = 0.0,
        has_sound: bool = False,
    ) -> None:
        self.images = tuple(images)
        self.hangs_up = hangs_up
        self.period_s = period_s
        self.has_sound = has_sound
        self.methods: list[str] = []
        self.ended = threading.Event()
        super().__init__(("127.0.0.1", 0), _Client)
        self._thread = threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        return f"rtsp://127.0.0.1:{self.server_address[1]}/live"

    def end(self) -> None:
        self.ended.set()
        self.shutdown()
        self.server_close()
        self._thread.join()


class _Client(socketserver.StreamRequestHandler):
    def handle(self) -> None:
        server = self.server
        assert isinstance(server, RtspServer)
        try:
            while lines := self._request():
                if self._answer(lines, server):
                    self._play(server)
                    return
        except OSError:
            pass

    def _request(self) -> list[str]:
        lines: list[str] = []
        while (line := self.rfile.readline().decode().strip()) or not lines:
            if not line:
                return []
            lines.append(line)
        return lines

    def _answer(self, lines: list[str], server: RtspServer) -> bool:
        """Whether the request was PLAY."""
        method = lines[0].split()[0]
        sequence = next(line for line in lines if line.lower().startswith("cseq:"))
        server.methods.append(method)
        body = SDP + (SOUND if server.has_sound else "") if method == "DESCRIBE" else ""
        heads = {
            "OPTIONS": ["Public: OPTIONS, DESCRIBE, SETUP, PLAY, TEARDOWN"],
            "DESCRIBE": ["Content-Type: application/sdp", f"Content-Length: {len(body)}"],
            "SETUP": ["Transport: RTP/AVP/TCP;unicast;interleaved=0-1", "Session: 1"],
            "PLAY": ["Session: 1", "Range: npt=0.000-"],
        }.get(method, [])
        self.wfile.write(("\r\n".join(["RTSP/1.0 200 OK", sequence, *heads, "", ""]) + body).encode())
        return method == "PLAY"

    def _play(self, server: RtspServer) -> None:
        number = 0
        for image in server.images:
            if image.wall_s is not None:
                self._send(1, sender_report(image))
            for packet in rtp_packets(image, number):
                self._send(0, packet)
                number += 1
            if server.period_s and server.ended.wait(server.period_s):
                return
        if not server.hangs_up:
            server.ended.wait()

    def _send(self, channel: int, packet: bytes) -> None:
        self.wfile.write(struct.pack(">cBH", b"$", channel, len(packet)) + packet)


def rtp_time(image: RtpImage) -> int:
    return round(image.time_s * RTP_HZ) % 2**32


def sender_report(image: RtpImage) -> bytes:
    seconds = (image.wall_s or 0.0) + NTP_EPOCH_S
    whole = int(seconds)
    fraction = int((seconds - whole) * 2**32)
    return struct.pack(">BBHIIIIII", 0x80, 200, 6, SSRC, whole, fraction, rtp_time(image), 0, 0)


def rtp_packets(image: RtpImage, number: int) -> list[bytes]:
    """The packets of one image, starting with this number."""
    width, height = image.size_wh_px
    tables, scan = jpeg_parts(np.asarray(grey_image(image.grey, image.size_wh_px)))
    packets: list[bytes] = []
    offset = 0
    while offset < len(scan):
        # Type 1 is 4:2:0; quality 255 has its own tables, in the first packet.
        payload = struct.pack(">I", offset) + bytes((1, 255, width // 8, height // 8))
        if offset == 0:
            payload += struct.pack(">BBH", 0, 0, len(tables)) + tables
        part = scan[offset : offset + MAX_PAYLOAD_BYTES]
        offset += len(part)
        marker = 0x80 if offset == len(scan) else 0
        head = struct.pack(
            ">BBHII", 0x80, marker | 26, (number + len(packets)) % 65536, rtp_time(image), SSRC
        )
        packets.append(head + payload + part)
    return packets


def jpeg_parts(image: np.ndarray) -> tuple[bytes, bytes]:
    """The quantisation tables and the coded scan of a JPEG, whose Huffman tables are those of RFC 2435."""
    content = cv2.imencode(".jpg", image)[1].tobytes()
    tables, place = b"", 2
    while True:
        kind, length = content[place + 1], int.from_bytes(content[place + 2 : place + 4], "big")
        segment = content[place + 4 : place + 2 + length]
        place += 2 + length
        if kind == DQT:
            tables += b"".join(segment[at + 1 : at + 65] for at in range(0, len(segment), 65))
        if kind == SOS:
            return tables, content[place:-2]

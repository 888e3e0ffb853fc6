"""Pages of a certificate for printing: result, figures, what it is valid for, and the map of the volume."""

from collections.abc import Iterable, Iterator, Sequence

from server.certificate.content import Certificate, CertifiedFault, CertifiedFigure, CertifiedVolume
from server.certificate.signature import SigningKey
from server.printing import PAPER_MM, Attachment, Disc, Fill, Label, Line, Sheet, pdf_from_sheets
from server.printing.sheet import Mark, Point, rectangle

LEFT_MM, TOP_MM, LINE_MM = 20.0, 22.0, 5.2
TEXT_MM, SMALL_MM = 3.6, 3.0
FIGURES = {
    "point_rms_mm": ("Error of a single tip (RMS)", "mm"),
    "point_bias_mm": ("Bias: error of the mean tip of a divot (RMS)", "mm"),
    "point_precision_mm": ("Precision: captures about the mean of their divot (RMS)", "mm"),
    "distance_rms_mm": ("Error of distances between divots (RMS)", "mm"),
    "repeatability_mm": ("Repeatability: same divot and posture again (RMS)", "mm"),
    "jitter_mm": ("Jitter of the tip at rest (RMS)", "mm"),
    "orientation_rms_deg": ("Error of the direction tip to marker, at most (RMS)", "deg"),
    "orientation_jitter_deg": ("Jitter of the orientation at rest (RMS)", "deg"),
    "inside_stated_95_ratio": ("Tips inside their stated 95 % region", "%"),
}
FAULTS = {
    "scale": ("Scale of plate and marker", "%"),
    "tip_offset": ("Offset of the tip", "mm"),
    "focal_length": ("Focal length", "%"),
}
MAX_DIVOT_ROWS = 40
MAP_WIDTH_MM, MAP_HEIGHT_MM = 150.0, 90.0
# Brightness of the cells of the map: at most the certified error, at most twice, more than twice.
LEVELS = ((1.0, 0.93), (2.0, 0.75), (float("inf"), 0.5))


def certificate_sheets(certificate: Certificate, *, signer: str) -> tuple[Sheet, Sheet]:
    """Return the two pages of a certificate, A4."""
    size = PAPER_MM["A4"]
    white = Fill(corners_mm=rectangle(0.0, 0.0, *size), white=True)
    return (
        Sheet(
            title="Accuracy certificate",
            size_mm=size,
            marks=(white, *_first_page(certificate, signer)),
        ),
        Sheet(title="Accuracy certificate, volume", size_mm=size, marks=(white, *_second_page(certificate))),
    )


def certificate_pdf(certificate: Certificate, signed_json: bytes, key: SigningKey) -> bytes:
    """Return the signed PDF of a certificate, with its signed JSON attached."""
    sheets = certificate_sheets(certificate, signer=key.signer)
    attachment = Attachment(name="certificate.json", content=signed_json)
    return key.signed_pdf(pdf_from_sheets(sheets, attachment=attachment))


def figure_rows(figures: Iterable[CertifiedFigure]) -> list[tuple[str, str, str, str]]:
    """Return title, value, 95 % interval and number of samples of each figure."""
    rows = []
    for one in figures:
        title, unit = FIGURES.get(one.name, (one.name, ""))
        value, low, high = (_number(number, unit) for number in (one.value, one.low, one.high))
        rows.append((title, f"{value} {unit}", f"{low} to {high} {unit}", str(one.samples)))
    return rows


def fault_rows(faults: Iterable[CertifiedFault]) -> list[tuple[str, str, str, str]]:
    """Return title, value, standard deviation and upper 95 % limit of each fault."""
    rows = []
    for one in faults:
        title, unit = FAULTS.get(one.fault, (one.fault, ""))
        size = sum(value**2 for value in one.value) ** 0.5 if len(one.value) > 1 else one.value[0]
        value, sd, limit = (_number(number, unit) for number in (size, one.sd, one.max_size))
        rows.append((title, f"{value} {unit}", f"sd {sd} {unit}", f"{limit} {unit}"))
    return rows


def _number(value: float, unit: str) -> str:
    return f"{100.0 * value:.2f}" if unit == "%" else f"{value:.3f}"


def _first_page(certificate: Certificate, signer: str) -> Iterator[Mark]:
    yield Label(text="Coaxial: certificate of accuracy", at_mm=(LEFT_MM, TOP_MM), size_mm=7.0)
    yield Label(
        text=f"Certified to {certificate.error_95_mm:.2f} mm until "
        f"{certificate.valid_until:%Y-%m-%d %H:%M} UTC",
        at_mm=(LEFT_MM, TOP_MM + 11.0),
        size_mm=6.0,
    )
    text = (
        "With a confidence of 95 %, at least 95 % of single tips lie within this distance of the truth, "
        "relative to each other,",
        f"at each tested distance:  x {_range(certificate, 0)}, y {_range(certificate, 1)}, "
        f"z {_range(certificate, 2)} mm in the camera's frame.",
        f"{certificate.captures} captures of {certificate.divots} divots in {certificate.placements} "
        "placements.",
        f"{certificate.standard}.",
        "Research software, not a medical device.",
    )
    row = TOP_MM + 19.0
    yield from _texts(text, row)
    row += LINE_MM * (len(text) + 1)
    header = ("Figure", "Value", "95 % interval", "Samples")
    yield from _table([header, *figure_rows(certificate.figures)], row)
    row += LINE_MM * (len(certificate.figures) + 1)
    largest = f"Largest error of a distance between two divots: {certificate.max_distance_error_mm:.2f} mm."
    yield from _texts([largest], row)
    row += 2.0 * LINE_MM
    yield from _table([("Fault", "Estimate", "", "Excluded above"), *fault_rows(certificate.faults)], row)
    row += LINE_MM * (len(certificate.faults) + 2)
    yield from _texts(_ties(certificate, signer), row)


def _ties(certificate: Certificate, signer: str) -> list[str]:
    camera, tool, plate = certificate.camera, certificate.tool, certificate.plate
    controls = ", ".join(f"{name} {value}" for name, value in sorted(camera.controls.items())) or "not stated"
    latency, audit = certificate.latency, certificate.audit
    return [
        "Valid only for this camera, lens, calibration, tool and version, and void with any change of them:",
        f"Camera {_cut(camera.name or camera.source or camera.device or 'without a name', 50)}, "
        f"{camera.size_wh_px[0]}x{camera.size_wh_px[1]} px, focal length {camera.focal_px[0]:.1f} and "
        f"{camera.focal_px[1]:.1f} px; controls: {_cut(controls, 40)}",
        f"    calibration SHA-256 {camera.calibration_sha256}",
        f"Tool with marker {tool.marker}, side {tool.side_mm:g} mm, tip "
        f"{', '.join(f'{value:.2f}' for value in tool.tip_in_marker_mm)} mm",
        f"Plate {_cut(plate.name, 40)}: {plate.divots} divots, rulers {plate.scale_x_ratio:.2%} and "
        f"{plate.scale_y_ratio:.2%} of their length (sd {plate.scale_sd_ratio:.2%})",
        f"Coaxial {certificate.software_version}",
        "Latency: not measured"
        if latency is None
        else f"Latency from light to page: median {latency.median_ms:.0f} ms, 99th percentile "
        f"{latency.p99_ms:.0f} ms (uncertainty {latency.uncertainty_ms:.0f} ms, {latency.samples} samples)",
        "Audit log: none on this computer"
        if audit is None
        else f"Audit log: {audit.lines} lines, SHA-256 of the last {audit.sha256}",
        f"Issued {certificate.issued_at:%Y-%m-%d %H:%M} UTC"
        + (f" by {_cut(certificate.issued_by, 60)}" if certificate.issued_by else ""),
        f"Signed (Ed25519) with the public key {signer}",
        "Check it with 'coaxial certify check FILE --signer KEY', with the key as its issuer states it.",
    ]


def _second_page(certificate: Certificate) -> Iterator[Mark]:
    yield Label(text="Where the camera sees well enough", at_mm=(LEFT_MM, TOP_MM), size_mm=5.0)
    note = (
        "Seen from above: x to the right, distance z upwards, camera below. Dots are the captured tips.",
        f"Light: at most {certificate.error_95_mm:.2f} mm; grey: at most twice that; dark: more; white: "
        "marker not in view.",
        "A prediction from the geometry of camera and marker, scaled to the measured error; only the box of",
        "the captured tips is certified.",
    )
    yield from _texts(note, TOP_MM + 7.0)
    top = TOP_MM + 33.0
    yield from _map(certificate.volume, certificate.error_95_mm, (LEFT_MM + 12.0, top))
    row = top + MAP_HEIGHT_MM + 18.0
    rows = [
        (one.placement, one.divot, f"{one.bias_mm:.2f}", f"{one.spread_mm:.2f}", str(one.captures))
        for one in certificate.errors_by_divot[:MAX_DIVOT_ROWS]
    ]
    header = ("Placement", "Divot", "Bias mm", "Spread mm", "Captures")
    half = -(-len(rows) // 2)
    yield from _table([header, *rows[:half]], row, columns_mm=(0.0, 24.0, 38.0, 54.0, 72.0))
    if rows[half:]:
        yield from _table([header, *rows[half:]], row, columns_mm=(90.0, 114.0, 128.0, 144.0, 162.0))
    rest = len(certificate.errors_by_divot) - len(rows)
    if rest > 0:
        yield from _texts([f"{rest} more are in the attached file."], row + LINE_MM * (half + 2))


def _map(volume: CertifiedVolume, error_mm: float, at_mm: Point) -> Iterator[Mark]:
    """Yield cells, tips, frame and scales; x to the right, z upwards."""
    (left, top), x, z = at_mm, volume.map_x_mm, volume.map_z_mm
    step_x, step_z = x[1] - x[0], z[1] - z[0]
    width, height = x[-1] - x[0] + step_x, z[-1] - z[0] + step_z
    scale = min(MAP_WIDTH_MM / width, MAP_HEIGHT_MM / height)

    def place(x_mm: float, z_mm: float) -> Point:
        return left + (x_mm - x[0] + step_x / 2.0) * scale, top + (z[-1] + step_z / 2.0 - z_mm) * scale

    for row, z_mm in enumerate(z):
        for column, x_mm in enumerate(x):
            value = volume.map_error_95_mm[row][column]
            if value is not None:
                level = next(grey for factor, grey in LEVELS if value <= factor * error_mm)
                corner = place(x_mm - step_x / 2.0, z_mm + step_z / 2.0)
                yield Fill(corners_mm=rectangle(*corner, step_x * scale, step_z * scale), grey_ratio=level)
    for x_mm, z_mm in volume.tips_xz_mm:
        yield Disc(centre_mm=place(x_mm, z_mm), radius_mm=0.5)
    frame = rectangle(left, top, width * scale, height * scale)
    for start, end in zip(frame, (*frame[1:], frame[0]), strict=True):
        yield Line(start_mm=start, end_mm=end)
    for x_mm in x[:: max(1, len(x) // 5)]:
        at = place(x_mm, z[0] - step_z / 2.0)
        yield Label(text=f"{x_mm:.0f}", at_mm=(at[0] - 3.0, at[1] + 4.5), size_mm=SMALL_MM)
    for z_mm in z[:: max(1, len(z) // 5)]:
        yield Label(text=f"{z_mm:.0f}", at_mm=(left - 11.0, place(x[0], z_mm)[1] + 1.0), size_mm=SMALL_MM)
    yield Label(text="x mm", at_mm=(left + width * scale + 2.0, place(0.0, z[0])[1] + 4.5), size_mm=SMALL_MM)
    yield Label(text="z mm", at_mm=(left - 11.0, top - 3.0), size_mm=SMALL_MM)


def _texts(lines: Sequence[str], row_mm: float) -> Iterator[Label]:
    for number, line in enumerate(lines):
        yield Label(text=line, at_mm=(LEFT_MM, row_mm + number * LINE_MM), size_mm=SMALL_MM)


def _table(
    rows: Sequence[Sequence[str]],
    row_mm: float,
    columns_mm: Sequence[float] = (0.0, 90.0, 112.0, 150.0),
) -> Iterator[Mark]:
    for number, row in enumerate(rows):
        at = row_mm + number * LINE_MM
        for text, column in zip(row, columns_mm, strict=True):
            yield Label(text=_cut(text, 60), at_mm=(LEFT_MM + column, at), size_mm=SMALL_MM)
        if number == 0:
            end = LEFT_MM + columns_mm[-1] + 18.0
            yield Line(start_mm=(LEFT_MM + columns_mm[0], at + 1.3), end_mm=(end, at + 1.3), width_mm=0.15)


def _cut(text: str, length: int) -> str:
    return text if len(text) <= length else f"{text[: length - 3]}..."


def _range(certificate: Certificate, axis: int) -> str:
    volume = certificate.volume
    return f"{volume.min_mm[axis]:.0f} to {volume.max_mm[axis]:.0f}"

"""Messages of errors of accuracy tests and their certificates, by code."""

from collections.abc import Mapping

from server.texts.language import Text

CERTIFICATE: Mapping[str, tuple[Text, ...]] = {
    "ACCURACY_CAPTURE_ORDER": (
        {
            "en": "the next capture is {due}, not {requested}",
            "de": "die nächste Aufnahme ist {due}, nicht {requested}",
        },
    ),
    "ACCURACY_CAPTURE_MOVED": (
        {
            "en": "the tip moved in the capture {capture}: standard deviation {sd_mm:.2f} mm, allowed "
            "{allowed_mm:g} mm; {off_mm:.2f} mm from the mean at most, allowed {allowed_off_mm:g} mm",
            "de": "die Spitze hat sich in der Aufnahme {capture} bewegt: Standardabweichung {sd_mm:.2f} mm, "
            "erlaubt {allowed_mm:g} mm; höchstens {off_mm:.2f} mm vom Mittel, erlaubt {allowed_off_mm:g} mm",
        },
    ),
    "ACCURACY_CAPTURE_REPEATED": (
        {
            "en": "the captures {capture} and {again} have the same poses",
            "de": "die Aufnahmen {capture} und {again} haben dieselben Lagen",
        },
    ),
    "ACCURACY_CAPTURE_SHORT": (
        {
            "en": "the capture {capture} has {images} different images, needed {needed}",
            "de": "die Aufnahme {capture} hat {images} verschiedene Bilder, nötig {needed}",
        },
    ),
    "ACCURACY_COVARIANCE_MISSING": (
        {
            "en": "the captured poses state no covariance, so that the stated errors cannot be checked",
            "de": "die aufgenommenen Lagen haben keine Kovarianz, die angegebenen Fehler sind nicht prüfbar",
        },
    ),
    "ACCURACY_ERROR_TOO_LARGE": (
        {
            "en": "95 % of the tips are within {error_95_mm:.2f} mm, allowed {allowed_mm:.2f} mm",
            "de": "95 % der Spitzen liegen innerhalb von {error_95_mm:.2f} mm, erlaubt {allowed_mm:.2f} mm",
        },
    ),
    "ACCURACY_FAULT_AMBIGUOUS": (
        {
            "en": "the residuals show a systematic fault that these captures do not tell apart: {faults}",
            "de": "die Restfehler zeigen einen systematischen Fehler, den diese Aufnahmen nicht "
            "unterscheiden: {faults}",
        },
    ),
    "ACCURACY_FAULT_NOT_EXCLUDED": (
        {
            "en": "{fault_phrase} of up to {size} is not excluded by these captures, allowed {allowed}",
            "de": "{fault_phrase} bis {size} ist durch diese Aufnahmen nicht ausgeschlossen, erlaubt "
            "{allowed}",
        },
    ),
    "ACCURACY_FOCAL_LENGTH": (
        {
            "en": "the focal length of the camera is stated {size_ratio:.2%} (sd {sd_ratio:.2%}) too "
            "{wrong_way}, allowed {allowed_ratio:.2%} with its uncertainty",
            "de": "die Brennweite der Kamera ist {size_ratio:.2%} (SD {sd_ratio:.2%}) zu {wrong_way} "
            "angegeben, erlaubt {allowed_ratio:.2%} mit der Unsicherheit",
        },
    ),
    "ACCURACY_MARKER_SCALE": (
        {
            "en": "distances measure {size_ratio:.2%} (sd {sd_ratio:.2%}) too {wrong_way} on a plate whose "
            "rulers were measured, allowed {allowed_ratio:.2%} with its uncertainty: the stated side of the "
            "marker is too {wrong_way}",
            "de": "Abstände messen {size_ratio:.2%} (SD {sd_ratio:.2%}) zu {wrong_way} auf einer Platte mit "
            "gemessenen Maßstäben, erlaubt {allowed_ratio:.2%} mit der Unsicherheit: die angegebene Seite "
            "des Markers ist zu {wrong_way}",
        },
    ),
    "ACCURACY_NOTHING_CAPTURED": (
        {"en": "there is no capture to discard", "de": "es gibt keine Aufnahme zu verwerfen"},
    ),
    "ACCURACY_PLACEMENT_SMALL": (
        {
            "en": "the placement '{placement}' has {captures} captures of {divots} divots, needed "
            "{needed} divots and {needed_more} captures more than divots",
            "de": "die Aufstellung „{placement}“ hat {captures} Aufnahmen von {divots} Mulden, nötig "
            "{needed} Mulden und {needed_more} Aufnahmen mehr als Mulden",
        },
    ),
    "ACCURACY_PLATE_SCALE": (
        {
            "en": "the plate is printed {size_ratio:.2%} too {wrong_way} by its rulers, allowed "
            "{allowed_ratio:.2%}",
            "de": "die Platte ist nach ihren Maßstäben {size_ratio:.2%} zu {wrong_way} gedruckt, erlaubt "
            "{allowed_ratio:.2%}",
        },
    ),
    "ACCURACY_PLATE_UNMEASURED": (
        {
            "en": "the rulers of the printed plate were not measured, so that its scale is unknown",
            "de": "die Maßstäbe der gedruckten Platte wurden nicht gemessen, ihre Größe ist unbekannt",
        },
    ),
    "ACCURACY_POSTURE_REPEATED": (
        {
            "en": "the tool is rotated by {rotation_deg:.1f} degrees between the captures {other} and "
            "{capture}, needed {needed_deg:g} degrees",
            "de": "das Instrument ist zwischen den Aufnahmen {other} und {capture} um {rotation_deg:.1f}° "
            "gedreht, nötig {needed_deg:g}°",
        },
    ),
    "ACCURACY_PRINT_SCALE": (
        {
            "en": "the plate is printed {size_ratio:.2%} (sd {sd_ratio:.2%}) too {wrong_way}, or the stated "
            "side of the marker is too {wrong_way}, allowed {allowed_ratio:.2%} with its uncertainty",
            "de": "die Platte ist {size_ratio:.2%} (SD {sd_ratio:.2%}) zu {wrong_way} gedruckt, oder die "
            "angegebene Seite des Markers ist zu {wrong_way}, erlaubt {allowed_ratio:.2%} mit der "
            "Unsicherheit",
        },
    ),
    "ACCURACY_STATED_TOO_SMALL": (
        {
            "en": "only {inside_ratio:.0%} of the tips are inside their stated 95 % region (95 % interval "
            "{low_ratio:.0%} to {high_ratio:.0%})",
            "de": "nur {inside_ratio:.0%} der Spitzen liegen in ihrem angegebenen 95-%-Bereich "
            "(95-%-Intervall {low_ratio:.0%} bis {high_ratio:.0%})",
        },
    ),
    "ACCURACY_SYSTEM_CHANGED": (
        {
            "en": "the camera, the tool or a calibration has changed during the accuracy test",
            "de": "Kamera, Instrument oder eine Kalibrierung wurde während des Genauigkeitstests geändert",
        },
    ),
    "ACCURACY_TEST_COMPLETE": (
        {
            "en": "all {captures} captures of the accuracy test are taken",
            "de": "alle {captures} Aufnahmen des Genauigkeitstests sind gemacht",
        },
    ),
    "ACCURACY_TEST_INCOMPLETE": (
        {
            "en": "{captures} of {planned} captures of the accuracy test are taken",
            "de": "{captures} von {planned} Aufnahmen des Genauigkeitstests sind gemacht",
        },
    ),
    "ACCURACY_TIP_OFFSET": (
        {
            "en": "the tip of the tool is {size_mm:.2f} mm (sd {sd_mm:.2f}) from where it is stated, allowed "
            "{allowed_mm:.2f} mm with its uncertainty",
            "de": "die Spitze des Instruments liegt {size_mm:.2f} mm (SD {sd_mm:.2f}) neben der Angabe, "
            "erlaubt {allowed_mm:.2f} mm mit der Unsicherheit",
        },
    ),
    "ACCURACY_TIP_UNSEEN": (
        {
            "en": "the tip was measured in {seen} of {images} images of the capture {capture}, needed "
            "{needed}",
            "de": "die Spitze wurde in {seen} von {images} Bildern der Aufnahme {capture} gemessen, nötig "
            "{needed}",
        },
    ),
    "ACCURACY_TOO_FEW_CAPTURES": (
        {
            "en": "{captures} captures of {divots} divots in {placements} placements leave {between:g} "
            "degrees of freedom between divots and {within} within them, needed {needed} captures and "
            "{needed_freedom:g} degrees of freedom",
            "de": "{captures} Aufnahmen von {divots} Mulden in {placements} Aufstellungen lassen {between:g} "
            "Freiheitsgrade zwischen den Mulden und {within} in ihnen, nötig {needed} Aufnahmen und "
            "{needed_freedom:g} Freiheitsgrade",
        },
    ),
    "ACCURACY_WRONG_DIVOT": (
        {
            "en": "the tip is {off_mm:.1f} mm from its divot in the capture {capture}; the nearest divot is "
            "'{nearest}'",
            "de": "die Spitze liegt in der Aufnahme {capture} {off_mm:.1f} mm neben ihrer Mulde; die nächste "
            "Mulde ist „{nearest}“",
        },
    ),
    "CERTIFICATE_ALTERED": (
        {
            "en": "the certificate was altered after it was signed",
            "de": "das Zertifikat wurde nach dem Signieren verändert",
        },
    ),
    "CERTIFICATE_CAMERA_CHANGED": (
        {
            "en": "the camera, its lens or its calibration has changed since the certificate was issued",
            "de": "Kamera, Objektiv oder Kalibrierung wurden nach der Ausstellung des Zertifikats geändert",
        },
    ),
    "CERTIFICATE_EXPIRED": (
        {
            "en": "the certificate was valid until {valid_until:%Y-%m-%d}",
            "de": "das Zertifikat war gültig bis {valid_until:%Y-%m-%d}",
        },
    ),
    "CERTIFICATE_FROM_THE_FUTURE": (
        {
            "en": "the certificate was issued at {issued_at:%Y-%m-%d %H:%M} UTC, after the time of this "
            "computer",
            "de": "das Zertifikat wurde um {issued_at:%Y-%m-%d %H:%M} UTC ausgestellt, nach der Zeit dieses "
            "Computers",
        },
    ),
    "CERTIFICATE_KEY_DAMAGED": (
        {"en": "the key in {file} cannot be read", "de": "der Schlüssel in {file} ist nicht lesbar"},
    ),
    "CERTIFICATE_MISSING": (
        {
            "en": "no accuracy certificate is installed for the marker '{marker}'",
            "de": "für den Marker „{marker}“ ist kein Genauigkeitszertifikat installiert",
        },
    ),
    "CERTIFICATE_NOT_APPLICABLE": (
        {
            "en": "the camera is not calibrated, or its focus or zoom has changed: no certificate applies",
            "de": "die Kamera ist nicht kalibriert, oder Schärfe oder Zoom wurde verstellt: kein Zertifikat "
            "gilt",
        },
        {
            "en": "the poses come from an external tracker: no certificate of a camera applies",
            "de": "die Lagen kommen von einem externen Trackingsystem: kein Zertifikat einer Kamera gilt",
        },
    ),
    "CERTIFICATE_PERIOD_INVALID": (
        {
            "en": "a certificate cannot be valid for {days} days, allowed 1 to {max_days}",
            "de": "ein Zertifikat kann nicht {days} Tage gültig sein, erlaubt 1 bis {max_days}",
        },
    ),
    "CERTIFICATE_REFUSED": (
        {
            "en": "an accuracy test with {problems} problems is not certified",
            "de": "ein Genauigkeitstest mit {problems} Problemen wird nicht zertifiziert",
        },
    ),
    "CERTIFICATE_SIGNER_UNKNOWN": (
        {
            "en": "the certificate is not signed by this installation",
            "de": "das Zertifikat ist nicht von dieser Installation signiert",
        },
    ),
    "CERTIFICATE_SOFTWARE_CHANGED": (
        {
            "en": "the certificate was issued with version {certified} of Coaxial, in use is {version}",
            "de": "das Zertifikat wurde mit Version {certified} von Coaxial ausgestellt, benutzt wird "
            "{version}",
        },
    ),
    "CERTIFICATE_TOOL_CHANGED": (
        {
            "en": "the tool, its marker or its calibration has changed since the certificate was issued",
            "de": "Instrument, Marker oder Kalibrierung wurden nach der Ausstellung des Zertifikats geändert",
        },
    ),
    "CERTIFICATE_UNREADABLE": (
        {"en": "the file is not a certificate", "de": "die Datei ist kein Zertifikat"},
        {"en": "the PDF is not a certificate", "de": "das PDF ist kein Zertifikat"},
        {
            "en": "the certificate has {values} values that this version does not know",
            "de": "das Zertifikat hat {values} Werte, die diese Version nicht kennt",
        },
    ),
    "DIVOT_UNKNOWN": (
        {
            "en": "the plate '{plate}' has no divot '{divot}'",
            "de": "die Platte „{plate}“ hat keine Mulde „{divot}“",
        },
    ),
    "PLATE_FILE_INVALID": (
        {
            "en": "the plate file cannot be used: {why}",
            "de": "die Plattendatei ist nicht brauchbar: {why}",
        },
    ),
    "PLATE_FILE_UNREADABLE": (
        {
            "en": "the plate file is neither valid YAML nor JSON",
            "de": "die Plattendatei ist weder gültiges YAML noch JSON",
        },
    ),
    "PLATE_INVALID": (
        {
            "en": "the plate '{plate}' cannot be used: {plate_problem}",
            "de": "die Platte „{plate}“ ist nicht brauchbar: {plate_problem}",
        },
        {
            "en": "a plate of {columns}x{rows} divots with a pitch of {pitch_mm:g} mm cannot be used",
            "de": "eine Platte mit {columns}x{rows} Mulden im Abstand {pitch_mm:g} mm ist nicht brauchbar",
        },
    ),
    "PLATE_RULERS_INVALID": (
        {"en": "the plate '{plate}' has no rulers", "de": "die Platte „{plate}“ hat keine Maßstäbe"},
        {
            "en": "rulers of {rulers_mm:g} mm cannot have {x_mm:g} and {y_mm:g} mm",
            "de": "Maßstäbe von {rulers_mm:g} mm können nicht {x_mm:g} und {y_mm:g} mm haben",
        },
    ),
    "PLATE_TOO_LARGE": (
        {
            "en": "the plate needs {needed_mm[0]:.1f} x {needed_mm[1]:.1f} mm, but {paper} has "
            "{free_mm[0]:.1f} x {free_mm[1]:.1f} mm in portrait orientation",
            "de": "die Platte braucht {needed_mm[0]:.1f} x {needed_mm[1]:.1f} mm, aber {paper} hat hochkant "
            "{free_mm[0]:.1f} x {free_mm[1]:.1f} mm",
        },
    ),
}

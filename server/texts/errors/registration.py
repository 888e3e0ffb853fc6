"""Messages of errors of registration and its check, by code."""

from collections.abc import Mapping

from server.texts.language import Text

REGISTRATION: Mapping[str, tuple[Text, ...]] = {
    "CAMERA_NOT_CALIBRATED": (
        {
            "en": "the camera is not calibrated, so that no position in mm can be measured",
            "de": "die Kamera ist nicht kalibriert, daher kann keine Position in mm gemessen werden",
        },
        {
            "en": "the camera is not calibrated, so that needles cannot be measured in mm",
            "de": "die Kamera ist nicht kalibriert, daher können Nadeln nicht in mm gemessen werden",
        },
        {
            "en": "the camera is not calibrated, so that no poses in mm can be measured",
            "de": "die Kamera ist nicht kalibriert, daher können keine Lagen in mm gemessen werden",
        },
    ),
    "CAPTURE_INTERRUPTED": (
        {
            "en": "{gap_s:.2f} s passed between two of {images} images, allowed {allowed_s:.2f} s at "
            "{rate_hz:.1f} images/s: the tip could have moved in between",
            "de": "zwischen zwei von {images} Bildern vergingen {gap_s:.2f} s, erlaubt {allowed_s:.2f} s "
            "bei {rate_hz:.1f} Bildern/s: die Spitze kann sich dazwischen bewegt haben",
        },
    ),
    "CAPTURE_MOVED": (
        {
            "en": "the tip moved: it spreads by {spread_mm:.2f} mm (standard deviation, allowed "
            "{allowed_mm:g}) and by {max_off_mm:.2f} mm at most (allowed {allowed_off_mm:g})",
            "de": "die Spitze bewegte sich: sie streut um {spread_mm:.2f} mm (Standardabweichung, erlaubt "
            "{allowed_mm:g}) und um höchstens {max_off_mm:.2f} mm (erlaubt {allowed_off_mm:g})",
        },
    ),
    "CAPTURE_RATE_TOO_LOW": (
        {
            "en": "{needed} images take {hold_s:.1f} s at {rate_hz:.1f} images/s, allowed {max_s:g} s",
            "de": "{needed} Bilder brauchen {hold_s:.1f} s bei {rate_hz:.1f} Bildern/s, erlaubt {max_s:g} s",
        },
    ),
    "CAPTURE_TOO_SHORT": (
        {
            "en": "there are {images} images over {lasted_s:.2f} s, needed {needed} over {min_s:g} s",
            "de": "es gibt {images} Bilder in {lasted_s:.2f} s, nötig {needed} in {min_s:g} s",
        },
        {
            "en": "there are {images} images over {lasted_s:.2f} s at {rate_hz:.1f} images/s, needed "
            "{needed} over {min_s:g} s",
            "de": "es gibt {images} Bilder in {lasted_s:.2f} s bei {rate_hz:.1f} Bildern/s, nötig {needed} "
            "in {min_s:g} s",
        },
    ),
    "CAPTURE_UNCERTAIN": (
        {
            "en": "the tip's uncertainty is {tip_sd_mm:.1f} mm in the worst image, allowed {allowed_mm:g} mm",
            "de": "die Unsicherheit der Spitze ist im schlechtesten Bild {tip_sd_mm:.1f} mm, erlaubt "
            "{allowed_mm:g} mm",
        },
    ),
    "CHECK_NOT_CAPTURED": (
        {
            "en": "the tip was seen in {images} images, needed {needed}",
            "de": "die Spitze war in {images} Bildern zu sehen, nötig {needed}",
        },
        {
            "en": "the tip was seen in {images} images at {rate_hz:.1f} images/s, needed {needed}",
            "de": "die Spitze war in {images} Bildern bei {rate_hz:.1f} Bildern/s zu sehen, nötig {needed}",
        },
    ),
    "LANDMARKS_TOO_FEW": (
        {
            "en": "the plan has {landmarks} landmarks on {vertebra}, the minimum is {needed}",
            "de": "die Planung hat {landmarks} Landmarken auf {vertebra}, mindestens {needed}",
        },
    ),
    "LANDMARK_CHECK_FAILED": (
        {
            "en": "on '{landmark}' the tip is displayed {distance_mm:.1f} mm off, allowed {allowed_mm:g} mm "
            "(left {left_mm:+.1f}, back {back_mm:+.1f}, head {head_mm:+.1f} mm)",
            "de": "an „{landmark}“ wird die Spitze {distance_mm:.1f} mm daneben angezeigt, erlaubt "
            "{allowed_mm:g} mm (links {left_mm:+.1f}, hinten {back_mm:+.1f}, kopfwärts {head_mm:+.1f} mm)",
        },
    ),
    "LANDMARK_NOT_TOUCHED": (
        {
            "en": "the landmark '{landmark}' has not been captured",
            "de": "die Landmarke „{landmark}“ ist nicht angetastet",
        },
    ),
    "LANDMARK_UNKNOWN": (
        {
            "en": "the vertebra has no landmark '{landmark}'",
            "de": "der Wirbel hat keine Landmarke „{landmark}“",
        },
    ),
    "LANDMARK_WAS_USED": (
        {
            "en": "'{landmark}' lies {apart_mm:.1f} mm from '{used}', which was used for the registration; "
            "needed {needed_mm:g} mm",
            "de": "„{landmark}“ liegt {apart_mm:.1f} mm von „{used}“, die zur Registrierung diente; nötig "
            "{needed_mm:g} mm",
        },
    ),
    "NEEDLES_AMBIGUOUS": (
        {
            "en": "two poses, {turned_deg:.0f} deg apart, fit the needles: the second is worse by "
            "{delta_chi2:.1f} in chi squared, needed {needed_delta_chi2:g}",
            "de": "zwei Lagen, {turned_deg:.0f}° verschieden, passen zu den Nadeln: die zweite ist um "
            "{delta_chi2:.1f} in Chi-Quadrat schlechter, nötig {needed_delta_chi2:g}",
        },
    ),
    "NEEDLES_COLLINEAR": (
        {
            "en": "the needles are within {across_mm:.1f} mm of one straight line, needed {needed_mm:g} mm",
            "de": "die Nadeln liegen bis auf {across_mm:.1f} mm auf einer Geraden, nötig {needed_mm:g} mm",
        },
    ),
    "NEEDLES_NOT_FITTED": (
        {"en": "the slice was placed without a fit", "de": "die Schicht liegt ohne Anpassung im Bild"},
    ),
    "NEEDLES_NOT_FOUND": (
        {
            "en": "{found} needles were found in the image, {planned} are planned",
            "de": "{found} Nadeln wurden im Bild gefunden, geplant sind {planned}",
        },
    ),
    "NEEDLES_TOO_CLOSE": (
        {
            "en": "needles '{one}' and '{other}' are {apart_mm:.1f} mm apart, needed {needed_mm:g} mm",
            "de": "die Nadeln „{one}“ und „{other}“ sind {apart_mm:.1f} mm auseinander, nötig {needed_mm:g} "
            "mm",
        },
    ),
    "NEEDLES_TOO_FEW": (
        {
            "en": "0 needles are planned, the slice is aligned with 3",
            "de": "0 Nadeln sind geplant, die Schicht wird mit 3 ausgerichtet",
        },
        {
            "en": "{needles} needles are planned, needed {needed}",
            "de": "{needles} Nadeln sind geplant, nötig {needed}",
        },
    ),
    "NEEDLES_UNPAIRED": (
        {
            "en": "{marked} needles are marked, but {planned} are planned",
            "de": "{marked} Nadeln sind markiert, geplant sind {planned}",
        },
        {
            "en": "{planned} needles are planned and {marked} are marked in the image",
            "de": "{planned} Nadeln sind geplant, im Bild markiert sind {marked}",
        },
    ),
    "NEEDLE_OFF_ITS_PLACE": (
        {
            "en": "needle '{needle}' is {offset_mm:.1f} mm ({offset_px:.1f} px) off its place, allowed "
            "{allowed_mm:g} mm",
            "de": "Nadel „{needle}“ ist {offset_mm:.1f} mm ({offset_px:.1f} px) von ihrem Ort entfernt, "
            "erlaubt {allowed_mm:g} mm",
        },
    ),
    "NUDGE_NONE": (
        {
            "en": "there is no nudge to undo",
            "de": "es gibt keine Feinkorrektur, die rückgängig zu machen wäre",
        },
    ),
    "NUDGE_TOO_FAR": (
        {
            "en": "with this nudge the registration would be {shift_mm:.1f} mm and {rotation_deg:.1f} deg "
            "from where it was made, allowed {max_mm:g} mm and {max_deg:g} deg",
            "de": "mit dieser Feinkorrektur wäre die Registrierung {shift_mm:.1f} mm und "
            "{rotation_deg:.1f}° von der ursprünglichen entfernt, erlaubt {max_mm:g} mm und {max_deg:g}°",
        },
    ),
    "POINTS_COUNTS_DIFFER": (
        {
            "en": "{fixed} points are marked on the CT and {moving} were touched",
            "de": "{fixed} Punkte sind auf dem CT markiert, {moving} wurden angetastet",
        },
    ),
    "POINTS_TOO_FEW": (
        {
            "en": "{points} landmarks are captured and used, minimum {needed}",
            "de": "{points} Landmarken sind angetastet und verwendet, mindestens {needed}",
        },
        {
            "en": "there are {points} pairs of points, needed {needed}",
            "de": "es gibt {points} Punktpaare, nötig {needed}",
        },
    ),
    "REFERENCE_UNSEEN": (
        {
            "en": "the marker '{reference}' on the patient is not seen in this image",
            "de": "der Patientenmarker „{reference}“ ist in diesem Bild nicht zu sehen",
        },
    ),
    "REGISTRATION_CONTEXT_CHANGED": (
        {
            "en": "case, plan, camera or tool has changed since this registration was started",
            "de": "Fall, Planung, Kamera oder Instrument wurde seit Beginn dieser Registrierung geändert",
        },
    ),
    "SURFACE_DISAGREES": (
        {
            "en": "only {used_ratio:.0%} of the sweep lies on the bone, needed {needed_ratio:.0%}",
            "de": "nur {used_ratio:.0%} der Abfahrt liegen auf dem Knochen, nötig {needed_ratio:.0%}",
        },
    ),
    "SURFACE_START_FAR": (
        {
            "en": "at the start the sweep lies {median_mm:.1f} mm from the bone (median), allowed "
            "{allowed_mm:g} mm",
            "de": "zu Beginn liegt die Abfahrt {median_mm:.1f} mm vom Knochen (Median), erlaubt "
            "{allowed_mm:g} mm",
        },
    ),
    "SURFACE_SWEEP_SMALL": (
        {
            "en": "the sweep touches about {places:.0f} different places spread over {spread_mm:.1f} mm "
            "(RMS), needed {needed} over {needed_mm:g} mm",
            "de": "die Spitze berührte etwa {places:.0f} verschiedene Stellen, verteilt über "
            "{spread_mm:.1f} mm (RMS), nötig {needed} über {needed_mm:g} mm",
        },
    ),
    "TOOL_UNKNOWN": (
        {"en": "there is no tool '{tool}' in use", "de": "es gibt kein verwendetes Instrument „{tool}“"},
    ),
    "TOUCHED_BESIDE_REFERENCE": (
        {
            "en": "the landmarks were captured relative to the marker '{reference}', not to the camera",
            "de": "die Landmarken wurden relativ zum Marker „{reference}“ angetastet, nicht zur Kamera",
        },
    ),
}

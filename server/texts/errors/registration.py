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
    "CAPTURE_MOVED": (
        {
            "en": "the tip moved: it spreads by {spread_mm:.2f} mm (standard deviation, allowed "
            "{allowed_mm:g}) and by {max_off_mm:.2f} mm at most (allowed {allowed_off_mm:g})",
            "de": "die Spitze bewegte sich: sie streut um {spread_mm:.2f} mm (Standardabweichung, erlaubt "
            "{allowed_mm:g}) und um höchstens {max_off_mm:.2f} mm (erlaubt {allowed_off_mm:g})",
        },
    ),
    "CAPTURE_UNCERTAIN": (
        {
            "en": "the tip's uncertainty is {tip_sd_mm:.1f} mm in the worst image, allowed {allowed_mm:g} mm",
            "de": "die Unsicherheit der Spitze ist im schlechtesten Bild {tip_sd_mm:.1f} mm, erlaubt "
            "{allowed_mm:g} mm",
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
            "en": "the reference is not seen",
            "de": "der Patientenmarker ist nicht zu sehen",
        },
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
            "de": "nur {used_ratio:.0%} der Messpunkte liegen auf dem Knochen, nötig {needed_ratio:.0%}",
        },
    ),
    "SURFACE_START_FAR": (
        {
            "en": "at the start the sweep lies {median_mm:.1f} mm from the bone (median), allowed "
            "{allowed_mm:g} mm",
            "de": "zu Beginn liegen die Messpunkte {median_mm:.1f} mm vom Knochen (Median), erlaubt "
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
    "CHECK_INVALID": (
        {
            "en": "landmark and tip are not three finite numbers each",
            "de": "Landmarke und Spitze bestehen nicht aus je drei endlichen Zahlen",
        },
    ),
    "COLLECTION_MISSING": ({"en": "no {collection} in progress", "de": "es läuft {collection}"},),
    "NEEDLE_PLACE_INVALID": (
        {
            "en": "the place of needle '{needle}' has an invalid number; its direction has a spread of "
            "{direction_sd_deg:g} deg, allowed above 0 to 90",
            "de": "der Ort der Nadel „{needle}“ hat eine ungültige Zahl; ihre Richtung hat eine "
            "Streuung von {direction_sd_deg:g}°, erlaubt über 0 bis 90",
        },
    ),
    "NEEDLE_SEEN_INVALID": (
        {
            "en": "a needle is {length_px:.1f} px long with a spread of {spread_px:g} px; needed at "
            "least {min_length_px:g} px and a spread above 0",
            "de": "eine Nadel ist {length_px:.1f} px lang mit einer Streuung von {spread_px:g} px; "
            "nötig mindestens {min_length_px:g} px und eine Streuung über 0",
        },
    ),
    "NEEDLE_TWICE": (
        {"en": "{needles} needles have {names} names", "de": "{needles} Nadeln haben {names} Namen"},
    ),
    "NUDGE_PIVOT_INVALID": (
        {
            "en": "the centre of rotation is not three finite numbers",
            "de": "der Drehpunkt besteht nicht aus drei endlichen Zahlen",
        },
    ),
    "OVERLAY_INVALID": (
        {
            "en": "the slice has scale {scale_px_per_mm:g} px/mm and opacity {fade_ratio:g}; allowed "
            "{min_scale:g} to {max_scale:g} px/mm and 0 to 1",
            "de": "die Schicht hat den Maßstab {scale_px_per_mm:g} px/mm und die Deckkraft "
            "{fade_ratio:g}; erlaubt {min_scale:g} bis {max_scale:g} px/mm und 0 bis 1",
        },
    ),
    "POINTS_AMBIGUOUS": (
        {
            "en": "the points fit to {fre_mm:.2f} mm RMS as given, and better "
            "({other_order_fre_mm:.2f} mm) with {exchanged_points} swapped, so that their order "
            "is ambiguous",
            "de": "die Punkte passen wie angegeben auf {fre_mm:.2f} mm RMS, und besser "
            "({other_order_fre_mm:.2f} mm), wenn man {exchanged_points} tauscht; ihre "
            "Reihenfolge ist daher mehrdeutig",
        },
    ),
    "POINTS_COINCIDENT": (
        {
            "en": "points {points[0]} and {points[1]} are {apart_mm:.2f} mm apart {points_where}, "
            "needed {needed_mm:g} mm{spread_hint}",
            "de": "die Punkte {points[0]} und {points[1]} liegen {points_where} {apart_mm:.2f} mm "
            "auseinander, nötig {needed_mm:g} mm{spread_hint}",
        },
    ),
    "POINTS_COLLINEAR": (
        {
            "en": "the points are nearly a line {points_where}: they reach {along_mm:.1f} mm along it "
            "and only {beside_mm:.2f} mm beside it (RMS), so that the rotation about that line "
            "is ambiguous (known to {turn_sd_deg:.0f} deg, allowed {allowed_deg:g} deg; needed "
            "beside it {needed_mm:.2f} mm at least)",
            "de": "die Punkte liegen {points_where} fast auf einer Geraden: sie reichen {along_mm:.1f} "
            "mm längs und nur {beside_mm:.2f} mm quer dazu (RMS), daher ist die Drehung um diese "
            "Gerade mehrdeutig (bekannt auf {turn_sd_deg:.0f}°, erlaubt {allowed_deg:g}°; quer "
            "dazu nötig mindestens {needed_mm:.2f} mm)",
        },
    ),
    "POINTS_FIT_TOO_LARGE": (
        {
            "en": "landmarks fit to {fre_rms_mm:.2f} mm RMS, allowed {allowed_mm:.2f} mm; {misfit}",
            "de": "die Landmarken passen auf {fre_rms_mm:.2f} mm RMS, erlaubt {allowed_mm:.2f} mm; {misfit}",
        },
    ),
    "POINTS_INVALID": (
        {
            "en": "the points {points_where} have shape {shape}, needed (n, 3)",
            "de": "die Punkte {points_where} haben die Form {shape}, nötig (n, 3)",
        },
        {
            "en": "{labels} points have {names} different names",
            "de": "{labels} Punkte haben {names} verschiedene Namen",
        },
        {
            "en": "{not_finite} of {points} points {points_where} have a number that is not finite",
            "de": "{not_finite} von {points} Punkten {points_where} haben eine Zahl, die nicht endlich ist",
        },
        {
            "en": "the covariances of {tips} tips have shape {shape}, or are not positive definite",
            "de": "die Kovarianzen von {tips} Spitzen haben die Form {shape}, oder sie sind nicht "
            "positiv definit",
        },
    ),
    "POINTS_MIRRORED": (
        {
            "en": "the points are mirrored: as given they fit to {fre_mm:.2f} mm RMS, their mirror "
            "image to {mirrored_fre_mm:.2f} mm",
            "de": "die Punkte sind gespiegelt: wie angegeben passen sie auf {fre_mm:.2f} mm RMS, ihr "
            "Spiegelbild auf {mirrored_fre_mm:.2f} mm",
        },
    ),
    "POINTS_SWAPPED": (
        {
            "en": "{exchanged_points} seem to be swapped: as given the points fit to {fre_mm:.2f} mm "
            "RMS, swapped to {other_order_fre_mm:.2f} mm",
            "de": "{exchanged_points} sind offenbar vertauscht: wie angegeben passen die Punkte auf "
            "{fre_mm:.2f} mm RMS, getauscht auf {other_order_fre_mm:.2f} mm",
        },
    ),
    "POINTS_TARGET_UNCERTAIN": (
        {
            "en": "at the target the registration has an uncertainty of {tre_stated_mm:.2f} mm (3-D "
            "RMS), allowed {allowed_mm:.2f} mm{outlier_exception}",
            "de": "am Zielpunkt hat die Registrierung eine Unsicherheit von {tre_stated_mm:.2f} mm "
            "(3-D RMS), erlaubt {allowed_mm:.2f} mm{outlier_exception}",
        },
    ),
    "POINTS_UNIT_SUSPECT": (
        {
            "en": "the points spread over {fixed_spread_mm:.4g} mm on the CT and over "
            "{moving_spread_mm:.4g} mm as touched, {size_ratio:.4g} times as much{unit_guess}",
            "de": "die Punkte streuen auf dem CT über {fixed_spread_mm:.4g} mm und beim Antasten über "
            "{moving_spread_mm:.4g} mm, um den Faktor {size_ratio:.4g} verschieden{unit_guess}",
        },
    ),
    "POINT_STRAYS": (
        {
            "en": "a landmark lies {leave_one_out_mm:.2f} mm from the fit of all others, allowed "
            "{allowed_mm:.2f} mm; {misfit}",
            "de": "eine Landmarke liegt {leave_one_out_mm:.2f} mm von der Anpassung aller übrigen, "
            "erlaubt {allowed_mm:.2f} mm; {misfit}",
        },
    ),
    "REFERENCE_DIFFERS": (
        {
            "en": "{title} is anchored to the marker '{registered}', but reference.marker in the "
            "settings {reference_setting}",
            "de": "{title} bezieht sich auf den Marker „{registered}“, aber reference.marker in den "
            "Einstellungen {reference_setting}",
        },
    ),
    "REGISTERED_TO_CAMERA": (
        {
            "en": "{title} is anchored to a camera, but an external tracker measures now",
            "de": "{title} bezieht sich auf eine Kamera, aber jetzt misst ein externes Trackingsystem",
        },
    ),
    "REGISTER_MISSING": (
        {"en": "{unregistered} is not registered", "de": "{unregistered} ist nicht registriert"},
    ),
    "REGISTRATION_COVARIANCE_INVALID": (
        {
            "en": "the uncertainty of the registration is not a finite covariance",
            "de": "die Unsicherheit der Registrierung ist keine endliche Kovarianz",
        },
        {
            "en": "the uncertainty of tracking at the registration is not a finite covariance",
            "de": "die Unsicherheit des Trackings bei der Registrierung ist keine endliche Kovarianz",
        },
    ),
    "SURFACE_AMBIGUOUS": (
        {
            "en": "the sweep fits in two places {apart_mm:.1f} mm apart at the target, mostly "
            "{direction}: to {rms_mm[0]:.2f} and to {rms_mm[1]:.2f} mm RMS",
            "de": "die Messpunkte passen an zwei Orten, die am Zielpunkt {apart_mm:.1f} mm auseinander "
            "liegen, vor allem {direction}: auf {rms_mm[0]:.2f} und auf {rms_mm[1]:.2f} mm RMS",
        },
    ),
    "SURFACE_SLIDES": (
        {
            "en": "the sweep slides on the bone {direction}: there it is {direction_sd} at the target, "
            "allowed {allowed_mm:g} mm",
            "de": "die Messpunkte lassen sich auf dem Knochen verschieben, {direction}: in dieser Richtung "
            "ist die Registrierung am Zielpunkt {direction_sd}, erlaubt {allowed_mm:g} mm",
        },
    ),
    "SWEEP_ANCHOR_DIFFERS": (
        {
            "en": "{title} is anchored to the {start_anchor}, but a sweep would be anchored to the "
            "{sweep_anchor}",
            "de": "{title} bezieht sich auf {start_anchor}, das Abfahren bezöge sich aber auf {sweep_anchor}",
        },
    ),
    "VIEW_INVALID": (
        {
            "en": "the camera is {distance_mm:g} mm away with a spread of {distance_sd_mm:g} mm; "
            "needed above 0",
            "de": "die Kamera ist {distance_mm:g} mm entfernt, mit einer Streuung von "
            "{distance_sd_mm:g} mm; nötig über 0",
        },
        {
            "en": "the camera looks straight down, so V and H do not determine the up direction in its image",
            "de": "die Kamera blickt senkrecht nach unten, daher bestimmen V und H nicht, wo in ihrem "
            "Bild oben ist",
        },
    ),
    "NEEDLES_SWAPPED": (
        {
            "en": "needles {needles} seem to be swapped: the other order fits better by {gain_chi2:.1f} in "
            "chi squared, allowed {allowed_chi2:g}",
            "de": "die Nadeln {needles} sind offenbar vertauscht: die andere Reihenfolge passt um "
            "{gain_chi2:.1f} in Chi-Quadrat besser, erlaubt {allowed_chi2:g}",
        },
    ),
    "NUDGE_STEP_INVALID": (
        {
            "en": "a nudge of {amount:g} {unit} is not allowed; the steps are {steps} {unit}",
            "de": "eine Korrektur um {amount:g} {unit} ist nicht erlaubt; die Schritte sind {steps} {unit}",
        },
    ),
    "SURFACE_SWEEP_INVALID": (
        {
            "en": "the swept points have shape {shape}, needed (n, 3), or a number is not finite",
            "de": "die abgefahrenen Punkte haben die Form {shape}, nötig (n, 3), oder eine Zahl ist nicht "
            "endlich",
        },
    ),
    "CAPTURE_UNSEEN": (
        {
            "en": "the tip was known in {seen} of {images} images{at_rate} and not in {unseen} "
            "({unseen_reason}), needed in all",
            "de": "die Spitze war in {seen} von {images} Bildern{at_rate} bekannt und in {unseen} nicht "
            "({unseen_reason}), nötig in allen",
        },
    ),
    "CAPTURE_INTERRUPTED": (
        {
            "en": "{gap_s:.2f} s passed between two of {images} images, allowed {allowed_s:.2f} s at "
            "{rate_text}: the tip could have moved in between",
            "de": "zwischen zwei von {images} Bildern vergingen {gap_s:.2f} s, erlaubt {allowed_s:.2f} s "
            "bei {rate_text}: die Spitze kann sich dazwischen bewegt haben",
        },
    ),
    "CAPTURE_RATE_TOO_LOW": (
        {
            "en": "{needed} images take {hold_s:.1f} s at {rate_text}, allowed {max_s:g} s",
            "de": "{needed} Bilder brauchen {hold_s:.1f} s bei {rate_text}, erlaubt {max_s:g} s",
        },
    ),
    "CAPTURE_TOO_SHORT": (
        {
            "en": "there are {images} images over {lasted_s:.2f} s{at_rate}{order}, needed {needed} over "
            "{min_s:g} s",
            "de": "es gibt {images} Bilder in {lasted_s:.2f} s{at_rate}{order}, nötig {needed} in "
            "{min_s:g} s",
        },
    ),
    "CHECK_NOT_CAPTURED": (
        {
            "en": "the tip was seen in {images} images{at_rate}, needed {needed}",
            "de": "die Spitze war in {images} Bildern{at_rate} zu sehen, nötig {needed}",
        },
    ),
    "NEEDLES_DISAGREE": (
        {
            "en": "needles, ruler and touched points disagree: chi squared is {chi2:.0f}, allowed "
            "{allowed_chi2:.0f}; worst is {worst_observation}",
            "de": "Nadeln, Lineal und angetastete Punkte widersprechen sich: Chi-Quadrat ist {chi2:.0f}, "
            "erlaubt {allowed_chi2:.0f}; am schlechtesten passt {worst_observation}",
        },
    ),
    "REGISTRATION_DOCUMENT_INVALID": (
        {
            "en": "{title} cannot be read: {document_problem}",
            "de": "{title} ist nicht lesbar: {document_problem}",
        },
    ),
}

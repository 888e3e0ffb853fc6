"""Messages of errors of calibrating a tool, by code."""

from collections.abc import Mapping

from server.texts.language import Text

TOOL: Mapping[str, tuple[Text, ...]] = {
    "PIVOT_POSES_DISAGREE": (
        {
            "en": "only {used} of {poses} poses agree on one pivot, needed {needed_ratio:.0%}",
            "de": "nur {used} von {poses} Lagen passen zu einem Drehpunkt, nötig {needed_ratio:.0%}",
        },
    ),
    "PIVOT_RESIDUAL_TOO_LARGE": (
        {
            "en": "the tip is {rms_3d_mm:.2f} mm from the pivot (3-D RMS), allowed {allowed_mm:.2f} mm",
            "de": "die Spitze liegt {rms_3d_mm:.2f} mm vom Drehpunkt (3-D RMS), erlaubt {allowed_mm:.2f} mm",
        },
    ),
    "PIVOT_TILT_TOO_SMALL": (
        {
            "en": "about one direction the tool was tilted by only {turned_deg:.1f} degrees from end to "
            "end, needed {needed_deg:g} degrees about each of two directions",
            "de": "um eine Richtung wurde das Instrument von Ende zu Ende nur um {turned_deg:.1f}° "
            "geschwenkt, nötig {needed_deg:g}° um jede von zwei Richtungen",
        },
    ),
    "PIVOT_TIP_UNCERTAIN": (
        {
            "en": "the tip has a standard deviation of {tip_sd_mm:.2f} mm, allowed {allowed_mm:.2f} mm",
            "de": "die Spitze hat eine Standardabweichung von {tip_sd_mm:.2f} mm, erlaubt {allowed_mm:.2f} "
            "mm",
        },
    ),
    "PIVOT_TIP_FAR": (
        {
            "en": "the tip lies {tip_mm:.0f} mm from the marker, allowed {allowed_mm:.0f} mm",
            "de": "die Spitze liegt {tip_mm:.0f} mm vom Marker entfernt, erlaubt {allowed_mm:.0f} mm",
        },
    ),
    "SPIN_AXIS_UNCERTAIN": (
        {
            "en": "the axis has a standard deviation of {axis_sd_deg:.2f} degrees, allowed {allowed_deg:.2f}",
            "de": "die Achse hat eine Standardabweichung von {axis_sd_deg:.2f}°, erlaubt {allowed_deg:.2f}",
        },
    ),
    "SPIN_NOT_ABOUT_TOOL": (
        {
            "en": "the axis of this motion is {off_deg:.0f} degrees from the direction to the tip, allowed "
            "{allowed_deg:g}: the tool was tilted, not spun",
            "de": "die Achse dieser Bewegung liegt {off_deg:.0f}° neben der Richtung zur Spitze, erlaubt "
            "{allowed_deg:g}: das Instrument wurde geschwenkt, nicht gedreht",
        },
    ),
    "TIP_CHECK_FAILED": (
        {
            "en": "the tip moves by {rms_3d_mm:.2f} mm (3-D RMS) and by {max_mm:.2f} mm at most, allowed "
            "{allowed_mm:.2f} mm (3-D RMS)",
            "de": "die Spitze bewegt sich um {rms_3d_mm:.2f} mm (3-D RMS) und um höchstens {max_mm:.2f} mm, "
            "erlaubt {allowed_mm:.2f} mm (3-D RMS)",
        },
    ),
    "TIP_CHECK_TILT_TOO_SMALL": (
        {
            "en": "about one direction the tool was tilted by only {turned_deg:.1f} degrees from end to "
            "end, needed {needed_deg:g}: a wrong tip would not be detected",
            "de": "um eine Richtung wurde das Instrument von Ende zu Ende nur um {turned_deg:.1f}° "
            "geschwenkt, nötig {needed_deg:g}: eine falsche Spitze würde nicht auffallen",
        },
    ),
    "TOOL_MARKER_UNKNOWN": (
        {
            "en": "the marker of the tool '{tool}' is not specified",
            "de": "der Marker des Instruments „{tool}“ ist nicht angegeben",
        },
    ),
    "TOOL_SHAPE_UNKNOWN": (
        {
            "en": "radius and length of '{tool}' are not known",
            "de": "Radius und Länge von „{tool}“ sind nicht bekannt",
        },
    ),
    "TOOL_TIP_MISSING": (
        {
            "en": "the tip of '{tool}' is not calibrated in this case",
            "de": "die Spitze von „{tool}“ ist in diesem Fall nicht kalibriert",
        },
        {
            "en": "the tip of '{tool}' is no longer available",
            "de": "die Spitze von „{tool}“ gibt es nicht mehr",
        },
        {"en": "there is no tip to check", "de": "es gibt keine Spitze, die geprüft werden könnte"},
    ),
    "TOOL_TOO_FEW_POSES": (
        {"en": "there are {poses} poses", "de": "es gibt {poses} Lagen"},
        {
            "en": "there are {different} different poses of {poses}, needed {needed}",
            "de": "es gibt {different} verschiedene Lagen von {poses}, nötig {needed}",
        },
    ),
    "SPIN_TOO_SMALL": (
        {
            "en": "the tool was spun by {spin_range_deg:.0f} degrees, needed {min_spin_deg:g}",
            "de": "das Instrument wurde um {spin_range_deg:.0f}° gedreht, nötig {min_spin_deg:g}°",
        },
    ),
    "SPIN_WOBBLES": (
        {
            "en": "the axis moved by {wobble_deg:.1f} degrees (RMS) while the tool was spun by "
            "{spin_range_deg:.0f}, allowed {max_wobble_deg:g}",
            "de": "die Achse bewegte sich um {wobble_deg:.1f}° (RMS), während das Instrument um "
            "{spin_range_deg:.0f}° gedreht wurde, erlaubt {max_wobble_deg:g}",
        },
    ),
    "MARKERS_TOO_SIMILAR": (
        {
            "en": "markers '{names[0]}' and '{names[1]}' look the same, however they are turned: "
            "correlation {correlation:.3f}, allowed {max_correlation}",
            "de": "die Marker „{names[0]}“ und „{names[1]}“ sehen in jeder Drehung gleich aus: "
            "Korrelation {correlation:.3f}, erlaubt {max_correlation}",
        },
    ),
    "MARKER_MIRROR_SYMMETRIC": (
        {
            "en": "marker '{name}' is its own mirror image: correlation {correlation:.3f}, allowed "
            "{max_correlation}; its reflection in steel would be detected as the marker, at a "
            "wrong pose",
            "de": "der Marker „{name}“ ist sein eigenes Spiegelbild: Korrelation {correlation:.3f}, "
            "erlaubt {max_correlation}; seine Spiegelung in Stahl würde als Marker erkannt, in "
            "falscher Lage",
        },
    ),
    "MARKER_NAMES_NOT_UNIQUE": (
        {
            "en": "{markers} markers have {different} names: {names}",
            "de": "{markers} Marker haben {different} Namen: {names}",
        },
    ),
    "MARKER_SIDE_INVALID": (
        {
            "en": "the side of marker '{name}' is {side_mm} mm, needed above 0 mm",
            "de": "die Seite des Markers „{name}“ ist {side_mm} mm, nötig über 0 mm",
        },
    ),
    "MARKER_SYMMETRIC": (
        {
            "en": "marker '{name}' looks the same when rotated by {turned_deg} degrees: correlation "
            "{correlation:.3f}, allowed {max_correlation}",
            "de": "der Marker „{name}“ sieht um {turned_deg} Grad gedreht gleich aus: Korrelation "
            "{correlation:.3f}, erlaubt {max_correlation}",
        },
    ),
    "POSE_COVARIANCE_INVALID": (
        {
            "en": "the covariances of {poses} poses have the shape {shape} or are not positive, needed "
            "{needed_shape}",
            "de": "die Kovarianzen von {poses} Lagen haben die Form {shape} oder sind nicht positiv, "
            "nötig {needed_shape}",
        },
    ),
    "TOOL_AXIS_INVALID": (
        {
            "en": "the drilling direction of '{tool}' is {axis}, which has no length",
            "de": "die Bohrrichtung von „{tool}“ ist {axis}, sie hat keine Länge",
        },
    ),
    "TOOL_FILE_OF_ANOTHER_MARKER": (
        {
            "en": "{file} was made with marker '{marker}' of {side_mm:g} mm, but the tool "
            "has '{tool_marker}' of {tool_side_mm:g} mm",
            "de": "{file} entstand mit dem Marker „{marker}“ von {side_mm:g} mm, das "
            "Instrument hat aber „{tool_marker}“ von {tool_side_mm:g} mm",
        },
    ),
    "TOOL_TIP_INVALID": (
        {
            "en": "the tip is {tip}, needed three numbers in mm",
            "de": "die Spitze ist {tip}, nötig drei Zahlen in mm",
        },
        {
            "en": "the tip is {tip}, which determines no direction from the marker",
            "de": "die Spitze ist {tip}, das bestimmt keine Richtung vom Marker aus",
        },
    ),
    "TOOL_TIP_UNKNOWN": (
        {
            "en": "tip and axis of '{tool}' are not defined",
            "de": "Spitze und Achse von „{tool}“ sind nicht definiert",
        },
    ),
    "TIME_OFFSET_AT_SEARCH_LIMIT": (
        {
            "en": "the correlation still increases at {offset_s:+.2f} s, where the search ends",
            "de": "die Korrelation steigt bei {offset_s:+.2f} s noch, wo die Suche endet",
        },
    ),
    "TIME_OFFSET_CHANGES": (
        {
            "en": "the offset changes by {change_ms:+.1f} ms from the first half of the recording to "
            "the second, allowed {allowed_ms:.1f} ms",
            "de": "der Zeitversatz ändert sich um {change_ms:+.1f} ms von der ersten zur zweiten "
            "Hälfte der Aufnahme, erlaubt {allowed_ms:.1f} ms",
        },
    ),
    "TIME_OFFSET_MOTIONS_DIFFER": (
        {
            "en": "the rates of both sources correlate by {correlation_ratio:.3f} at best (at "
            "{offset_s:+.2f} s), needed {min_correlation_ratio:g}",
            "de": "die Geschwindigkeiten beider Quellen korrelieren bestenfalls mit "
            "{correlation_ratio:.3f} (bei {offset_s:+.2f} s), nötig {min_correlation_ratio:g}",
        },
    ),
    "TIME_OFFSET_RATE_LOW": (
        {
            "en": "{source} has {rate_hz:.1f} poses per second, needed {min_rate_hz:g}",
            "de": "{source} hat {rate_hz:.1f} Lagen je Sekunde, nötig {min_rate_hz:g}",
        },
    ),
    "TIME_OFFSET_TOO_FEW_SAMPLES": (
        {
            "en": "{source} has {samples} different poses in intervals without a gap, needed {min_samples}",
            "de": "{source} hat {samples} verschiedene Lagen in Abschnitten ohne Lücke, nötig {min_samples}",
        },
    ),
    "MARKER_IMAGE_UNREADABLE": (
        {
            "en": "the marker picture {file} cannot be read: {system_error}",
            "de": "das Markerbild {file} ist nicht lesbar: {system_error}",
        },
        {
            "en": "the marker picture {file} ({bytes} bytes) cannot be decoded",
            "de": "das Markerbild {file} ({bytes} Bytes) lässt sich nicht dekodieren",
        },
    ),
    "MARKER_IMAGE_TOO_SMALL": (
        {
            "en": "the marker picture {file} is {width_px}x{height_px} px, the minimum is {min_px} px per "
            "side",
            "de": "das Markerbild {file} hat {width_px}x{height_px} px, mindestens {min_px} px je Seite",
        },
    ),
    "MARKER_IMAGE_NOT_SQUARE": (
        {
            "en": "the marker picture {file} is {width_px}x{height_px} px, its sides may differ by at most "
            "{tolerance_ratio:.0%}",
            "de": "das Markerbild {file} hat {width_px}x{height_px} px, die Seiten dürfen sich um "
            "höchstens {tolerance_ratio:.0%} unterscheiden",
        },
    ),
    "MARKER_IMAGE_FLAT": (
        {
            "en": "the marker picture {file} spans {contrast_grey} of 255 grey levels, the minimum is "
            "{min_contrast_grey}",
            "de": "das Markerbild {file} umfasst {contrast_grey} von 255 Graustufen, mindestens "
            "{min_contrast_grey}",
        },
    ),
    "TOOL_AXIS_UNKNOWN": (
        {
            "en": "the axis of '{tool}' is {axis_place}, expected in one place",
            "de": "die Achse von „{tool}“ ist {axis_place}, erwartet an einem Ort",
        },
    ),
    "TOOL_FILE_INVALID": (
        {
            "en": "the tool file {file} cannot be used: {library_error}",
            "de": "die Instrumentdatei {file} ist nicht verwendbar: {library_error}",
        },
    ),
    "ROTATION_INVALID": (
        {
            "en": "a pose is not a rigid motion: its rotation deviates from orthonormal by "
            "{off_orthonormal:.3g}, allowed {allowed:g}, and all numbers must be finite",
            "de": "eine Lage ist keine starre Bewegung: ihre Drehung weicht um {off_orthonormal:.3g} von "
            "orthonormal ab, erlaubt {allowed:g}, und alle Zahlen müssen endlich sein",
        },
    ),
    "TIME_OFFSET_NEEDS_ROTATIONS": (
        {
            "en": "sources with positions only: {names}",
            "de": "Quellen, die nur Orte enthalten: {names}",
        },
    ),
    "TIME_OFFSET_OVERLAP_SHORT": (
        {
            "en": "both sources saw the tool for {overlap_s:.1f} s at an offset within {max_offset_s:g} s, "
            "needed {min_overlap_s:g} s ({spans})",
            "de": "beide Quellen sahen das Instrument {overlap_s:.1f} s lang bei einem Versatz bis "
            "{max_offset_s:g} s, nötig {min_overlap_s:g} s ({spans})",
        },
    ),
    "TIME_OFFSET_NO_MOTION": (
        {
            "en": "in {source} the tool has a {motion} of {rate:.1f} {rate_unit} (RMS), needed {needed:g} "
            "{rate_unit}",
            "de": "in {source} hat das Instrument eine {motion} von {rate:.1f} {rate_unit} (RMS), nötig "
            "{needed:g} {rate_unit}",
        },
    ),
    "TIME_OFFSET_MOTION_UNIFORM": (
        {
            "en": "in {source} the {motion} of {rate:.1f} {rate_unit} varies by {variation:.1f} "
            "{rate_unit} (RMS), needed {needed:g} {rate_unit}: a constant velocity does not "
            "determine the offset",
            "de": "in {source} schwankt die {motion} von {rate:.1f} {rate_unit} um {variation:.1f} "
            "{rate_unit} (RMS), nötig {needed:g} {rate_unit}: eine konstante Geschwindigkeit "
            "bestimmt den Versatz nicht",
        },
    ),
    "TIME_OFFSET_AMBIGUOUS": (
        {
            "en": "an offset of {second_offset_s:+.2f} s has {second_peak_ratio:.2f} of the correlation at "
            "{offset_s:+.2f} s, allowed {max_second_peak_ratio:g}: the motion repeats itself",
            "de": "ein Versatz von {second_offset_s:+.2f} s hat das {second_peak_ratio:.2f}-Fache der "
            "Korrelation bei {offset_s:+.2f} s, erlaubt {max_second_peak_ratio:g}: die Bewegung "
            "wiederholt sich",
        },
    ),
    "TIME_OFFSET_UNCERTAIN": (
        {
            "en": "the offset of {offset_ms:+.1f} ms has a standard deviation of {sd_ms:.1f} ms, allowed "
            "{max_sd_ms:g} ms",
            "de": "der Versatz von {offset_ms:+.1f} ms hat eine Standardabweichung von {sd_ms:.1f} ms, "
            "erlaubt {max_sd_ms:g} ms",
        },
    ),
    "TIME_SERIES_INVALID": (
        {
            "en": "{source}: {series_problem}",
            "de": "{source}: {series_problem}",
        },
    ),
    "POSE_MATRIX_INVALID": (
        {
            "en": "a pose is not a rigid motion: {pose_problem}",
            "de": "eine Lage ist keine starre Bewegung: {pose_problem}",
        },
    ),
    "POSE_UNIT_SUSPECT": (
        {
            "en": "in {near_poses} poses the marker is nearer than {min_distance_mm:g} mm to the camera "
            "(median {median_distance_mm:.3g} mm), which is impossible; these seem to be metres",
            "de": "in {near_poses} Lagen ist der Marker näher als {min_distance_mm:g} mm an der Kamera "
            "(Median {median_distance_mm:.3g} mm), das ist unmöglich; es sind offenbar Meter",
        },
    ),
}

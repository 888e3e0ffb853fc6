"""Messages of warnings about completed work (`tracker.errors.Remark`), by code."""

from collections.abc import Mapping

from server.texts.language import Text

_CALIBRATION: Mapping[str, tuple[Text, ...]] = {
    "BOARD_SIZE_UNLIKELY": (
        {
            "en": "no view shows more than {columns} x {rows} of the {board_columns} x {board_rows} "
            "{board_points}, and most show just these",
            "de": "keine Ansicht zeigt mehr als {columns} x {rows} von {board_columns} x {board_rows} "
            "({board_points}), und die meisten zeigen genau diese",
        },
    ),
    "CORNERS_UNCOVERED": (
        {
            "en": "towards the image's {uncovered_corners} corner points reach {reach_percent:.0f} % of the "
            "way, advised are {advised_percent:.0f} %",
            "de": "in Richtung der Bildecke {uncovered_corners} reichen die Punkte {reach_percent:.0f} % "
            "des Wegs, empfohlen {advised_percent:.0f} %",
        },
    ),
    "FEW_VIEWS": (
        {
            "en": "{used} views are used, advised are {advised} and more",
            "de": "{used} Ansichten sind verwendet, empfohlen mindestens {advised}",
        },
    ),
    "FOCAL_LENGTH_UNCERTAIN": (
        {
            "en": "{parameter} is {value:.1f} px with a standard deviation of {sd_px:.1f} px, advised is "
            "{advised_px:.1f} px",
            "de": "{parameter} ist {value:.1f} px mit einer Standardabweichung von {sd_px:.1f} px, empfohlen "
            "höchstens {advised_px:.1f} px",
        },
    ),
    "LENS_IMPLAUSIBLE": (
        {
            "en": "the lens is implausible: {camera_problem}",
            "de": "das Objektiv ist unplausibel: {camera_problem}",
        },
    ),
    "LITTLE_TILT": (
        {
            "en": "the board's directions differ by {tilt_deg:.1f} deg at most, advised are "
            "{advised_deg:g} deg",
            "de": "die Richtungen der Tafel unterscheiden sich um höchstens {tilt_deg:.1f}°, empfohlen "
            "{advised_deg:g}°",
        },
    ),
    "MANY_VIEWS_OUT": (
        {
            "en": "{out} of {views} views are not used",
            "de": "{out} von {views} Ansichten sind nicht verwendet",
        },
    ),
    "MODEL_NOT_TRIED": ({"en": "lens model: {model_reason}", "de": "Objektivmodell: {model_reason}"},),
    "ONE_DISTANCE": (
        {
            "en": "the board is always {min_mm:.0f} to {max_mm:.0f} mm away",
            "de": "die Tafel ist immer {min_mm:.0f} bis {max_mm:.0f} mm entfernt",
        },
    ),
    "TWO_CAMERAS": (
        {
            "en": "{apart} of {views} views ({view_names}) fit a separate camera clearly better: RMS "
            "{split_rms_px:.3f} px instead of {rms_px:.3f} px, with focal lengths that differ by "
            "{difference_px[0]:+.1f} and {difference_px[1]:+.1f} px and a middle by "
            "{difference_px[2]:+.1f} and {difference_px[3]:+.1f} px",
            "de": "{apart} von {views} Ansichten ({view_names}) passen deutlich besser zu einer eigenen "
            "Kamera: RMS {split_rms_px:.3f} px statt {rms_px:.3f} px, mit Brennweiten, die um "
            "{difference_px[0]:+.1f} und {difference_px[1]:+.1f} px abweichen, und einer Bildmitte, die um "
            "{difference_px[2]:+.1f} und {difference_px[3]:+.1f} px abweicht",
        },
    ),
}
_CT: Mapping[str, tuple[Text, ...]] = {
    "CT_AFFINES_DIFFER": (
        {
            "en": "the sform and qform of the NIfTI differ by up to {difference_mm:.1f} mm; the sform is "
            "used",
            "de": "sform und qform der NIfTI-Datei weichen um bis zu {difference_mm:.1f} mm voneinander ab; "
            "die sform wird verwendet",
        },
    ),
    "CT_COMPRESSED_LOSSILY": (
        {
            "en": "the pixels were compressed lossily; thin walls of bone may be altered",
            "de": "die Pixel wurden verlustbehaftet komprimiert; dünne Knochenwände können verändert sein",
        },
    ),
    "CT_EMPTY": (
        {
            "en": "all voxels are {low} HU: this CT is empty",
            "de": "alle Voxel haben {low} HU: dieses CT ist leer",
        },
    ),
    "CT_FILES_EXCLUDED": (
        {
            "en": "excluded: {excluded_files} ({count})",
            "de": "nicht verwendet: {excluded_files} ({count})",
        },
    ),
    "CT_GANTRY_TILTED": (
        {
            "en": "the gantry was tilted by {tilt_deg:.1f} deg; the tilted slices are used unchanged",
            "de": "die Gantry war um {tilt_deg:.1f}° gekippt; die gekippten Schichten werden unverändert "
            "verwendet",
        },
    ),
    "CT_HU_NOT_DECLARED": (
        {
            "en": "the scanner does not declare its values as plain Hounsfield units; they are used as such",
            "de": "das CT-Gerät bezeichnet seine Werte nicht als einfache Hounsfield-Einheiten; sie werden "
            "als solche verwendet",
        },
    ),
    "CT_OTHER_SERIES": (
        {
            "en": "{others} other series were found and are not used",
            "de": "{others} weitere Serien wurden gefunden und werden nicht verwendet",
        },
    ),
    "CT_PATIENT_NOT_NAMED": (
        {
            "en": "the files do not identify the patient",
            "de": "die Dateien nennen den Patienten nicht",
        },
        {
            "en": "a NIfTI file does not identify the patient",
            "de": "eine NIfTI-Datei nennt den Patienten nicht",
        },
    ),
    "CT_SLICES_APART": (
        {
            "en": "between two slices {gap_mm:.2f} mm were not scanned ({thickness_mm:.2f} mm thick, "
            "{spacing_mm:.2f} mm apart)",
            "de": "zwischen zwei Schichten wurden {gap_mm:.2f} mm nicht erfasst (Schichtdicke "
            "{thickness_mm:.2f} mm, Abstand {spacing_mm:.2f} mm)",
        },
    ),
    "CT_SLICES_DUPLICATE": (
        {
            "en": "{doubles} slices are duplicates with equal pixels, and are used once",
            "de": "{doubles} Schichten sind doppelt mit gleichen Pixeln und werden einmal verwendet",
        },
    ),
    "CT_SLICES_THICK": (
        {
            "en": "the slices are {thickness_mm:.1f} mm thick and {spacing_mm:.1f} mm apart; above "
            "{max_mm:.0f} mm heights and tilts of a pedicle are uncertain",
            "de": "die Schichten sind {thickness_mm:.1f} mm dick und {spacing_mm:.1f} mm auseinander; über "
            "{max_mm:.0f} mm sind Höhen und Neigungen eines Pedikels unsicher",
        },
    ),
    "CT_SPACING_VARIES": (
        {
            "en": "slice positions deviate by up to {jitter_mm:.2f} mm from even spacing; up to "
            "{max_mm:.1f} mm are accepted",
            "de": "die Schichtpositionen weichen um bis zu {jitter_mm:.2f} mm von gleichmäßigen Abständen "
            "ab; bis {max_mm:.1f} mm sind zulässig",
        },
    ),
    "CT_TILT_CONTRADICTS": (
        {
            "en": "the scanner states a gantry tilt of {stated_deg:.1f} deg, but the slice positions give "
            "{tilt_deg:.1f} deg; the positions are used",
            "de": "das CT-Gerät nennt eine Gantry-Neigung von {stated_deg:.1f}°, die Schichtpositionen "
            "ergeben {tilt_deg:.1f}°; die Positionen werden verwendet",
        },
    ),
    "CT_UNIT_CONVERTED": (
        {
            "en": "the file states its geometry in {length_unit}; it was multiplied by {scale:g} to mm",
            "de": "die Datei gibt ihre Geometrie in {length_unit} an; sie wurde mit {scale:g} in mm "
            "umgerechnet",
        },
    ),
    "CT_VALUES_CLIPPED": (
        {
            "en": "{beyond} voxels were outside {min_hu} to {max_hu} HU and were clipped to this range",
            "de": "{beyond} Voxel lagen außerhalb von {min_hu} bis {max_hu} HU und wurden auf diesen Bereich "
            "begrenzt",
        },
    ),
    "CT_VALUES_NAN": (
        {
            "en": "{missing} voxels are NaN and were set to {padding_hu} HU",
            "de": "{missing} Voxel haben keinen Wert (NaN) und wurden auf {padding_hu} HU gesetzt",
        },
    ),
    "CT_WITHOUT_AIR": (
        {
            "en": "there is no air: the lowest value is {low} HU; the values may not be Hounsfield units",
            "de": "es gibt keine Luft: der kleinste Wert ist {low} HU; die Werte sind vielleicht keine "
            "Hounsfield-Einheiten",
        },
    ),
    "CT_WITHOUT_BONE": (
        {
            "en": "there is no bone: the highest value is {high} HU",
            "de": "es gibt keinen Knochen: der größte Wert ist {high} HU",
        },
    ),
}
_LABELS: Mapping[str, tuple[Text, ...]] = {
    "LABELS_CUT": (
        {
            "en": "cut by the border of the CT: {levels}",
            "de": "vom Rand des CT abgeschnitten: {levels}",
        },
    ),
    "LABELS_OF_OTHER_PARTS": (
        {
            "en": "{others} labels are no vertebra and are not used",
            "de": "{others} Labels sind kein Wirbel und werden nicht verwendet",
        },
    ),
    "LABELS_PARTLY_OUTSIDE_CT": (
        {
            "en": "{outside_ratio:.0%} of the labels lie outside of the CT",
            "de": "{outside_ratio:.0%} der Labels liegen außerhalb des CT",
        },
    ),
    "LABELS_TOO_SMALL": (
        {
            "en": "not used, because less than {min_ml:g} ml lie in the CT: {levels}",
            "de": "nicht verwendet, weil weniger als {min_ml:g} ml im CT liegen: {levels}",
        },
    ),
    "LABELS_UNNAMED": (
        {
            "en": "the file does not name its labels; their numbers were read as those of "
            "TotalSegmentator v2",
            "de": "die Datei benennt ihre Labels nicht; ihre Nummern wurden wie die von "
            "TotalSegmentator v2 gelesen",
        },
    ),
}
_SURFACE: Mapping[str, tuple[Text, ...]] = {
    "BONE_AVERAGED": (
        {
            "en": "there are too many voxels for full resolution, so {averaged} of them were averaged to one "
            "of {size} mm",
            "de": "für die volle Auflösung sind es zu viele Voxel, daher wurden je {averaged} zu einem von "
            "{size} mm gemittelt",
        },
    ),
    "BONE_CONTRADICTS_PLAN": (
        {
            "en": "on the planned axis the drill is {through_mm:.1f} mm through the bone's surface",
            "de": "auf der geplanten Achse ist der Bohrer {through_mm:.1f} mm durch die Knochenoberfläche",
        },
    ),
    "BONE_CUT_BY_CT": (
        {
            "en": "the bone continues beyond the CT: it is cut at the {cut_ends}",
            "de": "der Knochen reicht über das CT hinaus: er ist abgeschnitten an: {cut_ends}",
        },
    ),
    "BONE_THRESHOLD_UNUSUAL": (
        {
            "en": "the threshold of {threshold_hu:.0f} HU is far from the {proposed_hu:.0f} HU that the "
            "histogram proposes",
            "de": "die Schwelle von {threshold_hu:.0f} HU liegt weit von den {proposed_hu:.0f} HU, die das "
            "Histogramm nahelegt",
        },
    ),
    "MESH_CLEANED": (
        {
            "en": "{dropped_faces} degenerate or duplicate triangles of the mesh were removed",
            "de": "{dropped_faces} entartete oder doppelte Dreiecke des Netzes wurden entfernt",
        },
    ),
    "MESH_FLIPPED": (
        {
            "en": "{flipped_faces} of {faces} triangles were inside out and were flipped",
            "de": "{flipped_faces} von {faces} Dreiecken waren nach innen gewendet und wurden umgedreht",
        },
    ),
    "MESH_FROM_RAS": (
        {
            "en": "the mesh is in RAS; its first two axes were flipped to LPS",
            "de": "das Netz ist in RAS; seine ersten beiden Achsen wurden nach LPS umgekehrt",
        },
    ),
    "MESH_IN_PARTS": (
        {
            "en": "the mesh has {parts} parts that do not touch",
            "de": "das Netz hat {parts} Teile, die sich nicht berühren",
        },
    ),
    "MESH_NOT_MANIFOLD": (
        {
            "en": "the mesh has {non_manifold_edges} edges on which more than two triangles meet",
            "de": "das Netz hat {non_manifold_edges} Kanten, an denen mehr als zwei Dreiecke liegen",
        },
    ),
    "MESH_OPEN": (
        {
            "en": "the mesh is open: {border_edges} edges belong to one triangle only",
            "de": "das Netz ist offen: {border_edges} Kanten gehören nur zu einem Dreieck",
        },
    ),
    "MESH_SEVERAL_VERTEBRAE": (
        {
            "en": "the mesh is {size} mm, the size of several vertebrae or a whole spine",
            "de": "das Netz ist {size} mm groß, so groß wie mehrere Wirbel oder eine ganze Wirbelsäule",
        },
    ),
}
_PEDICLE: Mapping[str, tuple[Text, ...]] = {
    "PEDICLE_ANGLE_UNSURE": (
        {
            "en": "its walls hardly determine its transverse angle: 10 deg of difference in the usual angle "
            "there would change it by {change_deg:.0f} deg",
            "de": "seine Wände bestimmen den transversalen Winkel kaum: bei 10° anderem üblichem Winkel dort "
            "würde er sich um {change_deg:.0f}° ändern",
        },
    ),
    "PEDICLE_AXIS_LEAVES_ASIDE": (
        {
            "en": "the axis leaves the body through its {body_wall} (at {slant_deg:.0f} deg to its normal), "
            "not the front wall; the length ends there",
            "de": "die Achse verlässt den Wirbelkörper durch die {body_wall} (unter {slant_deg:.0f}° zu "
            "deren Normale), nicht durch die Vorderwand; die Länge endet dort",
        },
    ),
    "PEDICLE_BACK_NOT_FOUND": (
        {
            "en": "no bone surface was found behind; entry and length extend to the end of the visible part",
            "de": "hinten wurde keine Knochenoberfläche gefunden; Eintritt und Länge reichen bis zum Ende "
            "des sichtbaren Teils",
        },
    ),
    "PEDICLE_BEHIND_PROCESS": (
        {
            "en": "behind the entry the axis runs on through a process for {beyond_mm:.0f} mm; the length "
            "begins where the arch around it ends",
            "de": "hinter dem Eintritt verläuft die Achse noch {beyond_mm:.0f} mm durch einen Fortsatz; die "
            "Länge beginnt, wo der Bogen um sie endet",
        },
    ),
    "PEDICLE_CANAL_LATE": (
        {
            "en": "bone seems to extend {beyond_mm:.0f} mm beyond the medial wall ({usual_mm:.0f} mm are "
            "usual in such voxels); the isthmus may lie too far in front",
            "de": "der Knochen reicht offenbar {beyond_mm:.0f} mm über die mediale Wand hinaus "
            "({usual_mm:.0f} mm sind bei solchen Voxeln üblich); der Isthmus liegt vielleicht zu weit vorn",
        },
    ),
    "PEDICLE_FEW_VOXELS": (
        {
            "en": "the pedicle is only {voxels:.1f} voxels wide, a reliable width needs {needed:.0f} or more",
            "de": "der Pedikel ist nur {voxels:.1f} Voxel breit, eine verlässliche Breite braucht mindestens "
            "{needed:.0f}",
        },
    ),
    "PEDICLE_FRONT_TOUCHED": (
        {
            "en": "something as dense as bone touches the front wall, perhaps a vessel with contrast; the "
            "length ends at the outline of the body",
            "de": "etwas so Dichtes wie Knochen berührt die Vorderwand, vielleicht ein Gefäß mit "
            "Kontrastmittel; die Länge endet am Umriss des Wirbelkörpers",
        },
    ),
    "PEDICLE_FRONT_UNSURE": (
        {
            "en": "no front wall was found with certainty; the length ends where bone may end",
            "de": "keine Vorderwand wurde sicher gefunden; die Länge endet, wo der Knochen vielleicht endet",
        },
    ),
    "PEDICLE_SECTION_OBLIQUE": (
        {
            "en": "its section is oblique, {width_mm:.1f} x {height_mm:.1f} mm across its own axes; the "
            "smaller extent is given as its width",
            "de": "sein Querschnitt ist schräg, {width_mm:.1f} x {height_mm:.1f} mm längs seiner eigenen "
            "Achsen; die kleinere Ausdehnung ist als Breite angegeben",
        },
    ),
    "PEDICLE_SHORT": (
        {
            "en": "its narrow part is only {length_mm:.1f} mm long; its direction is less certain",
            "de": "sein enger Teil ist nur {length_mm:.1f} mm lang; seine Richtung ist weniger sicher",
        },
    ),
    "PEDICLE_SIDE_UNSURE": (
        {
            "en": "the {vertebra_part} lies as if this were not the {side_name} side",
            "de": "der {vertebra_part} liegt so, als wäre dies nicht die {side_name} Seite",
        },
    ),
    "PEDICLE_WALLS_NOT_FITTED": (
        {
            "en": "too few voxels to fit its walls; the values are those of coarse sections",
            "de": "zu wenige Voxel, um seine Wände anzupassen; die Werte sind die grober Querschnitte",
        },
    ),
    "PEDICLE_WITHOUT_BODY": (
        {
            "en": "it does not widen within {within_mm:.0f} mm in front",
            "de": "er wird vorn innerhalb von {within_mm:.0f} mm nicht weiter",
        },
    ),
}
_REGISTRATION: Mapping[str, tuple[Text, ...]] = {
    "POINTS_OUTLIER_NOT_EXCLUDED": (
        {
            "en": "{count} landmarks do not exclude an error {error_extent} in {doubtful_landmarks}; the "
            "stated error includes one landmark with an error of {gross_error_mm:g} mm (3-D RMS)",
            "de": "{count} Landmarken schließen einen Fehler {error_extent} nicht aus in: "
            "{doubtful_landmarks}; der angegebene Fehler enthält eine Landmarke mit einem Fehler von "
            "{gross_error_mm:g} mm (3-D-RMS)",
        },
    ),
    "POINTS_SCALE_DIFFERS": (
        {
            "en": "as touched the points are {difference_ratio:.1%} {size_comparison} than on the CT",
            "de": "beim Antasten sind die Punkte {difference_ratio:.1%} {size_comparison} als auf dem CT",
        },
    ),
    "POINTS_SWAP_UNDETECTABLE": (
        {
            "en": "a swap of {exchanged_points} would not be detected: the points fit to {fre_mm:.2f} mm RMS "
            "as given and to {other_order_fre_mm:.2f} mm swapped",
            "de": "eine Vertauschung ({exchanged_points}) würde nicht erkannt: die Punkte passen wie gegeben "
            "auf {fre_mm:.2f} mm RMS und vertauscht auf {other_order_fre_mm:.2f} mm",
        },
    ),
    "SURFACE_CONSTRAINED_BY_LANDMARKS": (
        {
            "en": "the sweep can slide {direction}; only the landmarks prevent it",
            "de": "das Abfahren kann gleiten, {direction}; nur die Landmarken verhindern es",
        },
    ),
}
REMARKS: Mapping[str, tuple[Text, ...]] = {
    **_CALIBRATION,
    "PRINCIPAL_POINT_UNCERTAIN": _CALIBRATION["FOCAL_LENGTH_UNCERTAIN"],
    **_CT,
    **_LABELS,
    **_SURFACE,
    **_PEDICLE,
    **_REGISTRATION,
}

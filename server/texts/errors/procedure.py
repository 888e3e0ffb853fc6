"""Messages of errors of procedure, plan and supervision, by code."""

from collections.abc import Mapping

from server.texts.language import Text

PROCEDURE: Mapping[str, tuple[Text, ...]] = {
    "BODY_TOO_LARGE": (
        {
            "en": "the request has at least {size_kb:.0f} kB, the maximum is {allowed_kb:g} kB",
            "de": "die Anfrage hat mindestens {size_kb:.0f} kB, höchstens {allowed_kb:g} kB",
        },
    ),
    "CALIBRATION_ABOVE_GATE": (
        {
            "en": "the reprojection error is {rms_px} px RMS, limit {max_rms_px:g} px; the calibration was "
            "not stored",
            "de": "der Reprojektionsfehler ist {rms_px} px RMS, Grenze {max_rms_px:g} px; die Kalibrierung "
            "wurde nicht gespeichert",
        },
    ),
    "CAMERA_DIFFERS": (
        {
            "en": "the camera changed from '{before}' to '{now}' while views were taken",
            "de": "die Kamera wechselte während der Aufnahme von „{before}“ zu „{now}“",
        },
        {
            "en": "{title} was calibrated for '{calibrated}', but images come from '{source}'",
            "de": "{title} wurde für „{calibrated}“ kalibriert, die Bilder kommen aber von „{source}“",
        },
        {
            "en": "the camera '{calibrated}' was calibrated, but images come from '{camera}'",
            "de": "kalibriert wurde die Kamera „{calibrated}“, die Bilder kommen aber von „{camera}“",
        },
    ),
    "CASE_NOT_OPEN": (
        {"en": "the case {case_id} is not open", "de": "der Fall {case_id} ist nicht geöffnet"},
        {
            "en": "another case was opened since the question was asked",
            "de": "inzwischen wurde ein anderer Fall geöffnet",
        },
    ),
    "COLLECTION_EMPTY": (
        {
            "en": "no view of the board has been taken yet",
            "de": "es ist noch keine Ansicht der Tafel aufgenommen",
        },
    ),
    "COLLECTION_UNREADY": (
        {
            "en": "{images} images of the burst have been processed so far",
            "de": "bisher sind {images} Bilder der Serie verarbeitet",
        },
    ),
    "CONFIRMATION_OUT_OF_DATE": (
        {
            "en": "the displayed registration is no longer in use; {title} is in use now",
            "de": "die angezeigte Registrierung gilt nicht mehr; jetzt gilt {title}",
        },
    ),
    "CONFIRMATION_UNSEEN": (
        {
            "en": "there is no image of the camera, so nothing can be verified",
            "de": "es gibt kein Bild der Kamera, daher kann nichts geprüft werden",
        },
    ),
    "CT_CHANGED": (
        {
            "en": "the CT was replaced during the measurement of the pedicle; nothing was stored",
            "de": "das CT wurde während der Messung des Pedikels ersetzt; nichts wurde gespeichert",
        },
    ),
    "CT_MISSING": ({"en": "the open case has no CT", "de": "der geöffnete Fall hat kein CT"},),
    "CT_REPLACED": (
        {
            "en": "the channel was not planned on the newest CT of this case",
            "de": "der Kanal wurde nicht auf dem neuesten CT dieses Falls geplant",
        },
    ),
    "DRILL_NOT_IN_BONE": (
        {
            "en": "the tip is {before_mm:.1f} mm before the entry of {channel}",
            "de": "die Spitze ist {before_mm:.1f} mm vor dem Eintritt von {channel}",
        },
    ),
    "DRILL_NOT_IN_CHANNEL": (
        {
            "en": "the drill is at {angle_deg:.0f} deg to {channel}, the limit is {max_angle_deg:g} deg",
            "de": "der Bohrer steht {angle_deg:.0f} Grad zu {channel}, Grenze {max_angle_deg:g} Grad",
        },
        {
            "en": "the axis of the drill is {offset_mm:.1f} mm from the entry of {channel}, "
            "the limit is {max_offset_mm:g} mm",
            "de": "die Achse des Bohrers ist {offset_mm:.1f} mm vom Eintritt von {channel} entfernt, "
            "Grenze {max_offset_mm:g} mm",
        },
    ),
    "HOLD_NOT_YOURS": (
        {
            "en": "the hold was requested by {by}, not by {person}",
            "de": "den Halt hat {by} erbeten, nicht {person}",
        },
    ),
    "IMAGE_SIZE_CHANGED": (
        {
            "en": "the image size changed from {before_width_px}x{before_height_px} px to "
            "{width_px}x{height_px} px",
            "de": "die Bildgröße änderte sich von {before_width_px}x{before_height_px} px auf "
            "{width_px}x{height_px} px",
        },
    ),
    "IMAGE_UNREADABLE": (
        {
            "en": "{image} is not a readable image ({size_bytes} bytes)",
            "de": "{image} ist kein lesbares Bild ({size_bytes} Bytes)",
        },
    ),
    "JOB_UNKNOWN": ({"en": "there is no job {job_id}", "de": "es gibt keinen Auftrag {job_id}"},),
    "LATENCY_CASE_CHANGED": (
        {
            "en": "the open case was closed or changed during the latency measurement",
            "de": "der geöffnete Fall wurde während der Latenzmessung geschlossen oder gewechselt",
        },
    ),
    "LATENCY_PAGE_LEFT": (
        {
            "en": "the page that shows the codes was silent for {silent_s:.1f} s, limit {max_silent_s:g} s",
            "de": "die Seite mit den Codes war {silent_s:.1f} s still, Grenze {max_silent_s:g} s",
        },
    ),
    "LATENCY_TOO_LONG": (
        {
            "en": "no result after {images} images, the maximum",
            "de": "kein Ergebnis nach {images} Bildern, das ist die Höchstzahl",
        },
    ),
    "MARKERS_ENOUGH": (
        {
            "en": "{markers} markers are tracked, the maximum is {allowed}",
            "de": "{markers} Marker werden verfolgt, höchstens {allowed}",
        },
    ),
    "NO_CAMERA_IN_USE": (
        {
            "en": "this step needs images of a camera, but the poses come from an external tracker",
            "de": "dieser Schritt braucht Bilder einer Kamera, aber die Lagen kommen von einem externen "
            "Trackingsystem",
        },
    ),
    "MARKER_WITHOUT_IMAGE": (
        {
            "en": "'{marker}' is a rigid body of an external tracker, which has no image",
            "de": "„{marker}“ ist ein Starrkörper eines externen Trackingsystems und hat kein Bild",
        },
    ),
    "MARKER_OF_SETTINGS": (
        {
            "en": "the marker '{marker}' is defined in the settings and cannot be changed in a case",
            "de": "der Marker „{marker}“ steht in den Einstellungen und kann in einem Fall nicht geändert "
            "werden",
        },
    ),
    "MARKER_UNKNOWN": (
        {"en": "there is no marker '{marker}'", "de": "es gibt keinen Marker „{marker}“"},
        {"en": "the marker '{marker}' is not tracked", "de": "der Marker „{marker}“ wird nicht verfolgt"},
    ),
    "NOTHING_YET": (
        {
            "en": "the tracking process has sent no message since the server started",
            "de": "der Tracking-Prozess hat seit dem Start des Servers nichts gemeldet",
        },
    ),
    "NOT_A_REHEARSAL": (
        {
            "en": "images come from {source}, not from the rehearsal",
            "de": "die Bilder kommen von {source}, nicht aus dem Probebetrieb",
        },
    ),
    "NO_ACTIVE_CHANNEL": (
        {
            "en": "the open case has no active channel",
            "de": "im geöffneten Fall ist kein Kanal zum Bohren gewählt",
        },
    ),
    "NO_CASE_OPEN": (
        {
            "en": "no case is open, so no result can be stored",
            "de": "es ist kein Fall geöffnet, daher kann kein Ergebnis gespeichert werden",
        },
    ),
    "NO_PICTURE": (
        {"en": "there is no image for the measurement", "de": "es gibt kein Bild für die Messung"},
        {
            "en": "the camera delivers no images, so that nothing can be timed",
            "de": "die Kamera liefert keine Bilder, daher ist keine Zeitmessung möglich",
        },
        {"en": "there are no more images", "de": "es kommen keine Bilder mehr"},
        {
            "en": "there is no image in which needles could be detected",
            "de": "es gibt kein Bild, in dem Nadeln gesucht werden könnten",
        },
    ),
    "PLACEMENT_NO_CHANNEL": (
        {
            "en": "no channel is active, so it is not known which screw was placed",
            "de": "kein Kanal ist gewählt, daher ist unbekannt, welche Schraube gesetzt wurde",
        },
    ),
    "PLACEMENT_NO_IMAGE": (
        {
            "en": "there is no image, so the position of the drill is not known",
            "de": "es gibt kein Bild, daher ist die Lage des Bohrers unbekannt",
        },
        {
            "en": "the newest image is {age_s:.1f} s old, so the position of the drill is not known",
            "de": "das neueste Bild ist {age_s:.1f} s alt, daher ist die Lage des Bohrers unbekannt",
        },
    ),
    "PLACEMENT_NO_NUMBERS": (
        {
            "en": "the newest image does not show where the drill is in the bone ({reason})",
            "de": "das neueste Bild zeigt nicht, wo der Bohrer im Knochen ist ({reason})",
        },
    ),
    "PLACEMENT_NO_SCREW": (
        {
            "en": "no screw is planned for {channel}, so its size is not known",
            "de": "für {channel} ist keine Schraube geplant, daher ist ihre Größe unbekannt",
        },
    ),
    "PLACEMENT_OTHER_CHANNEL": (
        {
            "en": "{channel} is the active channel now, not {stated_channel}",
            "de": "jetzt ist {channel} der gewählte Kanal, nicht {stated_channel}",
        },
    ),
    "PLACEMENT_SETUP_CHANGED": (
        {
            "en": "the newest image was computed with another channel or registration than the case has now",
            "de": "das neueste Bild wurde mit einem anderen Kanal oder einer anderen Registrierung "
            "berechnet, als der Fall jetzt hat",
        },
    ),
    "PLACEMENT_UNKNOWN": (
        {"en": "{title} is not a placed screw", "de": "{title} ist keine gesetzte Schraube"},
    ),
    "PLAN_EMPTY": (
        {
            "en": "the plan has {vertebrae} vertebrae, but no landmark and no channel",
            "de": "die Planung hat {vertebrae} Wirbel, aber keine Landmarke und keinen Kanal",
        },
    ),
    "PLAN_MISSING": ({"en": "the open case has no plan", "de": "der geöffnete Fall hat keine Planung"},),
    "PLAN_OF_ANOTHER_CT": (
        {
            "en": "the plan was made on another CT than that of the open case, or does not state its CT",
            "de": "die Planung entstand auf einem anderen CT als dem des geöffneten Falls, oder sie nennt "
            "ihr CT nicht",
        },
    ),
    "PLAN_OUT_OF_DATE": (
        {"en": "the plan is out of date: {reason}", "de": "die Planung ist veraltet: {reason}"},
    ),
    "REFERENCE_MISSING": (
        {"en": "{vertebra} has no reference slice", "de": "{vertebra} hat keine Referenzschicht"},
    ),
    "REGISTRATION_CHANGED": (
        {
            "en": "{title} was checked, but the newest version is {version}",
            "de": "geprüft wurde {title}, die neueste Version ist aber {version}",
        },
    ),
    "SCREW_INCOMPLETE": (
        {
            "en": "only one of diameter_mm and length_mm was given",
            "de": "nur eines von diameter_mm und length_mm wurde angegeben",
        },
    ),
    "SIGNATURE_NOT_YOURS": (
        {
            "en": "this was signed by {signer}, not by {person}",
            "de": "dies hat {signer} gegengezeichnet, nicht {person}",
        },
    ),
    "SIGNED_VERSION_OLD": (
        {
            "en": "the {kind} has changed since it was displayed; it is now {title}",
            "de": "{kind}: seit der Anzeige geändert; jetzt {title}",
        },
    ),
    "SLICE_OUTSIDE_CT": (
        {
            "en": "slice {slice_index} was requested, the CT has {slices} (0 to {last})",
            "de": "verlangt wurde Schicht {slice_index}, das CT hat {slices} (0 bis {last})",
        },
        {
            "en": "the reference slice is number {slice_index}, the CT has {slices}",
            "de": "die Referenzschicht hat die Nummer {slice_index}, das CT hat {slices}",
        },
    ),
    "SURFACE_MISSING": (
        {"en": "the open case has no bone surface", "de": "der geöffnete Fall hat keine Knochenoberfläche"},
    ),
    "UPLOAD_CUT": (
        {
            "en": "the connection ended after {taken_mb:.1f} MB",
            "de": "die Verbindung endete nach {taken_mb:.1f} MB",
        },
    ),
    "UPLOAD_EMPTY": ({"en": "the request body is empty", "de": "die Anfrage enthält keine Datei"},),
    "UPLOAD_TOO_LARGE": (
        {
            "en": "the file has {size_mb:.1f} MB or more, the maximum is {max_mb:g} MB",
            "de": "die Datei hat {size_mb:.1f} MB oder mehr, höchstens {max_mb:g} MB",
        },
    ),
    "UPLOAD_UNKNOWN": (
        {
            "en": "no upload {upload_id} is being read or waits for the choice of a series",
            "de": "kein Upload {upload_id} wird gelesen oder wartet auf die Wahl einer Serie",
        },
    ),
    "VIEWS_ENOUGH": (
        {
            "en": "{views} views have been taken, the maximum",
            "de": "{views} Ansichten sind aufgenommen, das ist die Höchstzahl",
        },
    ),
    "PEDICLE_CUT": (
        {
            "en": "the CT ends within the pedicle: {outside_percent:.0f} % of its wall lie outside, none may",
            "de": "das CT endet im Pedikel: {outside_percent:.0f} % seiner Wand liegen außerhalb, "
            "erlaubt ist nichts",
        },
    ),
    "PEDICLE_DOUBTFUL": (
        {
            "en": "the narrowest section that was found, {width_mm:.1f} x {height_mm:.1f} mm at "
            "{centre} mm, is hardly the pedicle's: beyond its medial wall bone goes on for "
            "{beyond_mm:.0f} mm (allowed {allowed_mm:.0f} mm), where the canal should begin",
            "de": "der engste gefundene Querschnitt, {width_mm:.1f} x {height_mm:.1f} mm bei {centre} "
            "mm, ist kaum der des Pedikels: jenseits seiner medialen Wand reicht Knochen noch "
            "{beyond_mm:.0f} mm weiter (erlaubt {allowed_mm:.0f} mm), wo der Spinalkanal "
            "beginnen müsste",
        },
        {
            "en": "the narrowest section from the click is {width_mm:.1f} x {height_mm:.1f} mm, and "
            "{second}; they should be one",
            "de": "der engste Querschnitt von der angetippten Stelle aus ist {width_mm:.1f} x "
            "{height_mm:.1f} mm, und {second}; beide müssten gleich sein",
        },
        {
            "en": "on the axis bone seems to end {front_mm:.0f} mm in front of the isthmus, but beside the "
            "axis the body reaches {chord_mm:.0f} mm (allowed difference {allowed_mm:.0f} mm): the front "
            "wall was not found",
            "de": "auf der Achse scheint der Knochen {front_mm:.0f} mm vor dem Isthmus zu enden, neben der "
            "Achse reicht der Wirbelkörper aber {chord_mm:.0f} mm weit (erlaubter Unterschied "
            "{allowed_mm:.0f} mm): die Vorderwand wurde nicht gefunden",
        },
        {
            "en": "from entry to front wall the axis runs {length_mm:.1f} mm in bone ({min_mm:.0f} to "
            "{max_mm:.0f} mm are possible): entry, front wall or direction are mistaken",
            "de": "vom Eintritt bis zur Vorderwand verläuft die Achse {length_mm:.1f} mm im Knochen "
            "({min_mm:.0f} bis {max_mm:.0f} mm sind möglich): Eintritt, Vorderwand oder Richtung sind falsch",
        },
    ),
    "PEDICLE_NOT_FOUND": (
        {
            "en": "the bone at the click ({seed_hu:.0f} HU) is open on all sides: no section of it "
            "within 7 mm is closed",
            "de": "der Knochen an der angetippten Stelle ({seed_hu:.0f} HU) ist nach allen Seiten "
            "offen: kein Querschnitt innerhalb von 7 mm ist geschlossen",
        },
        {
            "en": "the bone around the click is not a pedicle: {bone_shape} (noise {noise_hu:.0f} HU)",
            "de": "der Knochen um die angetippte Stelle ist kein Pedikel: {bone_shape} (Rauschen "
            "{noise_hu:.0f} HU)",
        },
    ),
    "SEED_INVALID": (
        {
            "en": "the click is not three finite numbers",
            "de": "die angetippte Stelle besteht nicht aus drei endlichen Zahlen",
        },
    ),
    "SEED_IN_AIR": (
        {
            "en": "the click lies in air or lung: {seed_hu:.0f} HU, bone begins far above {air_hu:.0f} HU",
            "de": "die angetippte Stelle liegt in Luft oder Lunge: {seed_hu:.0f} HU, Knochen beginnt "
            "weit über {air_hu:.0f} HU",
        },
    ),
    "SEED_NOT_IN_BONE": (
        {
            "en": "the click lies in {seed_hu:.0f} HU and no wall of bone closes around it, bone here "
            "is above {limit_hu:.0f} HU",
            "de": "die angetippte Stelle liegt in {seed_hu:.0f} HU, und keine Knochenwand schließt "
            "sich um sie, Knochen liegt hier über {limit_hu:.0f} HU",
        },
    ),
    "SEED_NOT_IN_PEDICLE": (
        {
            "en": "the nearest bar of bone does not contain the click: it lies {outside_mm:.1f} mm "
            "beside its wall (allowed {allowed_mm:.1f} mm) and {beyond_mm:.1f} mm beyond its end "
            "(allowed 9 mm)",
            "de": "der nächste Knochensteg enthält die angetippte Stelle nicht: sie liegt "
            "{outside_mm:.1f} mm neben seiner Wand (erlaubt {allowed_mm:.1f} mm) und "
            "{beyond_mm:.1f} mm hinter seinem Ende (erlaubt 9 mm)",
        },
    ),
    "SEED_ON_OTHER_SIDE": (
        {
            "en": "side is {side}, but canal and body lie as they do beside the patient's {other_side} "
            "pedicle",
            "de": "als Seite ist {side} angegeben, aber Spinalkanal und Wirbelkörper liegen wie beim "
            "Pedikel {other_side}",
        },
    ),
    "SEED_OUTSIDE_CT": (
        {
            "en": "the click at {seed} mm lies outside the CT, which reaches from {low} to {high} mm (LPS)",
            "de": "die angetippte Stelle bei {seed} mm liegt außerhalb des CT, das von {low} bis "
            "{high} mm reicht (LPS)",
        },
    ),
    "BONE_INSIDE_OUT": (
        {
            "en": "the bone's surface encloses {volume_ml:.1f} ml: its triangles are clockwise",
            "de": "die Knochenoberfläche umschließt {volume_ml:.1f} ml: ihre Dreiecke laufen im "
            "Uhrzeigersinn",
        },
    ),
    "BONE_NOT_AT_CHANNEL": (
        {
            "en": "{in_bone_percent:.0f} % of channel '{channel}' lies inside of the bone's surface, "
            "needed {needed_percent:.0f} % or more",
            "de": "{in_bone_percent:.0f} % des Kanals „{channel}“ liegen in der Knochenoberfläche, "
            "nötig {needed_percent:.0f} % oder mehr",
        },
    ),
    "BONE_THRESHOLD_OUTSIDE": (
        {
            "en": "a threshold of {threshold_hu:.0f} HU separates no voxels, which range from "
            "{lowest_hu:.0f} to {highest_hu:.0f} HU",
            "de": "ein Schwellwert von {threshold_hu:.0f} HU trennt keine Voxel, sie reichen von "
            "{lowest_hu:.0f} bis {highest_hu:.0f} HU",
        },
    ),
    "BONE_TOO_LARGE": (
        {
            "en": "at {threshold_hu:.0f} HU the surface has {vertices} vertices, allowed {max_vertices}",
            "de": "bei {threshold_hu:.0f} HU hat die Oberfläche {vertices} Eckpunkte, erlaubt {max_vertices}",
        },
    ),
    "CHANNEL_INVALID": (
        {
            "en": "channel '{channel}' is {length_mm:.2f} mm long with radius {radius_mm:.2f} mm, "
            "needed at least 1 mm and above 0 mm",
            "de": "der Kanal „{channel}“ ist {length_mm:.2f} mm lang mit einem Radius von "
            "{radius_mm:.2f} mm, nötig mindestens 1 mm und über 0 mm",
        },
    ),
    "CHANNEL_MISSING": (
        {"en": "{vertebra} has no {side} channel", "de": "{vertebra} hat {side} keinen Kanal"},
    ),
    "CHANNEL_OUTSIDE_CT": (
        {
            "en": "channel '{channel}' runs from {entry} to {target} mm, which is not all within the CT",
            "de": "der Kanal „{channel}“ verläuft von {entry} bis {target} mm und liegt damit nicht "
            "ganz im CT",
        },
    ),
    "CORRECTION_INVALID": (
        {
            "en": "'{name}' cannot be corrected, allowed are {allowed}",
            "de": "„{name}“ kann nicht korrigiert werden, erlaubt sind {allowed}",
        },
        {
            "en": "{number} was corrected to {corrected}, allowed are {low:g} to {high:g}",
            "de": "{number} wurde auf {corrected} korrigiert, erlaubt sind {low:g} bis {high:g}",
        },
    ),
    "CROP_OUTSIDE_CT": (
        {
            "en": "around the channels the CT has only {voxels} voxels, needed 2 along each axis",
            "de": "um die Kanäle herum hat das CT nur {voxels} Voxel, nötig 2 längs jeder Achse",
        },
    ),
    "FIELD_TOO_LARGE": (
        {
            "en": "the distances around the channel would take {nodes} nodes, allowed {max_nodes}",
            "de": "die Abstände um den Kanal bräuchten {nodes} Knoten, erlaubt {max_nodes}",
        },
    ),
    "LANDMARK_INVALID": (
        {
            "en": "landmark '{name}' has a place of shape {shape}, needed a name and three finite numbers",
            "de": "die Landmarke „{name}“ hat einen Ort der Form {shape}, nötig ein Name und drei "
            "endliche Zahlen",
        },
    ),
    "LANDMARK_OUTSIDE_CT": (
        {
            "en": "landmark '{name}' was set at ({point}) mm, which is not within the CT",
            "de": "die Landmarke „{name}“ wurde bei ({point}) mm gesetzt, das liegt nicht im CT",
        },
    ),
    "LANDMARK_TWICE": (
        {
            "en": "{landmarks} landmarks have only {different} different names; '{name}' is there "
            "{times} times",
            "de": "{landmarks} Landmarken haben nur {different} verschiedene Namen; „{name}“ kommt "
            "{times}-mal vor",
        },
    ),
    "LINES_INVALID": (
        {
            "en": "the outer lines stand {apart_mm} mm from the middle, allowed are {min_mm:.0f} to 100 mm",
            "de": "die äußeren Linien stehen {apart_mm} mm von der Mitte, erlaubt sind {min_mm:.0f} "
            "bis 100 mm",
        },
    ),
    "MIDDLE_OUTSIDE_CT": (
        {
            "en": "the middle line was set through ({middle}) mm, not on slice {slice_index} of the CT",
            "de": "die mittlere Linie wurde durch ({middle}) mm gelegt, nicht auf Schicht "
            "{slice_index} des CT",
        },
    ),
    "MIDDLE_UNKNOWN": (
        {
            "en": "{pedicles} pedicle is measured, the middle lies between 2",
            "de": "{pedicles} Pedikel ist gemessen, die Mitte liegt zwischen 2",
        },
    ),
    "NO_PEDICLE_MEASURED": (
        {
            "en": "0 pedicles are measured, a slice is proposed from 1 or 2",
            "de": "0 Pedikel sind gemessen, eine Schicht wird aus 1 oder 2 vorgeschlagen",
        },
    ),
    "NO_SCREW_FITS": (
        {
            "en": "the path leaves {nearest_wall_mm:.1f} mm to the nearest wall and {front_mm:.1f} mm "
            "to the front; the smallest screw is {thinnest_mm:.1f} x {shortest_mm:.0f} mm and "
            "needs {needed_wall_mm:.1f} and {needed_front_mm:.1f} mm",
            "de": "der Pfad lässt {nearest_wall_mm:.1f} mm bis zur nächsten Wand und {front_mm:.1f} mm "
            "nach vorn; die kleinste Schraube misst {thinnest_mm:.1f} x {shortest_mm:.0f} mm und "
            "braucht {needed_wall_mm:.1f} und {needed_front_mm:.1f} mm",
        },
    ),
    "PEDICLE_MISSING": (
        {
            "en": "the {side} pedicle of {vertebra} is not measured",
            "de": "der Pedikel {side} von {vertebra} ist nicht gemessen",
        },
    ),
    "PLANE_INVALID": (
        {
            "en": "the two directions of the plane are parallel or zero",
            "de": "die beiden Richtungen der Ebene sind parallel oder null",
        },
    ),
    "PLAN_INVALID": (
        {
            "en": "the plan names {vertebrae} vertebrae, but only {different} different ones: {names}",
            "de": "die Planung nennt {vertebrae} Wirbel, aber nur {different} verschiedene: {names}",
        },
    ),
    "SCREW_INVALID": (
        {
            "en": "the screw is {diameter_mm} x {length_mm} mm, allowed are diameters under 20 and "
            "lengths under 200 mm",
            "de": "die Schraube misst {diameter_mm} x {length_mm} mm, erlaubt sind Durchmesser unter "
            "20 und Längen unter 200 mm",
        },
    ),
    "SIDE_INVALID": (
        {
            "en": "side is '{given_side}', allowed are left and right",
            "de": "als Seite ist „{given_side}“ angegeben, erlaubt sind left und right",
        },
    ),
    "SLAB_INVALID": (
        {
            "en": "a slab of {slab_mm:g} mm cannot be shown, allowed 0 to {max_mm:.0f} mm",
            "de": "eine Schichtdicke von {slab_mm:g} mm kann nicht gezeigt werden, erlaubt 0 bis "
            "{max_mm:.0f} mm",
        },
    ),
    "SLICE_TOO_LARGE": (
        {
            "en": "a slice of {width_mm:.1f} x {height_mm:.1f} mm with pixels of {pixel_mm:.4f} mm "
            "cannot be shown, allowed {max_px} pixels a side",
            "de": "eine Schicht von {width_mm:.1f} x {height_mm:.1f} mm mit Pixeln von {pixel_mm:.4f} "
            "mm kann nicht gezeigt werden, erlaubt {max_px} Pixel je Seite",
        },
    ),
    "VERTEBRA_UNKNOWN": (
        {
            "en": "the plan has no vertebra '{name}', it has {existing}",
            "de": "die Planung hat keinen Wirbel „{name}“, sie hat {existing}",
        },
    ),
    "WINDOW_INVALID": (
        {
            "en": "a window of {width_hu:g} HU around {centre_hu:g} HU shows nothing, needed a width above 0",
            "de": "ein Fenster von {width_hu:g} HU um {centre_hu:g} HU zeigt nichts, nötig ist eine "
            "Breite über 0",
        },
    ),
    "ALARM_NOT_LOGGED": (
        {
            "en": "the alarm log failed: {cause}",
            "de": "das Alarmprotokoll ist ausgefallen: {cause}",
        },
        {
            "en": "the action could not be written to the alarm log within {timeout_s:g} s",
            "de": "die Aktion konnte nicht innerhalb von {timeout_s:g} s in das Alarmprotokoll "
            "geschrieben werden",
        },
    ),
    "MESH_FORMAT_UNKNOWN": (
        {
            "en": "the start of the file ({bytes} bytes) is not that of STL, OBJ or PLY",
            "de": "der Anfang der Datei ({bytes} Bytes) ist nicht der von STL, OBJ oder PLY",
        },
    ),
    "SCREW_NOT_IN_CATALOGUE": (
        {
            "en": "the catalogue has no screw of {diameter_mm:g} x {length_mm:g} mm",
            "de": "der Katalog hat keine Schraube von {diameter_mm:g} x {length_mm:g} mm",
        },
    ),
    "CHANNEL_DIRECTION_UNKNOWN": (
        {
            "en": "the line in {file} runs {forward_mm:.1f} mm anteriorly from its first point to its "
            "second; the first point counts as the entry from {min_forward_mm:g} mm on",
            "de": "die Linie in {file} verläuft vom ersten zum zweiten Punkt {forward_mm:.1f} mm nach "
            "vorn; ab {min_forward_mm:g} mm gilt der erste Punkt als Eintritt",
        },
    ),
    "LANDMARKS_UNNAMED": (
        {
            "en": "{file} has {unnamed} points without a label, the first is point {first}",
            "de": "{file} hat {unnamed} Punkte ohne Bezeichnung, der erste ist Punkt {first}",
        },
    ),
    "REGION_INVALID": (
        {
            "en": "the region from {low} to {high} mm is not a box, each side must be above 0 mm",
            "de": "der Bereich von {low} bis {high} mm ist kein Quader, jede Seite muss über 0 mm lang sein",
        },
    ),
    "REGION_OUTSIDE": (
        {
            "en": "the region from {low} to {high} mm lies outside of the CT, which reaches from "
            "{ct_low} to {ct_high} mm",
            "de": "der Bereich von {low} bis {high} mm liegt außerhalb des CT, das von {ct_low} bis "
            "{ct_high} mm reicht",
        },
    ),
    "PLAN_FILE_VERSION": (
        {
            "en": "the file has format version {found}, but this program reads version {known}",
            "de": "die Datei hat die Formatversion {found}, dieses Programm liest Version {known}",
        },
    ),
    "PLAN_FILE_INVALID": (
        {
            "en": "the file is not a plan: {plan_problem}",
            "de": "die Datei ist kein Plan: {plan_problem}",
        },
    ),
    "PLAN_VERSION_UNKNOWN": (
        {
            "en": "the plan has format version {found}, this program reads {known}",
            "de": "der Plan hat die Formatversion {found}, dieses Programm liest {known}",
        },
    ),
    "SIGNED_BY_MAKER": (
        {
            "en": "{title} was made by {maker}{import_phrase}, and its author cannot co-sign it",
            "de": "{title} wurde von {maker} erstellt{import_phrase}, und wer etwas erstellt hat, kann es "
            "nicht gegenzeichnen",
        },
    ),
    "VERTEBRA_INVALID": (
        {
            "en": "vertebra '{name}' has pedicles {pedicles}, channels {channels}, {references} reference "
            "slices and up to {screws} screws to a channel; needed a name and at most one of each to "
            "a side",
            "de": "Wirbel „{name}“ hat Pedikel {pedicles}, Kanäle {channels}, {references} "
            "Referenzschichten und bis zu {screws} Schrauben je Kanal; nötig ein Name und höchstens "
            "je eines pro Seite",
        },
    ),
    "SLICE_OUTSIDE": (
        {
            "en": "there is no {plane} slice at {at_mm:.2f} mm: the CT reaches from {from_mm:.2f} to "
            "{to_mm:.2f} mm",
            "de": "es gibt keine {plane} Schicht bei {at_mm:.2f} mm: das CT reicht von {from_mm:.2f} bis "
            "{to_mm:.2f} mm",
        },
    ),
    "PRESET_UNKNOWN": (
        {
            "en": "there is no preset '{preset}', available are {available}",
            "de": "es gibt keine Voreinstellung „{preset}“, verfügbar sind {available}",
        },
    ),
    "POINT_INVALID": (
        {
            "en": "{name} is '{given}', expected three numbers within 10000 mm",
            "de": "{name} ist „{given}“, erwartet drei Zahlen bis 10000 mm",
        },
    ),
    "ALARM_PAUSE_TOO_LONG": (
        {
            "en": "a pause of {requested_s:g} s was requested, allowed is more than 0 and up to {max_s:g} s",
            "de": "eine Pause von {requested_s:g} s wurde verlangt, erlaubt ist mehr als 0 und bis zu "
            "{max_s:g} s",
        },
    ),
    "BONE_NOT_FOUND": (
        {
            "en": "there is no bone surface in this region",
            "de": "in diesem Bereich gibt es keine Knochenoberfläche",
        },
        {
            "en": "there is no bone surface in this region at {threshold_hu:.0f} HU",
            "de": "in diesem Bereich gibt es keine Knochenoberfläche bei {threshold_hu:.0f} HU",
        },
    ),
    "CATALOGUE_INVALID": (
        {
            "en": "the screw catalogue's {setting} are {values}, needed one or more between 0 and 200 mm",
            "de": "{setting} im Schraubenkatalog sind {values}, nötig eines oder mehr zwischen 0 und 200 mm",
        },
    ),
}

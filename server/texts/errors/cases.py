"""Messages of errors of cases, documents and files, by code."""

from collections.abc import Mapping

from server.texts.language import Text

CASES: Mapping[str, tuple[Text, ...]] = {
    "ARCHIVE_NEWER": (
        {
            "en": "the archive has format version {found}, but this Coaxial reads version {known}",
            "de": "das Archiv hat die Formatversion {found}, dieses Coaxial liest Version {known}",
        },
    ),
    "CASE_DAMAGED": (
        {
            "en": "the name or the times of the case {case_id} are damaged on the disk",
            "de": "Name oder Zeiten des Falls {case_id} sind auf der Platte beschädigt",
        },
    ),
    "CASE_IN_USE": (
        {
            "en": "the case {case_id} is in use by {in_use} write or export operations",
            "de": "der Fall {case_id} wird von {in_use} Schreib- oder Exportvorgängen verwendet",
        },
    ),
    "CASE_OPEN": (
        {
            "en": "the case {case_id} is open, and an open case cannot be deleted",
            "de": "der Fall {case_id} ist geöffnet, und ein geöffneter Fall kann nicht gelöscht werden",
        },
    ),
    "CASE_UNKNOWN": ({"en": "there is no case {case_id}", "de": "es gibt keinen Fall {case_id}"},),
    "CONFIRMATION_WRONG": (
        {
            "en": "the confirmation is not the name of the case {case_id}",
            "de": "die Bestätigung ist nicht der Name des Falls {case_id}",
        },
    ),
    "CT_AFFINE_MISSING": (
        {
            "en": "the NIfTI does not state the positions of its voxels (sform and qform code are both 0), "
            "so that left, right and sizes are unknown",
            "de": "das NIfTI gibt die Orte seiner Voxel nicht an (sform- und qform-Code sind beide 0), "
            "daher sind links, rechts und Größen unbekannt",
        },
    ),
    "CT_ARCHIVE_BROKEN": (
        {
            "en": "the zip of {bytes} bytes cannot be read: its directory is damaged or truncated",
            "de": "das Zip mit {bytes} Bytes ist nicht lesbar: sein Verzeichnis ist beschädigt oder "
            "abgeschnitten",
        },
    ),
    "CT_ARCHIVE_ENCRYPTED": (
        {
            "en": "{files} of {of} files in the zip are encrypted",
            "de": "{files} von {of} Dateien im Zip sind verschlüsselt",
        },
    ),
    "CT_ARCHIVE_TOO_LARGE": (
        {
            "en": "the zip would unpack to {size_gib:.1f} GiB, the maximum is {max_gib:.0f} GiB",
            "de": "das Zip würde entpackt {size_gib:.1f} GiB haben, höchstens {max_gib:.0f} GiB",
        },
    ),
    "CT_ARCHIVE_UNSAFE": (
        {
            "en": "{files} of {of} files in the zip have names that point outside of it",
            "de": "{files} von {of} Dateien im Zip haben Namen, die aus ihm hinausführen",
        },
    ),
    "CT_FILE_DAMAGED": (
        {
            "en": "the NIfTI file of {bytes} bytes is truncated or damaged: {nifti_problem}",
            "de": "die NIfTI-Datei von {bytes} Bytes ist abgeschnitten oder beschädigt: {nifti_problem}",
        },
        {
            "en": "{damaged} of {files} files are truncated or damaged DICOM files",
            "de": "{damaged} von {files} Dateien sind abgeschnittene oder beschädigte DICOM-Dateien",
        },
    ),
    "CT_NIFTI_PAIR": (
        {
            "en": "this is the header of a NIfTI pair, its voxels are in a second file",
            "de": "dies ist der Kopf eines NIfTI-Paars, seine Voxel stehen in einer zweiten Datei",
        },
    ),
    "CT_NOT_THERE": (
        {"en": "the file or folder does not exist", "de": "die Datei oder der Ordner existiert nicht"},
    ),
    "CT_SLICES_CONTRADICT": (
        {
            "en": "{places} of {positions} positions have several slices with different pixels: the series "
            "contains more than one pass (phase, energy or kernel)",
            "de": "an {places} von {positions} Positionen gibt es mehrere Schichten mit verschiedenen "
            "Pixeln: die Serie enthält mehr als einen Durchlauf (Phase, Energie oder Kernel)",
        },
    ),
    "CT_SPACES_DIFFER": (
        {
            "en": "the slices have {spaces} frames of reference, expected 1: the patient may have moved",
            "de": "die Schichten haben {spaces} Bezugssysteme, erwartet 1: der Patient hat sich vielleicht "
            "bewegt",
        },
    ),
    "CT_TOO_FEW_SLICES": (
        {
            "en": "the series has slices at {places} place, needed at least 2",
            "de": "die Serie hat Schichten an {places} Ort, nötig mindestens 2",
        },
        {
            "en": "the CT has {slices} slice, the minimum is 2",
            "de": "das CT hat {slices} Schicht, mindestens 2",
        },
    ),
    "CT_TOO_MANY_FILES": (
        {
            "en": "there are {files} files or more, the maximum is {max_files}",
            "de": "es sind {files} Dateien oder mehr, höchstens {max_files}",
        },
    ),
    "CT_VALUES_MISSING": (
        {
            "en": "{missing} of {voxels} voxels are NaN, the maximum is {max_ratio:.0%}",
            "de": "{missing} von {voxels} Voxeln sind NaN, höchstens {max_ratio:.0%}",
        },
    ),
    "DOCUMENT_MISSING": (
        {"en": "there is no {kind} '{name}'", "de": "es gibt kein Dokument {kind} „{name}“"},
    ),
    "DOCUMENT_OUT_OF_DATE": (
        {"en": "{kind} '{name}' is out of date: {reason}", "de": "{kind} „{name}“ ist veraltet: {reason}"},
    ),
    "DOCUMENT_UNKNOWN": (
        {
            "en": "there is no document {document_id} in the case {case_id}",
            "de": "es gibt kein Dokument {document_id} im Fall {case_id}",
        },
    ),
    "FILE_UNKNOWN": (
        {
            "en": "there is no file {file_id} in the case {case_id}",
            "de": "es gibt keine Datei {file_id} im Fall {case_id}",
        },
    ),
    "MESH_TOO_LARGE": (
        {
            "en": "the mesh has {size_mb:.0f} MB, the maximum is {max_mb:.0f} MB",
            "de": "das Netz hat {size_mb:.0f} MB, höchstens {max_mb:.0f} MB",
        },
        {
            "en": "the mesh has {faces} triangles, the maximum is {max_faces}",
            "de": "das Netz hat {faces} Dreiecke, höchstens {max_faces}",
        },
    ),
    "VERSION_CONFLICT": (
        {
            "en": "{kind} '{name}' is at version {found_version}, but the change was made on version "
            "{expected_version}",
            "de": "{kind} „{name}“ ist in Version {found_version}, die Änderung bezog sich auf Version "
            "{expected_version}",
        },
    ),
    "CT_AFFINE_INVALID": (
        {
            "en": "the {affine} of the NIfTI is singular or not finite",
            "de": "die {affine} des NIfTI ist singulär oder nicht endlich",
        },
    ),
    "CT_ATLAS_SPACE": (
        {
            "en": "the NIfTI is deformed to an atlas (code {code}), so that lengths are not those of "
            "the patient",
            "de": "das NIfTI ist auf einen Atlas verformt (Code {code}), daher sind Längen nicht die "
            "des Patienten",
        },
    ),
    "CT_COMPRESSION_UNKNOWN": (
        {
            "en": "the slices are compressed as {syntax} with {bits} bits, which cannot be read here",
            "de": "die Schichten sind als {syntax} mit {bits} Bit komprimiert, was hier nicht lesbar ist",
        },
    ),
    "CT_DIRECTIONS_DIFFER": (
        {
            "en": "{slices} of {of} slices lie in another direction (planes up to {worst_deg:.2f} deg apart)",
            "de": "{slices} von {of} Schichten liegen in anderer Richtung (Ebenen bis {worst_deg:.2f}° "
            "verschieden)",
        },
    ),
    "CT_DIRECTIONS_INVALID": (
        {
            "en": "{slices} of {of} slices have directions that are not at right angles, or not of length 1",
            "de": "{slices} von {of} Schichten haben Richtungen, die nicht im rechten Winkel stehen "
            "oder nicht die Länge 1 haben",
        },
    ),
    "CT_GEOMETRY_MISSING": (
        {
            "en": "{slices} of {of} slices do not state their {attribute}",
            "de": "{slices} von {of} Schichten nennen ihr Attribut {attribute} nicht",
        },
    ),
    "CT_PIXELS_DIFFER": (
        {
            "en": "{slices} of {of} slices have pixels of another size: they go from {min_mm:.4f} to "
            "{max_mm:.4f} mm",
            "de": "{slices} von {of} Schichten haben Pixel anderer Größe: sie reichen von {min_mm:.4f} "
            "bis {max_mm:.4f} mm",
        },
    ),
    "CT_PIXELS_INVALID": (
        {
            "en": "the slices are declared as {columns} x {rows} pixels of {min_mm:g} to {max_mm:g} "
            "mm, allowed: 2 to {max_side_px} pixels per side of {min_pixel_mm} to "
            "{max_pixel_mm:.0f} mm",
            "de": "die Schichten sind mit {columns} x {rows} Pixeln von {min_mm:g} bis {max_mm:g} mm "
            "angegeben, erlaubt: 2 bis {max_side_px} Pixel je Seite von {min_pixel_mm} bis "
            "{max_pixel_mm:.0f} mm",
        },
    ),
    "CT_PIXELS_UNKNOWN": (
        {
            "en": "the NIfTI stores {stored}, which are not Hounsfield units",
            "de": "das NIfTI speichert {stored}, das sind keine Hounsfield-Einheiten",
        },
        {
            "en": "the slices store {bits_stored} of {bits_allocated} bits with {high_bit} as the "
            "highest, which is not a CT",
            "de": "die Schichten speichern {bits_stored} von {bits_allocated} Bit mit {high_bit} als "
            "höchstem, das ist kein CT",
        },
    ),
    "CT_SLICES_SHIFTED": (
        {
            "en": "{gap_problem}: one lies {off_mm:.3f} mm from its regular position, allowed "
            "{allowed_mm:.3f} mm",
            "de": "{gap_problem}: eine liegt {off_mm:.3f} mm neben ihrem regelmäßigen Ort, erlaubt "
            "{allowed_mm:.3f} mm",
        },
        {
            "en": "two slices lie in one plane, {shift_mm:.2f} mm apart, allowed {max_shift_mm:.2f} mm",
            "de": "zwei Schichten liegen in einer Ebene, {shift_mm:.2f} mm auseinander, erlaubt "
            "{max_shift_mm:.2f} mm",
        },
    ),
    "CT_SLICE_DAMAGED": (
        {
            "en": "a slice of {bytes} bytes cannot be decoded ({compression})",
            "de": "eine Schicht von {bytes} Bytes lässt sich nicht dekodieren ({compression})",
        },
    ),
    "CT_SLICE_TOO_LARGE": (
        {
            "en": "the file of a slice has {size_mib:.0f} MiB, the maximum is {max_mib:.0f} MiB",
            "de": "die Datei einer Schicht hat {size_mib:.0f} MiB, höchstens {max_mib:.0f} MiB",
        },
    ),
    "CT_TILT_TOO_LARGE": (
        {
            "en": "the slices are tilted by {tilt_deg:.1f} deg against the stacking direction, allowed "
            "{max_tilt_deg:.0f} deg",
            "de": "die Schichten sind um {tilt_deg:.1f}° gegen die Stapelrichtung gekippt, erlaubt "
            "{max_tilt_deg:.0f}°",
        },
    ),
    "CT_TOO_LARGE": (
        {
            "en": "the CT has {columns} x {rows} x {slices} voxels, {million:.0f} million, the maximum "
            "is {max_million:.0f} million",
            "de": "das CT hat {columns} x {rows} x {slices} Voxel, {million:.0f} Millionen, höchstens "
            "{max_million:.0f} Millionen",
        },
    ),
    "CT_VALUES_BEYOND": (
        {
            "en": "{beyond} of {voxels} voxels ({beyond_ratio:.0%}) are outside {min_hu} to {max_hu} "
            "HU, the maximum is {max_ratio:.0%}: slope or intercept is wrong",
            "de": "{beyond} von {voxels} Voxeln ({beyond_ratio:.0%}) liegen außerhalb von {min_hu} bis "
            "{max_hu} HU, höchstens {max_ratio:.0%}: Steigung oder Achsenabschnitt ist falsch",
        },
    ),
    "CONTENT_TOO_LARGE": (
        {
            "en": "the document has {size_mb:.1f} MB, the maximum is {max_mb:g} MB",
            "de": "das Dokument hat {size_mb:.1f} MB, höchstens {max_mb:g} MB",
        },
    ),
    "SUFFIX_INVALID": (
        {
            "en": "'{suffix}' is not a valid file name suffix",
            "de": "„{suffix}“ ist keine gültige Dateiendung",
        },
    ),
    "DEPENDS_ON_IDENTITY": (
        {
            "en": "a document must not depend on the patient's identity, because that is not exported",
            "de": "ein Dokument darf nicht auf der Identität des Patienten beruhen, weil diese nicht "
            "exportiert wird",
        },
    ),
    "HOME_IN_USE": (
        {
            "en": "another Coaxial is running with the folder {folder}, which only one may use at a time",
            "de": "ein anderes Coaxial läuft mit dem Ordner {folder}, den nur eines zur Zeit verwenden darf",
        },
    ),
    "IDENTITY_WITH_FILES": (
        {
            "en": "the document of the patient's identity must not have files, because files are exported",
            "de": "das Dokument mit der Identität des Patienten darf keine Dateien haben, weil Dateien "
            "exportiert werden",
        },
    ),
    "CT_UNREADABLE": (
        {
            "en": "the file or folder cannot be read: {system_error}",
            "de": "die Datei oder der Ordner ist nicht lesbar: {system_error}",
        },
    ),
    "CT_SIZES_DIFFER": (
        {
            "en": "the slices have different sizes in pixels: {counted}",
            "de": "die Schichten haben verschiedene Größen in Pixeln: {counted}",
        },
    ),
    "CT_RESCALE_MISSING": (
        {
            "en": "{slices} of {of} slices do not state their conversion to Hounsfield units (Rescale "
            "Slope and Intercept){table_hint}",
            "de": "{slices} von {of} Schichten nennen ihre Umrechnung in Hounsfield-Einheiten nicht "
            "(Rescale Slope und Intercept){table_hint}",
        },
    ),
    "CT_NOT_HU": (
        {
            "en": "the values of {slices} of {of} slices are not Hounsfield units, but {counted}",
            "de": "die Werte von {slices} von {of} Schichten sind keine Hounsfield-Einheiten, sondern "
            "{counted}",
        },
    ),
    "CT_NOT_CT": (
        {
            "en": "the images are not a CT: {counted}",
            "de": "die Bilder sind kein CT: {counted}",
        },
    ),
    "CT_SLICE_TRUNCATED": (
        {
            "en": "a slice is truncated: its file of {bytes} bytes lacks a part of the declared {columns} "
            "x {rows} pixels{pixel_count}",
            "de": "eine Schicht ist abgeschnitten: ihrer Datei von {bytes} Bytes fehlt ein Teil der "
            "angegebenen {columns} x {rows} Pixel{pixel_count}",
        },
    ),
    "CT_SERIES_UNCLEAR": (
        {
            "en": "there are {count} CT series, of {slices} slices",
            "de": "es gibt {count} CT-Serien, mit {slices} Schichten",
        },
    ),
    "CT_SERIES_UNKNOWN": (
        {
            "en": "none of the {count} series has this identifier",
            "de": "keine der {count} Serien hat diese Kennung",
        },
    ),
    "CT_PATIENTS_MIXED": (
        {
            "en": "{images_where} contains images with {patients} different {identity_kind}, expected 1",
            "de": "{images_where} enthält Bilder mit {patients} verschiedenen {identity_kind}, erwartet 1",
        },
    ),
    "CT_VOXEL_SIZE_ODD": (
        {
            "en": "the voxels have {size} mm (unit in the file: {unit}), allowed: {min_mm} to {max_mm:.0f} "
            "mm{voxel_unit_guess}",
            "de": "die Voxel haben {size} mm (Einheit in der Datei: {unit}), erlaubt: {min_mm} bis "
            "{max_mm:.0f} mm{voxel_unit_guess}",
        },
    ),
    "CT_AFFINES_CONTRADICT": (
        {
            "en": "the NIfTI's sform and qform contradict each other: one is the mirror image of the other",
            "de": "sform und qform des NIfTI widersprechen sich: eine ist das Spiegelbild der anderen",
        },
        {
            "en": "the NIfTI's sform and qform contradict each other: voxels of {sform_size} and "
            "{qform_size} mm",
            "de": "sform und qform des NIfTI widersprechen sich: Voxel von {sform_size} und {qform_size} mm",
        },
    ),
    "CT_NOT_ONE_VOLUME": (
        {
            "en": "the NIfTI has {voxels} voxels, expected one volume of three axes with at least 2 each",
            "de": "das NIfTI hat {voxels} Voxel, erwartet ein Volumen mit drei Achsen und mindestens je 2",
        },
    ),
    "CT_SLICES_MISSING": (
        {
            "en": "{missing} of {needed} slices are missing: after slice {after} of {slices}, in the order "
            "of their positions, the next is {gap_mm:.3f} mm away, the others lie {spacing_mm:.3f} "
            "mm apart",
            "de": "{missing} von {needed} Schichten fehlen: nach Schicht {after} von {slices}, in der "
            "Reihenfolge ihrer Positionen, folgt die nächste in {gap_mm:.3f} mm, die übrigen liegen "
            "{spacing_mm:.3f} mm auseinander",
        },
    ),
    "CT_SPACING_UNEVEN": (
        {
            "en": "{gap_problem}: one lies {off_mm:.3f} mm from its regular position, allowed "
            "{allowed_mm:.3f} mm",
            "de": "{gap_problem}: eine liegt {off_mm:.3f} mm neben ihrem regelmäßigen Ort, erlaubt "
            "{allowed_mm:.3f} mm",
        },
        {
            "en": "the slices lie between {min_mm:.3f} and {max_mm:.3f} mm apart, mostly {spacing_mm:.3f} "
            "mm: after slice {after} of {slices}, in the order of their positions, the next is "
            "{gap_mm:.3f} mm away",
            "de": "die Schichten liegen zwischen {min_mm:.3f} und {max_mm:.3f} mm auseinander, meist "
            "{spacing_mm:.3f} mm: nach Schicht {after} von {slices}, in der Reihenfolge ihrer "
            "Positionen, folgt die nächste in {gap_mm:.3f} mm",
        },
    ),
    "MESH_FORMAT_UNKNOWN": (
        {
            "en": "the mesh format '{format}' is not supported, supported are {formats}",
            "de": "das Netzformat „{format}“ wird nicht unterstützt, unterstützt sind {formats}",
        },
    ),
    "MESH_EMPTY": (
        {
            "en": "the mesh has {vertices} vertices and {faces} triangles",
            "de": "das Netz hat {vertices} Ecken und {faces} Dreiecke",
        },
        {
            "en": "the mesh has {with_area} triangles with an area, needed 4 or more",
            "de": "das Netz hat {with_area} Dreiecke mit einer Fläche, nötig 4 oder mehr",
        },
    ),
    "MESH_UNIT_INVALID": (
        {
            "en": "'{unit}' is not a unit of a mesh",
            "de": "„{unit}“ ist keine Einheit eines Netzes",
        },
    ),
    "DOCUMENT_DAMAGED": (
        {
            "en": "the document {document_id} of the case {case_id} is damaged on the disk",
            "de": "das Dokument {document_id} des Falls {case_id} ist auf der Platte beschädigt",
        },
    ),
    "FILE_DAMAGED": (
        {
            "en": "the file {file_id} of the case {case_id} is damaged: {damage}",
            "de": "die Datei {file_id} des Falls {case_id} ist beschädigt: {damage}",
        },
    ),
    "NOT_RESTORABLE": (
        {
            "en": "{title} is not the last intact version before a damaged one",
            "de": "{title} ist nicht die letzte unbeschädigte Version vor einer beschädigten",
        },
    ),
    "HOME_NOT_LOCKABLE": (
        {
            "en": "the disk of the folder {folder} does not support file locks (as some network disks), so "
            "that another Coaxial could write into it at the same time",
            "de": "die Platte des Ordners {folder} unterstützt keine Dateisperren (wie manche "
            "Netzlaufwerke), daher könnte ein anderes Coaxial zugleich hineinschreiben",
        },
    ),
    "STORE_SCHEMA_UNKNOWN": (
        {
            "en": "the database in {folder} has schema {found}, this program supports schemas {first} to "
            "{newest}",
            "de": "die Datenbank in {folder} hat das Schema {found}, dieses Programm unterstützt die "
            "Schemas {first} bis {newest}",
        },
    ),
    "CT_EMPTY": (
        {
            "en": "there are no files to read{excluded_hint}",
            "de": "es gibt keine lesbaren Dateien{excluded_hint}",
        },
    ),
    "CT_NO_DICOM": (
        {
            "en": "no DICOM slice in the upload (files: {files}): {excluded_list}",
            "de": "keine DICOM-Schicht im Hochgeladenen (Dateien: {files}): {excluded_list}",
        },
    ),
    "CT_DOCUMENT_INVALID": (
        {
            "en": "{title} cannot be used: {document_problem}",
            "de": "{title} ist nicht verwendbar: {document_problem}",
        },
    ),
    "MESH_UNREADABLE": (
        {
            "en": "the mesh is not a readable {format_name} file: {mesh_problem}",
            "de": "das Netz ist keine lesbare {format_name}-Datei: {mesh_problem}",
        },
        {
            "en": "the mesh is not a readable {format_name} file: {library_error}",
            "de": "das Netz ist keine lesbare {format_name}-Datei: {library_error}",
        },
        {
            "en": "the mesh cannot be read: {system_error}",
            "de": "das Netz ist nicht lesbar: {system_error}",
        },
    ),
    "MESH_INVALID": (
        {
            "en": "the mesh cannot be used: {mesh_problem}",
            "de": "das Netz ist nicht verwendbar: {mesh_problem}",
        },
    ),
    "MESH_SIZE_IMPLAUSIBLE": (
        {
            "en": "the mesh is {sides} in its own units, which in {tried_unit} is neither a vertebra nor "
            "several",
            "de": "das Netz misst {sides} in seinen eigenen Einheiten, das ist in {tried_unit} weder ein "
            "Wirbel noch mehrere",
        },
    ),
    "MESH_UNIT_NEEDED": (
        {
            "en": "the mesh is {sides} in its own units, which in {tried_unit} is neither a vertebra nor "
            "several",
            "de": "das Netz misst {sides} in seinen eigenen Einheiten, das ist in {tried_unit} weder ein "
            "Wirbel noch mehrere",
        },
    ),
    "SURFACE_INVALID": (
        {
            "en": "the surface cannot be used: {mesh_problem}",
            "de": "die Oberfläche ist nicht verwendbar: {mesh_problem}",
        },
    ),
    "VOLUME_INVALID": (
        {
            "en": "the CT cannot be used: {volume_problem}",
            "de": "das CT ist nicht verwendbar: {volume_problem}",
        },
    ),
    "BONE_SETTINGS_INVALID": (
        {
            "en": "the bone surface cannot be extracted: {bone_problem}",
            "de": "die Knochenoberfläche lässt sich nicht gewinnen: {bone_problem}",
        },
    ),
    "PLAN_INVALID": (
        {
            "en": "the plan cannot be read: {where} {plan_fault}",
            "de": "der Plan ist nicht lesbar: {where} {plan_fault}",
        },
        {
            "en": "the plan cannot be used: {plan_place} {plan_fault}",
            "de": "der Plan ist nicht verwendbar: {plan_place} {plan_fault}",
        },
    ),
    "NAME_INVALID": (
        {
            "en": "the {name_of} {name_problem}, allowed are 1 to {allowed} characters on one line",
            "de": "{name_of} {name_problem}, erlaubt sind 1 bis {allowed} Zeichen auf einer Zeile",
        },
    ),
    "CONTENT_NOT_JSON": (
        {
            "en": "the document cannot be stored as JSON: {json_place}{json_problem}",
            "de": "das Dokument lässt sich nicht als JSON speichern: {json_place}{json_problem}",
        },
    ),
    "ARCHIVE_INVALID": (
        {
            "en": "the archive cannot be imported: {archive_problem}",
            "de": "das Archiv lässt sich nicht importieren: {archive_problem}",
        },
    ),
    "SCAN_FAILED": (
        {
            "en": "the CT of the rehearsal's vertebra could not be simulated: {scan_problem}",
            "de": "das CT des Wirbels für den Probebetrieb ließ sich nicht simulieren: {scan_problem}",
        },
    ),
    "MARKUPS_UNREADABLE": (
        {
            "en": "{file} is not a file of markups: {markup_problem}",
            "de": "{file} ist keine Markups-Datei: {markup_problem}",
        },
    ),
    "MARKUPS_INVALID": (
        {
            "en": "{file} cannot be used: {markup_problem}",
            "de": "{file} ist nicht verwendbar: {markup_problem}",
        },
    ),
    "TRANSFORM_UNREADABLE": (
        {
            "en": "{file} is not a readable transform: {transform_problem}",
            "de": "{file} ist keine lesbare Transformation: {transform_problem}",
        },
    ),
    "TRANSFORM_INVALID": (
        {
            "en": "{file} cannot be used: {transform_problem}",
            "de": "{file} ist nicht verwendbar: {transform_problem}",
        },
    ),
}

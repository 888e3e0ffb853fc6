"""The measurements of a plan as a Comprehensive 3D SR by template TID 1500 (DICOM PS3.16)."""

from collections.abc import Iterator, Mapping

import numpy as np
from highdicom import sr
from highdicom.coding_schemes import CodingSchemeIdentificationItem
from pydicom.dataset import Dataset
from pydicom.sr.codedict import codes
from pydicom.sr.coding import Code

from server.imaging.dicom_objects.codes import (
    BREACH,
    CHANNEL,
    CLEARANCES,
    CORRECTED,
    DEG,
    DIAMETER,
    GRADE,
    HEIGHT,
    LATERALITY,
    LENGTH,
    MM,
    PEDICLE,
    PRIVATE_SCHEME,
    PRIVATE_SCHEME_NAME,
    SAGITTAL,
    SCREW,
    TRANSVERSE,
    WIDTH,
    ascii_text,
    code_of_grade,
    code_of_vertebra,
)
from server.imaging.dicom_objects.equipment import Equipment
from server.imaging.dicom_objects.source import SourceSeries
from tracker.geometry import Array
from tracker.plan import Channel, PedicleRecord, PlanDocument, ScrewPlan
from tracker.plan.pedicle import Side, sagittal_deg_of, transverse_deg_of

PEDICLE_MEASURES: Mapping[str, tuple[Code, Code]] = {
    "width_mm": (WIDTH, MM),
    "height_mm": (HEIGHT, MM),
    "length_mm": (LENGTH, MM),
    "transverse_deg": (TRANSVERSE, DEG),
    "sagittal_deg": (SAGITTAL, DEG),
}
Group = sr.MeasurementsAndQualitativeEvaluations


def has_measurements(plan: PlanDocument) -> bool:
    """Return whether a plan has a pedicle or channel, without which a report would be empty."""
    return any(vertebra.pedicles or vertebra.channels for vertebra in plan.vertebrae)


def report_object(source: SourceSeries, plan: PlanDocument, equipment: Equipment) -> Dataset:
    """Return the report of all pedicles, channels and screws of a plan."""
    context = sr.ObservationContext(
        observer_device_context=sr.ObserverContext(
            observer_type=codes.DCM.Device,
            observer_identifying_attributes=sr.DeviceObserverIdentifyingAttributes(
                uid=equipment.tracking_uid("coaxial"),
                name="Coaxial",
                manufacturer_name="Coaxial",
                model_name="Coaxial",
            ),
        )
    )
    return sr.Comprehensive3DSR(
        evidence=[equipment.without_patient(image) for image in source.images],
        content=sr.MeasurementReport(
            observation_context=context,
            procedure_reported=codes.cid100.CTUnspecifiedBodyRegion,
            imaging_measurements=list(_groups(source, plan, equipment)),
        )[0],
        is_complete=True,
        is_final=False,
        is_verified=False,
        coding_schemes=[CodingSchemeIdentificationItem(designator=PRIVATE_SCHEME, name=PRIVATE_SCHEME_NAME)],
        **equipment.of_series("plan", number=9903),
    )


def _groups(source: SourceSeries, plan: PlanDocument, equipment: Equipment) -> Iterator[Group]:
    groups = _GroupBuilder(source, equipment)
    for vertebra in plan.vertebrae:
        for record in vertebra.pedicles:
            yield groups.of_pedicle(vertebra.name, record)
        for planned in vertebra.channels:
            yield groups.of_channel(vertebra.name, planned.side, planned.channel)
            for screw in planned.screws:
                yield groups.of_screw(vertebra.name, planned.side, planned.channel, screw)


class _GroupBuilder:
    """Builds the groups of measurements (TID 1501)."""

    def __init__(self, source: SourceSeries, equipment: Equipment) -> None:
        self._source = source
        self._equipment = equipment

    def of_pedicle(self, vertebra: str, record: PedicleRecord) -> Group:
        """Return the values of a pedicle as they are used: measured, or corrected by a person."""
        used = record.used
        measurements = [
            sr.Measurement(
                name=name,
                value=float(getattr(used, key)),
                unit=unit,
                derivation=CORRECTED if key in record.corrected else None,
                # What a person has entered has no known uncertainty.
                properties=None if key in record.corrected else _uncertainty(getattr(used.sd, key), unit),
                referenced_coordinates=[_line(self._source, used.entry_lps_mm, used.front_lps_mm)]
                if key == "length_mm"
                else None,
            )
            for key, (name, unit) in PEDICLE_MEASURES.items()
        ]
        return self._group(vertebra, used.side, "pedicle", PEDICLE, measurements, used.isthmus_lps_mm)

    def of_channel(self, vertebra: str, side: Side, channel: Channel) -> Group:
        """Return size and direction of a channel; its length refers to entry and target."""
        axis = channel.axis_in_vertebra
        measurements = [
            sr.Measurement(name=DIAMETER, value=2.0 * channel.radius_mm, unit=MM),
            sr.Measurement(
                name=LENGTH,
                value=channel.length_mm,
                unit=MM,
                referenced_coordinates=[
                    _line(self._source, channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm)
                ],
            ),
            sr.Measurement(name=TRANSVERSE, value=transverse_deg_of(axis, side), unit=DEG),
            sr.Measurement(name=SAGITTAL, value=sagittal_deg_of(axis), unit=DEG),
        ]
        return self._group(vertebra, side, "channel", CHANNEL, measurements, channel.entry_in_vertebra_mm)

    def of_screw(self, vertebra: str, side: Side, channel: Channel, screw: ScrewPlan) -> Group:
        """Return size and clearance of a screw; its length refers to entry and tip."""
        tip_mm = channel.entry_in_vertebra_mm + screw.length_mm * channel.axis_in_vertebra
        measurements = [
            sr.Measurement(name=DIAMETER, value=screw.diameter_mm, unit=MM),
            sr.Measurement(
                name=LENGTH,
                value=screw.length_mm,
                unit=MM,
                referenced_coordinates=[_line(self._source, channel.entry_in_vertebra_mm, tip_mm)],
            ),
            *(
                sr.Measurement(name=name, value=float(getattr(screw.clearance, key)), unit=MM)
                for key, name in CLEARANCES.items()
            ),
            sr.Measurement(name=BREACH, value=screw.clearance.breach_mm, unit=MM),
        ]
        grade = sr.QualitativeEvaluation(name=GRADE, value=code_of_grade(screw.clearance.grade.value))
        return self._group(
            vertebra, side, "screw", SCREW, measurements, channel.entry_in_vertebra_mm, [grade]
        )

    def _group(
        self,
        vertebra: str,
        side: Side,
        what: str,
        finding: Code,
        measurements: list[sr.Measurement],
        point_lps_mm: Array,
        evaluations: list[sr.QualitativeEvaluation] | None = None,
    ) -> Group:
        name = f"{ascii_text(vertebra)} {side} {what}"
        frame = self._source.frames[self._source.nearest_slice(point_lps_mm)]
        image = self._source.images[frame.image]
        return Group(
            tracking_identifier=sr.TrackingIdentifier(
                uid=self._equipment.tracking_uid(name), identifier=name
            ),
            finding_type=finding,
            finding_sites=[
                sr.FindingSite(anatomic_location=code_of_vertebra(vertebra), laterality=LATERALITY[side])
            ],
            measurements=measurements,
            qualitative_evaluations=evaluations,
            source_images=[
                sr.SourceImageForMeasurementGroup(
                    referenced_sop_class_uid=str(image.SOPClassUID),
                    referenced_sop_instance_uid=str(image.SOPInstanceUID),
                    referenced_frame_numbers=[frame.frame_number] if frame.is_multi_frame else None,
                )
            ],
        )


def _uncertainty(sd: float, unit: Code) -> sr.MeasurementProperties:
    """Return the uncertainty of a measurement (TID 310, CID 225), which is stated to be a standard deviation.

    It is a property of the measurement: a reader that does not know it shows the measurement alone. A
    measurement of its own, derived as standard deviation, could be taken for the value.
    """
    item = sr.NumContentItem(
        name=codes.SCT.RangeOfMeasurementUncertainty,
        value=sd,
        unit=unit,
        relationship_type=sr.RelationshipTypeValues.HAS_PROPERTIES,
    )
    item.ContentSequence = sr.ContentSequence(
        [
            sr.CodeContentItem(
                name=codes.DCM.Derivation,
                value=codes.SCT.StandardDeviation,
                relationship_type=sr.RelationshipTypeValues.HAS_CONCEPT_MOD,
            )
        ]
    )
    properties = sr.MeasurementProperties()
    properties.append(item)
    return properties


def _line(source: SourceSeries, start_mm: Array, end_mm: Array) -> sr.CoordinatesForMeasurement3D:
    """Return a line in the patient's coordinates."""
    return sr.CoordinatesForMeasurement3D(
        graphic_type=sr.GraphicTypeValues3D.POLYLINE,
        graphic_data=np.stack([start_mm, end_mm]),
        frame_of_reference_uid=source.frame_of_reference_uid,
    )

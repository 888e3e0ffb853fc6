"""A plan as DICOM objects of the study of its CT: segmentation, models (STL) and measurement report.

The objects carry the patient's identity, because they belong to the patient's study. `source` reads it from
the headers of the CT and adds it to each finished object; neither the other modules nor highdicom see it.
"""

from server.imaging.dicom_objects.objects import PlanObject, plan_objects
from server.imaging.dicom_objects.source import SourceSeries, read_source

__all__ = ["PlanObject", "SourceSeries", "plan_objects", "read_source"]

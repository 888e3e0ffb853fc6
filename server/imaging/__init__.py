"""Images of the patient: DICOM and NIfTI in, meshes in. What is read here is handed to `tracker.plan`."""

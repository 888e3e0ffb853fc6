"""Reading of vertebra labels that another program segmented: NIfTI or DICOM SEG."""

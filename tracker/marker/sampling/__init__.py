"""What an image shows inside an outline, cell by cell. Only compiled loops: by which homography, in what light."""

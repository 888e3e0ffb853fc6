"""Image sources: cameras, phone, video file, network stream, folder, rehearsal. The newest image is used."""

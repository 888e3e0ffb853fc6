"""Image sources: cameras, phone, video file, network stream, folder, rehearsal; the newest image wins."""

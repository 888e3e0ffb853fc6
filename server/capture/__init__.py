"""Sources of images: local camera, video file, network stream, folder, rehearsal; the newest image wins."""

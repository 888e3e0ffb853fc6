"""Out to those who watch: MJPEG, image and pose in one WebSocket message, pose alone as JSON."""

"""What a camera sees of a marker's plane, and the pose that explains every pixel of it."""

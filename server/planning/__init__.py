"""What is worked out from CTs and meshes in processes of their own; it loads neither store nor web."""

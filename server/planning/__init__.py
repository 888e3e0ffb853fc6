"""Job functions for CTs and meshes, which run in separate processes and import neither store nor web."""

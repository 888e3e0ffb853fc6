"""Job functions for cameras, CTs and meshes, which run in processes and import neither store nor web."""

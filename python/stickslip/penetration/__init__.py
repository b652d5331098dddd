"""Nodes and edges inside bodies and obstacles, from the deformed meshes alone."""

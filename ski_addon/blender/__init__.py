"""The only package with bpy: the skier's rig and mesh, bake, pictures, properties, panels and jobs.

Importing this package does not import bpy; its modules do, except the pure geometry in `skier/`.
"""

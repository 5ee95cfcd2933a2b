"""Pictures to files: PNG that carries its scene, and linear pictures as OpenEXR or NumPy arrays.

Every writer writes beside its target and renames, so that a file is there whole or not at all.
"""

"""Slow, clear float64 versions of what the GPU does: what tests believe.

- `footprint`: the elliptical footprint of a tilted light cone (Soltesova2010, Eq. 2-11) and its moments.
- `slab`: what a slab of homogeneous tissue returns of a cone's light.
- `medium`, `rays`: a scene's tissue and a camera's rays.
- `multidirectional`: the twin of the multidirectional scheme, written from its description alone.
- `local_occlusion`: light that a point's neighbourhood leaves it (Hernell2007, Eq. 1-4).
- `cone`: the ray-traced cone integral, the truth that all techniques are measured against.

Nothing here shares code with the GPU's side. Numba, where it is installed, makes `cone` fast; the results
are the same without.
"""

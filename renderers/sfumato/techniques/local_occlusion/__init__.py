"""Local ambient occlusion and emissive tissue (Hernell2007): each point looks only into its neighbourhood.

From every texel rays go out over a short way; each brings the more light the less stands in it (`gather`, Eq. 1-3).
So nothing blacks out a whole organ, and hollows are darker than ridges, whatever the lamps do. Tissue that gives off
light shines on what is near it (Eq. 4). What is gathered does not depend on the camera: it is kept, one direction
after the other is added, and the mean so far is shown.

The volume is cut into blocks of 16^3 voxels (`pyramid`), each as coarse as can be without its looking otherwise
under the transfer function (`levels`), packed into one texture (`packing`). Light is gathered for the packed texels
alone; coarse blocks take longer steps.
"""

"""Rigs in millimetres: the motion that a head shows, and weights with which it shows what the FAPs mean.

A head with blendshapes is linear: each point has a rest position, and weight 1 of a shape adds a displacement to it
(`head`). A frame of FAPs determines by how many millimetres each point of the lips should move on this head, since its
units are shares of the head's measures (`meaning`, which also compares the two). `solve` finds a rig that makes them
agree; `avatar` and `landmarks` find the points of an avatar's lips in its file.
"""

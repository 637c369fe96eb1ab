"""Rigs in millimetres: what a head shows of a frame, and the weights with which it shows what the FAPs mean.

A head with blendshapes is linear: each point rests somewhere, and weight 1 of a shape adds a displacement to it
(`head`). A frame of FAPs says by how many millimetres each point of the lips is to move on this head, since its units
are shares of the head's own measures (`meaning`). `judge` compares the two; `solve` finds a rig that makes them agree;
`avatar` and `landmarks` find the points of an avatar's lips in its file.
"""

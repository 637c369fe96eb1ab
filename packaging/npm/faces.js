// What a frame can be given out as, beside FAPs: the names of each face's weights, in the order of its rig.
export const faces = {
    arkit: [
        "jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthStretchLeft", "mouthStretchRight",
        "mouthSmileLeft", "mouthSmileRight", "mouthFrownLeft", "mouthFrownRight", "mouthUpperUpLeft",
        "mouthUpperUpRight", "mouthLowerDownLeft", "mouthLowerDownRight",
    ],
};

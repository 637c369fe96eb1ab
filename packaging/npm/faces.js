// What a frame can be given out as, beside FAPs: the names of each face's weights, in the order of its rig.
const of = (names) => Object.freeze(names.split(" "));

export const faces = Object.freeze({
    arkit: of("jawOpen mouthClose mouthFunnel mouthPucker mouthStretchLeft mouthStretchRight mouthSmileLeft " +
        "mouthSmileRight mouthFrownLeft mouthFrownRight mouthUpperUpLeft mouthUpperUpRight mouthLowerDownLeft " +
        "mouthLowerDownRight mouthPressLeft mouthPressRight mouthRollUpper mouthRollLower mouthShrugLower " +
        "mouthShrugUpper"),
    vrm: of("aa ih ou ee oh"),
    oculus: of("sil PP FF TH DD kk CH SS nn RR aa E ih oh ou"),
});

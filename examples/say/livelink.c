/*
 * livelink.c - the columns in Live Link Face's order.
 */
#include "livelink.h"

#include "arkit.h"

#define STILL (-1) /* neither lips nor jaw move it */

const livelink_column_t livelink_columns[LIVELINK_COLUMNS] = {
    {"EyeBlinkLeft", STILL}, {"EyeLookDownLeft", STILL}, {"EyeLookInLeft", STILL}, {"EyeLookOutLeft", STILL},
    {"EyeLookUpLeft", STILL}, {"EyeSquintLeft", STILL}, {"EyeWideLeft", STILL}, {"EyeBlinkRight", STILL},
    {"EyeLookDownRight", STILL}, {"EyeLookInRight", STILL}, {"EyeLookOutRight", STILL}, {"EyeLookUpRight", STILL},
    {"EyeSquintRight", STILL}, {"EyeWideRight", STILL}, {"JawForward", STILL}, {"JawRight", STILL},
    {"JawLeft", STILL}, {"JawOpen", ARKIT_JAWOPEN}, {"MouthClose", ARKIT_MOUTHCLOSE},
    {"MouthFunnel", ARKIT_MOUTHFUNNEL}, {"MouthPucker", ARKIT_MOUTHPUCKER}, {"MouthRight", STILL},
    {"MouthLeft", STILL}, {"MouthSmileLeft", ARKIT_MOUTHSMILELEFT}, {"MouthSmileRight", ARKIT_MOUTHSMILERIGHT},
    {"MouthFrownLeft", ARKIT_MOUTHFROWNLEFT}, {"MouthFrownRight", ARKIT_MOUTHFROWNRIGHT}, {"MouthDimpleLeft", STILL},
    {"MouthDimpleRight", STILL}, {"MouthStretchLeft", ARKIT_MOUTHSTRETCHLEFT},
    {"MouthStretchRight", ARKIT_MOUTHSTRETCHRIGHT}, {"MouthRollLower", ARKIT_MOUTHROLLLOWER},
    {"MouthRollUpper", ARKIT_MOUTHROLLUPPER}, {"MouthShrugLower", ARKIT_MOUTHSHRUGLOWER},
    {"MouthShrugUpper", ARKIT_MOUTHSHRUGUPPER}, {"MouthPressLeft", ARKIT_MOUTHPRESSLEFT},
    {"MouthPressRight", ARKIT_MOUTHPRESSRIGHT}, {"MouthLowerDownLeft", ARKIT_MOUTHLOWERDOWNLEFT},
    {"MouthLowerDownRight", ARKIT_MOUTHLOWERDOWNRIGHT}, {"MouthUpperUpLeft", ARKIT_MOUTHUPPERUPLEFT},
    {"MouthUpperUpRight", ARKIT_MOUTHUPPERUPRIGHT}, {"BrowDownLeft", STILL}, {"BrowDownRight", STILL},
    {"BrowInnerUp", STILL}, {"BrowOuterUpLeft", STILL}, {"BrowOuterUpRight", STILL}, {"CheekPuff", STILL},
    {"CheekSquintLeft", STILL}, {"CheekSquintRight", STILL}, {"NoseSneerLeft", STILL}, {"NoseSneerRight", STILL},
    {"TongueOut", STILL}, {"HeadYaw", STILL}, {"HeadPitch", STILL}, {"HeadRoll", STILL}, {"LeftEyeYaw", STILL},
    {"LeftEyePitch", STILL}, {"LeftEyeRoll", STILL}, {"RightEyeYaw", STILL}, {"RightEyePitch", STILL},
    {"RightEyeRoll", STILL}
};

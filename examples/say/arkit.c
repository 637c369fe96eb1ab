/*
 * arkit.c - the table of blendshapes, and Live Link's columns.
 */
#include "arkit.h"

#include <ctype.h>

/* Weights are millionths of a blendshape per FAP unit, in the order of the channels: fap3, 16, 17, 51 to
 * 60. The jaw is wide open at 800 FAP units; mouthClose draws the lips shut over it, as p, b, m need it; the funnel and
 * the pucker are rounding with lips parted and not; corners sink as the jaw opens, which smile and frown allow for; the
 * lower lip goes down beyond what the jaw takes along. */
const arkit_shape_t arkit_shapes[ARKIT_SHAPES] = {
    {"jawOpen", 0, {1250, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"mouthClose", 0, {1250, 0, 0, 1250, 1250, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"mouthFunnel", -400, {0, 0, 4242, -848, -848, -2121, -2121, 0, 0, 0, 0, 0, 0}},
    {"mouthPucker", -100, {0, 0, 3929, 393, 393, -1964, -1964, 0, 0, 0, 0, 0, 0}},
    {"mouthSmileLeft", -150, {1278, 0, 0, 0, 0, 3194, 0, 0, 0, 0, 0, 3194, 0}},
    {"mouthSmileRight", -150, {1278, 0, 0, 0, 0, 0, 3194, 0, 0, 0, 0, 0, 3194}},
    {"mouthFrownLeft", 0, {-1600, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -4000, 0}},
    {"mouthFrownRight", 0, {-1600, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -4000}},
    {"mouthStretchLeft", 0, {0, 0, 0, 0, 0, 4000, 0, 0, 0, 0, 0, -2000, 0}},
    {"mouthStretchRight", 0, {0, 0, 0, 0, 0, 0, 4000, 0, 0, 0, 0, 0, -2000}},
    {"mouthLowerDownLeft", 0, {-3000, 0, 0, 0, 0, 0, 0, 0, 0, -3333, 0, 0, 0}},
    {"mouthLowerDownRight", 0, {-3000, 0, 0, 0, 0, 0, 0, 0, 0, 0, -3333, 0, 0}},
    {"mouthUpperUpLeft", 0, {0, 0, 0, 0, 0, 0, 0, -5000, 0, 0, 0, 0, 0}},
    {"mouthUpperUpRight", 0, {0, 0, 0, 0, 0, 0, 0, 0, -5000, 0, 0, 0, 0}},
};

const char *const arkit_columns[ARKIT_COLUMNS] = {
    "EyeBlinkLeft", "EyeLookDownLeft", "EyeLookInLeft", "EyeLookOutLeft", "EyeLookUpLeft", "EyeSquintLeft",
    "EyeWideLeft", "EyeBlinkRight", "EyeLookDownRight", "EyeLookInRight", "EyeLookOutRight", "EyeLookUpRight",
    "EyeSquintRight", "EyeWideRight", "JawForward", "JawRight", "JawLeft", "JawOpen", "MouthClose", "MouthFunnel",
    "MouthPucker", "MouthRight", "MouthLeft", "MouthSmileLeft", "MouthSmileRight", "MouthFrownLeft",
    "MouthFrownRight", "MouthDimpleLeft", "MouthDimpleRight", "MouthStretchLeft", "MouthStretchRight",
    "MouthRollLower", "MouthRollUpper", "MouthShrugLower", "MouthShrugUpper", "MouthPressLeft", "MouthPressRight",
    "MouthLowerDownLeft", "MouthLowerDownRight", "MouthUpperUpLeft", "MouthUpperUpRight", "BrowDownLeft",
    "BrowDownRight", "BrowInnerUp", "BrowOuterUpLeft", "BrowOuterUpRight", "CheekPuff", "CheekSquintLeft",
    "CheekSquintRight", "NoseSneerLeft", "NoseSneerRight", "TongueOut", "HeadYaw", "HeadPitch", "HeadRoll",
    "LeftEyeYaw", "LeftEyePitch", "LeftEyeRoll", "RightEyeYaw", "RightEyePitch", "RightEyeRoll"
};

void arkit_weights(const int16_t faps[LABIAL_CHANNELS], int weights[ARKIT_SHAPES])
{
    for (int s = 0; s < ARKIT_SHAPES; s++) {
        int32_t sum = arkit_shapes[s].offset * 1000;
        for (int i = 0; i < LABIAL_CHANNELS; i++)
            sum += arkit_shapes[s].weights[i] * faps[i];
        sum = sum > 0 ? (sum + 500) / 1000 : 0;
        weights[s] = sum > 1000 ? 1000 : (int)sum;
    }
}

int arkit_is_column(const arkit_shape_t *shape, const char *column)
{
    const char *name = shape->name;
    if (toupper((unsigned char)*name) != *column)
        return 0;
    while (*name && *++name == *++column)
        ;
    return *name == *column;
}

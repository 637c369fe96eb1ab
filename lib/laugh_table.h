/*
 * laugh_table.h - the statistics of laughter behind laugh.c. Written by export/labial/reference/laughs.py from those of
 * the synthetic corpus; do not edit.
 */
#ifndef LABIAL_LAUGH_TABLE_H
#define LABIAL_LAUGH_TABLE_H

#include <stdint.h>

#define PERIOD 210
#define PERIOD_SPREAD 25
#define PERIOD_SHORTEST 140
#define PERIOD_LONGEST 280
#define TRAIN_MEDIAN 3
#define TRAIN_LONGEST 17
#define SHORTEST 20

/* Of 256: how loud the next pulse, the next train and air drawn in are; the softest train. */
#define PULSE_DECAY 238u
#define TRAIN_DECAY 236u
#define INHALED_LOUDNESS 179u
#define SOFTEST 154u

/* Up to which loudness of 256 all is soft; 1/256 grades for each 1/256 more; how the dither moves on. */
#define SOFT 20u
#define GRADES 582u
#define DITHER_STEP 158u

/* Of 256: what a pause between trains has. */
#define INHALED 192
#define CLICKED 51
#define BY_NOSE 192
#define GRUNTED 46
#define SILENT 128
#define RESTED 38

/* Median duration of each phoneme, milliseconds; silence has its own. */
static const uint8_t medians[12] = {
    0, 240, 40, 80, 40, 120, 80, 92, 92, 200, 48, 98
};
/* Equally likely standard normal deviates, in 1/32. */
static const int8_t deviates[32] = {
    -69, -54, -45, -39, -34, -30, -27, -23, -20, -17, -14, -12, -9, -6, -4, -1, 1, 4, 6, 9, 12, 14, 17, 20, 23, 27,
    30, 34, 39, 45, 54, 69
};
/* Equally likely factors of a duration, in 1/128. */
static const uint8_t stretches[32] = {
    80, 89, 94, 98, 101, 104, 107, 109, 112, 114, 116, 118, 120, 123, 125, 127, 129, 131, 134, 136, 139, 141, 144,
    147, 150, 154, 158, 162, 168, 175, 185, 206
};
/* Equally likely factors of a train's length, in 1/32. */
static const uint8_t lengths[32] = {
    9, 12, 14, 15, 17, 18, 19, 21, 22, 23, 25, 26, 27, 28, 30, 31, 33, 34, 36, 38, 40, 42, 44, 47, 49, 53, 56, 61, 67,
    75, 87, 117
};
/* Kinds of pulses (breath first, vowel alone, cackle, nasal, stop first): shares of 256. */
static const uint8_t pulse_shares[5] = {
    158, 31, 26, 23, 18
};
/* How these grow with intensity, of 256. */
static const int16_t pulse_tilts[5] = {
    -40, 128, 205, -230, 0
};
/* Vowels of pulses, their shares and their tilts. */
static const uint8_t vowels[4] = {
    11, 7, 8, 6
};
/* The same. */
static const uint8_t vowel_shares[4] = {
    102, 87, 26, 41
};
/* The same. */
static const int16_t vowel_tilts[4] = {
    128, -50, 40, -128
};
/* What a laugh may start with. */
static const uint8_t onsets[4] = {
    1, 2, 9, 4
};
/* The shares, of 256; mostly it starts with a pulse. */
static const uint8_t onset_shares[4] = {
    64, 38, 51, 38
};
/* The soft grade of each phoneme that has one, 0 for the others; the loud grade is the next number. */
static const uint8_t soft_grades[12] = {
    0, 0, 0, 0, 0, 12, 14, 16, 18, 0, 20, 22
};

#endif

/*
 * labial/hear_private.h - the parts of hearing, for labial/hear.h alone. They are declared so that programs can
 * allocate a stream of sound statically. All members are private and may change with any version. Each structure
 * belongs to one file of lib/.
 */
#ifndef LABIAL_HEAR_PRIVATE_H
#define LABIAL_HEAR_PRIVATE_H

#include <stdint.h>

#include "labial/hear_model.h"
#include "labial/private.h"

#define LABIAL_HEAR_MAGIC_ 0x48454152u /* "HEAR" */
#define LABIAL_HEAR_WINDOW_ 256        /* samples of a window */
#define LABIAL_HEAR_HOP_ 160           /* from one window to the next */
/* Numbers that a window and the network's layers take turns in. */
#define LABIAL_HEAR_ROOM_                                                                                              \
    (2 * LABIAL_HEAR_UNITS_MAX > LABIAL_HEAR_WINDOW_ ? 2 * LABIAL_HEAR_UNITS_MAX : LABIAL_HEAR_WINDOW_)
#define LABIAL_HEAR_TAPS_ 32 /* samples that the conversion of rates looks at */

/* The conversion of rates (hear_convert.c). Times are in tenths of a point of the grid on which the filter lies. */
typedef struct {
    uint8_t reach;   /* samples that the filter takes on each side; 0 for 16 kHz, which is not converted */
    uint8_t spacing; /* points from one sample to the next */
    uint8_t at;      /* where the next sample goes; LABIAL_HEAR_TAPS_ before the first one */
    uint16_t step;   /* from one converted sample to the next */
    uint16_t phase;  /* from the latest sample of the filter's left half to the next converted sample */
    int16_t past[2 * LABIAL_HEAR_TAPS_]; /* every sample twice, so that the latest are always in one piece */
} labial_hear_convert_t;

/* The level of the voice and of the sound before it, 64 times the sum of the bands' log2 energies in Q8
 * (hear_features.c). */
typedef struct {
    int32_t level;
    int32_t quietest, before; /* hops until a voice is there */
    uint8_t stage;            /* waits for a voice, looks for its level, follows it */
} labial_hear_level_t;

/* Sound at 16 kHz on its way to features (hear_features.c). */
typedef struct {
    uint8_t hop;     /* 1 in the second half of a frame */
    uint8_t loud;    /* the frame has sound that is a voice */
    uint16_t filled; /* samples of the window; 0 before the first one */
    labial_hear_level_t level;
    int16_t bands[LABIAL_HEAR_INPUTS];                    /* features of the frame, Q9 */
    int16_t tail[LABIAL_HEAR_WINDOW_ - LABIAL_HEAR_HOP_]; /* samples that a window shares with the next one */
    int16_t window[LABIAL_HEAR_ROOM_]; /* samples, then their spectrum, then what layers of the network put out */
} labial_hear_features_t;

/* The network's memory (hear_network.c). */
typedef struct {
    uint8_t at[LABIAL_HEAR_BLOCKS_MAX];   /* the oldest row of each block's memory */
    uint8_t skip[LABIAL_HEAR_BLOCKS_MAX]; /* and of its former inputs */
    uint32_t taken;                       /* frames that it has heard, at most those that it needs ahead */
    const labial_hear_model_t *model;
    int16_t *rows; /* the workspace */
} labial_hear_network_t;

/* Poses on their way to motion (hear_motion.c). */
typedef struct {
    uint8_t held, leader; /* `now` is a pose; its class */
    uint8_t rest;         /* how far the face has come to rest in silence */
    uint32_t loud;        /* whether the latest 32 frames had sound, the last one in bit 0 */
    labial_articulation_t articulation;
    int16_t before[LABIAL_CHANNELS]; /* the pose before `now`, Q4 */
    int16_t now[LABIAL_CHANNELS];    /* the pose that is due next, before it is smoothed */
} labial_hear_motion_t;

/* What the last frame shows. */
enum { LABIAL_HEAR_NOTHING_, LABIAL_HEAR_SOUND_, LABIAL_HEAR_WAY_TO_REST_ };

/* A stream of sound (hear.c). */
typedef struct {
    uint32_t magic; /* set while the stream is initialised */
    uint8_t channels;
    uint8_t ended, busy;    /* no more sound is heard; a callback runs */
    uint8_t exact;          /* the end delivers no way to rest */
    uint8_t shown, earlier; /* the class of the last frame, and of the one before it */
    uint8_t told;           /* what the last frame shows */
    uint32_t sounding;      /* frames with sound, also in part, that are not yet delivered */
    uint32_t frame;         /* the next frame */
    uint32_t first;         /* of the class that is shown; the next frame if none is */
    void (*callback)(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);
    void (*class_callback)(void *user, unsigned shown, uint32_t frame, uint32_t frames);
    void *user;
    labial_hear_motion_t motion;
    labial_hear_network_t network;
    labial_fade_t fade;
    labial_hear_convert_t convert;
    labial_hear_features_t features;
} labial_hear_t;

#endif

/*
 * labial/private.h - the parts of a stream, for labial/labial.h alone. They are declared so that programs can allocate
 * a stream statically. All members are private and may change with any version. Each structure belongs to one file of
 * lib/.
 */
#ifndef LABIAL_PRIVATE_H
#define LABIAL_PRIVATE_H

#include <stdint.h>

#include "labial/config.h"
#include "labial/model.h"

/* A phoneme that was pushed (units.c). */
typedef struct {
    uint32_t frames; /* duration in frames, never 0 */
    uint16_t ms;     /* duration in milliseconds, 65535 for longer ones */
    uint8_t phoneme; /* of the model in the slot */
    uint8_t slot;    /* model it belongs to */
} labial_segment_t;

/* The queue of phonemes that were pushed and whose frames are not all accepted yet (units.c). */
typedef struct {
    uint8_t head, count;
    uint8_t begins;                       /* the next frame is the first of a solution */
    uint8_t rested;                       /* the oldest segment is a pause that a solution began with */
    uint8_t labelled;                     /* segments that have labels, the oldest ones */
    uint8_t labels[2 * LABIAL_REACH + 1]; /* phonemes of the frames around the last accepted one */
    uint16_t remainder;            /* of all durations so far: a part of a frame, in 1/1000, starting from one half */
    uint32_t taken;                /* frames of the oldest segment that were accepted */
    uint32_t frames;               /* of all segments, not yet accepted */
    uint32_t unlabelled;           /* frames of the last of these that have no label yet */
    uint32_t since[LABIAL_MODELS]; /* frames pushed since the last one of the model in each slot, modulo 2^32 */
    labial_segment_t segments[LABIAL_QUEUE];
} labial_units_t;

/* A channel of the shape of a phoneme (shape.c): at its start and at its end, positions. */
typedef struct {
    int16_t knots[2];
} labial_shape_t;

/* The selection of a shape (shape.c). */
typedef struct {
    labial_shape_t *shape;                             /* of the model's channels, in the workspace */
    uint8_t halves;                                    /* that are done */
    uint8_t count;                                     /* components that have a share */
    uint8_t components[LABIAL_PHONEME_COMPONENTS_MAX]; /* of the phoneme's */
    uint16_t shares[LABIAL_PHONEME_COMPONENTS_MAX];    /* of the mixture, Q12 */
    int16_t tilts[LABIAL_PHONEME_COMPONENTS_MAX];      /* how much of the slope counts: share times deviation, Q12 */
} labial_selection_t;

/* State of the search of one channel (viterbi.c). */
typedef struct {
    uint8_t first; /* state of the window */
    uint8_t count; /* states of the window; after the end of a unit it is the best one alone */
    uint8_t scores[LABIAL_SEARCHED];
    uint8_t path[LABIAL_LAG + 1]; /* states of the last steps, the latest first */
#if LABIAL_LAG > 0
    uint8_t best;                              /* state, counted from the first */
    uint8_t spans[LABIAL_LAG + 1];             /* frames of these steps */
    uint8_t undecided;                         /* steps before the last whose states may still change */
    uint8_t firsts[LABIAL_LAG];                /* windows of the steps before the last */
    uint8_t back[LABIAL_LAG][LABIAL_SEARCHED]; /* predecessors in them of the next step's states */
#endif
} labial_search_t;

/* State of the solution of one channel (trajectory.c): the recursion, and the row that the next one completes. */
typedef struct {
    uint8_t shifts[2]; /* headroom of the last row's two divisors, where cores do not count leading zeros; 0 at first */
    uint16_t hold, delta;
    int32_t row, bent; /* Q16 */
    int32_t k1, k2;    /* Q16 */
    int32_t q1, q2;    /* Q12 FAP */
    int32_t position;  /* Q12 FAP */
    int32_t pull, next_pull;
} labial_solver_t;

/* A frame's numbers for the backward pass (trajectory.c). */
typedef struct {
    int32_t q; /* Q12 FAP */
    uint16_t rho, kappa;
} labial_factors_t;

/* An accepted frame (stream.c). */
typedef struct {
    int16_t target[LABIAL_CHANNELS]; /* positions of the model's channels */
    uint8_t marks;
    uint32_t contacts; /* bit k: channel k of the model is in contact */
} labial_frame_t;

/* The factors that a channel keeps for its next backward pass, the latest last; a structure, so that it is copied
 * whole. */
typedef struct {
    labial_factors_t of[LABIAL_WINDOW + 1];
} labial_kept_t;

/* State of one channel (channels.c). */
typedef struct {
    labial_search_t search;
    labial_solver_t solver;
    labial_kept_t kept;
} labial_progress_t;

#if LABIAL_PAPER

/* The latest frames, and the search of one channel (published.c): all of the workspace. */
typedef struct {
    labial_frame_t frames[LABIAL_PIECE];
    int16_t motion[LABIAL_CHANNELS][LABIAL_PIECE]; /* Q4 FAP */
    int16_t gains[LABIAL_PIECE];                   /* articulation, in 1/256 */
    uint8_t back[LABIAL_PIECE][LABIAL_STATES_MAX]; /* the predecessor of each state in each step */
} labial_pieces_t;

/* All channels (published.c). The rings of frames share their place. */
typedef struct {
    uint8_t stride;  /* frames that share a state */
    uint8_t phase;   /* 0: channels take no turns */
    uint8_t entered; /* accepted frames, 255 for more */
    uint8_t beyond;  /* ticks since the last frame was accepted */
    uint8_t width;   /* channels that the workspace holds: all */
    uint8_t place;   /* of the latest frame in the rings */
    uint8_t frames;  /* of the piece so far, those included that it shares with the one before */
    uint8_t shared;  /* of these */
    uint8_t phoneme; /* frames of the latest phoneme, 0 for the piece's first */
    uint8_t slots[LABIAL_PIECE];
    labial_pieces_t *pieces;
} labial_channels_t;

#else

/* All channels (channels.c). The pointers are to parts of the workspace. */
typedef struct {
    uint8_t stride;   /* frames that share a state */
    uint8_t phase;    /* channels phase, phase + stride, ... step next */
    uint8_t entered;  /* accepted frames, 255 for more */
    uint8_t width;    /* channels that the workspace holds */
    uint8_t beyond;   /* ticks since the last frame was accepted */
    uint8_t stepping; /* channels of the frames in hand: the most that one of their models has */
    uint8_t slots[LABIAL_DELAY(LABIAL_SEARCH_STRIDE_MAX) + 1]; /* i: model of the frame that was accepted i ticks ago */
    labial_progress_t *progress;                               /* width */
    labial_frame_t *frames; /* the latest stride + LABIAL_LAG, the newest at the end */
    int16_t *motion;        /* width rings of stride frames, Q4 FAP */
} labial_channels_t;

#endif

/* The pose that was delivered last, and its way to another one (fade.c). */
typedef struct {
    uint16_t step;                    /* the next one of the way; 0 when there is none */
    uint16_t length;                  /* of the way, in steps */
    uint16_t closing;                 /* the steps after which jaw and lips are there, no more than its length */
    int16_t pose[LABIAL_CHANNELS];    /* Q4 FAP */
    int16_t earlier[LABIAL_CHANNELS]; /* the pose before it; on the way, how far `from` moves on */
    int16_t from[LABIAL_CHANNELS];    /* where the way begins */
} labial_fade_t;

/* How far the mouth moves (articulation.h), percent. */
typedef struct {
    uint8_t wanted;
    uint8_t present; /* of the latest frame */
} labial_articulation_t;

#define LABIAL_MAGIC_ 0x4c41424cu /* "LABL" */
#define LABIAL_DELAY_WORDS_ (LABIAL_DELAY(LABIAL_SEARCH_STRIDE_MAX) / 32 + 1)

/* The stream's state (stream.c). Small members come first, where small instructions reach them, behind the models,
 * whose place an index alone tells. */
typedef struct {
    const labial_model_t *models[LABIAL_MODELS];
    uint32_t magic;  /* set while the stream is initialised */
    uint8_t slot;    /* model of the next push */
    uint8_t ended;   /* no more phonemes will come */
    uint8_t begun;   /* a frame was delivered since the stream was initialised or restarted */
    uint8_t exact;   /* the face rests only after a cancel */
    uint8_t resting; /* the face is at rest or on its way there: motion fades in from it */
    uint8_t held;    /* ticks without a frame since the last frame or push, up to LABIAL_HOLD_TICKS */
    labial_articulation_t articulation;
    labial_channels_t channels;
    uint32_t frame;   /* number of the next frame */
    uint32_t pending; /* frames pushed and not yet delivered */
    /* Bit i is that of the frame accepted i ticks ago; those from before a cancel move beyond the delay before
     * a frame is due. */
    uint32_t begins[LABIAL_DELAY_WORDS_];  /* a solution begins with the frame */
    uint32_t touches[LABIAL_DELAY_WORDS_]; /* a channel is in contact */
    void (*callback)(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS]);
    void *user;
    labial_shape_t *shape;   /* of the phoneme that the latest frame belongs to, in the workspace */
    labial_selection_t next; /* that of the phoneme that begins next */
    labial_fade_t fade;
    labial_units_t units;
} labial_t;

#endif

/*
 * labial/model.h - the tables of a model, as the exporter writes them and the run-time reads them.
 *
 * A model is a set of constant tables: it stays in flash, is never written, and may serve any number of streams at
 * once. Programs do not fill these structures by hand: `labial export` writes a C file that does, and
 * labial_model_load() (labial/blob.h) makes one refer to a blob.
 *
 * Number formats, the same in every table:
 *
 *   position   int16, Q4: 1/16 FAP unit, relative to the channel's `centre`; at most +-LABIAL_POSITION_MAX
 *   cost       1/32 nat: a negative log-probability times 32, so that smaller is better
 *   gain       of a Gaussian with standard deviation s: 2^18 / (s * sqrt 2). For a distance x in the unit of s,
 *              z = x * gain / 2^12 is in Q6 and z^2 / 2^7 is the Gaussian's exponent as a cost
 *   short gain the same in 8 bits, exponent e in the high and mantissa m in the low four: (16 + m) * 2^(12 - e),
 *              so that z = x * (16 + m) / 2^e
 *   weight     an 8-bit minifloat, exponent e in the high and mantissa m in the low four bits: m when e is zero,
 *              (16 + m) << (e - 1) otherwise. Precisions (inverse variances) of one channel share one free scale.
 */
#ifndef LABIAL_MODEL_H
#define LABIAL_MODEL_H

#include <limits.h>
#include <stdint.h>

#if INT_MAX < 2147483647
#error "Labial needs an int of 32 bits, to which its arithmetic promotes."
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this format. A generated model of another version does not compile, and a blob of another version is
 * refused. */
#define LABIAL_MODEL_FORMAT 7

/* Channels of a frame: the 13 outer-lip, jaw and protrusion FAPs in the order of labial_fap_numbers (labial/faps.h). */
#define LABIAL_CHANNELS 13

/* In `sources`: FAP 17 is computed of the corners, by the table `protrusion`. */
#define LABIAL_FROM_CORNERS 255

/* Limits of the run-time's arithmetic and memory; labial_model_check() refuses a model that exceeds them. */
#define LABIAL_PHONEMES_MAX 128                              /* phonemes of one model */
#define LABIAL_CLASSES_MAX 32                                /* viseme classes of one model */
#define LABIAL_PHONEME_COMPONENTS_MAX 8                      /* mixture components of one phoneme */
#define LABIAL_STATES_MAX 64                                 /* codebook entries of one channel */
#define LABIAL_KERNEL_TAPS_MAX 32                            /* taps of one temporal kernel */
#define LABIAL_KERNEL_WORDS(channels) (((channels) + 3) / 4) /* that hold a tap of one phoneme */
#define LABIAL_PROTRUSION_VALUES 17                          /* ends of the intervals of labial_protrusion_t */
#define LABIAL_SEARCH_STRIDE_MAX 8                           /* frames that share a state */
#define LABIAL_NO_FLOOR (-16384)                             /* in `floors`: below every position */
#define LABIAL_POSITION_MAX 16383                            /* Q4: +-1023.9 FAP units around the channel's centre */

/* A phoneme is in contact in the middle half of its frames, in LABIAL_CONTACT_FRAMES of them at least, and in all but
 * LABIAL_CONTACT_OPEN of them, as a hum is. A shorter one borrows the frame before it and, if it has only one frame,
 * the frame after it as well. */
#define LABIAL_CONTACT_FRAMES 3
#define LABIAL_CONTACT_OPEN 7

/* Frames over which a mouth comes to rest in a pause. The last frames of a pause lead to what follows instead; a
 * stream that begins with a pause begins at rest. */
#define LABIAL_REST_FRAMES 16

/* Limits of equation 3 within a channel. Within them the error of its solution is below .1 FAP unit
 * (lib/trajectory.c). */
#define LABIAL_WEIGHT_SUM_MAX 16383 /* largest `hold` or `contact_weight` + 2 x largest weight[0] + 6 x weight[1] */
#define LABIAL_WEIGHT_MIN 8         /* the least `hold` */
#define LABIAL_STIFFNESS_MAX 16     /* a state's weight[1] over its `hold`; weight[0] is not above weight[1] */
#define LABIAL_PULL_MAX 65535 /* Q4: four times the largest weight[i] * |mean[1 + i]|, summed, over least `hold` */

/* A phoneme: its mixture components, and the viseme class that its neighbours see. */
typedef struct {
    uint16_t first_component; /* index into `components` */
    uint8_t component_count;  /* 1 .. LABIAL_PHONEME_COMPONENTS_MAX */
    uint8_t viseme_class;     /* below class_count */
    uint8_t boundary;         /* 1 when a unit begins and ends here (vowels, p, b, m), else 0 */
    uint8_t floor;            /* 1 + its row of `floors`, 0 without */
} labial_phoneme_t;

/* A mixture component's duration model (equation 2): log a_c + log N(d; mu_c, var_c) as a cost. */
typedef struct {
    uint16_t cost;          /* -log a_c + log sigma_c, cost, less the least of its phoneme */
    uint16_t duration_mean; /* mu_c, milliseconds */
    uint16_t duration_gain; /* gain of sigma_c, milliseconds */
} labial_component_t;

/* A codebook entry in the Viterbi search: a Gaussian on the static feature alone. */
typedef struct {
    int16_t mean; /* position */
    uint8_t gain; /* short gain of the standard deviation in positions */
    uint8_t cost; /* log sigma, cost, less the least of its channel */
} labial_emission_t;

/* A codebook entry in the trajectory (equation 3): means of m, its delta and its delta-delta, per frame, and an anchor
 * that ties the frame to its target, which the published method does not have. */
typedef struct {
    int16_t mean;      /* position */
    int8_t motion[2];  /* means of delta and delta-delta, in steps of motion_scale */
    uint8_t hold;      /* weight of static feature and anchor together */
    uint8_t share;     /* the anchor's share of it, in 1/256; from 128 on one more, so that 255 is all of it */
    uint8_t weight[2]; /* a quarter of delta's; delta-delta's */
} labial_state_t;

/* A transition into a state. */
typedef struct {
    uint8_t predecessor; /* a state */
    uint8_t cost;
} labial_transition_t;

/* One channel's scales and its hidden Markov model. States are sorted by their emissions' means. Each state has 4 K
 * transitions, in ascending order of the predecessor, the last one repeated where there are fewer. */
typedef struct {
    int16_t centre;                         /* Q4 FAP: added to every position on output */
    uint16_t shape_scale;                   /* positions per step of `shapes`, Q8; at most 32767 */
    uint16_t slope_scale;                   /* positions per step of `slopes` and unit of z, Q8; at most 16383 */
    uint16_t kernel_scale;                  /* positions per step of `kernels`, Q8 */
    uint16_t pair_scale;                    /* positions per step of `pairs`, Q8 */
    uint16_t motion_scale[2];               /* positions per frame, and per frame squared, per step of `motion`, Q8 */
    uint8_t contact_weight;                 /* least `hold` of a frame in contact; 0 where there is none */
    const labial_emission_t *emissions;     /* state_count */
    const labial_state_t *states;           /* state_count */
    const labial_transition_t *transitions; /* state_count x 4 K */
    const uint8_t *initials;                /* state_count, cost of starting there */
} labial_channel_t;

/* FAP 17, protrusion of the top lip, over the mean of FAP 53 and 54, the corners: values from `low` on in 16 even
 * intervals, linear in between, constant beyond. With s = FAP 53 + FAP 54 in Q4 and
 * u = clamp(s - 2 * low, 0, 65535) * gain >> 12, at most 4096, it is between values i = u >> 8 and i + 1:
 * values[i] + ((values[i + 1] - values[i]) * (u & 255) + 128 >> 8). The published method does not have it. */
typedef struct {
    int16_t low;                              /* Q4 FAP */
    uint16_t gain;                            /* 2^24 over twice the width of all intervals in Q4 FAP */
    int16_t values[LABIAL_PROTRUSION_VALUES]; /* Q4 FAP */
} labial_protrusion_t;

/* A model. It searches and solves C channels, of which `sources` makes the 13 of a frame: one of them may be several
 * FAPs, as in a mouth whose two sides move alike. Arrays are row-major in the order given; those marked optional may be
 * null. */
typedef struct {
    uint16_t format;            /* LABIAL_MODEL_FORMAT */
    uint16_t frames_per_second; /* 1 .. 250 */
    uint16_t component_count;   /* N: components of all phonemes */
    uint8_t phoneme_count;      /* P: 1 .. LABIAL_PHONEMES_MAX */
    uint8_t class_count;        /* V: 1 .. LABIAL_CLASSES_MAX */
    uint8_t state_count;        /* Q: 1 .. LABIAL_STATES_MAX */
    uint8_t predecessor_fours;  /* K: 1 .. LABIAL_STATES_MAX / 4; a state has four times as many transitions */
    uint8_t search_stride;      /* frames that share a state, 1 .. LABIAL_SEARCH_STRIDE_MAX; the search sees the target
                                 * of the middle one, or of the later of two */
    uint8_t silence;            /* the phoneme before the first, after the last, and in place of another model's; a long
                                 * one counts as two (lib/units.h) */
    uint8_t mixture_mean;       /* 1: shapes are the mixture's mean; 0: those of its best component (equation 2) */
    uint8_t kernel_taps;        /* L: 0 .. LABIAL_KERNEL_TAPS_MAX; 0 without temporal kernels */
    uint8_t kernel_stride;      /* frames from tap to tap */
    uint8_t kernel_behind;      /* taps that lie before the frame: tap i is at (i - kernel_behind) * kernel_stride,
                                 * LABIAL_REACH frames away at most; 0 when L is 0 */
    uint8_t floor_count;        /* F: rows of `floors`, 0 .. 255 */
    uint8_t pair_knots;         /* K': 1, or 2 where pairs move from a phoneme's start to its end */
    uint16_t pair_count;        /* R: rows of `pairs` */
    uint8_t channel_count;      /* C: 1 .. LABIAL_CHANNELS */
    uint8_t sources[LABIAL_CHANNELS];     /* of each channel of a frame: which of the C it is, or LABIAL_FROM_CORNERS */
    const labial_phoneme_t *phonemes;     /* P */
    const labial_component_t *components; /* N */
    const uint8_t *contexts;   /* N x V, in 1/2 nat: cost of the previous phoneme's class in the low four bits, of the
                                * next one's in the high four; less the least of a phoneme's components; optional */
    const int8_t *shapes;      /* N x C, mean shape in steps of shape_scale */
    const int8_t *slopes;      /* N x C, change of shape per unit of z, in steps of slope_scale; optional */
    const uint32_t *kernels;   /* P x L x LABIAL_KERNEL_WORDS(C), in steps of kernel_scale: four channels to a word, the
                                * first in the low byte, each 128 more than its steps; null when L is 0 */
    const uint16_t *pair_keys; /* R, ascending: phoneme * 256 + neighbour, + 128 when the neighbour is the next one;
                                * null when R is 0 */
    const int8_t *pairs;       /* R x K' x C, what such a neighbour adds to the phoneme's shape, in steps of
                                * pair_scale */
    const int16_t *floors;     /* F x C, positions that targets in the phoneme do not fall below; LABIAL_NO_FLOOR where
                                * none; null when F is 0 */
    const uint16_t *contacts;  /* F, bit k: channel k's floor is contact, as of the lips in p, b, m whatever their
                                * neighbours do: its `hold` is `contact_weight` at least, for LABIAL_CONTACT_FRAMES
                                * frames or more. In silence: it is where the channel comes to rest in a pause.
                                * Null when F is 0 */
    const labial_protrusion_t *protrusion; /* of which FAP 17 is computed; null where that has a channel */
    const labial_channel_t *channels;      /* C */
} labial_model_t;

/*
 * Checks everything that labial_init() and labial_use() assume: the version, every count, index and sum, and that no
 * required pointer is null. It cannot know how long the arrays are; load a model from outside the program by
 * labial_model_load(), which does.
 *
 * Returns LABIAL_OK, LABIAL_ERROR_NULL, LABIAL_ERROR_VERSION or LABIAL_ERROR_MODEL (labial/labial.h).
 */
int labial_model_check(const labial_model_t *model);

/*
 * The work of a tick: an upper estimate, for any input, of the instructions that one labial_tick() takes on a
 * Cortex-M0, the slowest of the processors that the library is measured on; the others take about three quarters of
 * them. Where models change, a tick takes at most the sum of their costs, one for each run of a model's phonemes within
 * the latest `search_stride` frames.
 *
 * The bundled models cost about 29,000 and 24,000, and their ticks take 14,200 at most, 15,500 where models change with
 * every phoneme. A model that labial_model_check() accepts can cost 140,000. So a program that plays foreign models
 * compares this number with the instructions that its processor has for a frame:
 *
 *     if (labial_model_load(&blob, data, size) != LABIAL_OK || labial_model_cost(&blob.model) > 50000)
 *         return -1; // 50,000 instructions 50 times a second are about a quarter of a Cortex-M0 at 16 MHz
 *
 * `model` is one that labial_model_check() accepts; 0 for a null pointer. Linked only when used.
 */
uint32_t labial_model_cost(const labial_model_t *model);

#ifdef __cplusplus
}
#endif

#endif

/*
 * prove_hear_network.c - the steps of hearing without stand-ins: prove_NAME() is the driver of lib/NAME.c.
 */
#include <string.h>

#include "hear_large.h"
#include "hear_parts.h"
#include "hear_small.h"
#include "prove.h"

/* ---- The conversion of rates ------------------------------------------------------------------------------------- */

/* Any rate; for each that there is, any samples, the first one and others at any place of the ring, at every
 * phase: those of one distance from the grid together, so that the filter's magnitudes add up to what they are. */

static labial_hear_convert_t convert;
static int16_t out[LABIAL_HEAR_CONVERTED_MAX];

/* Any sample at the phases from `least` to `most`. */
static void convert_at(unsigned least, unsigned most)
{
    FILL(convert.past);
    convert.at = (uint8_t)Frama_C_interval(0, LABIAL_HEAR_TAPS_);
    labial_hear_convert_last(&convert);
    convert.phase = (uint16_t)Frama_C_interval((int)least, (int)most);
    labial_hear_convert(&convert, any_int16, out);
}

static void convert_from(uint32_t rate)
{
    unsigned stride, point, points;
    if (labial_hear_convert_init(&convert, rate) != LABIAL_OK || convert.reach == 0)
        return;
    stride = convert.spacing * 10u;
    points = convert.spacing + convert.step / 10u;
    /*@ loop unroll 100; */
    for (point = convert.spacing; point <= points; point++)
        convert_at(point == convert.spacing ? stride : 10u * point - 5u,
                   point == points ? stride + convert.step - 1u : 10u * point + 4u);
}

int prove_hear_convert(void)
{
    static const uint32_t rates[] = { 8000, 12000, 16000, 22050, 24000, 32000, 44100, 48000 };
    unsigned i;
    labial_hear_convert_init(&convert, any_uint32);
    /*@ loop unroll 8; */
    for (i = 0; i < sizeof rates / sizeof rates[0]; i++)
        convert_from(rates[i]);
    return 0;
}

/* ---- Features ---------------------------------------------------------------------------------------------------- */

/* Any window of samples and any level that a stream can have; any sample, the first one or at any place of a
 * window. */

static void any_level(labial_hear_level_t *level)
{
    level->level = Frama_C_interval(LABIAL_HEAR_LEVEL_MIN / 256 * LABIAL_HEAR_LEVEL_ONE, 46 * LABIAL_HEAR_LEVEL_ONE);
    level->quietest = Frama_C_interval(LABIAL_HEAR_LEVEL_ONE, LABIAL_HEAR_LEVEL_NONE);
    level->before = Frama_C_interval(LABIAL_HEAR_LEVEL_ONE, LABIAL_HEAR_LEVEL_NONE);
    level->stage = (uint8_t)Frama_C_interval(0, 2);
}

int prove_hear_features(void)
{
    static labial_hear_features_t heard;
    static int16_t window[LABIAL_HEAR_WINDOW_], features[LABIAL_HEAR_BANDS], samples[LABIAL_HEAR_WINDOW_];
    labial_hear_level_t level;
    unsigned filled;
    any_level(&level);
    FILL(window);
    labial_hear_features(window, any_int, &level, features);
    labial_hear_features_reset(&heard);
    FILL(heard.window);
    FILL(heard.tail);
    heard.hop = (uint8_t)Frama_C_interval(0, 1);
    any_level(&heard.level);
    labial_hear_features_last(&heard);
    labial_hear_features_take(&heard, any_int16); /* the first one */
    heard.filled = (uint16_t)Frama_C_interval(LABIAL_HEAR_SHARED, LABIAL_HEAR_WINDOW_ - 1);
    labial_hear_features_begun(&heard);
    labial_hear_features_last(&heard);
    labial_hear_features_take(&heard, any_int16);
    FILL(samples);
    for (filled = 0; filled < LABIAL_HEAR_WINDOW_; filled++) {
        heard.filled = (uint16_t)filled;
        labial_hear_features_fill(&heard, samples, (size_t)Frama_C_interval(0, LABIAL_HEAR_WINDOW_));
    }
    return 0;
}

/* ---- The network ------------------------------------------------------------------------------------------------- */

/* Networks of the sizes of hear_small and of hear_large, with any weights, biases and shifts, after any number of
 * frames: any features, any memory. All tables are as long as these sizes ask for, and the workspace ends with the
 * last row. Scores and poses of any number of classes. */

#define UNITS 76
#define ROWS 27

/* The sizes are the models' own. */
typedef char are_those_of_small[HEAR_SMALL_WORKSPACE_SIZE == LABIAL_HEAR_WORKSPACE_SIZE(68, 27) ? 1 : -1];
typedef char are_those_of_large[HEAR_LARGE_WORKSPACE_SIZE == LABIAL_HEAR_WORKSPACE_SIZE(UNITS, ROWS) ? 1 : -1];

#define HEADS 40 /* 26 classes, closed lips and 13 FAPs */

static int8_t weights[4][UNITS * UNITS], last_weights[UNITS * UNITS], heads_weights[HEADS * UNITS], taps[4][UNITS * 7];
static int16_t biases[UNITS], positions[3][LABIAL_CHANNELS], closing[LABIAL_CHANNELS];
static uint8_t shifts[UNITS];
static int16_t workspace[ROWS * UNITS];
static labial_hear_block_t blocks[4];
static labial_hear_model_t model;
static labial_hear_network_t network;
static int16_t features[LABIAL_HEAR_INPUTS], scratch[LABIAL_HEAR_SCRATCH];

/* Tables end where those of so many rows and columns do. */
#define LAST(table, size) ((table) + (sizeof(table) / sizeof *(table) - (size)))

static void set_layer(labial_hear_dense_t *layer, const int8_t *last_weight, unsigned rows)
{
    layer->weights = last_weight;
    layer->biases = LAST(biases, rows);
    layer->shifts = LAST(shifts, rows);
}

static void set_block(unsigned number, unsigned units, unsigned past, unsigned dilation)
{
    labial_hear_block_t *const block = &blocks[number];
    set_layer(&block->dense, LAST(weights[number], units * (number > 0u ? units : LABIAL_HEAR_INPUTS)), units);
    block->taps = LAST(taps[number], units * (past + 2u));
    block->shifts = LAST(shifts, units);
    block->past = (uint8_t)past;
    block->ahead = 1;
    block->dilation = (uint8_t)dilation;
    network.at[number] = (uint8_t)Frama_C_interval(0, (int)((past + 1u) * dilation) - 1);
    network.skip[number] = (uint8_t)Frama_C_interval(0, number > 0u ? (int)dilation - 1 : 0);
}

static void set_model(unsigned units, unsigned count, unsigned ahead, unsigned rows)
{
    model.format = LABIAL_HEAR_MODEL_FORMAT;
    model.units = (uint8_t)units;
    model.blocks = (uint8_t)count;
    model.classes = 26;
    model.ahead = (uint8_t)ahead;
    model.rows = (uint8_t)rows;
    model.block = blocks;
    set_layer(&model.last, LAST(last_weights, units * units), units);
    set_layer(&model.heads, LAST(heads_weights, HEADS * units), HEADS);
    network.model = &model;
    network.rows = LAST(workspace, rows * units);
}

static void take(void)
{
    const int16_t *heads;
    labial_hear_network_reset(&network);
    FILL(workspace);
    FILL(features);
    FILL(scratch);
    network.taken = (uint32_t)Frama_C_interval(0, model.ahead);
    heads = labial_hear_network(&network, features, scratch);
    if (heads)
        any_int = heads[0] + heads[26 + LABIAL_CHANNELS];
}

static void pose(void)
{
    int16_t heads[LABIAL_HEAR_CLASSES_MAX + 1 + LABIAL_CHANNELS], found[LABIAL_CHANNELS];
    unsigned k;
    FILL(heads);
    FILL(positions);
    model.classes = (uint8_t)Frama_C_interval(2, LABIAL_HEAR_CLASSES_MAX);
    model.close_from = Frama_C_interval(-65536, 65536);
    model.close_width = Frama_C_interval(1, 65536);
    model.mean = positions[0];
    model.scale = positions[1];
    model.closed = positions[2];
    for (k = 0; k < LABIAL_CHANNELS; k++)
        closing[k] = (int16_t)Frama_C_interval(0, 256);
    model.closing = closing;
    labial_hear_leader(&model, heads);
    labial_hear_pose(&model, heads, Frama_C_interval(0, 512), found);
}

int prove_hear_network(void)
{
    unsigned i;
    FILL(weights);
    FILL(last_weights);
    FILL(heads_weights);
    FILL(taps);
    FILL(biases);
    for (i = 0; i < sizeof shifts; i++)
        shifts[i] = (uint8_t)Frama_C_interval(0, 15);
    set_model(68, 3, 4, 27);
    set_block(0, 68, 5, 1);
    set_block(1, 68, 5, 1);
    set_block(2, 68, 5, 2);
    take();
    set_model(76, 4, 4, 27);
    for (i = 0; i < 4; i++)
        set_block(i, 76, 5, 1);
    take();
    pose();
    return 0;
}

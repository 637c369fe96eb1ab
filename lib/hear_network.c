/*
 * hear_network.c - features to scores and FAPs (labial/hear_model.h). hearing/integer.py computes the same integers.
 *
 * Each block has a ring of rows for what its dense layer made of former frames, and all but the first another one for
 * their own input, once they have the frames ahead of it. A block's output lags its input by
 * ahead * dilation frames; until it has that many, it gives none.
 *
 * No sum overflows: 252 products of a weight and an activation are below 2^30, and so is a bias of 16 bits, shifted by
 * 15; a memory's 16 products are below 2^26.
 */
#include "hear_parts.h"

#include <string.h>

#include "fixed.h"
#include "hear_sums.h"

static int16_t held(int32_t value)
{
    return (int16_t)(value < -32768 ? -32768 : value > 32767 ? 32767 : value);
}

/* A row's value: its sum and bias, at the scale of activations. */
static int16_t row_value(int32_t sum, int32_t bias, unsigned shift, int32_t least)
{
    const int32_t value = (sum + (((2 * bias + 1) * (1 << shift)) >> 1)) >> shift; /* half of one rounds */
    return held(value < least ? least : value);
}

/* y = W x + b for `rows` rows, rounded up to fours, of `columns`; negative values become `least`, if that is 0. */
static void multiply(const labial_hear_dense_t *layer, unsigned rows, unsigned columns, const int16_t *x, int16_t *y,
                     int32_t least)
{
    const int8_t *weights = layer->weights;
    const int16_t *biases = layer->biases;
    const uint8_t *shifts = layer->shifts;
    const int16_t *const end = y + rows;
    for (; y < end; y += 4, biases += 4, shifts += 4, weights += 4u * columns) {
        int32_t sums[4];
        labial_hear_sums(weights, x, columns, sums);
        y[0] = row_value(sums[0], biases[0], shifts[0], least);
        y[1] = row_value(sums[1], biases[1], shifts[1], least);
        y[2] = row_value(sums[2], biases[2], shifts[2], least);
        y[3] = row_value(sums[3], biases[3], shifts[3], least);
    }
}

/* Adds a sum to the input of a unit, which waits for it in `waiting`. */
static void add_input(int32_t sum, int16_t *waiting, int16_t *x)
{
    sum += *waiting;
    *waiting = *x;
    *x = held(sum);
}

/* The memory of a block over its former rows and the present one, `y`, which takes the place of the oldest. Adds the
 * sums to `x`, or to what x was `behind` frames ago. */
static void remember(labial_hear_network_t *network, unsigned number, unsigned behind, int16_t *rows, int16_t *x,
                     const int16_t *y)
{
    const labial_hear_block_t *const block = &network->model->block[number];
    const unsigned units = network->model->units, taps = (unsigned)block->past + block->ahead + 1u;
    const unsigned held_rows = (taps - 1u) * block->dilation;
    int16_t *const oldest = rows + network->at[number] * units;
    int16_t *const waiting = behind > 0u ? rows + (held_rows + network->skip[number]) * units : x;
    const int16_t *row[LABIAL_HEAR_TAPS_MAX];
    const int8_t *w = block->taps;
    unsigned c, k, at;
    for (k = 0, at = network->at[number]; k < taps - 1u; k++) {
        row[k] = rows + at * units;
        at += block->dilation;
        if (at >= held_rows)
            at -= held_rows;
    }
    row[k] = y;
    for (c = 0; c < units; c += 2u, w += 2u * taps) { /* units come in fours */
        const unsigned shift = block->shifts[c], next_shift = block->shifts[c + 1u];
        int32_t sum = (1 << shift) >> 1, next_sum = (1 << next_shift) >> 1;
        for (k = 0; k < taps; k++) {
            const int16_t *const at_unit = row[k] + c;
            sum += w[k] * at_unit[0];
            next_sum += w[taps + k] * at_unit[1];
        }
        oldest[c] = y[c];
        oldest[c + 1u] = y[c + 1u];
        add_input(sum >> shift, waiting + c, x + c);
        add_input(next_sum >> next_shift, waiting + c + 1u, x + c + 1u);
    }
    if (++network->at[number] == held_rows)
        network->at[number] = 0;
    if (++network->skip[number] >= behind)
        network->skip[number] = 0;
}

uint32_t labial_hear_workspace_size(const labial_hear_model_t *model)
{
    return model ? LABIAL_HEAR_WORKSPACE_SIZE((uint32_t)model->units, model->rows) : 0;
}

void labial_hear_network_reset(labial_hear_network_t *network)
{
    memset(network->at, 0, sizeof network->at);
    memset(network->skip, 0, sizeof network->skip);
    memset(network->rows, 0, labial_hear_workspace_size(network->model));
    network->taken = 0;
}

const int16_t *labial_hear_network(labial_hear_network_t *network, const int16_t features[LABIAL_HEAR_INPUTS],
                                   int16_t scratch[LABIAL_HEAR_SCRATCH])
{
    const labial_hear_model_t *const model = network->model;
    const unsigned units = model->units;
    int16_t *const x = scratch, *const y = x + LABIAL_HEAR_UNITS_MAX, *rows = network->rows;
    unsigned b, begins = 0; /* the first frame for which the block has an input */
    for (b = 0; b < model->blocks && network->taken >= begins; b++) {
        const labial_hear_block_t *const block = &model->block[b];
        const unsigned behind = (unsigned)block->ahead * block->dilation;
        if (b == 0u) {
            multiply(&block->dense, units, LABIAL_HEAR_INPUTS, features, y, 0);
            memset(x, 0, units * sizeof *x); /* its input is not added */
            remember(network, b, 0, rows, x, y);
        } else {
            multiply(&block->dense, units, units, x, y, 0);
            remember(network, b, behind, rows, x, y);
            rows += behind * units;
        }
        rows += ((unsigned)block->past + block->ahead) * block->dilation * units;
        begins += behind;
    }
    if (network->taken < begins) {
        network->taken++;
        return NULL;
    }
    multiply(&model->last, units, units, x, y, 0);
    multiply(&model->heads, (unsigned)model->classes + 1u + LABIAL_CHANNELS, units, y, x, -32768);
    return x;
}

unsigned labial_hear_leader(const labial_hear_model_t *model, const int16_t *heads)
{
    unsigned k, leader = 0;
    for (k = 1; k < model->classes; k++)
        if (heads[k] > heads[leader])
            leader = k;
    return leader;
}

void labial_hear_pose(const labial_hear_model_t *model, const int16_t *heads, int32_t gain,
                      int16_t pose[LABIAL_CHANNELS])
{
    const int32_t closing = gain < 256 ? gain : 256;
    int32_t over, share, value;
    unsigned k;
    heads += model->classes;
    over = *heads++ - model->close_from;
    over = over < 0 ? 0 : over > model->close_width ? model->close_width : over;
    share = (int32_t)labial_quotient((uint32_t)over << 8, (uint32_t)model->close_width); /* Q8 */
    /*@ assert 0 <= share <= 256; */
    LABIAL_CHECK(share >= 0 && share <= 256);
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        value = model->mean[k] + ((heads[k] * model->scale[k]) >> 9);
        value = (value * gain + 128) >> 8;
        value += ((((model->closed[k] * closing + 128) >> 8) - value) * ((share * model->closing[k]) >> 8)) >> 8;
        pose[k] = (int16_t)labial_clamp(value, INT16_MAX);
    }
}

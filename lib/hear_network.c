/*
 * hear_network.c - features to scores and FAPs (labial/hear_model.h). hearing/integer.py computes the same integers.
 *
 * Each block has a ring of rows for what its dense layer made of former frames, and all but the first another one for
 * their own input, which is added when the frames ahead of it are known. So the output of a block is later than its
 * input by ahead * dilation frames, and a block waits until its first input comes.
 *
 * No sum overflows: 128 products of a weight and an activation are below 2^29, a bias of 16 bits, shifted by 15, below
 * 2^30, and a memory's 16 products below 2^26.
 */
#include "hear_network.h"

#include <string.h>

#include "fixed.h"

static int16_t held(int32_t value)
{
    return (int16_t)(value < -32768 ? -32768 : value > 32767 ? 32767 : value);
}

/* y = W x + b for `rows` rows, rounded up to fours, of `columns`; negative values become `least`, if that is 0. */
static void multiply(const labial_hear_dense_t *layer, unsigned rows, unsigned columns, const int16_t *x, int16_t *y,
                     int32_t least)
{
    const int8_t *w = layer->weights;
    unsigned r, i;
    for (r = 0; r < rows; r += 4u) {
        const int16_t *p;
        int32_t sums[4] = { 0, 0, 0, 0 };
        int32_t a = 0, b = 0, c = 0, d = 0;
        for (p = x; p < x + columns; p += 2, w += 8) { /* columns come in fours */
            int32_t value = p[0];
            a += w[0] * value;
            b += w[1] * value;
            c += w[2] * value;
            d += w[3] * value;
            value = p[1];
            a += w[4] * value;
            b += w[5] * value;
            c += w[6] * value;
            d += w[7] * value;
        }
        sums[0] = a;
        sums[1] = b;
        sums[2] = c;
        sums[3] = d;
        for (i = 0; i < 4u; i++) {
            const int32_t one = 1 << layer->shifts[r + i];
            const int32_t value = (sums[i] + layer->biases[r + i] * one + (one >> 1)) >> layer->shifts[r + i];
            y[r + i] = held(value < least ? least : value);
        }
    }
}

/* The memory of a block over its former rows and the present one, `y`, which takes the place of the oldest. Adds the
 * sums to `x`, or to what x was `behind` frames ago. */
static void remember(labial_hear_network_t *network, unsigned number, unsigned behind, int16_t *rows, int16_t *x,
                     const int16_t *y)
{
    const labial_hear_block_t *const block = &network->model->block[number];
    const unsigned units = network->model->units, last = (unsigned)block->past + block->ahead;
    const unsigned held_rows = last * block->dilation;
    int16_t *oldest = rows + network->at[number] * units, *input = rows + (held_rows + network->skip[number]) * units;
    const int16_t *row[LABIAL_HEAR_TAPS_MAX];
    const int8_t *w = block->taps;
    unsigned c, k, at;
    for (k = 0, at = network->at[number]; k < last; k++) {
        row[k] = rows + at * units;
        at += block->dilation;
        if (at >= held_rows)
            at -= held_rows;
    }
    for (c = 0; c < units; c++) {
        const unsigned shift = block->shifts[c];
        int32_t sum = (1 << shift) >> 1;
        for (k = 0; k < last; k++)
            sum += *w++ * row[k][c];
        sum = (sum + *w++ * y[c]) >> shift;
        oldest[c] = y[c];
        if (behind > 0u) {
            sum += input[c];
            input[c] = x[c];
        } else {
            sum += x[c];
        }
        x[c] = held(sum);
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
    multiply(&model->heads, (unsigned)model->classes + LABIAL_CHANNELS, units, y, x, -32768);
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
    int32_t rival = -32768, over, share, value;
    unsigned k;
    for (k = 0; k < model->classes; k++)
        if (k != model->closure && heads[k] > rival)
            rival = heads[k];
    over = heads[model->closure] - rival - model->close_from;
    over = over < 0 ? 0 : over > model->close_width ? model->close_width : over;
    share = (int32_t)labial_quotient((uint32_t)over << 8, (uint32_t)model->close_width); /* Q8 */
    /*@ assert 0 <= share <= 256; */
    LABIAL_CHECK(share >= 0 && share <= 256);
    heads += model->classes;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        value = model->mean[k] + ((heads[k] * model->scale[k]) >> 9);
        value = (value * gain + 128) >> 8;
        value += ((((model->closed[k] * closing + 128) >> 8) - value) * share) >> 8;
        pose[k] = (int16_t)labial_clamp(value, INT16_MAX);
    }
}

/*
 * The matrix of equation 3 is symmetric, positive definite and pentadiagonal. It is factored as L D L' frame by frame,
 * with lambda and kappa the first and second subdiagonal of L:
 *
 *     e_t      = b_t - kappa_(t-1) e_(t-1)                              (eliminated off-diagonal)
 *     D_t      = a_t - lambda_(t-1) e_(t-1) - kappa_(t-2) c_(t-2)
 *     lambda_t = e_t / D_t,  kappa_t = c_t / D_t
 *     z_t      = r_t - lambda_(t-1) z_(t-1) - kappa_(t-2) z_(t-2)
 *     m_t      = z_t / D_t - lambda_t m_(t+1) - kappa_t m_(t+2)         (backwards)
 *
 * with a, b, c the diagonals and r the right-hand side. Formats: weights, and so a, b, c, are integers; D, e, c are in
 * Q12; r and z in weight times Q4 FAP; lambda and kappa in Q28; z / D and m in Q12 FAP. What keeps this inside 32 bits:
 * every diagonal element is at most LABIAL_WEIGHT_SUM_MAX, every |r| at most LABIAL_PULL_MAX, and every frame is held by
 * at least LABIAL_WEIGHT_MIN, hence 8 <= D < 2^18; |kappa| <= 1 because D_t holds all of the row that gives c_t; and
 * |lambda| <= 2 as long as earlier frames, given this one, are expected no farther from zero than it is, which is what
 * holds, equal neighbours and straight lines all amount to. Were it ever otherwise, lambda is held below 8.
 */
#include "trajectory.h"

#include <stddef.h>

#include "fixed.h"

/* One row each of W: what the state of a frame asks for. */
typedef struct {
    int32_t static_weight, static_pull; /* weight and weight * mean */
    int32_t delta_weight, delta_pull;   /* a quarter of delta's precision; half of precision * mean */
    int32_t delta2_weight, delta2_pull;
} row_t;

static void read_row(const labial_channel_t *channel, const labial_ties_t *ties, const uint8_t *path, unsigned length,
                     const int16_t *positions, unsigned t, row_t *row)
{
    const labial_state_t *state = &channel->states[path[t]];
    const int32_t held = (int32_t)labial_weight(state->weight[0]);
    int32_t anchor = (int32_t)labial_weight(state->anchor);
    if (ties->precisions) {
        const uint32_t precision = labial_weight(ties->precisions[(uint32_t)ties->component[t] * LABIAL_CHANNELS]);
        anchor += (int32_t)((precision * ties->share[t] + 32768u) >> 16);
    }
    row->static_weight = held + anchor;
    row->static_pull = held * state->mean[0] + anchor * positions[(size_t)t * LABIAL_CHANNELS];
    if (t > 0 && t + 1u < length) {
        row->delta_weight = (int32_t)labial_weight(state->weight[1]);
        row->delta_pull = row->delta_weight * 2 * state->mean[1];
        row->delta2_weight = (int32_t)labial_weight(state->weight[2]);
        row->delta2_pull = row->delta2_weight * state->mean[2];
    } else {
        row->delta_weight = row->delta_pull = row->delta2_weight = row->delta2_pull = 0;
    }
}

/* 2^60 / d for 2^30 <= d < 2^31, to about 29 bits: a table of eight bits and two Newton steps x += x (1 - d x). */
static int32_t reciprocal(int32_t d)
{
    static const uint8_t table[64] = {
        254, 250, 246, 243, 239, 236, 232, 229, 226, 223, 220, 217, 214, 211, 209, 206, 204, 201, 199, 196,
        194, 192, 189, 187, 185, 183, 181, 179, 177, 175, 173, 172, 170, 168, 166, 165, 163, 161, 160, 158,
        157, 155, 154, 152, 151, 150, 148, 147, 146, 144, 143, 142, 141, 139, 138, 137, 136, 135, 134, 133,
        132, 131, 130, 129
    };
    const int32_t one = (int32_t)1 << 30;
    int32_t x = (int32_t)table[((uint32_t)d >> 24) & 63u] << 22;
    x += labial_mulshift(x, one - labial_mulshift(d, x, 30), 30);
    x += labial_mulshift(x, one - labial_mulshift(d, x, 30), 30);
    return x;
}

/* How far d must be shifted left to lie in 2^30 .. 2^31, for 2^12 <= d < 2^31. */
static int headroom(int32_t d)
{
    int shift = 0;
    if (d < (int32_t)1 << 22) {
        d <<= 8;
        shift = 8;
    }
    while (d < (int32_t)1 << 30) {
        d <<= 1;
        shift++;
    }
    return shift;
}

void labial_trajectory_solve(const labial_channel_t *channel, const labial_ties_t *ties, const uint8_t *path,
                             unsigned length, int16_t *positions, int32_t *scratch)
{
    row_t rows[3] = { { 0, 0, 0, 0, 0, 0 }, { 0, 0, 0, 0, 0, 0 }, { 0, 0, 0, 0, 0, 0 } };
    row_t *before = &rows[0], *here = &rows[1], *after = &rows[2];
    int32_t e1 = 0, c1 = 0, c2 = 0;           /* e_(t-1), c_(t-1), c_(t-2) */
    int32_t lambda1 = 0, kappa1 = 0, kappa2 = 0; /* lambda_(t-1), kappa_(t-1), kappa_(t-2) */
    int32_t z1 = 0, z2 = 0, m1 = 0, m2 = 0;
    int32_t *out = scratch;
    unsigned t;

    read_row(channel, ties, path, length, positions, 0, here);
    for (t = 0; t < length; t++) {
        int32_t a, b, c, d, e, r, z, inverse;
        int shift;
        row_t *spare;

        if (t + 1u < length)
            read_row(channel, ties, path, length, positions, t + 1u, after);
        else
            after->static_weight = after->static_pull = after->delta_weight = after->delta_pull =
                after->delta2_weight = after->delta2_pull = 0;
        a = here->static_weight + before->delta_weight + after->delta_weight + before->delta2_weight +
            4 * here->delta2_weight + after->delta2_weight;
        b = -2 * (here->delta2_weight + after->delta2_weight);
        c = after->delta2_weight - after->delta_weight;
        r = labial_add(here->static_pull, labial_sub(before->delta_pull, after->delta_pull));
        r = labial_add(r, labial_add(labial_sub(before->delta2_pull, 2 * here->delta2_pull), after->delta2_pull));

        a *= 1 << 12;
        c *= 1 << 12;
        e = labial_sub(b * (1 << 12), labial_mulshift(kappa1, e1, 28));
        d = labial_sub(a, labial_add(labial_mulshift(lambda1, e1, 28), labial_mulshift(kappa2, c2, 28)));
        if (d < (int32_t)1 << 12) /* not with a model that was checked; it keeps what follows defined */
            d = (int32_t)1 << 12;
        e = labial_clamp(e, d < (int32_t)1 << 27 ? 8 * d - 1 : INT32_MAX);
        z = labial_sub(r, labial_add(labial_mulshift(lambda1, z1, 28), labial_mulshift(kappa2, z2, 28)));

        shift = headroom(d);
        inverse = reciprocal(d << shift);
        kappa2 = kappa1;
        lambda1 = labial_scale(labial_mulshift(e, inverse, 30), shift - 2);
        kappa1 = labial_scale(labial_mulshift(c, inverse, 30), shift - 2);
        out[0] = lambda1;
        out[1] = kappa1;
        out[2] = labial_scale(labial_mulshift(z, inverse, 30), shift - 10);
        out += 3;

        z2 = z1;
        z1 = z;
        e1 = e;
        c2 = c1;
        c1 = c;
        spare = before;
        before = here;
        here = after;
        after = spare;
    }

    for (t = length; t-- > 0;) {
        int32_t m;
        out -= 3;
        m = labial_sub(out[2], labial_add(labial_mulshift(out[0], m1, 28), labial_mulshift(out[1], m2, 28)));
        m2 = m1;
        m1 = m;
        positions[(size_t)t * LABIAL_CHANNELS] =
            (int16_t)labial_clamp(labial_add(m, 128) >> 8, LABIAL_POSITION_MAX);
    }
}

void labial_trajectory_fade(int16_t held[LABIAL_CHANNELS], const int16_t fresh[LABIAL_CHANNELS], unsigned step,
                            unsigned steps)
{
    const int32_t share = (int32_t)((step << 14) / steps); /* Q14 */
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        held[k] = (int16_t)(held[k] + (((fresh[k] - held[k]) * share + 8192) >> 14));
}

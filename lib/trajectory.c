/*
 * trajectory.c - states to motion (trajectory.h).
 *
 * The matrix of equation 3 is symmetric, positive definite and pentadiagonal, and its rows sum to the hold of each
 * frame, since deltas of a constant are zero. L D L' written with these sums keeps apart the hold of a frame (g), what
 * ties it to its neighbours (f, c), and has no small difference of large numbers. With h the hold of frame t, d and dd
 * its weights:
 *
 *     c_t     = dd_(t+1) - d_(t+1)                                   second off-diagonal
 *     g_t     = h_t + row_(t-1) - k_(t-2)                            row sums, eliminated like a right-hand side
 *     f_t     = 2 (d_t + d_(t+1)) + bent_(t-1)                       eliminated first off-diagonal: -(f + 2 c)
 *     rho_t   = g_t / D_t,  kappa_t = c_t / D_t,  D_t = g_t + f_t + c_t
 *     k_t     = rho_t c_t
 *     row_t   = rho_t f_t + 2 k_t,  bent_t = kappa_t f_t + 2 k_t     what the next frame takes over
 *     q_t     = q_(t-1) + (h_t (x_t - q_(t-1)) + k_(t-2) (q_(t-1) - q_(t-2)) + p_t) / g_t
 *     m_t     = m_(t+1) + rho_t (q_t - m_(t+1)) + kappa_t (m_(t+1) - m_(t+2))              (backwards)
 *
 * q_t is the position of frame t given all before it, x_t where its hold draws it, p_t the pull of delta and
 * delta-delta means. Rounding rho or kappa moves m by that share of a difference, and nothing where the motion rests.
 * c has 14 bits, so that its products are short.
 *
 * An articulation g multiplies x and p, and so all that is on the right-hand side. The largest doubles the bounds of q
 * and m, which have room for that.
 *
 * Formats: weights are integers; g, f, c, D, k, row, bent in Q16; rho and kappa in Q24, 16 bits where they are kept for
 * the backward pass; q and m in Q12 FAP. g is never below the hold, f and c never below zero as long as d is not above
 * dd, and so rho and kappa lie within 0 .. 1.
 *
 * All of g, f, c and D stay below 2^30, from frame to frame however many there are: what rounding takes from or adds to
 * row, bent and k makes the factors those of a matrix with slightly other entries, exactly. A pivot D is that matrix's
 * diagonal less what is eliminated, which is not negative, and the diagonal is h + 2 d + 6 dd of the largest ones at
 * most: LABIAL_WEIGHT_SUM_MAX, 65,536 short of 2^30. row and bent are too large by 7 at most, since an inverse is too
 * large by a tenth; k is too small by 30, since rho may be by 3 and c has 28 bits: together less than 100.
 */
#include "trajectory.h"

#include "fixed.h"
#include "units.h"

/* A quotient that may be as large as 2^BEND_BITS has so many bits less. */
#define BEND_BITS 4

/* How far d must be shifted left to lie in 2^30 .. 2^31, for 2^19 <= d < 2^31. Cores that do not count leading zeros go
 * there from the shift of the row before, which is near. */
static inline unsigned headroom(uint32_t d, unsigned shift)
{
#if !LABIAL_NARROW_MULTIPLY && defined(__GNUC__) &&                                                                    \
    (defined(__ARM_FEATURE_CLZ) || defined(__x86_64__) || defined(__aarch64__))
    (void)shift;
    return (unsigned)__builtin_clz(d) - 1u;
#else
    while (d >> (30u - shift) == 0)
        shift++;
    while (d >> (30u - shift) > 1u)
        shift--;
    return shift;
#endif
}

/* 2^(54 - shift) / d for 2^19 <= d < 2^31, to about 24 bits; `*shift` becomes the headroom of d. A table of eight bits and
 * two Newton steps x += x (1 - d x). */
static uint32_t reciprocal(uint32_t d, uint8_t *shift)
{
    static const uint8_t table[64] = { 254, 250, 246, 243, 239, 236, 232, 229, 226, 223, 220, 217, 214, 211, 209, 206,
                                       204, 201, 199, 196, 194, 192, 189, 187, 185, 183, 181, 179, 177, 175, 173, 172,
                                       170, 168, 166, 165, 163, 161, 160, 158, 157, 155, 154, 152, 151, 150, 148, 147,
                                       146, 144, 143, 142, 141, 139, 138, 137, 136, 135, 134, 133, 132, 131, 130, 129 };
    const unsigned left = headroom(d, *shift);
    const uint32_t scaled = d << left;
    const int32_t rough = table[(scaled >> 24) & 63u];
    const int32_t x = (rough << 8) + ((rough * (((int32_t)1 << 24) - (int32_t)(scaled >> 15) * rough * 2)) >> 16);
    const int32_t error = ((int32_t)1 << 30) - labial_part16((int32_t)scaled, (uint32_t)x);
    *shift = (uint8_t)left;
    return (uint32_t)((x << 8) + ((x * (error >> 4)) >> 18));
}

/* x / d, 0 .. 1, as a part in Q24, with the inverse of d and its shift; kept in 16 bits, of which the largest stands for
 * one. */
static uint32_t keep_part(int32_t x, uint32_t inverse, unsigned shift, uint16_t *kept)
{
    const uint32_t part = ((uint32_t)labial_part24(x, inverse) << shift) >> 6, rounded = (part + 128u) >> 8;
    *kept = (uint16_t)(rounded - (rounded >> 16));
    return part;
}

/* Advances to the position of the pending frame given all before it; `g` is its row sum, eliminated. */
static void filter_row(labial_solver_t *solver, int32_t g)
{
    const uint32_t inverse = reciprocal((uint32_t)g, &solver->shifts[0]);
    const unsigned shift = solver->shifts[0];
    const uint32_t hold = (uint32_t)solver->hold << (shift + 1u); /* below 2^16 */
    const uint32_t bend = (((uint32_t)solver->k2 >> BEND_BITS) << shift) >> 7;
    const int32_t q = solver->q1, moved = (q - solver->q2) * (1 << BEND_BITS);
    const int32_t pull = shift < 7u ? solver->pull >> (7u - shift) : solver->pull * (1 << (shift - 7u));
    solver->q2 = q;
    solver->q1 =
        q + 2 * labial_part24(labial_part16(solver->position - q, hold) + labial_part24(moved, bend) + pull, inverse);
}

/* Factors the pending frame; c is its second off-diagonal, `delta` the weight of the row after it. */
static void factor(labial_solver_t *solver, int32_t c, int32_t delta, labial_factors_t *factors)
{
    const int32_t hold = (int32_t)solver->hold << 16;
    const int32_t f = ((int32_t)solver->delta + delta) * 131072 + solver->bent;
    const int32_t second = c * 65536; /* its products with parts are exact */
    int32_t g = hold + solver->row - solver->k2;
    uint32_t inverse, rho, kappa;
    unsigned shift;
    /* GCOVR_EXCL_BR_START: a guard that nothing known meets. Exactly the sum is never below `hold`; where frames are tied
     * at all it is more by 32 and above, of which rounding takes less than three. */
    if (g < hold)
        g = hold;
    /* GCOVR_EXCL_BR_STOP */
    inverse = reciprocal((uint32_t)(g + f + second), &solver->shifts[1]);
    shift = solver->shifts[1];
    rho = keep_part(g, inverse, shift, &factors->rho);
    kappa = keep_part(second, inverse, shift, &factors->kappa);
    filter_row(solver, g);
    factors->q = solver->q1;
    solver->k2 = solver->k1;
    solver->k1 = labial_part24(second, rho);
    solver->row = labial_part24(f, rho) + 2 * solver->k1;
    solver->bent = labial_part24(f, kappa) + 2 * solver->k1;
}

/* A mean of delta or delta-delta, Q4. */
static inline int32_t moving(const labial_channel_t *channel, const labial_state_t *state, unsigned which, int32_t gain)
{
    return (state->motion[which] * ((channel->motion_scale[which] * gain) >> 8) + 128) >> 8;
}

void labial_trajectory_terms(const labial_channel_t *channel, unsigned number, int32_t gain, labial_terms_t *terms)
{
    const labial_state_t *state = &channel->states[number];
    const int32_t contact = (int32_t)labial_weight(channel->contact_weight);
    const int32_t delta2 = (int32_t)labial_weight(state->weight[1]);
    const int32_t share = (((int32_t)state->share + (state->share >> 7)) * gain) >> 4;
    terms->share = share;
    terms->centre = channel->centre;
    terms->gain = gain;
    terms->position = (terms->centre + state->mean) * gain - ((state->mean * share) >> 4);
    terms->hold = (int32_t)labial_weight(state->hold);
    terms->contact_weight = contact > terms->hold ? contact : terms->hold;
    terms->delta = (int32_t)labial_weight(state->weight[0]);
    terms->stiff = delta2 - terms->delta;
    terms->delta_pull = 2 * terms->delta * moving(channel, state, 0, gain);
    terms->delta2_pull = delta2 * moving(channel, state, 1, gain);
}

void labial_trajectory_rows(labial_solver_t *solver, const labial_terms_t *terms, const labial_frame_t *frame,
                            unsigned channel, unsigned count, labial_factors_t *own)
{
    const labial_frame_t *const end = frame + count;
    do {
        const int is_first = frame->marks & LABIAL_BEGINS, is_last = frame->marks & LABIAL_ENDS;
        if (is_first || is_last) { /* without deltas */
            if (is_first)
                solver->row = solver->bent = solver->k1 = solver->k2 = solver->q1 = solver->q2 = solver->next_pull = 0;
            else
                factor(solver, 0, 0, own - 1);
            solver->delta = 0;
            solver->pull = solver->next_pull;
            solver->next_pull = 0;
        } else {
            solver->pull += terms->delta2_pull - terms->delta_pull;
            factor(solver, terms->stiff, terms->delta, own - 1);
            solver->delta = (uint16_t)terms->delta;
            solver->pull = solver->next_pull - 2 * terms->delta2_pull;
            solver->next_pull = terms->delta2_pull + terms->delta_pull;
        }
        if (frame->contacts >> channel & 1u) {
            solver->hold = (uint16_t)terms->contact_weight;
            solver->position = (terms->centre + frame->target[channel]) *
                               (terms->gain < LABIAL_GAIN_ONE ? terms->gain : LABIAL_GAIN_ONE);
        } else {
            solver->hold = (uint16_t)terms->hold;
            solver->position = terms->position + ((frame->target[channel] * terms->share) >> 4);
        }
        if (is_last)
            factor(solver, 0, 0, own);
        own++;
    } while (++frame < end);
}

/* How far the frame of `at` lies from the next, whose position is `m` and which lies `moved` from the one after it. */
static inline int32_t step_back(const labial_factors_t *at, int32_t m, int32_t moved)
{
    const uint32_t rho = at->rho + ((at->rho + 1u) >> 16); /* the largest stands for one */
    return labial_part16(at->q - m, rho) + labial_part16(moved, at->kappa);
}

void labial_trajectory_back(const labial_factors_t *newest, unsigned ahead, unsigned wanted, unsigned place,
                            unsigned places, int16_t *motion)
{
    const labial_factors_t *const due = newest - ahead;
    int32_t m = newest->q, moved = 0;
    for (;;) {
        if (newest <= due) {
            motion[place] = (int16_t)labial_clamp((m + 128) >> 8, INT16_MAX);
            if (--wanted == 0)
                return;
            if (place == 0)
                place = places;
            place--;
        }
        moved = step_back(--newest, m, moved);
        m += moved;
    }
}

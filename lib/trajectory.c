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
 * every diagonal element is at most LABIAL_WEIGHT_SUM_MAX, every |r| at most LABIAL_PULL_MAX, and every frame is held
 * by at least LABIAL_WEIGHT_MIN, hence 8 <= D < 2^18; |kappa| <= 1 because D_t holds all of the row that gives c_t; and
 * |lambda| <= 2 as long as earlier frames, given this one, are expected no farther from zero than it is, which is what
 * holds, equal neighbours and straight lines all amount to. Were it ever otherwise, lambda is held below 8.
 */
#include "trajectory.h"

#include "fixed.h"

/* 2^60 / d for 2^30 <= d < 2^31, to about 29 bits: a table of eight bits and two Newton steps x += x (1 - d x), the
 * first of which needs no more than 16 bits of d. */
static int32_t reciprocal(int32_t d)
{
    static const uint8_t table[64] = {
        254, 250, 246, 243, 239, 236, 232, 229, 226, 223, 220, 217, 214, 211, 209, 206, 204, 201, 199, 196,
        194, 192, 189, 187, 185, 183, 181, 179, 177, 175, 173, 172, 170, 168, 166, 165, 163, 161, 160, 158,
        157, 155, 154, 152, 151, 150, 148, 147, 146, 144, 143, 142, 141, 139, 138, 137, 136, 135, 134, 133,
        132, 131, 130, 129
    };
    const int32_t one = (int32_t)1 << 30;
    const int32_t rough = table[((uint32_t)d >> 24) & 63u];
    const int32_t short_d = (int32_t)(((uint32_t)d + 0x8000u) >> 16);
    int32_t x = (rough << 22) + rough * (((int32_t)1 << 22) - short_d * rough);
    x += labial_mulshift(x, one - labial_mulshift(d, x, 30), 30);
    return x;
}

/* How far d must be shifted left to lie in 2^30 .. 2^31, for 2^15 <= d < 2^31. */
static unsigned headroom(int32_t d)
{
#if defined(__GNUC__) && (defined(__ARM_FEATURE_CLZ) || defined(__x86_64__) || defined(__aarch64__))
    return (unsigned)__builtin_clz((unsigned)d) - 1u;
#else
    unsigned shift = 0;
    if (d < (int32_t)1 << 23) {
        d <<= 8;
        shift = 8;
    }
    if (d < (int32_t)1 << 27) {
        d <<= 4;
        shift += 4;
    }
    while (d < (int32_t)1 << 30) {
        d <<= 1;
        shift++;
    }
    return shift;
#endif
}

/* x / d in Q28, for |x| < 8 d; `inverse` is the reciprocal of d shifted left by `shift`. */
static int32_t quotient(int32_t x, int32_t inverse, unsigned shift)
{
    x = shift < 3u ? x >> (3u - shift) : (int32_t)((uint32_t)x << (shift - 3u));
    return labial_mulshift(x, inverse, 29);
}

/* a x + b y with a and b in Q28. The one makes up for what two products that are rounded down lose on average. */
static int32_t two_products(int32_t a, int32_t x, int32_t b, int32_t y)
{
    return labial_add(labial_add(labial_mulshift(a, x, 28), labial_mulshift(b, y, 28)), 1);
}

/* Takes up frame t - 1, to which no later row adds anything but c, its second off-diagonal element. */
static void factor(labial_solver_t *solver, int32_t c, int32_t *factors)
{
    const int32_t a = solver->a1 * (1 << 12), b = solver->b1 * (1 << 12);
    const int32_t lambda = solver->lambda, kappa = solver->kappa2, z1 = solver->z1;
    const int32_t e = labial_sub(b, labial_mulshift(solver->kappa1, solver->e, 28));
    const int32_t z = labial_sub(solver->r1, two_products(lambda, z1, kappa, solver->z2));
    int32_t d = labial_sub(a, two_products(lambda, solver->e, kappa, solver->c2));
    int32_t inverse, held;
    unsigned shift;

    /* Not needed with a model that was checked; it keeps what follows defined. */
    d = d < LABIAL_WEIGHT_MIN << 12 ? LABIAL_WEIGHT_MIN << 12 : d < 1 << 30 ? d : (1 << 30) - 1;
    held = labial_clamp(e, d < (int32_t)1 << 27 ? 8 * d - 1 : INT32_MAX);
    shift = headroom(d); /* 1 .. 15 */
    inverse = reciprocal((int32_t)((uint32_t)d << shift));
    c *= 1 << 12;
    solver->kappa2 = solver->kappa1;
    solver->lambda = factors[0] = quotient(held, inverse, shift);
    solver->kappa1 = factors[1] = quotient(c, inverse, shift);
    factors[2] = shift < 9u ? labial_mulshift(z, inverse, 31) >> (9u - shift)
                            : labial_mulshift(z, inverse, 40u - shift);
    solver->e = held;
    solver->c2 = solver->c1;
    solver->c1 = c;
    solver->z2 = z1;
    solver->z1 = z;
}

/* Takes up row t. */
static void take_row(labial_solver_t *solver, const labial_channel_t *channel, const uint8_t *path, unsigned length,
                     const int16_t *positions, unsigned t, int32_t *factors)
{
    int32_t held = 0, pull = 0;        /* static row and anchor: weight, and weight times mean */
    int32_t delta = 0, delta_pull = 0; /* a quarter of delta's precision; half of precision times mean */
    int32_t delta2 = 0, delta2_pull = 0;
    if (t < length) {
        const labial_state_t *state = &channel->states[path[t]];
        const int32_t anchor = (int32_t)labial_weight(state->anchor);
        held = (int32_t)labial_weight(state->weight[0]);
        pull = held * state->mean[0] + anchor * positions[t * LABIAL_CHANNELS];
        held += anchor;
        if (t > 0 && t + 1u < length) {
            delta = (int32_t)labial_weight(state->weight[1]);
            delta_pull = delta * 2 * state->mean[1];
            delta2 = (int32_t)labial_weight(state->weight[2]);
            delta2_pull = delta2 * state->mean[2];
        }
    }
    if (t > 0) {
        solver->a1 += delta + delta2;
        solver->b1 -= 2 * delta2;
        solver->r1 = labial_add(solver->r1, labial_sub(delta2_pull, delta_pull));
        factor(solver, delta2 - delta, factors + (t - 1u) * LABIAL_FACTORS);
    }
    solver->a1 = solver->a0 + held + 4 * delta2;
    solver->b1 = -2 * delta2;
    solver->r1 = labial_add(solver->r0, labial_sub(pull, 2 * delta2_pull));
    solver->a0 = delta + delta2;
    solver->r0 = delta_pull + delta2_pull;
}

void labial_trajectory_forward(labial_solver_t *solver, const labial_channel_t *channel, const uint8_t *path,
                               unsigned length, const int16_t *positions, unsigned t, unsigned end, int32_t *factors)
{
    for (; t < end; t++)
        take_row(solver, channel, path, length, positions, t, factors);
}

void labial_trajectory_backward(labial_solver_t *solver, const int32_t *factors, unsigned t, unsigned end,
                                int16_t *positions)
{
    int32_t m1 = solver->m1, m2 = solver->m2;
    factors += t * LABIAL_FACTORS;
    positions += t * LABIAL_CHANNELS;
    for (; t > end; t--) {
        int32_t m;
        factors -= LABIAL_FACTORS;
        positions -= LABIAL_CHANNELS;
        m = labial_sub(factors[2],
                       labial_add(labial_mulshift(factors[0], m1, 28), labial_mulshift(factors[1], m2, 28)));
        m2 = m1;
        m1 = m;
        *positions = (int16_t)labial_clamp(labial_add(m, 128) >> 8, LABIAL_POSITION_MAX);
    }
    solver->m1 = m1;
    solver->m2 = m2;
}

void labial_trajectory_fade(int16_t held[LABIAL_CHANNELS], const int16_t fresh[LABIAL_CHANNELS], unsigned step,
                            unsigned steps)
{
    const int32_t share = labial_ease(step, steps);
    unsigned k;
    for (k = 0; k < LABIAL_CHANNELS; k++)
        held[k] = (int16_t)(held[k] + (((fresh[k] - held[k]) * share + 8192) >> 14));
}

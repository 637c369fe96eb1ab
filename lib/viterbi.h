/*
 * viterbi.h - targets to states: the most likely path of one channel through its codebook, step by step.
 *
 * A score is the cost of the best path into a state, less that of the best state, at most LABIAL_DEAD. Every state can
 * be entered from its predecessors, and from the best state of the previous step at the cost LABIAL_DEAD, the highest
 * cost of a transition. So a state with this score need not be stored, and eight bits are enough.
 *
 * Only the LABIAL_SEARCHED states around the one nearest to the target are searched; the others are dead. Probable
 * paths hardly leave this window, and it makes all steps take the same work.
 *
 * The state of a step is decided LABIAL_LAG frames later, by tracing back from the state that is best then, or at the
 * end of the unit if that comes earlier; nothing before the end of a unit is decided after it.
 */
#ifndef LABIAL_VITERBI_H
#define LABIAL_VITERBI_H

#include "fixed.h"
#include "labial/labial.h"
#include "units.h"

#define LABIAL_DEAD 255u

/* Largest z of an emission, just below 16 in Q6: beyond some 22 standard deviations a state costs no more. */
#define LABIAL_EMISSION_Z_MAX 1023u

/* Negative log-likelihood of a position in a state. */
static inline uint32_t labial_viterbi_emission(const labial_emission_t *state, int32_t position)
{
    const int32_t distance = position - state->mean;
    const uint32_t z =
        ((uint32_t)(distance < 0 ? -distance : distance) * (16u + (state->gain & 15u))) >> (state->gain >> 4);
    return labial_z_cost(z < LABIAL_EMISSION_Z_MAX ? z : LABIAL_EMISSION_Z_MAX) + state->cost;
}

/* Finds the least cost of entering each of `size` states of a window from those of the latest step, the first of which
 * has its `fours` times four transitions at `transition`. Not static, or compilers would make it a part of
 * labial_viterbi_step(), whose variables would take the registers that its loops need. */
void labial_viterbi_enter(labial_search_t *search, const labial_transition_t *transition, unsigned fours, unsigned size,
                          uint32_t *costs);

/*
 * Makes the next step of a path, for a target `position`. `marks` are those of its frames (units.h): with LABIAL_BEGINS
 * it is a path's first step; with LABIAL_UNIT_ENDS it ends a unit, and the next step starts from its best state.
 */
void labial_viterbi_step(const labial_model_t *model, const labial_channel_t *channel, int32_t position, unsigned marks,
                         labial_search_t *search);

/* Sets the number of frames of the last step. */
static inline void labial_viterbi_span(labial_search_t *search, unsigned frames)
{
#if LABIAL_LAG > 0
    search->spans[0] = (uint8_t)frames;
#else
    (void)search;
    (void)frames;
#endif
}

/* The state of the frame that lies `age` frames before the last one of the last step, at most LABIAL_LAG before that
 * step's first. */
static inline unsigned labial_viterbi_state(const labial_search_t *search, unsigned age)
{
    unsigned i = 0;
#if LABIAL_LAG > 0
    for (; age >= search->spans[i]; i++)
        age -= search->spans[i];
#else
    (void)age;
#endif
    return search->path[i];
}

#endif

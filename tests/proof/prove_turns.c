/*
 * Any marks, models, targets and contacts, any phase and places in the rings, with strides from one to three, every
 * number of frames that entered and that lie beyond the last one; in a workspace that ends with that of the stride.
 * viterbi.c and trajectory.c are not part of it; their stand-ins here give any of their results, and touch the ends of
 * what those read and write.
 */
#include "any_model.h"
#include "stream.h"
#include "trajectory.h"
#include "viterbi.h"

#define MOST 3 /* stride: that of the bundled models; larger ones take EVA too long */

static uint32_t workspace[LABIAL_WORKSPACE_SIZE(MOST) / 4];
static labial_model_t model;
static labial_t stream;

void labial_viterbi_begin(const labial_model_t *any, const labial_channel_t *channel, int32_t position,
                          labial_search_t *search)
{
    search->best = (uint8_t)(any->state_count + channel->emissions[0].mean + position);
    search->path[0] = (uint8_t)Frama_C_interval(0, LABIAL_STATES_MAX - 1);
}

void labial_viterbi_step(const labial_model_t *any, const labial_channel_t *channel, int32_t position,
                         labial_search_t *search)
{
    labial_viterbi_begin(any, channel, position, search);
}

void labial_viterbi_end_unit(labial_search_t *search)
{
    search->best = 0;
}

void labial_trajectory_terms(const labial_channel_t *channel, unsigned state, labial_terms_t *terms)
{
    terms->position = channel->states[state].mean[0];
}

void labial_trajectory_row(labial_solver_t *solver, const labial_terms_t *terms, int32_t position, int contact,
                           unsigned marks, labial_factors_t *before, labial_factors_t *own)
{
    solver->position = any_int ? terms->position : position;
    before->q = own->q = contact;
    before->rho = own->rho = (uint16_t)marks;
    before->kappa = own->kappa = any_uint16;
}

void labial_trajectory_back(const labial_factors_t *factors, unsigned size, unsigned newest, unsigned count,
                            unsigned wanted, unsigned place, unsigned places, int16_t *motion)
{
    /*@ assert wanted <= count; */
    /*@ assert count <= size; */
    /*@ assert wanted <= places; */
    motion[place * LABIAL_CHANNELS] = (int16_t)factors[newest].rho;
    motion[(places - 1u) * LABIAL_CHANNELS] = (int16_t)factors[size - 1u].rho;
}

/* As labial_init() does. */
static void lay_out(int stride)
{
    labial_factors_t *factors;
    stream.stride = (uint8_t)stride;
    stream.tracks =
        (labial_track_t *)(void *)(workspace +
                                   (LABIAL_WORKSPACE_SIZE(MOST) - LABIAL_WORKSPACE_SIZE((unsigned)stride)) / 4u);
    factors = (labial_factors_t *)(void *)(stream.tracks + LABIAL_CHANNELS);
    stream.frames = (labial_frame_t *)(void *)(factors + LABIAL_CHANNELS * LABIAL_FACTORS_((unsigned)stride));
    stream.motion = (int16_t *)(void *)(stream.frames + stride + LABIAL_LAG);
}

/* With more frames than the delay all that entered are as many. */
static void take(int stride, int entered, int beyond)
{
    int i;
    lay_out(stride);
    FILL(workspace);
    for (i = 0; i < LABIAL_CHANNELS; i++)
        stream.tracks[i].search.path[0] = (uint8_t)Frama_C_interval(0, LABIAL_STATES_MAX - 1);
    for (i = 0; i < stride + LABIAL_LAG; i++)
        stream.frames[i].slot = (uint8_t)Frama_C_interval(0, LABIAL_MODELS - 1);
    stream.phase = (uint8_t)Frama_C_interval(0, stride - 1);
    stream.frame_place = (uint8_t)Frama_C_interval(0, stride + LABIAL_LAG - 1);
    stream.factor_place = (uint8_t)Frama_C_interval(0, LABIAL_WINDOW + stride);
    stream.entered = (uint8_t)Frama_C_interval(entered, entered > LABIAL_DELAY(stride) ? 255 : entered);
    stream.beyond = (uint8_t)beyond;
    labial_turns_take(&stream);
}

int main(void)
{
    int stride, entered, beyond, i;
    any_model(&model, 1);
    for (i = 0; i < LABIAL_MODELS; i++)
        stream.models[i] = &model;
    /*@ loop unroll 3; */
    for (stride = 1; stride <= MOST; stride++)
        /*@ loop unroll 9; */
        for (entered = 1; entered <= LABIAL_DELAY(stride) + 1; entered++)
            /*@ loop unroll 9; */
            for (beyond = 0; beyond < entered && beyond <= LABIAL_DELAY(stride); beyond++)
                take(stride, entered, beyond);
    return 0;
}

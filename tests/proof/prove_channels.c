/*
 * Any marks, models, targets and contacts, any phase, with every stride and every number of frames that entered and that lie
 * beyond the last one; in a workspace that ends with that of the stride.
 * viterbi.c, trajectory.c and followers.c are not part of it; their stand-ins here give any of their results, and touch the ends of
 * what those read and write.
 */
#include "any_model.h"
#include "channels.h"
#include "trajectory.h"
#include "viterbi.h"

#define MOST LABIAL_SEARCH_STRIDE_MAX

static uint32_t workspace[LABIAL_WORKSPACE_SIZE(MOST, LABIAL_CHANNELS) / 4];
static labial_model_t model;
static const labial_model_t *models[LABIAL_MODELS];

void labial_viterbi_step(const labial_model_t *any, const labial_channel_t *channel, int32_t position, unsigned marks,
                         labial_search_t *search)
{
    search->first = (uint8_t)(any->state_count + channel->emissions[0].mean + position + (int)(marks & 255u));
    search->path[0] = (uint8_t)Frama_C_interval(0, LABIAL_STATES_MAX - 1);
}

void labial_trajectory_terms(const labial_channel_t *channel, unsigned state, int32_t gain, labial_terms_t *terms)
{
    /*@ assert 0 <= gain <= 512; */
    terms->position = channel->states[state].mean + gain;
}

/* Writes own[0] of every frame as if it were its solution's last: that frames are marked so that what is read was written
 * is units.c's. */
void labial_trajectory_rows(labial_solver_t *solver, const labial_terms_t *terms, const labial_frame_t *frame,
                            unsigned channel, unsigned count, labial_factors_t *own)
{
    unsigned i;
    /*@ assert 1 <= count <= LABIAL_SEARCH_STRIDE_MAX; */
    own[-1].q = any_int32;
    own[-1].rho = own[-1].kappa = any_uint16;
    for (i = 0; i < count; i++) {
        solver->position = any_int ? terms->position : frame[i].target[channel];
        solver->hold = (uint16_t)(frame[i].contacts >> channel & 1u);
        own[i].q = any_int32;
        own[i].rho = own[i].kappa = any_uint16;
    }
}

void labial_trajectory_back(const labial_factors_t *newest, unsigned ahead, unsigned wanted, unsigned place,
                            unsigned places, int16_t *motion)
{
    /*@ assert place < places; */
    /*@ assert wanted <= places; */
    motion[place] = (int16_t)newest->q;
    motion[places - 1u] = (int16_t)newest[-(int)(ahead + wanted - 1u)].q;
}

void labial_followers_complete(const labial_model_t *any, const int16_t *motion, unsigned spacing,
                               int16_t frame[LABIAL_CHANNELS])
{
    frame[0] = motion[0];
    frame[LABIAL_CHANNELS - 1] = motion[(any->channel_count - 1u) * spacing];
}

/* A step with this many frames that entered; with more than the delay all that entered are as many. */
static void step_with(int stride, int entered, int beyond)
{
    labial_channels_t channels;
    uint32_t *start =
        workspace + (sizeof workspace - LABIAL_WORKSPACE_SIZE((unsigned)stride, LABIAL_CHANNELS)) / sizeof *workspace;
    int i;
    labial_channels_init(&channels, (unsigned)stride, LABIAL_CHANNELS, start);
    FILL(workspace);
    for (i = 0; i < LABIAL_CHANNELS; i++)
        channels.progress[i].search.path[0] = (uint8_t)Frama_C_interval(0, LABIAL_STATES_MAX - 1);
    for (i = 0; i <= LABIAL_DELAY(stride); i++)
        channels.slots[i] = (uint8_t)Frama_C_interval(0, LABIAL_MODELS - 1);
    channels.stepping = (uint8_t)Frama_C_interval(0, LABIAL_CHANNELS);
    channels.phase = (uint8_t)Frama_C_interval(0, stride - 1);
    channels.entered = (uint8_t)Frama_C_interval(entered, entered > LABIAL_DELAY(stride) ? 255 : entered);
    channels.beyond = (uint8_t)beyond;
    labial_channels_step(&channels, models, Frama_C_interval(0, 512));
}

/* What comes before a step and after it, with any number of frames. */
static void pass(int stride)
{
    labial_channels_t channels;
    int16_t frame[LABIAL_CHANNELS];
    int i;
    labial_channels_init(&channels, (unsigned)stride, LABIAL_CHANNELS, workspace);
    labial_channels_reset(&channels);
    FILL(workspace);
    channels.phase = (uint8_t)Frama_C_interval(0, stride - 1);
    channels.entered = any_uint8;
    channels.beyond = (uint8_t)Frama_C_interval(0, LABIAL_DELAY(stride) - 1);
    channels.stepping = (uint8_t)Frama_C_interval(0, LABIAL_CHANNELS);
    for (i = 0; i <= LABIAL_DELAY(stride); i++)
        channels.slots[i] = (uint8_t)Frama_C_interval(0, LABIAL_MODELS - 1);
    if (labial_channels_due(&channels, models, frame))
        channels.phase = (uint8_t)(frame[0] + frame[LABIAL_CHANNELS - 1] > 0 ? 0 : channels.phase);
    if (any_int)
        labial_channels_enter(&channels, models, (unsigned)Frama_C_interval(0, LABIAL_MODELS - 1))->marks = any_uint8;
    else
        labial_channels_run_out(&channels);
}

int main(void)
{
    int stride, entered, beyond, i;
    any_model(&model, 1);
    for (i = 0; i < LABIAL_MODELS; i++)
        models[i] = &model;
    /*@ loop unroll 8; */
    for (stride = 1; stride <= MOST; stride++) {
        pass(stride);
        /*@ loop unroll 14; */
        for (entered = 1; entered <= LABIAL_DELAY(stride) + 1; entered++)
            /*@ loop unroll 14; */
            for (beyond = 0; beyond < entered && beyond <= LABIAL_DELAY(stride); beyond++)
                step_with(stride, entered, beyond);
    }
    return 0;
}

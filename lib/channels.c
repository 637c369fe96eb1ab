/*
 * channels.c - the channel step (channels.h).
 *
 * Frames are named by their age here: how many ticks ago they were taken.
 */
#include "channels.h"

#include <string.h>

#include "protrusion.h"
#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

void labial_channels_init(labial_channels_t *channels, unsigned stride, void *workspace)
{
    channels->stride = (uint8_t)stride;
    channels->progress = (labial_progress_t *)workspace;
    channels->frames = (labial_frame_t *)(void *)(channels->progress + LABIAL_CHANNELS);
    channels->motion = (int16_t *)(void *)(channels->frames + stride + LABIAL_LAG);
    labial_channels_reset(channels);
}

void labial_channels_reset(labial_channels_t *channels)
{
    /* Zeros, or a first backward pass would go on into frames that were forgotten. */
    memset(channels->progress, 0, LABIAL_WORKSPACE_SIZE((uint32_t)channels->stride));
    channels->entered = channels->beyond = channels->full = 0;
    channels->phase = (uint8_t)(channels->stride - 1u);
}

static void shift(labial_channels_t *channels)
{
    const unsigned size = channels->stride + LABIAL_LAG;
    unsigned i;
    channels->phase = (uint8_t)(channels->phase + 1u < channels->stride ? channels->phase + 1u : 0u);
    if (channels->entered < 255u)
        channels->entered++;
    for (i = 1; i < size; i++)
        channels->frames[i - 1u] = channels->frames[i];
    for (i = LABIAL_DELAY(channels->stride); i > 0; i--)
        channels->slots[i] = channels->slots[i - 1u];
    if (channels->full > 0)
        channels->full--;
}

/* Lets the last channel go on after frames that had none: in the midst of a solution, whose frames before count for
 * nothing; a pending row must be held by something. */
static void resume(labial_progress_t *progress)
{
    memset(progress, 0, sizeof *progress);
    progress->solver.hold = LABIAL_WEIGHT_MIN;
}

labial_frame_t *labial_channels_enter(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                                      unsigned slot)
{
    shift(channels);
    channels->slots[0] = (uint8_t)slot;
    if (labial_channel_count(models[slot]) == LABIAL_CHANNELS) {
        if (LABIAL_LAG == 0 && channels->full == 0)
            resume(&channels->progress[LABIAL_CHANNELS - 1]);
        channels->full = (uint8_t)(LABIAL_DELAY(channels->stride) + 1);
    }
    return &channels->frames[channels->stride + LABIAL_LAG - 1];
}

void labial_channels_run_out(labial_channels_t *channels)
{
    shift(channels);
    channels->beyond++;
}

int labial_channels_uses(const labial_channels_t *channels, unsigned slot)
{
    const unsigned delay = LABIAL_DELAY(channels->stride);
    unsigned age;
    for (age = channels->beyond; age < delay && age < channels->entered; age++)
        if (channels->slots[age] == slot)
            return 1;
    return 0;
}

const int16_t *labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS])
{
    const unsigned delay = LABIAL_DELAY(channels->stride);
    int16_t *motion = channels->motion + channels->phase * LABIAL_CHANNELS;
    if (channels->entered <= delay)
        return NULL;
    labial_protrusion_complete(models[channels->slots[delay]], motion);
    return motion;
}

/* One channel in its step. */
typedef struct {
    const labial_model_t *const *models;
    const uint8_t *slots;         /* by age */
    const labial_frame_t *latest; /* the frame of age 0 */
    labial_progress_t *progress;
    labial_factors_t *end; /* those of age LABIAL_LAG, the latest frame whose row can be known */
    unsigned channel;
    int32_t gain; /* articulation */
} step_t;

/* The model of the frame of an age. */
static const labial_model_t *model_of(const step_t *step, int age)
{
    return step->models[step->slots[age]];
}

/* Searches a state for the frames from `age` on, down to `least` or to the end of their solution, by the target of the
 * frame of age `middle` or of the one nearest to it; returns the age of the last. */
static int search(const step_t *step, int age, int least, int middle)
{
    const labial_model_t *model = model_of(step, age);
    labial_search_t *own = &step->progress->search;
    const int first = age;
    unsigned marks = step->latest[-age].marks;
    int32_t position;
    while (!(marks & LABIAL_ENDS) && age > least)
        marks |= step->latest[-(--age)].marks;
    middle = middle > first ? first : middle < age ? age : middle;
    position = step->latest[-middle].target[step->channel];
    labial_viterbi_step(model, &model->channels[step->channel], position, marks, own);
    labial_viterbi_span(own, (unsigned)(first - age + 1));
    return age;
}

/* Adds the rows of the frames of ages `age` to `last`, of which there may be none; the search stands at the frame of age
 * `searched`. Returns the age of the next row. */
static int solve(const step_t *step, int age, int last, int searched)
{
    const labial_search_t *own = &step->progress->search;
    while (age >= last) {
        const int first = age;
        const labial_frame_t *frame = step->latest - first;
        const unsigned state = labial_viterbi_state(own, (unsigned)(age - searched));
        labial_terms_t terms;
        labial_trajectory_terms(&model_of(step, first)->channels[step->channel], state, step->gain, &terms);
        do /* without a lag all of them are of one solution and have the same state */
            age--;
        while (age >= last && (LABIAL_LAG == 0 || (!(step->latest[-(age + 1)].marks & LABIAL_ENDS) &&
                                                   labial_viterbi_state(own, (unsigned)(age - searched)) == state)));
        labial_trajectory_rows(&step->progress->solver, &terms, frame, step->channel, (unsigned)(first - age),
                               step->end - (first - LABIAL_LAG));
    }
    return age;
}

/* Copies what a channel keeps from step to step. */
static inline void keep(labial_factors_t *to, const labial_factors_t *from)
{
    *(labial_kept_t *)(void *)to = *(const labial_kept_t *)(const void *)from;
}

static void step_channel(const labial_channels_t *channels, const labial_model_t *const *models, unsigned channel,
                         int32_t gain)
{
    const int stride = channels->stride, beyond = channels->beyond, entered = channels->entered;
    const int newest = beyond > LABIAL_LAG ? beyond : LABIAL_LAG; /* whose row is due */
    labial_factors_t work[LABIAL_WINDOW + LABIAL_SEARCH_STRIDE_MAX + 1], *own;
    int age = (entered < stride ? entered : stride) - 1;
    int row = (entered < stride + LABIAL_LAG ? entered : stride + LABIAL_LAG) - 1;
    step_t step;
    step.models = models;
    step.slots = channels->slots;
    step.latest = channels->frames + stride + LABIAL_LAG - 1;
    step.progress = &channels->progress[channel];
    step.end = work + LABIAL_WINDOW + stride;
    step.channel = channel;
    step.gain = gain;
    keep(work, step.progress->kept.of);
    step.end->q = 0; /* stays so where the latest row waits for the next one */
    step.end->rho = step.end->kappa = 0;
    if (entered < stride + LABIAL_LAG) /* rows are still missing, and the backward pass goes over their places */
        memset(work + LABIAL_WINDOW + 1, 0, (unsigned)stride * sizeof *work);
    while (age >= beyond) {
        const int searched = search(&step, age, beyond, stride - 1 - stride / 2);
        row = solve(&step, row, searched + LABIAL_LAG, searched);
        age = searched - 1;
    }
    if (LABIAL_LAG > 0)
        solve(&step, row, newest, beyond);
    age = newest - LABIAL_LAG < stride ? newest - LABIAL_LAG : stride;
    for (own = step.end - age + 1; own <= step.end; own++) { /* as if all frames beyond were equal to the last */
        own->q = own[-1].q;
        own->rho = own->kappa = 0;
    }
    /* The latest row waits for the next one, unless it is its solution's last. */
    age = beyond > LABIAL_LAG || (step.latest[-LABIAL_LAG].marks & LABIAL_ENDS) ? 0 : 1;
    labial_trajectory_back(step.end - age, (unsigned)(LABIAL_WINDOW + 1 - age), (unsigned)stride,
                           (channels->phase > 0 ? channels->phase : (unsigned)stride) - 1u, (unsigned)stride,
                           channels->motion + channel);
    keep(step.progress->kept.of, work + stride);
}

void labial_channels_step(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS], int32_t gain)
{
    /* With a lag the last channel never rests: its rows ask for the states of frames long before. */
    const unsigned count = LABIAL_LAG > 0 || channels->full > 0 ? LABIAL_CHANNELS : LABIAL_CHANNELS_SOLVED;
    unsigned channel;
    for (channel = channels->phase; channel < count; channel += channels->stride)
        step_channel(channels, models, channel, gain);
}

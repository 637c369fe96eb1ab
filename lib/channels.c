/*
 * channels.c - the channel step (channels.h).
 *
 * Frames are named by their age here: how many ticks ago they were accepted.
 */
#include "channels.h"

#include <string.h>

#include "trajectory.h"
#include "units.h"
#include "viterbi.h"

#if !LABIAL_PAPER /* published.c is in its place then */

labial_shape_t *labial_channels_init(labial_channels_t *channels, unsigned stride, unsigned width, void *workspace)
{
    channels->stride = (uint8_t)stride;
    channels->width = (uint8_t)width;
    channels->progress = (labial_progress_t *)workspace;
    channels->frames = (labial_frame_t *)(void *)(channels->progress + width);
    channels->motion = (int16_t *)(void *)(channels->frames + stride + LABIAL_LAG);
    return (labial_shape_t *)(void *)(channels->motion + stride * width);
}

void labial_channels_reset(labial_channels_t *channels)
{
    /* Zeros, or a first backward pass would go on into frames that were forgotten. */
    memset(channels->progress, 0, (size_t)((char *)channels->motion - (char *)channels->progress));
    channels->entered = channels->beyond = channels->stepping = 0;
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
}

/* Lets a channel go on after frames that had none: in the midst of a solution, whose frames before count for nothing; a
 * pending row must be held by something, and with a lag states of those frames are asked for. */
static void resume(labial_progress_t *progress)
{
    memset(progress, 0, sizeof *progress);
    progress->solver.hold = LABIAL_WEIGHT_MIN;
    labial_viterbi_span(&progress->search, 255);
}

/* How many channels step, once the newest frame has `count`: those of the widest model in hand. Where it has fewer than
 * step, one that has as many is in hand, or as many frames as can be have been taken since. */
static void widen(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS], unsigned count)
{
    const unsigned delay = LABIAL_DELAY((unsigned)channels->stride);
    unsigned most = count, age;
    for (age = 1; most < channels->stepping && age <= delay; age++)
        if (models[channels->slots[age]]->channel_count > most)
            most = models[channels->slots[age]]->channel_count;
    for (age = channels->stepping; age < most && channels->stepping > 0; age++)
        resume(&channels->progress[age]);
    channels->stepping = (uint8_t)most;
}

labial_frame_t *labial_channels_enter(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                                      unsigned slot)
{
    shift(channels);
    channels->slots[0] = (uint8_t)slot;
    widen(channels, models, models[slot]->channel_count);
    return &channels->frames[channels->stride + LABIAL_LAG - 1];
}

void labial_channels_run_out(labial_channels_t *channels)
{
    shift(channels);
    channels->beyond++;
}

int labial_channels_due(const labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS],
                        int16_t frame[LABIAL_CHANNELS])
{
    const unsigned delay = LABIAL_DELAY(channels->stride);
    if (channels->entered <= delay)
        return 0;
    labial_followers_complete(models[channels->slots[delay]], channels->motion + channels->phase, channels->stride,
                              frame);
    return 1;
}

/* One channel in its step. */
typedef struct {
    const labial_model_t *const *models;
    const uint8_t *slots;         /* by age */
    const labial_frame_t *latest; /* the frame of age 0 */
    labial_progress_t *progress;
    labial_factors_t *end; /* those of age LABIAL_LAG, the latest frame whose row can be known */
    unsigned channel;
    int32_t gain;   /* articulation */
    unsigned place; /* of the last frame that becomes due, in the rings of motion */
} step_t;

/* The model of the frame of an age. */
static const labial_model_t *model_of(const step_t *step, int age)
{
    return step->models[step->slots[age]];
}

/* Which of a model's channels the step's is: the first where the model has fewer. */
static unsigned channel_in(const step_t *step, const labial_model_t *model)
{
    return step->channel < model->channel_count ? step->channel : 0u;
}

/* Searches a state for the frames from `age` on, down to `least` or to the end of their solution, by the target of the
 * frame of age `middle` or of the one nearest to it; returns the age of the last. */
static int search(const step_t *step, int age, int least, int middle)
{
    const labial_model_t *model = model_of(step, age);
    const unsigned channel = channel_in(step, model);
    labial_search_t *own = &step->progress->search;
    const int first = age;
    unsigned marks = step->latest[-age].marks;
    int32_t position;
    while (!(marks & LABIAL_ENDS) && age > least)
        marks |= step->latest[-(--age)].marks;
    middle = middle > first ? first : middle < age ? age : middle;
    if (LABIAL_LAG == 0 && step->channel >= model->channel_count) {
        own->path[0] = 0; /* which every model has: nobody asks */
        return age;
    }
    position = step->latest[-middle].target[channel];
    labial_viterbi_step(model, &model->channels[channel], position, marks, own);
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
        const labial_model_t *model = model_of(step, first);
        const unsigned channel = channel_in(step, model);
        labial_terms_t terms;
        labial_trajectory_terms(&model->channels[channel], state, step->gain, &terms);
        do /* without a lag all of them are of one solution and have the same state */
            age--;
        while (age >= last && (LABIAL_LAG == 0 || (!(step->latest[-(age + 1)].marks & LABIAL_ENDS) &&
                                                   labial_viterbi_state(own, (unsigned)(age - searched)) == state)));
        labial_trajectory_rows(&step->progress->solver, &terms, frame, channel, (unsigned)(first - age),
                               step->end - (first - LABIAL_LAG));
    }
    return age;
}

/* Copies what a channel keeps from step to step. */
static inline void keep(labial_factors_t *to, const labial_factors_t *from)
{
    *(labial_kept_t *)(void *)to = *(const labial_kept_t *)(const void *)from;
}

/* Searches and solves a channel up to the latest frame, and goes back from there to the frames that are due. `work` holds
 * the factors: what the channel kept, then those of age stride - 1 to 0. */
static void step_channel(const labial_channels_t *channels, step_t *step, labial_factors_t *work, unsigned channel)
{
    const int stride = channels->stride, beyond = channels->beyond, entered = channels->entered;
    const int newest = beyond > LABIAL_LAG ? beyond : LABIAL_LAG; /* whose row is due */
    labial_factors_t *own;
    int age = (entered < stride ? entered : stride) - 1;
    int row = (entered < stride + LABIAL_LAG ? entered : stride + LABIAL_LAG) - 1;
    step->progress = &channels->progress[channel];
    step->channel = channel;
    keep(work, step->progress->kept.of);
    step->end->q = 0; /* stays so where the latest row waits for the next one */
    step->end->rho = step->end->kappa = 0;
    if (entered < stride + LABIAL_LAG) /* rows are still missing, and the backward pass goes over their places */
        memset(work + LABIAL_WINDOW + 1, 0, (unsigned)stride * sizeof *work);
    while (age >= beyond) {
        const int searched = search(step, age, beyond, stride - 1 - stride / 2);
        row = solve(step, row, searched + LABIAL_LAG, searched);
        age = searched - 1;
    }
    if (LABIAL_LAG > 0)
        solve(step, row, newest, beyond);
    age = newest - LABIAL_LAG;
    /* As if all frames beyond were equal to the last. */
    for (own = step->end - (age < stride ? age : stride); own < step->end; own++) {
        own[1].q = own->q;
        own[1].rho = own[1].kappa = 0;
    }
    /* The latest row waits for the next one, unless it is its solution's last. */
    age = step->latest[-LABIAL_LAG].marks & LABIAL_ENDS ? 0 : 1;
    labial_trajectory_back(step->end - age, (unsigned)(LABIAL_WINDOW + 1 - age), (unsigned)stride, step->place,
                           (unsigned)stride, channels->motion + channel * (unsigned)stride);
    keep(step->progress->kept.of, work + stride);
}

void labial_channels_step(labial_channels_t *channels, const labial_model_t *const models[LABIAL_MODELS], int32_t gain)
{
    labial_factors_t work[LABIAL_WINDOW + LABIAL_SEARCH_STRIDE_MAX + 1];
    step_t step;
    unsigned channel;
    step.models = models;
    step.slots = channels->slots;
    step.latest = channels->frames + channels->stride + LABIAL_LAG - 1;
    step.end = work + LABIAL_WINDOW + channels->stride;
    step.gain = gain;
    step.place = (channels->phase > 0 ? channels->phase : channels->stride) - 1u;
    for (channel = channels->phase; channel < channels->stepping; channel += channels->stride)
        step_channel(channels, &step, work, channel);
}

#endif

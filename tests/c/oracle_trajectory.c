/*
 * oracle_trajectory.c - equation 3 as a system of equations, and streams put together of all steps.
 */
#include "oracle.h"

#include <stdlib.h>
#include <string.h>

/* ---- Equation 3 ---- */

/* An equation: what frames t - 2 .. t + 2 weigh in it, and its right-hand side. */
typedef struct {
    double a[5], right;
} equation_t;

/* Adds a row of W around frame t, with its precision and mean. */
static void add_row(equation_t *equations, size_t t, double before, double own, double behind, double precision,
                    double mean)
{
    double w[3];
    int i, k;
    w[0] = before;
    w[1] = own;
    w[2] = behind;
    for (i = -1; i <= 1; i++) {
        if (w[i + 1] == 0.0)
            continue;
        for (k = -1; k <= 1; k++)
            equations[(ptrdiff_t)t + i].a[2 + k - i] += w[i + 1] * w[k + 1] * precision;
        equations[(ptrdiff_t)t + i].right += w[i + 1] * precision * mean;
    }
}

static void fill(equation_t *equations, const labial_channel_t *channel, const uint8_t *path, const int16_t *targets,
                 const uint16_t *contacts, unsigned bit, size_t count)
{
    size_t t;
    for (t = 0; t < count; t++) {
        const labial_state_t *state = &channel->states[path[t]];
        const double firm = fixture_weight_value(channel->contact_weight);
        double hold = fixture_weight_value(state->hold);
        double anchor = hold * (state->share < 128 ? state->share : state->share + 1) / 256.0;
        if (contacts[t] >> bit & 1u)
            anchor = hold = firm > hold ? firm : hold;
        add_row(equations, t, 0, 1, 0, hold - anchor, state->mean);
        add_row(equations, t, 0, 1, 0, anchor, targets[t]);
        if (t == 0 || t + 1 == count)
            continue;
        add_row(equations, t, -0.5, 0, 0.5, 4.0 * fixture_weight_value(state->weight[0]),
                fixture_motion(channel, state, 0));
        add_row(equations, t, 1, -2, 1, fixture_weight_value(state->weight[1]), fixture_motion(channel, state, 1));
    }
}

void oracle_trajectory(const labial_channel_t *channel, const uint8_t *path, const int16_t *targets,
                       const uint16_t *contacts, unsigned bit, size_t count, const size_t *start, double *motion)
{
    equation_t *e = (equation_t *)calloc(count + 2, sizeof *e);
    size_t t, i;
    if (!e)
        abort();
    fill(e, channel, path, targets, contacts, bit, count);
    for (t = 0; t < count; t++) /* Gauss: frame t leaves the two equations behind its own */
        for (i = 1; i <= 2 && t + i < count; i++) {
            const double factor = e[t + i].a[2 - i] / e[t].a[2];
            e[t + i].a[3 - i] -= factor * e[t].a[3];
            e[t + i].a[4 - i] -= factor * e[t].a[4];
            e[t + i].right -= factor * e[t].right;
        }
    for (t = 0; t < count; t++) {
        const size_t from = start ? start[t] : count - 1;
        const double *a = e[from].a;
        double m1 = e[from].right / (a[2] + a[3] + a[4]), m2 = m1; /* as if the next two were equal to it */
        for (i = from; i-- > t;) {
            const double m = (e[i].right - e[i].a[3] * m1 - e[i].a[4] * m2) / e[i].a[2];
            m2 = m1;
            m1 = m;
        }
        motion[t] = m1 + channel->centre;
    }
    free(e);
}

void oracle_starts(const labial_model_t *model, unsigned channel, size_t first, size_t count, size_t *start)
{
    const size_t stride = model->search_stride, last = first + count - 1;
    size_t t;
    for (t = 0; t < count; t++) {
        /* the channel's first turn in which the frame is due; the frame LABIAL_LAG before it has its row, and what came
         * before that all it is tied to */
        size_t turn = first + t + LABIAL_WINDOW + LABIAL_LAG + 1;
        while (turn % stride != channel % stride)
            turn++;
        start[t] = (last <= turn - LABIAL_LAG ? last : turn - LABIAL_LAG - 1) - first;
    }
}

/* ---- A whole stream ---- */

#define FADE 8

typedef struct {
    const labial_model_t *const *models;
    oracle_frame_t *frames;
    int16_t (*targets)[LABIAL_CHANNELS];
    uint16_t *contacts;
    size_t count;
} stream_t;

static double limited(double value)
{
    return value > INT16_MAX ? INT16_MAX : value < -INT16_MAX ? -INT16_MAX : value;
}

/* The motion of one solution. */
static void solve(const stream_t *stream, size_t first, size_t count, double (*motion)[LABIAL_CHANNELS])
{
    const labial_model_t *model = stream->models[stream->frames[first].model];
    uint8_t *path = (uint8_t *)malloc(count);
    int16_t *targets = (int16_t *)malloc(count * sizeof *targets);
    size_t *start = (size_t *)malloc(count * sizeof *start), t;
    double *m = (double *)malloc(count * sizeof *m);
    unsigned c;
    if (!path || !targets || !start || !m)
        abort();
    for (c = 0; c < LABIAL_CHANNELS; c++) {
        oracle_search(model, c, stream->frames + first, (const int16_t(*)[LABIAL_CHANNELS])(stream->targets + first),
                      first, count, path);
        for (t = 0; t < count; t++)
            targets[t] = stream->targets[first + t][c];
        oracle_starts(model, c, first, count, start);
        oracle_trajectory(&model->channels[c], path, targets, stream->contacts + first, c, count, start, m);
        for (t = 0; t < count; t++)
            motion[first + t][c] = limited(m[t]);
    }
    free(path);
    free(targets);
    free(start);
    free(m);
}

/* Frame j of a fade, from `held`, which moves on by `pace` / 2, / 4, ... */
static double faded(double fresh, double held, double pace, unsigned j)
{
    const double s = j / (FADE + 1.0), share = s * s * (3.0 - 2.0 * s);
    const double base = held + pace * (1.0 - 1.0 / (double)(1u << j));
    return base + (fresh - base) * share;
}

static void fade(const stream_t *stream, const double *pose, double (*motion)[LABIAL_CHANNELS])
{
    double held[LABIAL_CHANNELS] = { 0 }, pace[LABIAL_CHANNELS] = { 0 };
    unsigned c, j = 0;
    int is_paced = 0; /* neither of the two frames before is missing, and the later one did not fade */
    size_t t;
    for (t = 0; t < stream->count; t++) {
        if (stream->frames[t].begins && (t > 0 || pose)) {
            for (c = 0; c < LABIAL_CHANNELS; c++) {
                held[c] = t > 0 ? motion[t - 1][c] : pose[c];
                pace[c] = is_paced ? held[c] - motion[t - 2][c] : 0.0;
            }
            j = 1;
        }
        for (c = 0; j > 0 && c < LABIAL_CHANNELS; c++)
            motion[t][c] = limited(faded(motion[t][c], held[c], pace[c], j));
        is_paced = t > 0 && j == 0;
        j = j > 0 && j < FADE ? j + 1 : 0;
    }
}

size_t oracle_stream(const labial_model_t *const *models, const fixture_phoneme_t *input, size_t count,
                     const double *held, double (*motion)[LABIAL_CHANNELS], size_t room)
{
    stream_t stream;
    size_t first, t;
    stream.models = models;
    stream.frames = (oracle_frame_t *)malloc(room * sizeof *stream.frames);
    stream.targets = (int16_t(*)[LABIAL_CHANNELS])malloc(room * sizeof *stream.targets);
    stream.contacts = (uint16_t *)malloc(room * sizeof *stream.contacts);
    if (!stream.frames || !stream.targets || !stream.contacts)
        abort();
    stream.count = oracle_units(models, input, count, stream.frames, room);
    oracle_targets(models, stream.frames, stream.count, stream.targets, stream.contacts);
    for (first = t = 0; t < stream.count; t++)
        if (stream.frames[t].ends) {
            solve(&stream, first, t + 1 - first, motion);
            first = t + 1;
        }
    fade(&stream, held, motion);
    free(stream.frames);
    free(stream.targets);
    free(stream.contacts);
    return stream.count;
}
